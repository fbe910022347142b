"""Figures 1 to 5 of the paper: bodies, control meshes and convergence."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Sheet
from scipy.spatial import cKDTree

from app.rendering.camera import View
from app.rendering.palette import LIGHT
from app.research.cases import BODIES, LINE, Study, line_share, moved
from app.research.figure_scene import Image, body_picture, control_picture, line_picture, view_of
from app.research.figure_style import COLOURS, Figure, sheet, show, trimmed
from app.research.sphere import SphereModel, sphere_model
from core.document.design import TEMPLATES
from core.geometry.mesh import Floats, Mesh, Points
from core.geometry.plane_sections import arc_length, cut, join_segments, resample
from core.mechanics.exact_solution import solve_exact
from core.pipeline.build import Stages
from core.pipeline.solve import Solution

COLUMNS = (
    "body",
    "body_polygons",
    "control_polygons",
    "control_points",
    "free_control_points",
    "control_volume_ml",
    "line_rest_mm",
)
AZIMUTH, ELEVATION = 25.0, 6.0


def figure_1(study: Study) -> Figure:
    """Draw both bodies, each with both control meshes (paper Fig. 1, which shows the mannequin with 120)."""
    drawn = sheet(4.8)
    axes = drawn.subplots(2, 3, width_ratios=(0.8, 1.0, 1.0))
    rows = []
    for line, (letter, body) in zip(axes, BODIES.items(), strict=True):
        stages = {number: study.stages(body, number) for number in sorted(TEMPLATES)}
        whole = view_of(stages["120"].body.mesh, AZIMUTH, ELEVATION)
        picture = body_picture(stages["120"].body.mesh, study.occlusion(body), whole)
        show(line[0], trimmed([picture])[0], f"({letter}) {body}")
        near = view_of(stages["120"].control.mesh, AZIMUTH, ELEVATION)
        meshes = [
            control_picture(each.control.mesh, near, fixed=each.control.fixed) for each in stages.values()
        ]
        for plot, picture, number in zip(line[1:], trimmed(meshes), stages, strict=True):
            show(plot, picture, f"{number} polygons")
        rows += [_counts(body, each) for each in stages.values()]
    caption = (
        "Left: the bodies, "
        + " and ".join(
            f"{body} of {row[1]:,} polygons" for body, row in zip(BODIES.values(), rows[::2], strict=True)
        )
        + ". Right: the two control meshes laid on each, enlarged; dark points are fixed, light ones move ("
        + " and ".join(f"{row[4]} of {row[3]} on {row[2]} polygons" for row in rows[:2])
        + "). As in the paper, the figures below have 120 polygons on the mannequin and 168 on the person."
    )
    return Figure("fig-1-meshes", "Bodies and control meshes", caption, COLUMNS, rows, drawn)


def figure_3(study: Study) -> Figure:
    """Draw the person and its control mesh with the line (paper Fig. 3)."""
    stages = study.stages("person")
    path = line_points(stages)
    views = [view_of(mesh, AZIMUTH, ELEVATION) for mesh in (stages.body.mesh, stages.control.mesh)]
    pictures = [
        body_picture(stages.body.mesh, study.occlusion("person"), views[0], paths={LINE: path}),
        control_picture(stages.control.mesh, views[1], fixed=stages.control.fixed, paths=[path]),
    ]
    row = _counts("person", stages)
    drawn = _side_by_side(pictures, ("(a) person with the line", "(b) control mesh"))
    caption = (
        f"(a) The person, {row[1]:,} polygons. (b) Its control mesh of {row[2]} polygons; {row[4]} of "
        f"{row[3]} control points are free (light), the others are fixed. The line runs halfway between "
        f"fold and bust points, {row[6]:.0f} mm at rest from side to side."
    )
    return Figure("fig-3-person", "The person with its line", caption, COLUMNS, [row], drawn)


def figure_5(study: Study) -> Figure:
    """Draw both bodies under the control meshes that the turns are made with (paper Fig. 5)."""
    pictures, rows = [], []
    for body in BODIES.values():
        stages = study.stages(body)
        control = (stages.control.mesh, stages.control.fixed)
        view = view_of(stages.body.mesh, AZIMUTH, ELEVATION)
        pictures.append(body_picture(stages.body.mesh, study.occlusion(body), view, control=control))
        rows.append(_counts(body, stages))
    drawn = _side_by_side(pictures, [f"({letter}) {body}" for letter, body in BODIES.items()])
    caption = "The bodies of Figs. 6 and 7 under their control meshes. " + " ".join(
        f"({letter}) {row[0]}: {row[1]:,} polygons, control mesh of {row[2]}, volume {row[5]:,.0f} ml."
        for letter, row in zip(BODIES, rows, strict=True)
    )
    return Figure("fig-5-bodies", "Bodies under their control meshes", caption, COLUMNS, rows, drawn)


def line_points(stages: Stages) -> Points:
    """Return the control points at rest that the paper's line runs through, shape (k, 3) [mm]."""
    return stages.control.mesh.vertices[list(stages.control.paths[LINE])]


def _side_by_side(pictures: list[Image], titles: list[str] | tuple[str, ...]) -> Sheet:
    drawn = sheet(3.9)
    for plot, picture, title in zip(drawn.subplots(1, len(pictures)), pictures, titles, strict=True):
        show(plot, trimmed([picture])[0], title)
    return drawn


def _counts(body: str, stages: Stages) -> tuple[str, int, int, int, int, float, float]:
    control = stages.control
    line = next(line for line in stages.model.lines if line.name == LINE)
    return (
        body,
        len(stages.body.mesh.faces),
        len(control.mesh.faces),
        len(control.mesh.vertices),
        int((~control.fixed).sum()),
        stages.model.volume.rest_volume / 1000.0,
        line.rest_length,
    )


ROWS = (("shorter", 0.8), ("original", 1.0), ("longer", 1.15))

FIG_2_COLUMNS = (
    "line",
    "set_percent",
    "reached_percent",
    "across_mm",
    "along_mm",
    "control_error_percent",
    "body_change_percent",
    "newton_steps",
)


def figure_2(study: Study) -> Figure:
    """Draw lines, control mesh and body for three lengths and two lines (paper Fig. 2)."""
    drawn = sheet(4.0)
    rows: list[tuple[object, ...]] = []
    blocks = np.ravel(np.asarray(drawn.subfigures(1, 2, wspace=0.06)))
    for block, (letter, line) in zip(blocks, (("a", "horizontal"), ("b", "vertical")), strict=True):
        block.suptitle(f"({letter}) {line} line", fontsize=9, fontweight="semibold")
        axes = block.subplots(3, 3)
        pictures: list[Image] = []
        for _, ratio in ROWS:
            row, drawings = _case(line, ratio)
            rows.append(row)
            pictures += drawings
        for at, (plot, picture) in enumerate(zip(axes.ravel(), trimmed(pictures), strict=True)):
            show(plot, picture, ("line", "control mesh", "body")[at] if at < 3 else "")
        for plot, (name, ratio) in zip(axes[:, 0], ROWS, strict=True):
            plot.text(
                -0.08,
                0.5,
                f"{name}, {100 * ratio:.0f} %",
                rotation=90,
                va="center",
                ha="right",
                transform=plot.transAxes,
            )
    text = "; ".join(
        f"{row[0]} {row[1]:.0f} %: {row[3]:.0f} and {row[4]:.0f} mm" for row in rows if row[1] != 100.0
    )
    caption = (
        "A sphere 200 mm across, control mesh of 168 polygons with no fixed point, body of 20,480, solved "
        f"exactly. Size across the line's plane and in it: {text}. Volume of the control mesh within "
        f"{max(abs(float(str(row[5]))) for row in rows):.1g} %, of the body within "
        f"{max(abs(float(str(row[6]))) for row in rows):.2g} %."
    )
    return Figure("fig-2-sphere", "Lines round a sphere", caption, FIG_2_COLUMNS, rows, drawn)


def _case(line: str, ratio: float) -> tuple[tuple[object, ...], list[Image]]:
    """Return the table row of a case and its three pictures."""
    ball = sphere_model((line,))
    balance = solve_exact(ball.model, tuple(ratio if each.name == line else 1.0 for each in ball.model.lines))
    points, body = ball.centred(balance.state.moved), ball.shape(balance.state.moved)
    size = np.ptp(points, axis=0)
    across = 2 if line == "horizontal" else 1
    volume = ball.model.volume
    worn = next(each for each in ball.model.lines if each.name == line)
    row = (
        line,
        100.0 * ratio,
        100.0 * worn.length(points) / worn.rest_length,
        float(size[across]),
        float(np.delete(size, across).mean()),
        100.0 * (volume.volume(points) / volume.rest_volume - 1.0),
        100.0 * (body.enclosed_volume() / ball.body.enclosed_volume() - 1.0),
        balance.steps,
    )
    return row, _pictures(ball, points, body.vertices, line)


def _pictures(ball: SphereModel, points: Points, places: Points, line: str) -> list[Image]:
    view = view_of(ball.body, 35.0, 18.0, 1.45)
    control = ball.control.mesh.moved(points)
    path = points[list(ball.control.paths[line])]
    return [
        line_picture(control, view, [path]),
        control_picture(control, view, fixed=ball.control.fixed, paths=[path]),
        body_picture(ball.body.moved(places), np.ones(len(places)), view),
    ]


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
    texts = []
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
            texts.append(_words(solution, title))
        _frame(plot, at, f"line {100 * (1 - reached):.0f} % shorter")
    axes["p0"].legend(loc="lower left", fontsize=6.5)
    _name_change(axes["change"])
    caption = (
        f"Side views of the {BODY}, the line reaching {100 * REACHED[0]:.0f} % of its rest length; "
        f"profiles through the left bust point also at {100 * REACHED[1]:.0f} %; with the volume free the "
        "line has the same natural length. " + " ".join(texts)
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
