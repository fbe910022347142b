"""What a bust detector must doubt or refuse: men, breasts taken away, clothes, stone, forms, leaning, sizes.

Each maker returns a scan in mm and its body if its landmarks are known, and the doubt that should be raised.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import potpourri3d
from cloth import COLUMNS, STEP, in_shirt
from people import Cut, Figure, People, Person, Rng, cut_out, rotated
from scipy import sparse
from scipy.ndimage import gaussian_filter
from scipy.sparse.linalg import spsolve
from worn_scans import Scan

Draw = Callable[..., Person]
FOREIGN = {"foot": 304.8, "yard": 914.4}
"""Units that a file may have though the program does not offer them [mm]."""


@dataclass(frozen=True)
class Odd:
    """A scan in the canonical frame, the doubts that should be raised, and how it is written.

    ``scale``: the true size over that of the file read in ``unit``; ``lean``: degrees forward and aside.
    """

    scan: Scan
    kinds: list[str]
    expects: list[str]
    refuse: bool = False
    scale: float = 1.0
    unit: str = "mm"
    lean: tuple[float, float] = (0.0, 0.0)


def man(people: People, draw: Draw, rng: Rng) -> Odd:
    """A man, slim to stout; his chest may be muscular or soft."""
    one = draw(rng, weight=(0.2, 1.0), muscle=(0.2, 1.0), gender=(0.9, 1.0))
    pecs = float(rng.uniform(0.0, 1.0))
    one = replace(one, details={**one.details, "torso/torso-muscle-pectoral-incr": pecs})
    return Odd(_scan(_cut(people, one, rng)), ["man"], ["no breasts"])


def removed(people: People, draw: Draw, rng: Rng) -> Odd:
    """A woman both of whose breasts were taken away."""
    one = draw(rng, cup=(0.4, 0.9), weight=(0.3, 0.9))
    figure = flattened(_cut(people, replace(one, relief=False), rng))
    return Odd(_scan(figure), ["removed"], ["no breasts"])


def flattened(figure: Figure) -> Figure:
    """Take both breasts away: the chest runs on there as evenly as it can (a thin plate, by its edge)."""
    v, faces = figure.mesh.vertices, figure.mesh.faces
    stiff = potpourri3d.cotan_laplacian(v, faces)
    bend = (
        stiff @ sparse.diags_array(1.0 / np.maximum(potpourri3d.vertex_areas(v, faces), 0.1)) @ stiff
    ).tocsr()
    inside = figure.share > 0.05
    rest = -bend[inside][:, ~inside] @ v[~inside]
    v = v.copy()
    v[inside] = spsolve(bend[inside][:, inside].tocsc(), rest)
    return figure.moved(v)


def clothed(people: People, draw: Draw, rng: Rng) -> Odd:
    """A woman in a loose T-shirt."""
    one = draw(rng, cup=(0.3, 0.9), weight=(0.2, 0.9))
    return Odd(_scan(in_shirt(_cut(people, one, rng), rng)), ["shirt"], ["clothes"])


def stone(people: People, draw: Draw, rng: Rng) -> Odd:
    """A block of stone: rough, or with a bust carved out of its front."""
    size = rng.uniform((240.0, 180.0, 380.0), (360.0, 300.0, 620.0))
    rows = int(size[2] / STEP)
    turn = np.arange(COLUMNS)[None, :] * (2.0 * np.pi / COLUMNS)
    power = rng.uniform(4.0, 14.0)
    half_x, half_y = size[0] / 2.0, size[1] / 2.0
    block = (np.abs(np.sin(turn) / half_x) ** power + np.abs(np.cos(turn) / half_y) ** power) ** (
        -1.0 / power
    )
    up = np.linspace(0.0, 1.0, rows)[:, None]
    radius = block * (1.0 + rng.uniform(-0.15, 0.15) * (up - 0.5))
    kinds = ["stone"]
    carved = rng.random()
    if carved < 0.7:
        kinds.append("carved")
        front = np.clip(np.cos(turn), 0.0, 1.0) ** 0.5
        height, spread, out = rng.uniform(0.5, 0.7), rng.uniform(28.0, 45.0), rng.uniform(25.0, 70.0)
        apart = rng.uniform(55.0, 90.0)
        for side in (1.0, -1.0):
            x = radius * np.sin(turn) - side * apart
            z = (up - height) * size[2]
            below = np.where(z < 0.0, 0.8, 1.4)
            radius = radius + front * out * np.exp(-((x / spread) ** 2) - (z / (below * spread)) ** 2)
    rough = gaussian_filter(rng.normal(size=radius.shape), rng.uniform(1.0, 4.0), mode=("nearest", "wrap"))
    radius = radius + rough / rough.std() * rng.uniform(0.3, 3.0)
    return Odd(_closed(radius, rng), kinds, ["no body"], refuse=True)


def _closed(radius: np.ndarray, rng: Rng) -> Scan:
    """Return a closed surface of radii around the z axis, shape (rows, COLUMNS) [mm], with flat ends."""
    rows, count = radius.shape
    turn = np.arange(count) * (2.0 * np.pi / count)
    z = np.repeat(np.arange(rows) * STEP, count).reshape(rows, count)
    side = np.stack([radius * np.sin(turn), -radius * np.cos(turn), z], axis=2).reshape(-1, 3)
    at = (np.arange(rows - 1)[:, None] * count + np.arange(count)).ravel()
    right = at - at % count + (at + 1) % count
    faces = [np.stack([at, right, at + count], 1), np.stack([right, right + count, at + count], 1)]
    ends = []
    for row, outward in ((0, -1), (rows - 1, 1)):
        middle = side[row * count : (row + 1) * count].mean(axis=0)
        ring = row * count + np.arange(count)
        nexts = np.roll(ring, -1)
        cap = np.stack([np.full(count, len(side) + len(ends)), ring, nexts], 1)
        faces.append(cap if outward > 0 else cap[:, ::-1])
        ends.append(middle)
    return np.concatenate([side, ends]), np.concatenate(faces)


def form(people: People, draw: Draw, rng: Rng) -> Odd:
    """A dress form at half scale: smooth, closed flat at neck, arms and hips."""
    one = draw(rng, cup=(0.4, 0.8), weight=(0.3, 0.6), firmness=(0.6, 1.0))
    figure = people.figure(replace(one, relief=False, uneven=0.3), rng)
    figure = cut_out(figure, Cut(0.05, 0.35, float(rng.uniform(0.0, 60.0)), 0.0))
    return Odd(_scan(figure), ["form"], ["size"], scale=0.5, unit=str(rng.choice(["cm", "cm", "mm", "inch"])))


def sized(people: People, draw: Draw, rng: Rng) -> Odd:
    """A woman whose file is larger or smaller than she is, or in feet or yards."""
    figure = _cut(people, draw(rng, weight=(0.25, 0.85)), rng)
    if rng.random() < 0.35:
        name = str(rng.choice(list(FOREIGN)))
        return Odd(_scan(figure), ["sized", name], ["size"], unit=name)
    scale = float(rng.choice([0.5, 0.6, 0.7, 0.8, 0.85, 1.15, 1.25, 1.4, 1.6, 1.8]))
    unit = str(rng.choice(["mm", "cm", "m", "inch"]))
    return Odd(_scan(figure), ["sized", f"x{scale:g}"], ["size"], scale=scale, unit=unit)


def leaning(people: People, draw: Draw, rng: Rng) -> Odd:
    """A woman who leans forward, back or aside in a file that is level and was cut level."""
    figure = people.figure(draw(rng, weight=(0.2, 0.9)), rng, whole=False)
    degrees = float(rng.uniform(5.0, 20.0))
    forward, aside = ((degrees, 0.0), (-degrees, 0.0), (0.0, degrees), (0.0, -degrees))[
        int(rng.choice(4, p=[0.4, 0.2, 0.2, 0.2]))
    ]
    figure = rotated(figure, forward, aside)
    level = bool(rng.random() < 0.6)
    neck, hips = float(rng.uniform(0.2, 0.8)), float(rng.uniform(20.0, 120.0))
    figure = cut_out(figure, Cut(float(rng.uniform(0.1, 0.5)), neck, hips if level else -1e3, 0.0))
    way = "forward" if forward > 0 else "back" if forward < 0 else "aside"
    return Odd(_scan(figure), ["leaning", way], ["lean"], lean=(forward, aside))


ODD: dict[str, Callable[[People, Draw, Rng], Odd]] = {
    "men": man,
    "removed": removed,
    "clothed": clothed,
    "stones": stone,
    "forms": form,
    "sized": sized,
    "leaning": leaning,
}


def _cut(people: People, one: Person, rng: Rng) -> Figure:
    arm = float(rng.choice([rng.uniform(0.1, 0.5), 2.0], p=[0.75, 0.25]))
    return cut_out(
        people.figure(one, rng), Cut(arm, float(rng.uniform(0.1, 0.8)), float(rng.uniform(-20.0, 120.0)))
    )


def _scan(figure: Figure) -> Scan:
    return figure.mesh.vertices, figure.mesh.faces


def odd_entry(odd: Odd, matrix: np.ndarray, name: str) -> dict[str, Any]:
    """Return what truth.json tells of it."""
    return {
        "file": f"{name}.ply",
        "kinds": odd.kinds,
        "expects": odd.expects,
        "refuse": odd.refuse,
        "canonical_to_file": matrix.tolist(),
        "scale": odd.scale,
        "written_in": odd.unit,
        "lean_deg": list(odd.lean),
    }
