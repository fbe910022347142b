"""Tasks on a cluster that is there already, and workers with another version of Busk."""

from __future__ import annotations

import logging
import subprocess
import sys
from collections.abc import Iterator
from io import StringIO
from pathlib import Path
from types import SimpleNamespace

import pytest
from batch_tools import ROOT, lasting, parquet_rows, run_batch
from distributed import Client

from app.batch.batch_design import batch_design
from app.batch.body_worker import Limits
from app.batch.engine import Run, _register, _silence_dask, local_cluster, results
from app.batch.one_body import compute_row, plain_row
from app.batch.worker_plugin import BodyProcesses, compute_bodies
from core import __version__
from core.document.design import Design, ScanSource
from core.errors import UserError

CLUSTER = """
import sys
from distributed import LocalCluster

if __name__ == "__main__":
    with LocalCluster(n_workers=1, threads_per_worker=2, dashboard_address="127.0.0.1:0") as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.read()
"""


@pytest.fixture(scope="module")
def scheduler(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a cluster with one worker of two threads, in another folder."""
    folder = tmp_path_factory.mktemp("cluster")
    (folder / "cluster.py").write_text(CLUSTER)
    process = subprocess.Popen(
        [sys.executable, "cluster.py"],
        cwd=folder,
        env={"PYTHONPATH": str(ROOT), "PATH": ""},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert process.stdout is not None
    yield process.stdout.readline().strip()
    process.communicate("", timeout=60)


@pytest.mark.parametrize("ship", [[], ["--ship"]])
def test_a_cluster_that_is_there_gives_the_same_rows(
    scheduler: str, person: Path, mannequin: Path, tmp_path: Path, ship: list[str]
) -> None:
    words = ["--line", "mid-bust=-20mm", "--out", str(tmp_path), "--scheduler", scheduler, *ship]
    code, _, errors = run_batch(person, mannequin, tmp_path / "none.ply", *words)
    assert code == 3, errors
    rows = {row["scan"]: row for row in parquet_rows(tmp_path)}
    design = batch_design("design", Design(ScanSource("")), ["mid-bust=-20mm"], [], [])
    for scan in (person, mannequin):
        alone = plain_row(compute_row(design, scan).row)
        found = lasting(rows[str(scan)])
        assert {name: found[name] for name in alone} == alone
    assert rows[str(tmp_path / "none.ply")]["state"] == "refused"


def test_no_other_user_of_the_machine_can_use_the_workers_of_a_run() -> None:
    with local_cluster(Run([], 1)) as cluster:
        address = cluster.scheduler_address
        assert address.startswith("tls://127.0.0.1:")
        with pytest.raises(OSError, match="tcp:"):
            Client(address.replace("tls:", "tcp:"), timeout="1s", set_as_default=False)


def test_a_worker_of_another_version_computes_nothing() -> None:
    assert compute_bodies("none", "0.0.1", [{"scan": "a"}]) == __version__
    run = Run([], 1)
    plugin = BodyProcesses("one", run.setup, Limits())
    plugin._version = "0.0.1"

    class Worker:
        address = "tcp://host:1"

    with pytest.raises(RuntimeError, match=r"0\.0\.1 here"):
        plugin.setup(Worker())


def test_a_worker_that_is_lost_at_the_start_is_started_again(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[int] = []

    def start(lost: int) -> str:
        tried.append(1)
        if len(tried) <= lost:
            raise RuntimeError("Nanny failed to start.")
        return "cluster"

    monkeypatch.setattr("app.batch.engine.LocalCluster", lambda **_: start(2))
    assert local_cluster(Run([], 1)) == "cluster"
    tried.clear()
    monkeypatch.setattr("app.batch.engine.LocalCluster", lambda **_: start(100))
    with pytest.raises(UserError, match="workers could not be started: Nanny failed"):
        local_cluster(Run([], 1))


def test_a_plugin_is_registered_again_if_a_worker_is_lost_meanwhile() -> None:
    tried: list[object] = []

    def register(plugin: object) -> None:
        tried.append(plugin)
        if len(tried) == 1:
            raise OSError("Stream is closed")

    _register(SimpleNamespace(register_plugin=register), "plugin")
    assert tried == ["plugin", "plugin"]


def test_a_scheduler_that_is_lost_is_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    class Lost:
        status = "lost"

    class Completed(list[Lost]):
        def __init__(self, **options: object) -> None:
            self.add = self.append

        def __next__(self) -> tuple[Lost, None]:
            return self.pop(), None

    monkeypatch.setattr("app.batch.engine.as_completed", Completed)
    client = SimpleNamespace(loop=None, nthreads=lambda: {"worker": 1}, submit=lambda *_, **__: Lost())
    with pytest.raises(UserError, match="connection to the scheduler was lost"):
        next(results(client, lambda _: [], iter([{"scan": "a"}])))


def test_dask_prints_nothing_of_its_own() -> None:
    client = logging.getLogger("distributed.client")
    own = StringIO()
    handler = logging.StreamHandler(own)
    client.addHandler(handler)
    try:
        _silence_dask()
        client.error("Failed to reconnect to scheduler")
        assert own.getvalue() == ""
    finally:
        client.removeHandler(handler)
