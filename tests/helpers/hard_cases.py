"""Over-constrained cases at random: several lines at once, own ones too, under every choice of the model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from shapes import fitted, torso

from core.control_mesh.fit import ControlMesh
from core.document.line_notation import with_custom_lines
from core.document.lines import CustomLine
from core.mechanics.convergence import Convergence, assess_convergence
from core.mechanics.exact_solution import solve_exact
from core.mechanics.gain_limit import gain_limit
from core.mechanics.iteration import LineTargets, iterate
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.options import CONTACTS, LAWS, LINE_HOLDS, VOLUMES, ModelOptions
from core.mechanics.solver_comparison import assess_equilibrium, shape_of
from core.pipeline.stages import GAIN_SHARE

BODIES = ("mannequin 168", "mannequin 120", "person 168", "person 120", "torso", "skew torso")
TURNS = 300


@dataclass(frozen=True, eq=False)
class HardCase:
    """Case number ``seed``: a body, the choices of the model, and a length for each of some lines."""

    seed: int
    body: str
    mechanics: ModelOptions
    own: tuple[CustomLine, ...]
    ratios: dict[str, float]

    @cached_property
    def model(self) -> ConstrainedModel:
        control = with_custom_lines(control_of(self.body), self.own)
        return constrained_model(control, worn=self.ratios, mechanics=self.mechanics)

    @property
    def targets(self) -> tuple[float, ...]:
        return tuple(self.ratios.get(line.name, 1.0) for line in self.model.lines)

    def exact(self) -> tuple[float, Convergence]:
        """The residual of the exact answer [mm], and what is said of it."""
        balance = solve_exact(self.model, self.targets)
        condition = shape_of(self.model).quality(self.model.tensegric.expand(balance.state.moved))
        return balance.residual, assess_equilibrium(self.model, balance, condition)

    def turns(self, control: str, turns: int = TURNS) -> tuple[float, Convergence]:
        """The last step of a run [mm], and what is said of it."""
        gain = GAIN_SHARE * gain_limit(self.model)
        targets = LineTargets(self.targets, control, gain)
        records = []
        for state, measured in iterate(self.model, lambda: targets, turns=turns):
            records.append(measured)
            moved = state.moved
        condition = shape_of(self.model).quality(self.model.tensegric.expand(moved))
        return records[-1].step, assess_convergence(records, condition)

    def __str__(self) -> str:
        lines = " ".join(f"{name}={ratio:.3f}" for name, ratio in self.ratios.items())
        m = self.mechanics
        how = f"{m.member_law} {m.line_force} {m.line_contact} {m.line_hold} stiffness {m.line_stiffness:.1f}"
        return f"seed {self.seed}: {self.body}, {how}, chest {m.firm_chest:.2f}, {m.volume_of}; {lines}"


def control_of(body: str) -> ControlMesh:
    name, _, template = body.partition(" ")
    return fitted(name, template) if template.isdigit() else torso(skew=0.3 if name == "skew" else 0.0)


def hard_case(seed: int) -> HardCase:
    """Return case number ``seed``, always the same."""
    rng = np.random.default_rng(seed)
    body = str(rng.choice(BODIES))
    control = control_of(body)
    explicit = rng.random() < 0.1
    mechanics = ModelOptions(
        member_law=str(rng.choice(LAWS)),
        prestress=float(rng.uniform(0.3, 0.7)),
        # A force that is kept during the turn is calm for soft lines only: see benchmarks/RESULTS.md.
        line_stiffness=0.1 if explicit else float(np.exp(rng.uniform(np.log(4.0), np.log(200.0)))),
        line_force="explicit" if explicit else "implicit",
        line_contact=str(rng.choice(CONTACTS)),
        line_hold=str(rng.choice(LINE_HOLDS, p=(0.75, 0.25))),
        firm_chest=float(rng.choice((0.0, 0.1))),
        volume_of=str(rng.choice(VOLUMES)),
    )
    own = tuple(own_line(control, rng, f"own {number}") for number in range(rng.integers(0, 3)))
    worn = [name for name in ("mid-bust", "full-bust") if rng.random() < 0.7] + [line.name for line in own]
    return HardCase(
        seed, body, mechanics, own, {name: float(rng.uniform(0.5, 1.1)) for name in worn or ["mid-bust"]}
    )


def own_line(control: ControlMesh, rng: np.random.Generator, name: str) -> CustomLine:
    """An upright or an oblique line from a point to the next over the grid of control points."""
    at = {(int(r), int(c)): i for i, (r, c) in enumerate(zip(control.row, control.column, strict=True))}
    rows, columns = int(control.row.max()), int(control.column.max())
    if rng.random() < 0.5:
        column = int(rng.integers(1 - columns, columns))
        places = [(row, column) for row in range(1, rows)]
    else:
        first, row = int(rng.integers(1 - columns, 1)), int(rng.integers(1, rows))
        places = [(row, first)]
        for column in range(first + 1, first + int(rng.integers(3, columns + 2))):
            row = int(np.clip(row + rng.integers(-1, 2), 1, rows - 1))
            places.append((row, column))
    return CustomLine(name, tuple(at[place] for place in places if place in at))
