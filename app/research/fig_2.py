"""Fig. 2: a sphere with a horizontal or a vertical line that is shorter, at rest, or longer."""

from __future__ import annotations

import numpy as np

from app.research.cases import Study
from app.research.figure_scene import Image, body_picture, control_picture, line_picture, view_of
from app.research.figure_style import Figure, sheet, show, trimmed
from app.research.sphere import SphereModel, sphere_model
from core.geometry.mesh import Points
from core.mechanics.exact_solution import solve_exact

ROWS = (("shorter", 0.8), ("original", 1.0), ("longer", 1.15))

COLUMNS = (
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
    said = "; ".join(
        f"{row[0]} {row[1]:.0f} %: {row[3]:.0f} and {row[4]:.0f} mm" for row in rows if row[1] != 100.0
    )
    caption = (
        "A sphere 200 mm across, control mesh of 168 polygons with no fixed point, body of 20,480, solved "
        f"exactly. Size across the line's plane and in it: {said}. Volume of the control mesh within "
        f"{max(abs(float(str(row[5]))) for row in rows):.1g} %, of the body within "
        f"{max(abs(float(str(row[6]))) for row in rows):.2g} %."
    )
    return Figure("fig-2-sphere", "Lines round a sphere", caption, COLUMNS, rows, drawn)


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
