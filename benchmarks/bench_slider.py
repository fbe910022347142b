"""From a slider's move to the new body: one exact solve, t-FFD and normals, no drawing; and the load.

Run: python benchmarks/bench_slider.py [SCAN ...]; without a scan the two sample bodies are taken. Prints
medians [ms] of a drag from 100 % to 85 % and back; every solve starts at rest.
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

from core.design import Design, ScanSource, WornLine
from core.exact import solve_exact
from core.pipeline import Stages, build
from core.solver import Targets, at_rest, turn

SAMPLES = Path(__file__).parent.parent / "resources" / "samples"


def milliseconds(work: Callable[[], object]) -> float:
    start = time.perf_counter()
    work()
    return 1000.0 * (time.perf_counter() - start)


def drag(stages: Stages) -> dict[str, float]:
    """Medians of the parts of a slider's move over a drag from 100 % to 85 % and back."""
    ratios = np.concatenate([np.linspace(1.0, 0.85, 60), np.linspace(0.85, 1.0, 60)])
    parts: dict[str, list[float]] = {"solve": [], "shape": [], "slider": []}
    for ratio in ratios:
        start = time.perf_counter()
        state = solve_exact(stages.model, (1.0, float(ratio), 1.0)).state
        solved = time.perf_counter()
        stages.shape(stages.model.tensegric.expand(state.moved))
        done = time.perf_counter()
        parts["solve"].append(1000.0 * (solved - start))
        parts["shape"].append(1000.0 * (done - solved))
        parts["slider"].append(1000.0 * (done - start))
    return {name: statistics.median(values) for name, values in parts.items()}


def figures(scan: str) -> list[float]:
    """Load [s], then medians [ms]: solve, shape, both, one adaptive turn."""
    design = Design(ScanSource(str(Path(scan).absolute())), lines=(WornLine("mid-bust", 0.95),))
    loads = []
    for _ in range(3):
        start = time.perf_counter()
        stages = build(design)
        loads.append(time.perf_counter() - start)
    parts = drag(stages)
    ratios = (1.0, 0.9, 1.0)
    one = partial(turn, stages.model, Targets(ratios), at_rest(stages.model), stages.watch)
    turns = [milliseconds(one) for _ in range(99)]
    return [
        statistics.median(loads),
        parts["solve"],
        parts["shape"],
        parts["slider"],
        statistics.median(turns),
    ]


def main() -> None:
    scans = sys.argv[1:] or [str(path) for path in sorted(SAMPLES.glob("*.ply"))]
    heads = ["load s", "solve", "t-FFD + normals", "slider to body", "turn"]
    print("scan".ljust(24) + "".join(name.rjust(17) for name in heads))
    with threadpool_limits(1):
        for scan in scans:
            print(Path(scan).name.ljust(24) + "".join(f"{figure:17.2f}" for figure in figures(scan)))


if __name__ == "__main__":
    main()
