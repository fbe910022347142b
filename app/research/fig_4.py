"""Fig. 4: the bust from the side, before and after, with and without the volume constraint."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from scipy.spatial import cKDTree

from app.rendering.camera import View
from app.rendering.palette import LIGHT
from app.research.cases import LINE, Study, line_share, moved
from app.research.fig_1_3_5 import line_points
from app.research.figure_scene import Image, body_picture
from app.research.figure_style import COLOURS, Figure, sheet, show, trimmed
from core.geometry.mesh import Floats, Mesh, Points
from core.geometry.plane_sections import arc_length, cut, join_segments, resample
from core.pipeline.build import Stages
from core.pipeline.solve import Solution

BODY = "person"
REACHED = (0.97, 0.90)
"""Reached length of the line with the volume held, over that at rest: the paper's, and a plainer one."""

ABOVE, BELOW = 130.0, 110.0
"""Part of the profile that is drawn, above and below the bust point [mm]."""


def figure_4(study: Study) -> Figure:
    """Draw side views and profiles of the person (paper Fig. 4, a and b)."""
    stages = study.stages(BODY)
    drawn = sheet(6.0)
    upper, lower = np.ravel(np.asarray(drawn.subfigures(2, 1, height_ratios=(1.0, 1.15))))
    plots = [*upper.subplots(1, 3), *lower.subplots(1, 3, width_ratios=(1.0, 1.0, 1.5))]
    axes = dict(zip(("rest", "held", "free", "p0", "p1", "change"), plots, strict=True))
    _show_views(study, stages, [axes[name] for name in ("rest", "held", "free")])
    at = stages.landmarks.position("bust_point_left")
    rest = profile(stages.body.mesh, at)
    way = arc_length(rest)
    way = way[np.linalg.norm(rest - at[1:], axis=1).argmin()] - way
    rows: list[tuple[object, ...]] = [("rest", 100.0, float(y), float(z)) for y, z in rest]
    said = []
    for plot, reached in zip((axes["p0"], axes["p1"]), REACHED, strict=True):
        ratio = study.ratio_for(BODY, reached)
        plot.plot(*rest.T, color=COLOURS["rest"], lw=1.0, ls=(0, (3, 2)), label="before")
        for control, colour, title in (
            ("none", LIGHT.warn_mark, "volume free"),
            ("adaptive", COLOURS["adaptive"], "volume controlled"),
        ):
            solution = study.solved(BODY, ratio, control)
            shape = profile(solution.body, at)
            plot.plot(*shape.T, color=colour, lw=1.2, label=title)
            rows += [(title.replace(" ", "_"), 100.0 * reached, float(y), float(z)) for y, z in shape]
            dashes = "-" if reached == REACHED[0] else (0, (4, 2))
            label = f"{title}, {100 * reached:.0f} %"
            axes["change"].plot(outward(rest, shape), way, color=colour, ls=dashes, lw=1.2, label=label)
            said.append(_words(solution, title))
        _frame(plot, at, f"line {100 * (1 - reached):.0f} % shorter")
    axes["p0"].legend(loc="lower left", fontsize=6.5)
    _name_change(axes["change"])
    caption = (
        f"Side views of the {BODY}, the line reaching {100 * REACHED[0]:.0f} % of its rest length; "
        f"profiles through the left bust point also at {100 * REACHED[1]:.0f} %; with the volume free the "
        "line has the same natural length. " + " ".join(said)
    )
    columns = ("state", "reached_percent_with_volume_held", "profile_y_mm", "profile_z_mm")
    return Figure("fig-4-side-view", "Side view before and after", caption, columns, rows, drawn)


def _show_views(study: Study, stages: Stages, axes: Sequence[Axes]) -> None:
    """Show the body from the side: before, and after with the volume held and free."""
    held, free = (study.solved(BODY, study.ratio_for(BODY, REACHED[0]), c) for c in ("adaptive", "none"))
    pictures = [_picture(study, stages, each) for each in (None, held, free)]
    titles = ("before", "after, volume controlled", "after, volume free")
    for plot, picture, title in zip(axes, trimmed(pictures), titles, strict=True):
        show(plot, picture, title)


def _name_change(plot: Axes) -> None:
    """Say what the plot of the change across the skin is of."""
    plot.axvline(0.0, color=LIGHT.control, lw=0.6)
    plot.set(title="moved outward", xlabel="across the skin [mm]", ylabel="way over the bust point [mm]")
    plot.legend(loc="upper left", fontsize=6.5)


def profile(body: Mesh, at: Floats) -> Points:
    """Return y and z of the front of the section through ``at``, shape (3,), straight from front to back.

    Shape (k, 2) [mm], from top to bottom.
    """
    curves = [points for points, _ in join_segments(cut(body, (at[0], 0.0, 0.0), (1.0, 0.0, 0.0)))]
    outline = max(curves, key=lambda points: float(np.ptp(points[:, 2])))[:, 1:]
    top, bottom = int(outline[:, 1].argmax()), int(outline[:, 1].argmin())
    first, last = min(top, bottom), max(top, bottom)
    ways = [outline[first : last + 1], np.concatenate([outline[last:], outline[: first + 1]])]
    front = min(ways, key=lambda way: float(way[:, 0].mean()))
    front = front if front[0, 1] > front[-1, 1] else front[::-1]
    front = front[(front[:, 1] < at[2] + ABOVE) & (front[:, 1] > at[2] - BELOW)]
    return resample(np.column_stack([front, np.zeros(len(front))]), 1.0)[:, :2]


def outward(rest: Points, shape: Points) -> Floats:
    """Return how far a profile (k, 2) lies outside that at rest, (m, 2), at the points of that, (m,) [mm]."""
    along = np.gradient(rest, axis=0)
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1) / np.linalg.norm(along, axis=1)[:, None]
    fine = resample(np.column_stack([shape, np.zeros(len(shape))]), 0.1)[:, :2]
    _, nearest = cKDTree(fine).query(rest)
    return np.asarray(np.einsum("ij,ij->i", fine[nearest] - rest, normal))


def _picture(study: Study, stages: Stages, solution: Solution | None) -> Image:
    x, y, z = stages.control.mesh.vertices.mean(axis=0)
    view = View((float(x), float(y), float(z)), azimuth=90.0, parallel=True)
    view = view.framing((x - 1, x + 1, y - 90, y + 110, z - 150, z + 150), 1.0, 1.0)
    return body_picture(
        stages.body.mesh,
        study.occlusion(BODY),
        view,
        moved=solution.body.vertices if solution else None,
        paths={LINE: line_points(stages)},
    )


def _frame(plot: Axes, at: Floats, title: str) -> None:
    plot.set(title=title, xlabel="y, backwards [mm]", ylabel="height [mm]")
    plot.set_aspect("equal")
    plot.axhline(at[2], color=LIGHT.line, lw=0.8, zorder=0)


def _words(solution: Solution, title: str) -> str:
    bust, up, forward = moved(solution)
    return (
        f"Line at {100 * line_share(solution):.1f} %, {title}: volume {100 * solution.last.error:+.4f} %, "
        f"apex {up:+.1f} mm up and {forward:+.1f} mm forward, bust points {bust:+.2f} mm up."
    )
