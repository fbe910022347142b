"""Runs side by side: the turn-based volume controls in lockstep on the same targets, beside the exact answer.

All runs see the same lengths at the same turn, so their curves can be laid over each other even while a
slider moves.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from core.mechanics.convergence import Convergence, assess_convergence
from core.mechanics.exact_solution import BodyChange, solve_body_exact, solve_exact
from core.mechanics.iteration import LineTargets, Record, SolverState, Watch, initial_state, record, step
from core.mechanics.mesh_quality import MeshQuality, OriginalShape
from core.mechanics.model import ConstrainedModel
from core.mechanics.newton import Equilibrium

COMPARED_CONTROLS = ("adaptive", "conventional")
"""The controls that are always compared; another joins when it is the chosen one."""

NEAR = 0.05
"""Lengths that change by no more than this let the exact answer start from the last one [1]."""

CALM_ERROR, CALM_STEP = 0.05, 20.0
"""Volume error [1] and largest move in a turn [mm] below which a state of a diverging run can be shown."""

MOST_TURNS, MOST_TURNS_OF_TRUNK = 300, 600
"""Turns after a change of the targets at which a run is left as it is, settled or not.

A trunk without firmness, or whose lines are ten times as stiff as usual, takes more of them than a bust.
"""


def most_turns(model: ConstrainedModel) -> int:
    """Return the turns after which a run of the model is left as it is."""
    return MOST_TURNS_OF_TRUNK if model.volume.separate else MOST_TURNS


class ControlRun:
    """One volume control at work: its state, all its records, and its motion since the targets changed."""

    def __init__(
        self, model: ConstrainedModel, control: str, state: SolverState, watch: Watch | None
    ) -> None:
        self.control = control
        self.most_turns = most_turns(model)
        self.state = self._calm = state
        self.records: list[Record] = [record(model, state, 0.0, watch)]
        self.reset_history()

    def reset_history(self) -> None:
        """Assess only iterations from now on."""
        self.changed_at = self.state.iteration
        self.verdict = assess_convergence([])

    def restart(self, model: ConstrainedModel) -> None:
        """Restart from the original; the iteration count continues."""
        self.state = self._calm = replace(initial_state(model), iteration=self.state.iteration)

    def take(self, state: SolverState, measured: Record) -> None:
        """Take the next turn."""
        self.state = state
        if abs(measured.error) < CALM_ERROR and measured.step < CALM_STEP:
            self._calm = state
        self.records.append(measured)
        self.verdict = assess_convergence(self.records[self.changed_at - self.records[0].iteration + 1 :])

    @property
    def is_finished(self) -> bool:
        """Return whether there is nothing more to see: settled, diverging, or long enough watched."""
        turns = self.state.iteration - self.changed_at
        return turns > 0 and (turns >= self.most_turns or self.verdict.motion in ("settled", "diverging"))

    @property
    def ended(self) -> bool:
        """Whether it came to an end that says something: one that did not converge is at a chance place.

        Collapsed meshes come back from there hardly or never, whatever lengths are asked for then.
        """
        return not (self.is_finished and self.verdict.motion == "settling")

    @property
    def sane(self) -> bool:
        """Return whether the run can be gone on from: a diverging one starts again at rest."""
        return self.verdict.motion != "diverging"

    @property
    def shown(self) -> SolverState:
        """Return the state to show: of a diverging run the last calm one, not a body torn apart."""
        return self.state if self.sane else self._calm


class SolverComparison:
    """The runs of the compared controls and the exact answer, for one model whose targets may move."""

    def __init__(
        self,
        model: ConstrainedModel,
        targets: LineTargets,
        watch: Watch | None = None,
        body_change: BodyChange | None = None,
        exact: Equilibrium | None = None,
    ) -> None:
        self.model = model
        self.targets = targets
        self.watch = watch
        self.runs: dict[str, ControlRun] = {}
        self._body_change = body_change
        self._shape = shape_of(model)
        self._solve(None, exact)
        self._set_runs(fresh=True)

    def retarget(
        self,
        model: ConstrainedModel,
        targets: LineTargets,
        fresh: bool = False,
        exact: Equilibrium | None = None,
    ) -> None:
        """Take new targets, warm: every run goes on from where it is, unless it diverged or never converged.

        ``model`` may differ in the lines that are worn, not in its control points. ``fresh`` begins new
        records at turn 0; ``exact`` is the exact answer if it is known.
        """
        near, same = None, model is self.model and targets == self.targets
        if model is self.model and self.exact.is_converged:
            moved = np.abs(np.subtract(targets.ratios, self.targets.ratios)).max(initial=0.0)
            near = self.exact if moved <= NEAR else None
        if model is not self.model:
            for run in self.runs.values():
                run.state = carried(run.state, self.model, model)
        self.model, self.targets = model, targets
        self._solve(near, exact)
        self._set_runs(fresh, same)

    def _solve(self, near: Equilibrium | None, known: Equilibrium | None = None) -> None:
        """Find the exact answer; from one near by it is quicker, and the first Newton step is its tangent."""
        self._exact_is_near = near is not None and known is None
        if known is not None:
            self.exact = known
        elif self._body_change is None:
            self.exact = solve_exact(self.model, self.targets.ratios, near=near)
        else:
            self.exact = solve_body_exact(self.model, self.targets.ratios, self._body_change, near=near)

    @property
    def main(self) -> ControlRun | None:
        """Return the run of the chosen control; None when the exact answer is shown."""
        return self.runs.get(self.targets.control)

    @property
    def shown(self) -> SolverState:
        """Return the state to show: that of the chosen control's run, or the exact answer."""
        return self.main.shown if self.main else self.exact.state

    @property
    def verdict(self) -> Convergence:
        """Return how the chosen control stands, and in what condition the mesh is that is shown."""
        verdict = self.main.verdict if self.main else assess_equilibrium(self.model, self.exact)
        points = self.model.tensegric.expand(self.shown.moved)
        return replace(verdict, condition=self._shape.quality(points))

    @property
    def is_finished(self) -> bool:
        """Return whether every run rests, and the exact answer is that which is found from rest."""
        return not self._exact_is_near and self._runs_rest

    @property
    def _runs_rest(self) -> bool:
        return all(run.is_finished for run in self.runs.values())

    def advance(self) -> None:
        """Make one turn in every run that does not rest; when all do, find the exact answer from rest.

        Where there is more than one balance the answer must not depend on the way that a slider took.
        """
        if self._runs_rest:
            self._solve(None)
        for run in self.runs.values():
            if not run.is_finished:
                targets = replace(self.targets, control=run.control)
                run.take(*step(self.model, targets, run.state, self.watch))

    def _set_runs(self, fresh: bool, same: bool = False) -> None:
        """Let runs go on from where they are, or from rest where that is no place to go on from.

        With the ``same`` targets one that has not converged yet does.
        """
        wanted = dict.fromkeys([*COMPARED_CONTROLS, self.targets.control])
        wanted.pop("exact", None)
        runs = {}
        for control in wanted:
            old = self.runs.get(control)
            warm = old is not None and old.sane and (old.ended or same)
            if old is None or fresh:
                state = replace(old.state, iteration=0) if old and warm else initial_state(self.model)
                runs[control] = ControlRun(self.model, control, state, self.watch)
            else:
                if not warm:
                    old.restart(self.model)
                old.reset_history()
                runs[control] = old
        self.runs = runs


def carried(state: SolverState, old: ConstrainedModel, new: ConstrainedModel) -> SolverState:
    """Return a state of the ``old`` model for the ``new`` one: the same places and the same pressure.

    Tensions of held lines begin anew, for they may be those of other lines.
    """
    pressure = replace(state.pressure, value=new.pressure_like(old, state.pressure.value))
    return SolverState(state.moved, pressure, state.iteration)


def assess_equilibrium(
    model: ConstrainedModel, balance: Equilibrium, condition: MeshQuality | None = None
) -> Convergence:
    """Return the verdict of an exact answer: settled if the balance was found."""
    error = record(model, balance.state, 0.0).error
    return Convergence(
        "settled" if balance.is_converged else "settling", balance.steps, error, condition=condition
    )


def shape_of(model: ConstrainedModel) -> OriginalShape:
    """Return the control mesh of a model at rest."""
    return OriginalShape(model.tensegric.rest, model.volume.faces, model.tensegric.cables)
