"""What the way from a scan's file to a fitted model costs: `python benchmarks/bench_scan.py [FILE ...]`.

Without files, each sample body is taken as it is, and with its triangles split in four twice: a million. Each
file is read by a process of its own on one core, three times; told are the least processor seconds of the
three, as other programs disturb these least, and the most memory that a process held.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

SAMPLES = Path(__file__).parents[1] / "resources" / "samples"
ROUNDS = 3
SINGLE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")


def stages(path: str) -> dict[str, float]:
    """Return the processor time of each stage from the start of Python to the model [s], and memory [MB]."""
    from core.document.design import Design, ScanSource  # noqa: PLC0415
    from core.pipeline.build import build  # noqa: PLC0415

    begun = [("start", 0.0), ("reading", time.process_time())]

    def hear(what: str, share: float) -> None:
        if what != begun[-1][0]:
            begun.append((what, time.process_time()))

    made = build(Design(ScanSource(path)), progress=hear)
    begun.append(("end", time.process_time()))
    spent: dict[str, float] = {"triangles": len(made.body.mesh.faces)}
    for (name, start), (_, end) in pairwise(begun):
        spent[name] = spent.get(name, 0.0) + end - start
    spent["from file to model"] = begun[-1][1] - begun[1][1]
    spent["with start"] = begun[-1][1]
    spent["memory [MB]"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    return spent


def measured(path: Path) -> dict[str, float]:
    """Return the least of each figure over some processes that read the file."""
    runs = []
    for _ in range(ROUNDS):
        command = [sys.executable, __file__, "--one", str(path)]
        told = subprocess.run(command, env=os.environ | SINGLE, capture_output=True, check=True, text=True)
        runs.append(json.loads(told.stdout))
    return {name: min(run.get(name, 0.0) for run in runs) for name in runs[0]}


def files(folder: Path) -> Iterator[Path]:
    """Give the samples and their split copies, which are written into the folder."""
    import trimesh  # noqa: PLC0415

    for name in ("mannequin", "person"):
        path = SAMPLES / f"{name}.ply"
        yield path
        mesh = trimesh.load(path, process=False)
        path = folder / f"{name}, split.ply"
        mesh.subdivide().subdivide().export(path)
        yield path


def main() -> None:
    if sys.argv[1:2] == ["--one"]:
        print(json.dumps(stages(sys.argv[2])))
        return
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(name) for name in sys.argv[1:]] or list(files(Path(folder)))
        table = {path.stem: measured(path) for path in paths}
    rows = list(dict.fromkeys(row for told in table.values() for row in told))
    width = max(map(len, rows))
    print("| " + " " * width + " | " + " | ".join(table) + " |")
    print("|-" + "-" * width + "-|" + "".join("-" * (len(name) + 1) + ":|" for name in table))
    for row in rows:
        digits = 0 if row in ("triangles", "memory [MB]") else 2
        figures = [f"{told.get(row, 0.0):,.{digits}f}".rjust(len(name)) for name, told in table.items()]
        print(f"| {row:<{width}} | " + " | ".join(figures) + " |")


if __name__ == "__main__":
    main()
