"""Bodies on a Dask worker: processes that compute them, and the task that a worker runs."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from distributed import Worker, WorkerPlugin, get_worker

from app.batch.body_files import packed_files
from app.batch.body_worker import BodyWorker, Limits
from app.batch.one_body import Row
from core import __version__


class BodyProcesses(WorkerPlugin):  # type: ignore[misc]  # it has no types here
    """Keeps one process for each thread of a worker, from task to task.

    ``setup`` is the first line of each process, see ``BodyWorker``. Raises RuntimeError on a worker with
    another version of Busk than ``version``.
    """

    def __init__(self, name: str, setup: str, limits: Limits) -> None:
        self.name, self._setup, self._limits, self._version = name, setup, limits, __version__
        self._idle: list[BodyWorker] = []
        self._closed = False

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_idle": []}

    def setup(self, worker: Worker) -> None:
        """Check the version of Busk on the worker."""
        if self._version != __version__:
            raise RuntimeError(f"Busk {__version__} on {worker.address}, {self._version} here")

    def teardown(self, worker: Worker) -> None:
        """End the processes."""
        self._closed = True
        while self._idle:
            self._idle.pop().close()

    def compute(self, bodies: Sequence[Mapping[str, Any]]) -> list[Row]:
        """Return the rows of bodies, one after the other."""
        process = self._idle.pop() if self._idle else BodyWorker(self._setup, self._limits)
        try:
            return [_computed(process, body) for body in bodies]
        finally:
            if self._closed:
                process.close()
            else:
                self._idle.append(process)


def _computed(process: BodyWorker, body: Mapping[str, Any]) -> Row:
    data = body.get("data")
    request = {key: value for key, value in body.items() if key != "data"}
    if data is None:
        return process.compute(request)
    with tempfile.TemporaryDirectory(prefix="busk-") as folder:
        place = Path(folder) / "in" / (os.path.basename(body["file"]) or "scan")
        place.parent.mkdir()
        place.write_bytes(data)
        out = Path(folder) / "out"  # a worker may have no file system in common with the command
        out.mkdir()
        return packed_files(process.compute({**request, "file": str(place), "out": str(out)}), out)


def compute_bodies(name: str, version: str, bodies: Sequence[Mapping[str, Any]]) -> list[Row] | str:
    """Return the rows of bodies, computed by the plugin ``name`` of the worker that runs this task.

    A worker with another version of Busk returns that version and computes nothing.
    """
    if version != __version__:
        return __version__
    plugin = get_worker().plugins[name]
    assert isinstance(plugin, BodyProcesses)
    return plugin.compute(bodies)
