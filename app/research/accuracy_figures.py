"""Draw the contact sheet of an accuracy run: every body from the front and the left, with landmarks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from textwrap import shorten, wrap

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure as Sheet
from scipy.ndimage import gaussian_filter, grey_erosion

from app.rendering.palette import LIGHT
from app.research.accuracy import DOUBTED, TRUSTED, Case
from app.research.figure_style import print_style
from core.errors import UserError
from core.files.atomic_write import atomic_path
from core.geometry.mesh import Faces, Floats, Points
from core.scan.readers.registry import read_triangles, scan_bytes

COLUMNS, ROWS = 5, 4
CELL = (3.9, 4.3)
"""Width and height of a body on the sheet [inch]."""

DOTS = 100  # per inch
TALL, WIDE = 320, {"front": 232, "left": 148}
"""Height and widths of the views of a body [pixels]."""

BODY = (450.0, 350.0, 1200.0)
"""How far skin lies from the middle of the landmarks at most: to the side, in depth, in height [mm]."""

SAMPLES = 300_000
ALONG = {"front": (0, 1, 1.0), "left": (1, 0, -1.0)}
"""Per view: the axis to the right, the one into the picture, and its sign: whether it grows into it."""


def save_sheets(cases: Sequence[Case], folder: Path, out: Path) -> list[Path]:
    """Write one picture for each ``COLUMNS`` x ``ROWS`` bodies to ``out``; return their names.

    Rings are true landmarks, dots found ones: green if sure, amber if not quite, red if unsure.
    """
    each = COLUMNS * ROWS
    pages = [cases[first : first + each] for first in range(0, len(cases), each)]
    written = []
    for number, page in enumerate(pages, start=1):
        name = out / f"accuracy-{number}.png"
        with print_style(), atomic_path(name) as partial:
            _page(page, folder).savefig(partial, format="png", dpi=DOTS, metadata={"Software": "Busk"})
        written.append(name)
    return written


def _page(cases: Sequence[Case], folder: Path) -> Sheet:
    rows = -(-len(cases) // COLUMNS)
    drawn = Sheet(figsize=(COLUMNS * CELL[0], rows * CELL[1]))
    FigureCanvasAgg(drawn)
    for place, case in enumerate(cases):
        row, column = divmod(place, COLUMNS)
        box = ((column + 0.02) / COLUMNS, 1.0 - (row + 0.83) / rows, 0.96 / COLUMNS, 0.74 / rows)
        axes = drawn.add_axes(box)
        _draw(axes, case, folder)
    return drawn


def _draw(axes: Axes, case: Case, folder: Path) -> None:
    """Draw one body from two sides with its name above and its verdict below."""
    axes.set_axis_off()
    axes.set_title(shorten(case.truth.name.replace("_", " "), 60), loc="center", fontsize=9)
    good = case.right and case.sure
    colour = LIGHT.text_quiet if good else LIGHT.warn if case.right else LIGHT.bad
    words = "\n".join(wrap(verdict(case), 56)[:3])
    axes.text(0.5, -0.02, words, transform=axes.transAxes, ha="center", va="top", fontsize=8, color=colour)
    try:
        vertices, faces = read_triangles(case.truth.file, scan_bytes(folder / case.truth.file))
    except UserError:
        return
    skin = vertices @ case.to_mm[:3, :3].T + case.to_mm[:3, 3]
    samples = _samples(skin, faces)
    low, high = np.percentile(samples[_about(samples, case)], (0.5, 99.5), axis=0)
    width, depth, height = high - low
    middle, size = 0.5 * (low + high), max(height / TALL, width / WIDE["front"], depth / WIDE["left"])
    images, shift = [], 0
    for view in ALONG:
        images.append(_picture(samples, middle, 1.05 * size, view, 3 if len(faces) else 7))
        _landmarks(axes, case, view, middle, 1.05 * size, shift)
        shift += WIDE[view]
    axes.imshow(np.concatenate(images, axis=1), cmap="gray", vmin=0.0, vmax=1.0, aspect="equal")
    axes.set_xlim(0, shift)
    axes.set_ylim(TALL, 0)


def verdict(case: Case) -> str:
    """Return in a few words what came of a file."""
    if case.truth.refuse:
        return f"refused, as it should be: {case.failed}" if case.failed else "should have been refused"
    if case.failed:
        return case.failed
    if not case.right:
        wrong = [] if case.unit_right else ["unit"]
        wrong += [] if case.sides_right else ["sides"]
        return f"{' and '.join(wrong) or f'turned by {case.turned:.0f} degrees'}: wrong" + (
            ", and sure of it" if case.sure else ", but asks"
        )
    worst = sorted(case.marks, key=lambda mark: -mark.off)[:2]
    words = [f"{mark.name.replace('_', ' ')} {mark.off:.1f} mm ({mark.confidence:.2f})" for mark in worst]
    return "; ".join(words) + ("" if case.sure else "; asks")


def _samples(vertices: Points, faces: Faces) -> Points:
    """Return points spread over the triangles, shape (n, 3); the vertices of a cloud as they are."""
    if len(faces) == 0:
        return vertices
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    times = np.ceil(SAMPLES * areas / max(float(areas.sum()), 1e-12)).astype(np.int64)
    row = np.repeat(np.arange(len(faces)), np.minimum(times, 4000))
    u, v = np.random.default_rng(0).random((2, len(row), 1))
    over = u + v > 1.0
    u, v = np.where(over, 1.0 - u, u), np.where(over, 1.0 - v, v)
    return np.asarray(a[row] + u * (b - a)[row] + v * (c - a)[row])


def _about(samples: Points, case: Case) -> npt.NDArray[np.bool_]:
    """Return which samples lie about the landmarks: not the far ends of what the body stands on."""
    if not case.true:
        return np.ones(len(samples), dtype=bool)
    away = np.abs(samples - np.mean(list(case.true.values()), axis=0))
    return np.asarray((away < BODY).all(axis=1))


def _pixels(points: Points, middle: Points, size: float, view: str) -> Floats:
    """Return where points, shape (n, 3) [mm], lie in a view, shape (n, 2) [pixels right, down]."""
    right, _, _ = ALONG[view]
    across = 0.5 * WIDE[view] + (points[:, right] - middle[right]) / size
    return np.stack([across, 0.5 * TALL - (points[:, 2] - middle[2]) / size], axis=1)


def _picture(samples: Points, middle: Points, size: float, view: str, spot: int) -> npt.NDArray[np.float64]:
    """Return a shaded picture of the skin that is in front; ``size`` is that of a pixel [mm].

    A sample is ``spot`` pixels wide, so that no skin behind is seen between two.
    """
    _, into, sign = ALONG[view]
    at = np.floor(_pixels(samples, middle, size, view)).astype(np.int64)
    inside = ((at >= 0) & (at < (WIDE[view], TALL))).all(axis=1)
    depth = np.full((TALL, WIDE[view]), np.inf)
    np.minimum.at(depth, (at[inside, 1], at[inside, 0]), sign * samples[inside, into])
    depth = grey_erosion(depth, size=(spot, spot))
    seen = np.isfinite(depth)
    weight = gaussian_filter(seen.astype(float), 0.8)
    smooth = gaussian_filter(np.where(seen, depth, 0.0), 0.8) / np.where(weight > 0.0, weight, 1.0)
    down, right = np.gradient(smooth / size)
    light = (0.35 * right + 0.5 * down + 0.8) / np.sqrt(1.0 + right**2 + down**2)
    return np.where(seen, np.clip(0.25 + 0.65 * light, 0.1, 0.97), 1.0)


def _landmarks(axes: Axes, case: Case, view: str, middle: Points, size: float, shift: int) -> None:
    confidence = {mark.name: mark.confidence for mark in case.marks} | dict(case.invented)
    for name, at in _seen(case.true, view):
        x, y = _pixels(at[None], middle, size, view)[0]
        axes.plot(shift + x, y, "o", ms=6.5, mfc="none", mec=LIGHT.text, mew=0.9)
        if name in case.found:
            u, v = _pixels(case.found[name][None], middle, size, view)[0]
            axes.plot([shift + x, shift + u], [y, v], color=LIGHT.text, lw=0.7)
    for name, at in _seen(case.found, view):
        sure = confidence.get(name)
        colour = LIGHT.exact_curve if sure is None else _colour(sure)
        x, y = _pixels(at[None], middle, size, view)[0]
        axes.plot(shift + x, y, "o", ms=3.4, mfc=colour, mec="white", mew=0.4)


def _seen(points: Mapping[str, Points], view: str) -> Iterator[tuple[str, Points]]:
    return ((name, at) for name, at in points.items() if view == "front" or not name.endswith("right"))


def _colour(confidence: float) -> str:
    if confidence >= TRUSTED:
        return LIGHT.ok
    return LIGHT.warn_mark if confidence >= DOUBTED else LIGHT.bad
