"""Figures 6 to 10 of the paper: volume, lengths and shapes over iterations."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap

from app.rendering.palette import LIGHT
from app.research.cases import (
    BODIES,
    EXCESSIVE,
    LINE,
    MODEST,
    PAPER_CONTROLS,
    TEMPLATE,
    TURNS,
    Study,
    bust_heights,
    curve,
)
from app.research.fig_1_to_5 import AZIMUTH, ELEVATION
from app.research.figure_scene import body_picture, view_of
from app.research.figure_style import COLOURS, Figure, sheet, show, trimmed
from app.research.parameter_study import routes
from core.document.lines import CustomLine
from core.geometry.mesh import Floats
from core.mechanics.iteration import LineTargets, iterate
from core.pipeline.model_stages import line_targets
from core.pipeline.stages import GAIN_SHARE

LENGTHS = (EXCESSIVE, MODEST)


def figure_6(study: Study) -> Figure:
    """Draw the height of bust points and apex over the turns: a1, a2, b1, b2 (paper Fig. 6)."""
    drawn = sheet(8.2)
    axes = drawn.subplots(4, 2, sharex=True, sharey="row")
    rows: list[tuple[object, ...]] = []
    texts = []
    for block, ratio in enumerate(LENGTHS):
        for column, (letter, body) in enumerate(BODIES.items()):
            upper, lower = axes[2 * block, column], axes[2 * block + 1, column]
            ends = {}
            for digit, control in PAPER_CONTROLS.items():
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
            texts.append(
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
        "Adaptive less conventional, means of the last 20 turns: " + "; ".join(texts) + "."
    )
    columns = ("curve", "body", "control", "set_percent", "turn", "bust_point_change_mm", "apex_change_mm")
    return Figure("fig-6-bust-point", "Height of the bust points", caption, columns, rows, drawn)


def figure_7(study: Study) -> Figure:
    """Draw the volume error over the turns: a1, a2, b1, b2 (paper Fig. 7)."""
    drawn = sheet(4.6)
    axes = drawn.subplots(2, 2, sharex=True, sharey="row")
    rows: list[tuple[object, ...]] = []
    texts = []
    for block, ratio in enumerate(LENGTHS):
        for column, (letter, body) in enumerate(BODIES.items()):
            plot = axes[block, column]
            for digit, control in PAPER_CONTROLS.items():
                solution = study.solved(body, ratio, control, TURNS)
                errors = np.array([(r.error * 100.0, r.error_ml) for r in curve(solution)])
                _line(plot, errors[:, 0], control, f"{letter}{digit} {control}")
                name = (f"{letter}{digit}", body, control, 100.0 * ratio)
                rows += [(*name, turn, *map(float, pair)) for turn, pair in enumerate(errors)]
                texts.append(_error_words(f"{letter}{digit} at {100 * ratio:.0f} %", errors))
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
        + "; ".join(texts)
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
    texts = []
    for column, (letter, body) in enumerate(BODIES.items()):
        # Turns hold the volume of both breasts together, so they are set against the answer that does.
        exact = study.solved(body, ratio, "exact", volume_of="both")
        for control in ("conventional", "accumulating", "adaptive"):
            away, error = study.way_to(body, ratio, control, turns, exact.state.moved)
            for plot, values in zip(axes[:, column], (away, 100.0 * np.abs(error)), strict=True):
                plot.semilogy(np.arange(turns + 1), values, color=COLOURS[control], label=control)
            rows += _way_rows(body, control, away, error)
            texts.append(
                f"{body}, {control}: {away[-1]:.2g} mm and {100 * error[-1]:+.2g} % after {turns} iterations"
            )
        away, error = study.newton_way(body, ratio, exact.state.moved)
        axes[0, column].semilogy(away, "D-", ms=2.6, lw=0.8, color=COLOURS["exact"], label="exact, Newton")
        rows += _way_rows(body, "exact", away, error)
        axes[0, column].set_title(f"({letter}) {body}, line at {100 * ratio:.0f} %")
        axes[1, column].set_xlabel("iteration or Newton step")
        texts.append(
            f"{body}, exact: {exact.last.iteration} Newton steps, {abs(100 * exact.last.error):.1g} %"
        )
    _label_distances(axes)
    caption = (
        "Largest distance of a control point to the exact answer with one pressure for both breasts, as "
        "turns have, and size of the volume error; accumulating: half of each error is added. "
        + "; ".join(texts)
        + "."
    )
    columns = ("body", "control", "turn_or_step", "distance_to_exact_mm", "volume_error_percent")
    return Figure(
        "fig-8-exact", "Both controls compared with the exact solution", caption, columns, rows, drawn
    )


def _label_distances(axes: Any) -> None:
    """Label the plots of distance and volume error, (2, 2)."""
    axes[0, 0].set_ylabel("maximum distance to the\nexact solution [mm]")
    axes[1, 0].set_ylabel("volume error [%]")
    axes[0, 0].legend(loc="upper right", bbox_to_anchor=(1.0, 0.77))
    axes[0, 0].set_ylim(1e-5, 30.0)
    axes[1, 0].set_ylim(1e-9, 10.0)


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


SWEPT_RATIOS = np.round(np.arange(0.51, 1.12, 0.06), 3)  # not 1: at rest there is no error to flip
GAINS = np.round(np.arange(1.10, 1.71, 0.04), 3)
SWEPT_TURNS = 120
STEPS = (0.0, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 1e3)
"""Bounds of the classes of swing [%]; the lowest counts as calm, the highest is divergence."""

SHADES = ("#F4F2EF", "#FCE4B8", "#F2BC5E", "#D98516", "#A04B0B", "#4A1D06")


def figure_9(study: Study) -> Figure:
    """Draw the swing of the volume left after a run, over line length and conventional gain (ours)."""
    drawn = sheet(3.5)
    axes = drawn.subplots(1, 2, sharey=True)[None][0]
    rows: list[tuple[object, ...]] = []
    texts = []
    for plot, (letter, body) in zip(axes, BODIES.items(), strict=True):
        limit = study.stages(body).gain_limit
        swing = np.array([[_swing(study, body, r, "conventional", g) for r in SWEPT_RATIOS] for g in GAINS])
        calm = [_swing(study, body, r, "adaptive", 1.0) for r in SWEPT_RATIOS]
        picture = _draw_gains(plot, swing, limit)
        plot.set_title(f"({letter}) {body}, {TEMPLATE[body]} triangles")
        rows += [
            (body, 100.0 * float(ratio), float(gain), float(swing[j, i]), limit)
            for j, gain in enumerate(GAINS)
            for i, ratio in enumerate(SWEPT_RATIOS)
        ]
        texts.append(
            f"{body}: limit {limit:.2f}, default {GAIN_SHARE * limit:.2f}; the adaptive force leaves at most "
            f"{max(calm):.1g} % at any of these lengths"
        )
    axes[0].set_ylabel("gain of the conventional force [1]")
    axes[0].legend(loc="lower right")
    bar = drawn.colorbar(picture, ax=axes, extend="neither", ticks=STEPS[1:-1])
    bar.set_ticklabels(["0.001", "0.01", "0.1", "1", "10"])
    bar.set_label("amplitude per iteration [%]")
    caption = (
        f"Largest swing of the volume from turn to turn in the last 12 of {SWEPT_TURNS} turns. Line: the "
        "gain limit computed at rest before any turn is made; dashed: the default gain. "
        + "; ".join(texts)
        + "."
    )
    columns = ("body", "set_percent", "gain", "swing_percent", "gain_limit_at_rest")
    return Figure(
        "fig-9-gain-map", "Stability region of the conventional force", caption, columns, rows, drawn
    )


def _draw_gains(plot: Axes, swing: Floats, limit: float) -> Any:
    """Draw the swing [%] over length and gain, with the limit of the gain and its default."""
    shades, norm = ListedColormap(SHADES), BoundaryNorm(STEPS, len(SHADES))
    picture = plot.pcolormesh(100.0 * SWEPT_RATIOS, GAINS, swing, cmap=shades, norm=norm)
    plot.axhline(limit, color=LIGHT.text, lw=1.2, label="limit computed on the original body")
    plot.axhline(GAIN_SHARE * limit, color=LIGHT.text, lw=1.2, ls=(0, (3, 2)), label="default gain")
    plot.set_xlabel("set length of the line [% of original]")
    plot.grid(visible=False)
    return picture


def _swing(study: Study, body: str, ratio: float, control: str, gain: float) -> float:
    """Return the largest flip of the volume error from turn to turn at the end of a run [%]."""
    stages = study.stages(body)
    asked = line_targets(replace(stages.design.with_line(LINE, float(ratio)), volume=control), stages)
    targets: LineTargets = replace(asked, gain=float(gain))
    errors: Floats = np.array(
        [measured.error for _, measured in iterate(stages.model, lambda: targets, turns=SWEPT_TURNS)]
    )
    if len(errors) < SWEPT_TURNS or not np.isfinite(errors).all():
        return STEPS[-1]
    # The second difference of a flip-flop is twice its swing; that of a slow approach almost nothing.
    return float(min(50.0 * np.abs(np.diff(errors[-14:], 2)).max(), STEPS[-1]))


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
    texts = []
    for column, (letter, body) in enumerate(BODIES.items()):
        own = _show_slings(study, body, axes[0, column], f"({letter}) {body} with slings")
        for ratio in RATIOS:
            ends, first = {}, 0.0
            for digit, control in PAPER_CONTROLS.items():
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
            texts.append(
                f"{body} at {100 * ratio:.0f} %: bust points {ends['1']:+.2f} and {ends['2']:+.2f} mm, first "
                f"error {first:.2f} % ({words})"
            )
    _name_axes(axes)
    caption = (
        "Slings from the upper edge of the control mesh round each breast, glued, in place of the line. "
        "Conventional and adaptive force at the end, and largest error of the first ten turns, adaptive: "
        f"{'; '.join(texts)}."
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
