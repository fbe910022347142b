"""What the answers of the control mesh cost, beside the optimisers that one would take instead.

Run: python benchmarks/bench_solver.py [SCAN ...]; without a scan the two sample bodies are taken. All get
the same functions (energy, volumes, first and exact second derivatives, one look at a place shared
between them), start at rest, and are timed in turn, round by round, on one thread, in processor time, so
that it hardly matters what else runs. Figures are medians [ms] and how many times longer than a cold
exact answer; how far an answer lies from ours; its unbalanced force over the mean stiffness and its
volume error. SLSQP runs once as loosely as the asserted 1e-4 mm allow, and once until it can no more.
IPOPT takes part if ``ipyopt`` is there.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import NonlinearConstraint, minimize
from threadpoolctl import threadpool_limits

from core.analysis.length_limits.limits import limits_from
from core.control_mesh.fit import fit_control_mesh
from core.control_mesh.template import read_template
from core.geometry.mesh import Floats
from core.landmarks.detect import find_landmarks
from core.mechanics.exact_solution import solve_exact
from core.mechanics.gain_limit import gain_limit
from core.mechanics.hessian_layout import layout_of
from core.mechanics.iteration import LineTargets, initial_state, step
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.potential import Evaluation, Potential
from core.scan.body import read_scan

try:
    import ipyopt
except ImportError:
    ipyopt = None

SAMPLES = Path(__file__).parents[1] / "resources" / "samples"
ROUNDS, NEAR = 5, 0.005
Work = Callable[[], object]


class Posed:
    """The problem as an optimiser wants it: functions of the free coordinates in one row, shape (3 f,)."""

    def __init__(self, model: ConstrainedModel, ratios: tuple[float, ...]) -> None:
        self.potential = Potential(model, ratios)
        self.size = 3 * len(model.tensegric.free)
        self.held = len(self.potential.wanted)
        self._seen: tuple[Floats, Evaluation] | None = None
        rough = np.random.default_rng(1).normal(size=self.size)
        pattern = self.hessian(rough, np.ones(self.held)) != 0.0
        self.rows, self.columns = np.nonzero(np.tril(pattern | pattern.T))

    def at(self, flat: Floats) -> Evaluation:
        """The place ``flat``, looked at once however many functions ask for it."""
        if self._seen is None or not np.array_equal(self._seen[0], flat):
            self._seen = flat.copy(), self.potential.at(flat.reshape(-1, 3))
        return self._seen[1]

    def energy(self, flat: Floats) -> float:
        return self.potential.energy(self.at(flat))

    def gradient(self, flat: Floats) -> Floats:
        return self.at(flat).gradient

    def hessian(self, flat: Floats, multipliers: Floats) -> Floats:
        """Second derivative of the energy plus ``multipliers`` times what is held, full."""
        lower = self.potential.hessian(self.at(flat), -multipliers, clip=False, curved=True)
        return self.potential.model.layout.band.full(lower)

    def bend(self, flat: Floats, multipliers: Floats) -> Floats:
        """Second derivative of ``multipliers`` times what is held alone."""
        return self.hessian(flat, multipliers) - self.hessian(flat, np.zeros(self.held))


def exact(model: ConstrainedModel, ratios: tuple[float, ...]) -> Floats:
    return solve_exact(model, ratios).state.moved.ravel()


def slsqp(posed: Posed, tolerance: float) -> Floats:
    held = {"type": "eq", "fun": lambda x: posed.at(x).held, "jac": lambda x: posed.at(x).slopes}
    options = {"ftol": tolerance, "maxiter": 1000}
    start = np.zeros(posed.size)
    return minimize(
        posed.energy, start, jac=posed.gradient, constraints=held, method="SLSQP", options=options
    ).x


def trust_constr(posed: Posed) -> Floats:
    still = np.zeros(posed.held)
    held = NonlinearConstraint(
        lambda x: posed.at(x).held, 0.0, 0.0, jac=lambda x: posed.at(x).slopes, hess=posed.bend
    )
    return minimize(
        posed.energy,
        np.zeros(posed.size),
        jac=posed.gradient,
        hess=lambda x: posed.hessian(x, still),
        constraints=held,
        method="trust-constr",
        options={"gtol": 1e-9, "xtol": 1e-12, "maxiter": 1000},
    ).x


def ipopt(posed: Posed) -> Floats:
    free, none = np.full(posed.size, np.inf), np.zeros(posed.held)
    held = np.indices((posed.held, posed.size)).reshape(2, -1)

    def put(values: Floats, out: Floats) -> None:
        out[:] = values.ravel()

    def hessian(x: Floats, multipliers: Floats, share: float, out: Floats) -> None:
        whole = posed.hessian(x, multipliers)
        if share != 1.0:
            whole += (share - 1.0) * posed.hessian(x, none)
        out[:] = whole[posed.rows, posed.columns]

    problem: Any = ipyopt.Problem(
        posed.size, -free, free, posed.held, none, none, tuple(held.tolist()),
        (posed.rows.tolist(), posed.columns.tolist()), posed.energy,
        lambda x, out: put(posed.gradient(x), out),
        lambda x, out: put(posed.at(x).held, out),
        lambda x, out: put(posed.at(x).slopes, out),
        hessian,
        ipopt_options={"print_level": 0, "sb": "yes", "tol": 1e-9, "constr_viol_tol": 1e-9},
    )  # fmt: skip
    return np.asarray(problem.solve(np.zeros(posed.size))[0])


def milliseconds(work: Work) -> float:
    """Processor time of one call; of quick work the median of several, so that all start with warm caches."""
    taken: list[float] = []
    while len(taken) < 7 and sum(taken) < 50.0:
        start = time.process_time()
        work()
        taken.append(1e3 * (time.process_time() - start))
    return statistics.median(taken)


def interleaved(contenders: dict[str, Work]) -> dict[str, float]:
    """Medians over rounds in which every contender has its turn, the slowest not in all of them."""
    taken: dict[str, list[float]] = {name: [] for name in contenders}
    for _ in range(ROUNDS):
        for name, work in contenders.items():
            if sum(taken[name]) < 2000.0:
                taken[name].append(milliseconds(work))
    return {name: statistics.median(values) for name, values in taken.items()}


def quality(posed: Posed, flat: Floats) -> tuple[float, float]:
    """Largest unbalanced force over the mean stiffness [mm] and volume error over the rest volume."""
    place, model = posed.at(flat), posed.potential.model
    multipliers = np.linalg.lstsq(place.slopes.T, place.gradient, rcond=None)[0]
    left = np.abs(place.gradient - multipliers @ place.slopes).max() / model.tensegric.mean_stiffness
    return float(left), float(np.abs(place.held).max() * posed.potential.area / model.volume.rest_volume)


def measure(scan: str) -> None:
    body = read_scan(scan)
    control = fit_control_mesh(read_template("168"), body, find_landmarks(body))
    make = partial(constrained_model, control, worn=["mid-bust"])
    model = make()
    print(f"{body.name}: {len(control.mesh.faces)} triangles, {len(model.tensegric.free)} free points")
    for ratio in (0.97, 0.9, 0.8):
        contest(model, (1.0, ratio, 1.0))
    ratios = (1.0, 0.9, 1.0)
    near = solve_exact(model, (1.0, 0.9 + NEAR, 1.0))
    state, _ = step(model, LineTargets(ratios), initial_state(model))
    parts: dict[str, Work] = {
        "exact, cold": lambda: solve_exact(model, ratios),
        f"exact, {100 * NEAR:.1f} % on": lambda: solve_exact(model, ratios, near=near),
        "one turn": lambda: step(model, LineTargets(ratios), state),
        "gain limit": lambda: gain_limit(model),
        "shortest line": lambda: limits_from(model, (1.0, 1.0, 1.0), "mid-bust"),
        "model": make,
        "layout": lambda: layout_of(model.tensegric, model.segments, model.volume),
    }
    found = interleaved(parts)
    print("  " + "   ".join(f"{name} {value:.2f}" for name, value in found.items()))


def contest(model: ConstrainedModel, ratios: tuple[float, ...]) -> None:
    posed = Posed(model, ratios)
    solvers: dict[str, Callable[[], Floats]] = {
        "exact": partial(exact, model, ratios),
        **({"IPOPT": partial(ipopt, posed)} if ipyopt else {}),
        "trust-constr": partial(trust_constr, posed),
        "SLSQP, 1e-8": partial(slsqp, posed, 1e-8),
        "SLSQP, 1e-13": partial(slsqp, posed, 1e-13),
    }
    ours = solvers["exact"]()
    medians = interleaved(dict(solvers))
    print(f"  line at {100 * ratios[1]:.0f} %, {solve_exact(model, ratios).steps} Newton steps")
    for name, solve in solvers.items():
        answer = solve()
        away, (residual, volume) = float(np.abs(answer - ours).max()), quality(posed, answer)
        assert away < 1e-4, f"{name} ends {away:.1e} mm away"
        ratio = medians[name] / medians["exact"]
        print(f"    {name:14}{medians[name]:9.2f} ms{ratio:8.1f} x   {away:.0e} mm off", end="")
        print(f"   residual {residual:.0e} mm   volume {volume:.0e}")


def main() -> None:
    if ipyopt is None:
        print("IPOPT does not take part: the package ipyopt is not there.")
    with threadpool_limits(1):
        for scan in sys.argv[1:] or sorted(map(str, SAMPLES.glob("*.ply"))):
            measure(scan)


if __name__ == "__main__":
    main()
