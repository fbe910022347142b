"""How a batch run scales: ``batch_scaling.py bodies|cluster|table [N]``.

``bodies`` computes N copies of a sample with a plain loop and with one and two workers. ``cluster`` runs the
engine on a real scheduler with 1,008 processes, whose tasks wait as long as a body takes.
``table`` writes N rows.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
import resource
import shutil
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import dask
from distributed import Client, LocalCluster

from app.batch.batch_design import BatchDesign, batch_design
from app.batch.body_worker import BodyWorker, Limits
from app.batch.engine import Run, results, run_batch
from app.batch.one_body import Row
from app.batch.store import ResultStore
from app.presenters.samples import sample_path
from core.document.design import Design, ScanSource
from core.garment.presets import find_preset, with_preset

SECONDS = 1.5
"""Duration of a stand-in body [s]; ``bodies`` measures what it is."""

NODES, THREADS = 63, 16
"""A simulated cluster: each node is a Dask worker, each of its threads has a process."""


def designs() -> list[BatchDesign]:
    """Return the designs that are measured: an elastic, and a preset with cups on solid tissue."""
    bare = Design(ScanSource(""))
    line = batch_design("band", bare, ["mid-bust=-20mm"], ["mid-bust=plush 12"], [])
    return [line, batch_design("underwired", with_preset(bare, find_preset("underwired bra")), [], [], [])]


def requests(folder: Path, count: int) -> Iterator[dict[str, Any]]:
    """Yield requests for copies of a sample, none equal to another."""
    data = sample_path("person").read_bytes()
    for number in range(count):
        scan = folder / f"{number}.ply"
        scan.write_bytes(data + number.to_bytes(4, "big"))
        yield {"scan": scan.name, "file": str(scan), "variant": 0, "name": "band"}


def measure_bodies(count: int) -> None:
    """Print seconds and memory of a body in a plain loop, and how much faster workers are."""
    for design in designs():
        with tempfile.TemporaryDirectory() as folder:
            run = partial(Run, [design], out=Path(folder), files={"picture": ""})
            bodies = list(requests(Path(folder), count))
            process = BodyWorker(run(1).setup, Limits())
            process.compute(bodies[0])
            start = time.perf_counter()
            rows = [process.compute(body) for body in bodies]
            plain = time.perf_counter() - start
            process.close()
            memory = [row["memory_mb"] for row in rows]
            print(f"{design.name}: plain loop {plain / count:.3f} s a body, memory "
                  f"{memory[0]:.0f} MB at the first, {memory[-1]:.0f} MB at the last body")  # fmt: skip
            for workers in (1, 2):
                start, ends = time.perf_counter(), []
                for rows in run_batch(run(workers), iter(bodies)):
                    ends += [time.perf_counter()] * len(rows)
                going = (ends[-1] - ends[workers - 1]) / (count - workers)
                print(f"  {workers} workers: first body after {ends[0] - start:.1f} s, then {going:.3f} s "
                      f"a body, {plain / count / going:.2f} x the plain loop")  # fmt: skip


async def stand_in(seconds: float, row: Row, bodies: Sequence[Mapping[str, Any]]) -> list[Row]:
    """Return rows after the time that bodies take."""
    await asyncio.sleep(seconds * len(bodies))
    return [{**row, "scan": body["scan"]} for body in bodies]


def measure_cluster(count: int) -> None:
    """Print how busy the engine keeps 1,008 processes, and how many bodies a second it can hand out."""
    row = example_row()
    options = {
        "processes": False,
        "n_workers": NODES,
        "threads_per_worker": THREADS,
        "dashboard_address": None,
        "silence_logs": logging.CRITICAL,
    }
    # 63 workers in one process would look at the processor and take profiles 63 times as often as one.
    quiet = {"distributed.worker.profile.enabled": False, "distributed.admin.system-monitor.interval": "60s"}
    start = time.perf_counter()
    with (
        dask.config.set(quiet),
        LocalCluster(**options, memory_limit=None) as cluster,
        Client(cluster) as client,
    ):
        print(f"{NODES * THREADS} processes after {time.perf_counter() - start:.0f} s")
        for seconds in (SECONDS, 0.0):
            start = time.perf_counter()
            bodies = ({"scan": str(number), "file": "", "variant": 0} for number in range(count))
            done = sum(map(len, results(client, partial(stand_in, seconds, row), bodies)))
            took = time.perf_counter() - start
            assert done == count
            share = (
                f", {100.0 * seconds * count / NODES / THREADS / took:.0f} % of the processes' time"
                if seconds
                else ""
            )
            print(f"{seconds:g} s a body: {count} bodies in {took:.1f} s, {count / took:.0f} a second{share}")


def measure_table(count: int) -> None:
    """Print how fast rows are written, the size of the files, and time and memory of the end of a run."""
    row, folder = example_row(), Path(tempfile.mkdtemp())
    store = ResultStore(folder, designs()[:1])
    names = [f"{number}.ply" for number in range(count)]
    start = time.perf_counter()
    for at in range(0, count, 100):
        store.add({**row, "scan": name, "scan_sha256": name} for name in names[at : at + 100])
    store.flush()
    took = time.perf_counter() - start
    parts = list((folder / "results.parquet").iterdir())
    size = sum(part.stat().st_size for part in parts)
    print(
        f"{count} rows in {took:.1f} s, {count / took:.0f} a second; {len(parts)} parts, {size / 1e6:.0f} MB"
    )
    start = time.perf_counter()
    store.finish(names, 1.0, interrupted=False)
    files = ", ".join(
        f"{name} {os.path.getsize(folder / name) / 1e6:.0f} MB" for name in ("results.csv", "index.html")
    )
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"end: {time.perf_counter() - start:.1f} s, {files}; most memory {memory:.0f} MB")
    store.close()
    start = time.perf_counter()
    ResultStore(folder, designs()[:1]).close()
    print(f"continued after {time.perf_counter() - start:.1f} s")
    shutil.rmtree(folder)


def example_row() -> Row:
    """Return the row of the sample."""
    process = BodyWorker(Run(designs()[:1], 1).setup, Limits())
    row = process.compute({"scan": "a", "file": str(sample_path("person")), "variant": 0, "name": "band"})
    process.close()
    print(f"a row has {len(row)} values, {len(json.dumps(row))} bytes as JSON")
    return row


MEASURES = {
    "bodies": (measure_bodies, 20),
    "cluster": (measure_cluster, 20_000),
    "table": (measure_table, 100_000),
}

if __name__ == "__main__":
    measure, usual = MEASURES[sys.argv[1]]
    measure(int(sys.argv[2]) if len(sys.argv) > 2 else usual)
