"""Fig. 10: slings round the breasts in place of the line, as the search found them (ours)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from app.research.cases import BODIES, CONTROLS, TURNS, Study, bust_heights, curve
from app.research.fig_1_3_5 import AZIMUTH, ELEVATION
from app.research.figure_scene import body_picture, view_of
from app.research.figure_style import COLOURS, Figure, sheet, show, trimmed
from app.research.parameter_study import routes
from core.document.lines import CustomLine

RATIOS = (0.97, 0.6)

COLUMNS = (
    "curve",
    "body",
    "control",
    "set_percent",
    "turn",
    "bust_point_change_mm",
    "volume_error_percent",
)


def figure_10(study: Study) -> Figure:
    """Draw Figs. 6 and 7 again with slings from the upper edge round each breast."""
    drawn = sheet(8.4)
    axes = drawn.subplots(4, 2, height_ratios=(1.35, 1.0, 1.0, 1.0))
    rows: list[tuple[object, ...]] = []
    said = []
    for column, (letter, body) in enumerate(BODIES.items()):
        own = _show_slings(study, body, axes[0, column], f"({letter}) {body} with slings")
        for ratio in RATIOS:
            ends, first = {}, 0.0
            for digit, control in CONTROLS.items():
                solution = study.solved(body, ratio, control, TURNS, own_lines=own)
                records, words = curve(solution), solution.verdict.words
                height = bust_heights(records)[:, 0]
                error = np.array([record.error * 100.0 for record in records])
                style = {"color": COLOURS[control], "label": f"{letter}{digit} {control}"}
                axes[1 + RATIOS.index(ratio), column].plot(height - height[0], **style)
                if ratio == RATIOS[0]:
                    axes[3, column].plot(error, **style)
                name = (f"{letter}{digit}", body, control, 100.0 * ratio)
                rows += [
                    (*name, turn, float(h - height[0]), float(e))
                    for turn, (h, e) in enumerate(zip(height, error, strict=True))
                ]
                ends[digit] = height[-20:].mean() - height[0]
                first = max(first, float(np.abs(error[:11]).max())) if control == "adaptive" else first
            said.append(
                f"{body} at {100 * ratio:.0f} %: bust points {ends['1']:+.2f} and {ends['2']:+.2f} mm, first "
                f"error {first:.2f} % ({words})"
            )
    _name_axes(axes)
    caption = (
        "Slings from the upper edge of the control mesh round each breast, glued, in place of the line. "
        "Conventional and adaptive force at the end, and largest error of the first ten turns, adaptive: "
        f"{'; '.join(said)}."
    )
    return Figure("fig-10-slings", "Slings instead of the line", caption, COLUMNS, rows, drawn)


def _name_axes(axes: np.ndarray) -> None:
    """Say what the plots (4, 2) are of; those beside each other have one height."""
    for line, ratio in zip(axes[1:3], RATIOS, strict=True):
        line[0].set_ylabel(f"bust point, change in\nheight [mm], {100 * ratio:.0f} %")
    axes[3, 0].set_ylabel(f"volume error [%], {100 * RATIOS[0]:.0f} %")
    for plot in axes[3]:
        plot.set_xlabel("turn")
        plot.legend(loc="lower right")
    for line in axes[1:]:
        line[1].sharey(line[0])
        line[0].autoscale(axis="y")


def _show_slings(study: Study, body: str, plot: Axes, title: str) -> tuple[CustomLine, ...]:
    """Show a body with its slings, and return them."""
    stages = study.stages(body)
    paths = routes(stages.control)["slings"]
    points = {name: stages.control.mesh.vertices[list(path)] for name, path in paths.items()}
    view = view_of(stages.control.mesh, AZIMUTH, ELEVATION, margin=1.5)
    picture = body_picture(stages.body.mesh, study.occlusion(body), view, paths=points)
    show(plot, trimmed([picture])[0], title)
    return tuple(CustomLine(name, path) for name, path in sorted(paths.items()))
