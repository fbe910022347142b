"""What measuring costs: all measures of the samples, and of both before and after, in processor time."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from threadpoolctl import threadpool_limits

from core.document.design import Design, ScanSource
from core.measurements.table import before_after, measures
from core.pipeline.build import build
from core.pipeline.solve import solve

SAMPLES = Path(__file__).parent.parent / "resources" / "samples"


def seconds(work: Callable[[], object], times: int = 5) -> float:
    """Return the processor time of the quickest of a few runs [s]."""
    spent = []
    for _ in range(times):
        start = time.process_time()
        work()
        spent.append(time.process_time() - start)
    return min(spent)


def main() -> None:
    """Print one line a sample."""
    for path in sorted(SAMPLES.glob("*.ply")):
        stages = build(Design(ScanSource(str(path)), volume="exact").with_line("mid-bust", 0.95))
        points, body = solve(stages).control_points, stages.body
        once = seconds(lambda body=body, marks=stages.landmarks: measures(body.smoothed, marks))
        both = seconds(lambda stages=stages, points=points: before_after(stages, points))
        print(f"{path.stem}, {len(body.mesh.vertices)} vertices: {once:.2f} s, before and after {both:.2f} s")


if __name__ == "__main__":
    with threadpool_limits(1):
        main()
