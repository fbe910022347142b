"""Figure 11: the waist line of a whole trunk, over iterations and in the exact solution (ours)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from app.rendering.palette import LIGHT
from app.research.cases import Study
from app.research.figure_scene import body_picture, view_of
from app.research.figure_style import COLOURS, Figure, sheet, show, trimmed
from app.research.lower_cases import LAST, RATIOS, WAIST, Course, LowerStudy
from core.control_mesh.lower_template import SEAT, read_lower_template

PARTS = {0.97: "-", 0.99: (0, (4, 1.5)), 1.01: (0, (1.5, 1.5)), 1.05: "-"}
"""Gains of the conventional force in parts of the computed limit, and how their courses are drawn."""

CALM, EXCESSIVE = 0.97, 1.05
"""The gains whose errors are shown: the default one, and one just beyond the limit."""

SEEN = (-16.0, 8.0)
"""Errors that are shown [% of the zone]: those beyond the gain limit grow out of any scale."""

SHOWN_ROWS = range(2, 10)
WAISTED = 0.9
"""The length at which one volume is compared with one in each zone."""

COLUMNS = ("set_percent", "control", "gain_over_limit", "turn", "distance_to_exact_mm")


def figure_11(study: Study) -> Figure:
    """Draw errors and swings of the zones under a waist line, and what a single volume would do."""
    lower = study.lower
    drawn = sheet(7.4)
    axes = drawn.subplots(3, 3, height_ratios=(1.0, 1.0, 1.25))
    rows: list[tuple[object, ...]] = []
    texts = []
    for column, ratio in enumerate(RATIOS):
        adaptive = lower.course(ratio, "adaptive")
        conventional = {part: lower.course(ratio, "conventional", part) for part in PARTS}
        _errors(axes[0, column], adaptive, conventional)
        _swings(axes[1, column], adaptive, conventional)
        axes[0, column].set_title(f"waist line at {100 * ratio:.0f} %")
        rows += _rows(ratio, "adaptive", None, adaptive)
        for part, course in conventional.items():
            rows += _rows(ratio, "conventional", part, course)
        texts.append(f"{100 * ratio:.0f} %, " + _words(lower.gain_limit(ratio), adaptive, conventional))
    _label_axes(axes)
    apart = _compared_volumes(lower, axes[2])
    stages = lower.stages(RATIOS[0])
    caption = (
        f"The waist line of the whole trunk, over {len(adaptive.zones) - 1} iterations. Top: the zone that "
        f"the line presses, with the adaptive force and the conventional one at {CALM:g} and {EXCESSIVE:g} "
        "of its gain limit. Middle: the largest flip of any of the five zones from iteration to iteration. "
        "The limit is computed where the run comes to rest; that on the original body is "
        f"{stages.gain_limit:.3f}. "
        + "; ".join(texts)
        + f". Bottom: how far control points move outward in the exact solution at {100 * WAISTED:.0f} %, "
        f"all volume kept; one volume for the trunk pushes the seat out by up to {apart[0]:.1f} mm, five "
        f"zones by {apart[1]:.1f} mm."
    )
    names = tuple(f"{name}_error_percent_of_zone" for name in stages.control.zone_names)
    return Figure(
        "fig-11-lower-trunk", "Waist line on a whole trunk", caption, (*COLUMNS, *names), rows, drawn
    )


def _label_axes(axes: np.ndarray) -> None:
    """Say what the plots (3, 3) are of; those beside each other have one height."""
    for first, *others in (axes[0], axes[1], axes[2, 1:]):
        for plot in others:
            plot.sharey(first)
            plot.tick_params(labelleft=False)
    axes[0, 0].set_ylabel("volume error of the\nwaist zone [% of it]")
    axes[0, 0].set_ylim(*SEEN)
    axes[1, 0].set_ylabel("swing of a zone\n[% of its volume]")
    axes[1, 2].legend(loc="upper center", ncols=3, title="gain / limit", columnspacing=0.9, handlelength=1.4)


def _errors(plot: Axes, adaptive: Course, conventional: dict[float, Course]) -> None:
    for part, width, above in ((EXCESSIVE, 0.5, 2), (CALM, 1.4, 3)):
        error = np.clip(conventional[part].zones[:, 0], 2.0 * SEEN[0], 2.0 * SEEN[1])
        plot.plot(error, color=COLOURS["conventional"], lw=width, zorder=above)
    plot.plot(adaptive.zones[:, 0], color=COLOURS["adaptive"], lw=1.4, zorder=4)
    plot.set_xlabel("iteration")


def _swings(plot: Axes, adaptive: Course, conventional: dict[float, Course]) -> None:
    """Draw how each course swings; straight lines that rise are those beyond the limit."""
    for part, style in PARTS.items():
        thick = 1.8 if part == EXCESSIVE else 1.1
        swing = conventional[part].swings
        plot.semilogy(swing, color=COLOURS["conventional"], ls=style, lw=thick, label=f"{part:g}")
    plot.semilogy(adaptive.swings, color=COLOURS["adaptive"], label="adaptive")
    plot.set_ylim(1e-8, 1e8)
    plot.set_xlabel("iteration")


def _compared_volumes(lower: LowerStudy, axes: np.ndarray) -> tuple[float, float]:
    """Draw body and outward moves by row; return the largest at the seat of one volume and of five [mm]."""
    stages = lower.stages(WAISTED)
    points = stages.control.mesh.vertices
    view = view_of(stages.body.mesh, 125.0, 5.0, margin=1.06)
    line = {WAIST: points[list(stages.control.paths[WAIST])]}
    mesh = (stages.control.mesh, stages.control.fixed)
    picture = body_picture(stages.body.mesh, lower.occlusion(), view, paths=line, control=mesh)
    show(axes[0], trimmed([picture])[0])
    one, five = (lower.outward(WAISTED, together=together) for together in (True, False))
    template = read_lower_template()
    for plot, column, where in ((axes[1], 0, "front centre"), (axes[2], SEAT, "seat")):
        at = [template.point(row, column) for row in SHOWN_ROWS]
        height = points[at, 2] - points[at[1], 2]
        plot.plot(height, one[at], "o-", ms=3, color=LIGHT.warn_mark, label="one volume")
        plot.plot(height, five[at], "o-", ms=3, color=COLOURS["exact"], label="five zones")
        plot.axhline(0.0, color=COLOURS["rest"], lw=0.6)
        plot.set_title(where)
        plot.set_xlabel("height above the waist [mm]")
    axes[1].set_ylabel("moves outward [mm]")
    axes[2].legend(loc="lower left")
    seat = lower.at_seat()
    return float(one[seat].max()), float(five[seat].max())


def _rows(ratio: float, control: str, part: float | None, course: Course) -> list[tuple[object, ...]]:
    pairs = zip(course.away.tolist(), course.zones.tolist(), strict=True)
    return [
        (100.0 * ratio, control, "" if part is None else part, turn, away, *zones)
        for turn, (away, zones) in enumerate(pairs)
    ]


def _words(limit: float, adaptive: Course, conventional: dict[float, Course]) -> str:
    peak, swing = float(np.abs(adaptive.zones).max()), float(adaptive.swings[-LAST:].max())
    parts = ", ".join(f"{c.swings[-LAST:].max():.1g} % at {p:g}" for p, c in conventional.items())
    return (
        f"limit {limit:.3f}: adaptive, peak {peak:.2f} %, at the end swing {swing:.1g} % and "
        f"{adaptive.away[-1]:.1g} mm from the exact solution; conventional, swing {parts} of the limit"
    )
