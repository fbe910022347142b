"""What finer control meshes cost: 168 to 10,584 triangles on the same analytic torso, under the same tape.

Run: python benchmarks/bench_scaling.py. Prints, for each size: what is made once (model, layout, gain
limit) and what is repeated (a turn, a cold exact answer, one warm per cent of a slider's move), all in
milliseconds of processor time on one thread; how far the band of the matrices reaches; then residual,
energy and volume error of the answer from rest and of the one along the slider's path in steps of 1 %. A
line that is longer than at rest pushes: fine meshes then wrinkle into several equilibria. The path is
followed twice, and must come to the same bits.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import numpy as np
from threadpoolctl import threadpool_limits

from core.control_mesh.fit import ControlMesh
from core.geometry.mesh import Mesh
from core.mechanics.exact_solution import solve_exact
from core.mechanics.gain_limit import gain_limit
from core.mechanics.hessian_layout import layout_of
from core.mechanics.iteration import LineTargets, initial_state, step
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.newton import Equilibrium
from core.mechanics.options import DEFAULT_LINE_STIFFNESS, ModelOptions
from core.mechanics.potential import Potential

HEIGHTS = (-150.0, -92.0, -30.0, 0.0, 38.0, 70.0, 105.0, 145.0)
ANGLES = (0.0, 20.0, 33.0, 45.0, 62.0, 80.0, 97.0)
SIZES = ((7, 6), (21, 12), (42, 30), (63, 42))
"""Cells from bottom to top, and from the centre to one side."""

SHORTEST, LONGEST = 0.85, 1.03
MOST_STEPS = 60
Work = Callable[[], object]


def torso(tall: int, half: int) -> ControlMesh:
    """A trunk with two bumps, of ``tall`` rows and twice ``half`` columns of cells."""
    across = np.arange(-half, half + 1)
    row, column = (at.ravel() for at in np.meshgrid(np.arange(tall + 1), across, indexing="ij"))
    level, side = row * 7.0 / tall, column * 6.0 / half  # as rows and columns of the template
    angle = np.sign(side) * np.radians(np.interp(np.abs(side), np.arange(7), ANGLES))
    x, y, z = 130.0 * np.sin(angle), -90.0 * np.cos(angle), np.interp(level, np.arange(8), HEIGHTS)
    for centre in (-75.0, 75.0):
        bump = 60.0 * np.exp(-(((x - centre) / 60.0) ** 2) - ((z + 15.0) / 65.0) ** 2)
        y = y - bump * (np.cos(angle) > 0.0)
    wide = 2 * half + 1
    corner = (np.arange(tall)[:, None] * wide + np.arange(2 * half)).ravel()
    rising = ((column[corner] >= 0) == (row[corner] >= 3 * tall / 7))[:, None]
    a, b, d, e = corner, corner + 1, corner + wide, corner + wide + 1
    first = np.where(rising, np.stack([a, b, e], 1), np.stack([a, b, d], 1))
    second = np.where(rising, np.stack([a, e, d], 1), np.stack([b, e, d], 1))
    mesh = Mesh(np.stack([x, y, z], axis=1), np.concatenate([first, second]))
    fixed = ~((level > 1.01) & (level < 5.99) & (np.abs(side) < 4.99))
    line = round(2 * tall / 7)
    path = tuple(int(line * wide + half + c) for c in across if abs(c) <= round(5 * half / 6))
    nowhere = (int(3 * wide), int(3 * wide))
    return ControlMesh(mesh, fixed, row, column, {"mid-bust": path}, nowhere, mesh.boundary_loops[:1], ())


def milliseconds(work: Work, least: int = 1) -> float:
    """Median processor time of one call, of ``least`` calls at least and for a tenth of a second."""
    taken: list[float] = []
    while len(taken) < least or (sum(taken) < 100.0 and len(taken) < 50):
        start = time.process_time()
        work()
        taken.append(1e3 * (time.process_time() - start))
    return statistics.median(taken)


def follow(model: ConstrainedModel, end: float) -> tuple[list[Equilibrium], float]:
    """The balances along a slider's path from rest in steps of 1 %, and the median cost of a step [ms]."""
    balances, taken = [solve_exact(model, (1.0,))], []
    for ratio in np.linspace(1.0, end, round(100.0 * abs(1.0 - end)) + 1)[1:]:
        start = time.process_time()
        balances.append(solve_exact(model, (float(ratio),), MOST_STEPS, near=balances[-1]))
        taken.append(1e3 * (time.process_time() - start))
    return balances, statistics.median(taken)


def measure(tall: int, half: int) -> None:
    control = torso(tall, half)
    # A tape's stiffness per millimetre stays: shorter segments are stiffer.
    choice = ModelOptions(line_stiffness=DEFAULT_LINE_STIFFNESS * half / 6.0)
    build = milliseconds(lambda: constrained_model(control, mechanics=choice))
    model = constrained_model(control, mechanics=choice)
    layout = milliseconds(lambda: layout_of(model.tensegric, model.segments, model.volume))
    limit = milliseconds(lambda: gain_limit(model))
    state, _ = step(model, LineTargets((SHORTEST,)), initial_state(model))
    one = milliseconds(lambda: step(model, LineTargets((SHORTEST,)), state), 5)
    cold = milliseconds(lambda: solve_exact(model, (SHORTEST,)))
    _, warm = follow(model, SHORTEST)
    print(
        f"{len(control.mesh.faces):6} triangles, {len(model.tensegric.free):5} free points, band"
        f" {model.layout.band.size} x {model.layout.band.reach}\n"
        f"    once: model {build:.1f}, layout {layout:.1f}, gain limit {limit:.1f} ms"
        f"   repeated: turn {one:.2f}, exact cold {cold:.1f}, warm {warm:.1f} ms"
    )
    for ratio in (SHORTEST, LONGEST):
        compare(model, ratio)


def compare(model: ConstrainedModel, ratio: float) -> None:
    """Print how good the answers from rest and along the slider's path are, and how far they lie apart."""
    cold = solve_exact(model, (ratio,), MOST_STEPS)
    (balances, _), (again, _) = follow(model, ratio), follow(model, ratio)
    pairs = zip(balances, again, strict=True)
    same = all(np.array_equal(one.state.moved, two.state.moved) for one, two in pairs)
    apart = float(np.abs(balances[-1].state.moved - cold.state.moved).max())
    print(f"    line at {100.0 * ratio:.0f} %: {apart:.0e} mm apart; followed twice:", end=" ")
    print("the same to the bit" if same else "NOT THE SAME")
    for name, balance in (("from rest", cold), ("followed", balances[-1])):
        print(f"        {name:10}{balance.steps:3} steps   {quality(model, balance, ratio)}")


def quality(model: ConstrainedModel, balance: Equilibrium, ratio: float) -> str:
    """Energy, residual and volume error of an answer, in words."""
    potential = Potential(model, (ratio,))
    energy = potential.energy(potential.at(balance.state.moved))
    volume = model.volume.volume(model.tensegric.expand(balance.state.moved)) / model.volume.rest_volume - 1.0
    found = "" if balance.is_converged else "   NOT FOUND"
    return f"energy {energy:.4f}   residual {balance.residual:.0e} mm   volume {volume:+.0e}{found}"


def main() -> None:
    with threadpool_limits(1):
        for tall, half in SIZES:
            measure(tall, half)


if __name__ == "__main__":
    main()
