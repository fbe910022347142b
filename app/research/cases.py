"""Build and solve the cases of the figures: the two sample bodies, each case once."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from app.presenters.samples import sample_design
from app.rendering.ambient_occlusion import bake_occlusion
from app.research.case_memo import CaseMemo
from app.research.lower_cases import LowerStudy
from core.document.lines import ActiveLine
from core.geometry.mesh import Floats, Points
from core.mechanics.exact_solution import newton, solve_exact
from core.mechanics.iteration import Record, iterate
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import Solution, solve

LINE = "mid-bust"
"""The paper's line, "between full bust and under bust"."""

BODIES = {"a": "mannequin", "b": "person"}
"""The paper's letters: (a) a mannequin, (b) a real human."""

TEMPLATE = {"mannequin": "120", "person": "168"}
"""Polygons of the control mesh of each body, as in the paper."""

PAPER_CONTROLS = {"1": "conventional", "2": "adaptive"}
"""The paper's digits in the curves a1, a2, b1 and b2."""

EXCESSIVE, MODEST = 0.5, 0.97
"""Lengths of the line at which the curves are shown, in parts of its rest length."""

TURNS = 120
"""Turns shown: the paper does not say how many it made."""


@dataclass(frozen=True, eq=False)
class Study(CaseMemo):
    """Keeps what has been built and solved, by what was asked; ``lower`` that of the lower trunk."""

    lower: LowerStudy = field(default_factory=LowerStudy)

    def stages(self, body: str, template: str | None = None, **choices: Any) -> Stages:
        """Return the stages of a sample body with its line on, on the paper's template for it if None.

        ``choices`` are other values of the ``Design`` than the default ones.
        """
        number = template or TEMPLATE[body]

        def make() -> Stages:
            other = next((self.memo[key] for key in self.memo if key[:2] == ("stages", body)), None)
            return build(replace(sample_design(body), template=number, **choices), other)

        return self._once(("stages", body, number, *sorted(choices.items())), make)

    def occlusion(self, body: str) -> Floats:
        """Return how open the sky is above each vertex of a sample body, for its pictures."""
        return self._once(("occlusion", body), lambda: bake_occlusion(self.stages(body).body.mesh))

    def solved(
        self, body: str, ratio: float, control: str, turns: int | None = None, **choices: Any
    ) -> Solution:
        """Return a body solved with the paper's line at a length ratio, under a volume control.

        If ``choices`` has own lines, they are worn in its place, all at that ratio.
        """

        def make() -> Solution:
            stages = self.stages(body, **choices)
            names = [line.name for line in stages.design.own_lines] or [LINE]
            lines = tuple(ActiveLine(name, ratio) for name in names)
            return solve(build(replace(stages.design, lines=lines, volume=control), stages), turns)

        return self._once(("solved", body, ratio, control, turns, *sorted(choices.items())), make)

    def ratio_for(self, body: str, reached: float, **choices: Any) -> float:
        """Return the natural length at which the exact line reaches ``reached``, both over its rest length.

        The line is a spring: it ends longer than it is set (paper section 3).
        """

        def make() -> float:
            low, high = 0.5, 1.0
            while high - low > 1e-6:
                ratio = 0.5 * (low + high)
                too_short = reached_length(self.stages(body, **choices), ratio) < reached
                low, high = (ratio, high) if too_short else (low, ratio)
            return 0.5 * (low + high)

        return self._once(("ratio", body, reached, *sorted(choices.items())), make)

    def way_to(
        self, body: str, ratio: float, control: str, turns: int, goal: Points
    ) -> tuple[Floats, Floats]:
        """Return over ``turns`` turns the largest distance to ``goal`` (f, 3) [mm] and the volume error [1].

        Both have shape (turns + 1,) and begin at rest; ``goal`` are displacements of the free points.
        """
        stages = self.stages(body)
        targets = line_targets(replace(stages.design.with_line(LINE, ratio), volume=control), stages)
        away, error = [float(np.linalg.norm(goal, axis=1).max())], [0.0]
        for state, measured in iterate(stages.model, lambda: targets, turns=turns):
            away.append(float(np.linalg.norm(state.moved - goal, axis=1).max()))
            error.append(measured.error)
        return np.array(away), np.array(error)

    def newton_way(self, body: str, ratio: float, goal: Points) -> tuple[Floats, Floats]:
        """Return what ``way_to`` does, over the Newton steps of the exact answer."""
        stages = self.stages(body, volume_of="both")
        ratios = line_targets(stages.design.with_line(LINE, ratio), stages).ratios
        states = [balance.state.moved for balance in newton(stages.model, ratios)]
        volumes = [stages.model.volume.volume(stages.model.tensegric.expand(moved)) for moved in states]
        away = np.array([np.linalg.norm(moved - goal, axis=1).max() for moved in states])
        return away, np.array(volumes) / stages.model.volume.rest_volume - 1.0


def reached_length(stages: Stages, ratio: float) -> float:
    """Return the length of the paper's line in the exact answer over its rest length [1]."""
    ratios = line_targets(stages.design.with_line(LINE, ratio), stages).ratios
    points = stages.model.tensegric.expand(solve_exact(stages.model, ratios).state.moved)
    line = next(line for line in stages.model.lines if line.name == LINE)
    return line.length(points) / line.rest_length


def line_share(solution: Solution) -> float:
    """Return the reached over the rest length of the paper's line [1]."""
    lines = solution.stages.model.lines
    at = next(index for index, line in enumerate(lines) if line.name == LINE)
    return solution.last.lengths[at] / lines[at].rest_length


def curve(solution: Solution) -> list[Record]:
    """Return the records of a run with the one at rest before them."""
    return [solution.rest, *solution.records]


def moved(solution: Solution) -> tuple[float, float, float]:
    """Return how far bust points and apex rose, and how far the apex came forward, in the end [mm]."""
    rest, now = solution.rest.marks, solution.last.marks
    assert rest is not None
    assert now is not None
    bust = 0.5 * (
        now.bust_point_left_z + now.bust_point_right_z - rest.bust_point_left_z - rest.bust_point_right_z
    )
    return bust, now.apex_z - rest.apex_z, now.apex_protrusion - rest.apex_protrusion


def bust_heights(records: list[Record]) -> Floats:
    """Return the mean height of both bust points and that of the apex, shape (n, 2) [mm]."""
    marks = [record.marks for record in records]
    return np.array(
        [(0.5 * (m.bust_point_left_z + m.bust_point_right_z), m.apex_z) for m in marks if m is not None]
    )


def signed(value: float) -> str:
    """Return a number with one decimal and its sign, nothing as +0.0."""
    return f"{round(value, 1) + 0.0:+.1f}"
