"""Fig. 9: at which gain and length the conventional force is calm, and the limit that is computed before."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap

from app.rendering.palette import LIGHT
from app.research.cases import BODIES, LINE, TEMPLATE, Study
from app.research.figure_style import Figure, sheet
from core.geometry.mesh import Floats
from core.mechanics.iteration import LineTargets, iterate
from core.pipeline.build import GAIN_SHARE, line_targets

RATIOS = np.round(np.arange(0.51, 1.12, 0.06), 3)  # not 1: at rest there is no error to flip
GAINS = np.round(np.arange(1.10, 1.71, 0.04), 3)
TURNS = 120
STEPS = (0.0, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 1e3)
"""Bounds of the classes of swing [%]; the lowest counts as calm, the highest is divergence."""

SHADES = ("#F4F2EF", "#FCE4B8", "#F2BC5E", "#D98516", "#A04B0B", "#4A1D06")


def figure_9(study: Study) -> Figure:
    """Draw the swing of the volume left after a run, over line length and conventional gain (ours)."""
    drawn = sheet(3.5)
    axes = drawn.subplots(1, 2, sharey=True)[None][0]
    rows: list[tuple[object, ...]] = []
    said = []
    for plot, (letter, body) in zip(axes, BODIES.items(), strict=True):
        limit = study.stages(body).gain_limit
        swing = np.array([[_swing(study, body, r, "conventional", g) for r in RATIOS] for g in GAINS])
        calm = [_swing(study, body, r, "adaptive", 1.0) for r in RATIOS]
        picture = plot.pcolormesh(
            100.0 * RATIOS, GAINS, swing, cmap=ListedColormap(SHADES), norm=BoundaryNorm(STEPS, len(SHADES))
        )
        plot.axhline(limit, color=LIGHT.text, lw=1.2, label=("limit computed on the original body"))
        plot.axhline(GAIN_SHARE * limit, color=LIGHT.text, lw=1.2, ls=(0, (3, 2)), label="default gain")
        plot.set_title(f"({letter}) {body}, {TEMPLATE[body]} triangles")
        plot.set_xlabel("set length of the line [% of original]")
        plot.grid(visible=False)
        rows += [
            (body, 100.0 * float(ratio), float(gain), float(swing[j, i]), limit)
            for j, gain in enumerate(GAINS)
            for i, ratio in enumerate(RATIOS)
        ]
        said.append(
            f"{body}: limit {limit:.2f}, default {GAIN_SHARE * limit:.2f}; the adaptive force leaves at most "
            f"{max(calm):.1g} % at any of these lengths"
        )
    axes[0].set_ylabel("gain of the conventional force [1]")
    axes[0].legend(loc="lower right")
    bar = drawn.colorbar(picture, ax=axes, extend="neither", ticks=STEPS[1:-1])
    bar.set_ticklabels(["0.001", "0.01", "0.1", "1", "10"])
    bar.set_label("amplitude per iteration [%]")
    caption = (
        f"Largest swing of the volume from turn to turn in the last 12 of {TURNS} turns. Line: the "
        "gain limit computed at rest before any turn is made; dashed: the default gain. "
        + "; ".join(said)
        + "."
    )
    columns = ("body", "set_percent", "gain", "swing_percent", "gain_limit_at_rest")
    return Figure(
        "fig-9-gain-map", "Stability region of the conventional force", caption, columns, rows, drawn
    )


def _swing(study: Study, body: str, ratio: float, control: str, gain: float) -> float:
    """Return the largest flip of the volume error from turn to turn at the end of a run [%]."""
    stages = study.stages(body)
    asked = line_targets(replace(stages.design.with_line(LINE, float(ratio)), volume=control), stages)
    targets: LineTargets = replace(asked, gain=float(gain))
    errors: Floats = np.array(
        [measured.error for _, measured in iterate(stages.model, lambda: targets, turns=TURNS)]
    )
    if len(errors) < TURNS or not np.isfinite(errors).all():
        return STEPS[-1]
    # The second difference of a flip-flop is twice its swing; that of a slow approach almost nothing.
    return float(min(50.0 * np.abs(np.diff(errors[-14:], 2)).max(), STEPS[-1]))
