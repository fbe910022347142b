"""From a slider's move to the new body: an answer from the last one, t-FFD, normals, girths; no drawing.

Run: python benchmarks/bench_slider.py [SCAN ...]; without a scan the two sample bodies are taken. Prints
medians of processor time [ms] on one thread over a drag from 100 % to 85 % and back in 120 moves, for the
choices of the model that change what an answer costs; then what an answer from rest costs in each place
of the same drag.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from core.document.design import Design, ScanSource
from core.document.lines import ActiveLine
from core.mechanics.exact_solution import solve_exact
from core.mechanics.iteration import LineTargets, initial_state, step
from core.pipeline.build import Stages, build
from core.pipeline.observables import Tapes

SAMPLES = Path(__file__).parent.parent / "resources" / "samples"
GIRTHS = ("under-bust", "mid-bust", "full-bust")
CHOICES: dict[str, dict[str, str]] = {
    "as by default": {},
    "prestressed": {"member_law": "prestressed"},
    "co-rotated": {"member_law": "co-rotated"},
    "sliding": {"line_contact": "sliding"},
    "held": {"line_hold": "held"},
}
HEADS = ("solve", "body", "girths", "frame", "from rest", "turn", "steps")


def milliseconds(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return 1e3 * (time.process_time() - start)


def drag(stages: Stages) -> dict[str, float]:
    """Medians of the parts of a slider's move."""
    model, tensegric = stages.model, stages.model.tensegric
    lines = {line.name: line for line in model.lines}
    heights = [float((lines[name].weights @ tensegric.rest)[:, 2].mean()) for name in GIRTHS]
    tapes = Tapes(stages.moving, heights)
    parts: dict[str, list[float]] = {name: [] for name in HEADS}
    balance = solve_exact(model, (1.0, 1.0, 1.0))
    for ratio in np.concatenate([np.linspace(1.0, 0.85, 61)[1:], np.linspace(0.85, 1.0, 61)[1:]]):
        ratios = (1.0, float(ratio), 1.0)
        start = time.process_time()
        balance = solve_exact(model, ratios, near=balance)
        solved = time.process_time()
        places, _ = stages.shape(tensegric.expand(balance.state.moved))
        shaped = time.process_time()
        tapes(places)
        done = time.process_time()
        parts["solve"].append(1e3 * (solved - start))
        parts["body"].append(1e3 * (shaped - solved))
        parts["girths"].append(1e3 * (done - shaped))
        parts["frame"].append(1e3 * (done - start))
        parts["steps"].append(balance.steps)
        parts["from rest"].append(milliseconds(partial(solve_exact, model, ratios)))
    one = partial(step, model, LineTargets((1.0, 0.9, 1.0)), initial_state(model), stages.watch)
    parts["turn"] = [milliseconds(one) for _ in range(99)]
    return {name: statistics.median(values) for name, values in parts.items()}


def main() -> None:
    scans = sys.argv[1:] or [str(path) for path in sorted(SAMPLES.glob("*.ply"))]
    with threadpool_limits(1):
        for scan in scans:
            stages = None
            print(f"{Path(scan).name:24}" + "".join(f"{name:>11}" for name in HEADS))
            for name, choice in CHOICES.items():
                source = ScanSource(str(Path(scan).absolute()))
                stages = build(Design(source, lines=(ActiveLine("mid-bust", 0.95),), **choice), stages)
                medians = drag(stages)
                print(f"  {name:22}" + "".join(f"{medians[head]:11.2f}" for head in HEADS))


if __name__ == "__main__":
    main()
