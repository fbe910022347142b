"""Figs. 6, 7 and 8: what happens turn by turn under each volume control."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from app.research.cases import (
    BODIES,
    CONTROLS,
    EXCESSIVE,
    MODEST,
    TEMPLATE,
    TURNS,
    Study,
    bust_heights,
    curve,
)
from app.research.figure_style import COLOURS, Figure, sheet
from core.geometry.mesh import Floats

LENGTHS = (EXCESSIVE, MODEST)


def figure_6(study: Study) -> Figure:
    """Draw the height of bust points and apex over the turns: a1, a2, b1, b2 (paper Fig. 6)."""
    drawn = sheet(8.2)
    axes = drawn.subplots(4, 2, sharex=True, sharey="row")
    rows: list[tuple[object, ...]] = []
    said = []
    for block, ratio in enumerate(LENGTHS):
        for column, (letter, body) in enumerate(BODIES.items()):
            upper, lower = axes[2 * block, column], axes[2 * block + 1, column]
            ends = {}
            for digit, control in CONTROLS.items():
                heights = bust_heights(curve(study.solved(body, ratio, control, TURNS)))
                change = heights - heights[0]
                for at, (plot, values) in enumerate(((upper, change[:, 0]), (lower, change[:, 1]))):
                    _line(plot, values, control, f"{letter}{digit} {control}" if at == 1 else "")
                name = (f"{letter}{digit}", body, control, 100.0 * ratio)
                rows += [(*name, turn, *map(float, pair)) for turn, pair in enumerate(change)]
                ends[digit] = change[-20:].mean(axis=0)
            exact = bust_heights(curve(study.solved(body, ratio, "exact")))
            for plot, level in zip((upper, lower), (exact[-1] - exact[0]).tolist(), strict=True):
                plot.axhline(level, color=COLOURS["exact"], lw=0.9, ls=(0, (4, 3)), zorder=1)
            higher = ends["2"] - ends["1"]
            said.append(
                f"{body} at {100 * ratio:.0f} %: bust point {higher[0]:+.2f} mm, apex {higher[1]:+.2f} mm"
            )
            upper.set_title(f"({letter}) {body}, line at {100 * ratio:.0f} %")
            lower.legend(loc="lower right", ncols=2)
        axes[2 * block, 0].set_ylabel("bust point, change\nin height [mm]")
        axes[2 * block + 1, 0].set_ylabel("apex, change\nin height [mm]")
    for plot in axes[-1]:
        plot.set_xlabel("turn")
    caption = (
        "Height of the bust points (mean of left and right) and of the apex, the foremost place of the "
        f"breasts, over {TURNS} turns, against that at rest. a: mannequin on {TEMPLATE['mannequin']} "
        f"triangles, b: person on {TEMPLATE['person']}; 1: conventional, 2: adaptive; dashed: exact. "
        "Adaptive less conventional, means of the last 20 turns: " + "; ".join(said) + "."
    )
    columns = ("curve", "body", "control", "set_percent", "turn", "bust_point_change_mm", "apex_change_mm")
    return Figure("fig-6-bust-point", "Height of the bust points", caption, columns, rows, drawn)


def figure_7(study: Study) -> Figure:
    """Draw the volume error over the turns: a1, a2, b1, b2 (paper Fig. 7)."""
    drawn = sheet(4.6)
    axes = drawn.subplots(2, 2, sharex=True, sharey="row")
    rows: list[tuple[object, ...]] = []
    said = []
    for block, ratio in enumerate(LENGTHS):
        for column, (letter, body) in enumerate(BODIES.items()):
            plot = axes[block, column]
            for digit, control in CONTROLS.items():
                solution = study.solved(body, ratio, control, TURNS)
                errors = np.array([(r.error * 100.0, r.error_ml) for r in curve(solution)])
                _line(plot, errors[:, 0], control, f"{letter}{digit} {control}")
                name = (f"{letter}{digit}", body, control, 100.0 * ratio)
                rows += [(*name, turn, *map(float, pair)) for turn, pair in enumerate(errors)]
                said.append(_error_words(f"{letter}{digit} at {100 * ratio:.0f} %", errors))
            rest = solution.stages.model.volume.rest_volume / 1e5
            side = plot.secondary_yaxis("right", functions=(lambda p, r=rest: p * r, lambda m, r=rest: m / r))
            side.set_ylabel("[ml]")
            plot.set_title(f"({letter}) {body}, line at {100 * ratio:.0f} %")
            plot.legend(loc="lower left" if ratio == EXCESSIVE else "lower right")
        axes[block, 0].set_ylabel("volume error [%]")
    for plot in axes[-1]:
        plot.set_xlabel("turn")
    caption = (
        f"Volume error of the control mesh over {TURNS} iterations; negative for missing volume. "
        + "; ".join(said)
        + "."
    )
    columns = ("curve", "body", "control", "set_percent", "turn", "volume_error_percent", "volume_error_ml")
    return Figure("fig-7-volume-error", "Volume error", caption, columns, rows, drawn)


def figure_8(study: Study) -> Figure:
    """Draw how far each control is from the exact answer, turn by turn (ours)."""
    ratio, turns = 0.9, 300
    drawn = sheet(4.8)
    axes = drawn.subplots(2, 2, sharex=True, sharey="row")
    rows: list[tuple[object, ...]] = []
    said = []
    for column, (letter, body) in enumerate(BODIES.items()):
        # Turns hold the volume of both breasts together, so they are set against the answer that does.
        exact = study.solved(body, ratio, "exact", volume_of="both")
        for control in ("conventional", "accumulating", "adaptive"):
            away, error = study.way_to(body, ratio, control, turns, exact.state.moved)
            for plot, values in zip(axes[:, column], (away, 100.0 * np.abs(error)), strict=True):
                plot.semilogy(np.arange(turns + 1), values, color=COLOURS[control], label=control)
            rows += _way_rows(body, control, away, error)
            said.append(
                f"{body}, {control}: {away[-1]:.2g} mm and {100 * error[-1]:+.2g} % after {turns} iterations"
            )
        away, error = study.newton_way(body, ratio, exact.state.moved)
        axes[0, column].semilogy(away, "D-", ms=2.6, lw=0.8, color=COLOURS["exact"], label="exact, Newton")
        rows += _way_rows(body, "exact", away, error)
        axes[0, column].set_title(f"({letter}) {body}, line at {100 * ratio:.0f} %")
        axes[1, column].set_xlabel("iteration or Newton step")
        said.append(
            f"{body}, exact: {exact.last.iteration} Newton steps, {abs(100 * exact.last.error):.1g} %"
        )
    axes[0, 0].set_ylabel("maximum distance to the\nexact solution [mm]")
    axes[1, 0].set_ylabel("volume error [%]")
    axes[0, 0].legend(loc="upper right", bbox_to_anchor=(1.0, 0.77))
    axes[0, 0].set_ylim(1e-5, 30.0)
    axes[1, 0].set_ylim(1e-9, 10.0)
    caption = (
        "Largest distance of a control point to the exact answer with one pressure for both breasts, as "
        "turns have, and size of the volume error; accumulating: half of each error is added. "
        + "; ".join(said)
        + "."
    )
    columns = ("body", "control", "turn_or_step", "distance_to_exact_mm", "volume_error_percent")
    return Figure(
        "fig-8-exact", "Both controls compared with the exact solution", caption, columns, rows, drawn
    )


def _way_rows(body: str, control: str, away: Floats, error: Floats) -> list[tuple[object, ...]]:
    pairs = zip(away.tolist(), (100.0 * error).tolist(), strict=True)
    return [(body, control, turn, *pair) for turn, pair in enumerate(pairs)]


def _line(plot: Axes, values: Floats, control: str, label: str) -> None:
    # A curve that flips every turn is drawn thin, or it would melt into a block.
    flips = np.abs(np.diff(values[-20:], 2)).mean() > 0.02 * max(float(np.ptp(values)), 1e-12)
    thick, above = (0.6, 2) if flips else (1.4, 3)
    plot.plot(values, color=COLOURS[control], lw=thick, label=label or None, zorder=above)


def _error_words(name: str, errors: Floats) -> str:
    peak = float(np.abs(errors[:, 0]).max())
    mean, swing = errors[-20:, 0].mean(), np.ptp(errors[-20:, 0]) / 2.0
    return f"{name}: peak {peak:.2f} %, end {mean:+.4f} ± {swing:.2g} %"
