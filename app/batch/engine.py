"""The engine of a run: bodies as tasks of Dask, on a local cluster or on one that is there."""

from __future__ import annotations

import json
import logging
import secrets
import signal
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from itertools import chain, islice
from multiprocessing import resource_tracker
from pathlib import Path
from typing import Any

import dask
from distributed import Client, Future, KilledWorker, LocalCluster, as_completed
from distributed.client import ClosedClientError
from distributed.comm import CommClosedError

from app.batch.batch_design import BatchDesign
from app.batch.body_files import unpacked_files
from app.batch.body_worker import Limits, lost_row
from app.batch.one_body import Row
from app.batch.worker_plugin import BodyProcesses, compute_bodies
from core import __version__
from core.errors import UserError, reason_of
from core.messages import Message, join

TASKS_A_PROCESS = 2
"""Tasks in flight for each process, which is a thread of a worker: one that runs and one that waits."""

RECOUNT_SECONDS = 5.0
"""Processes are counted so often [s]: a cluster may grow and shrink."""

PROCESSES_A_BODY = 128
"""A task has one body for so many processes, at most MOST_BODIES: the scheduler keeps up with thousands."""

MOST_BODIES = 16

TRIES = 5
"""A task whose workers were lost so often is given up; Dask itself repeats each some times."""


Work = Callable[[Sequence[Mapping[str, Any]]], list[Row] | str]
"""What a task does: rows of bodies, or the version of Busk on the worker if it is another one."""

_LOGGERS = ("distributed", "distributed.client", "tornado", "tornado.application")
"""Those to which Dask gives a handler of their own."""

_ALL_LOST = (
    Message("All workers that computed this body were lost."),
    Message("Check the cluster, then use --retry."),
)


@dataclass(frozen=True)
class Run:
    """What is run and where: on ``workers`` local processes, or on the cluster of a ``scheduler``.

    The ``files`` that are wanted of each body, with the manner of each kind, are written below ``out``.
    """

    designs: Sequence[BatchDesign]
    workers: int
    limits: Limits = field(default_factory=Limits)
    scheduler: str = ""
    out: Path = Path()
    files: Mapping[str, str] = field(default_factory=dict)

    @property
    def setup(self) -> str:
        """Return the first line of a process that computes bodies."""
        designs = [each.as_data() for each in self.designs]
        return json.dumps({"designs": designs, "out": str(self.out.absolute()), "files": dict(self.files)})


def run_batch(run: Run, bodies: Iterable[Mapping[str, Any]]) -> Iterator[list[Row]]:
    """Yield rows in the order in which tasks end; ``bodies`` are requests of ``body_process``.

    Bodies are taken from the iterable as tasks end. Lost workers' bodies are computed again. Raises UserError
    if there is no scheduler, if it is lost, or if its workers have another version of Busk.
    """
    bodies = iter(bodies)
    first = next(bodies, None)
    if first is None:
        return
    with _client(run) as client:
        name = f"busk-bodies-{secrets.token_hex(4)}"
        _register(client, BodyProcesses(name, run.setup, run.limits))
        try:
            work = partial(compute_bodies, name, __version__)
            for rows in results(client, work, chain([first], bodies)):
                yield [unpacked_files(row, run.out) for row in rows]
        except (CommClosedError, ClosedClientError) as problem:
            raise _lost_scheduler() from problem
        finally:
            with suppress(Exception):  # of a scheduler that is gone
                client.unregister_worker_plugin(name)


def results(client: Client, work: Work, bodies: Iterator[Mapping[str, Any]]) -> Iterator[list[Row]]:
    """Yield the rows that ``work`` computes of ``bodies``, in the order in which tasks end.

    Raises UserError if a worker has another version of Busk, or the scheduler is lost.
    """
    tries: dict[Future, tuple[list[Mapping[str, Any]], int]] = {}
    # Results come while others are read: one after the other, 1,000 processes wait for the way of each.
    running = as_completed(loop=client.loop, with_results=True, raise_errors=False)

    def submit(task: list[Mapping[str, Any]], tried: int = 0) -> None:
        future = client.submit(work, task, pure=False)
        tries[future] = task, tried
        running.add(future)

    processes, counted = 1, -RECOUNT_SECONDS

    def refill() -> None:
        nonlocal processes, counted
        if time.monotonic() - counted >= RECOUNT_SECONDS:
            processes, counted = max(sum(client.nthreads().values()), 1), time.monotonic()
        size = min(max(processes // PROCESSES_A_BODY, 1), MOST_BODIES)
        while len(tries) < TASKS_A_PROCESS * processes and (task := list(islice(bodies, size))):
            submit(task)

    refill()
    while tries:
        future, rows = next(running)
        task, tried = tries.pop(future)
        if future.status != "finished":
            _check_workers_lost(future)
            if tried + 1 < TRIES:
                submit(task, tried + 1)
                continue
            rows = [lost_row(body, str(join(_ALL_LOST))) for body in task]
        if isinstance(rows, str):
            raise _other_version(rows)
        future.release()
        refill()
        yield rows


def _check_workers_lost(future: Future) -> None:
    """Raise what ended a task, unless all of its workers were lost."""
    if future.status in ("lost", "cancelled"):
        raise _lost_scheduler()
    if not isinstance(error := future.exception(), KilledWorker):
        raise error


def _lost_scheduler() -> UserError:
    return UserError(
        Message("The connection to the scheduler was lost."),
        Message("Check the cluster, then repeat the command: it continues the run."),
    )


def _other_version(version: str) -> UserError:
    return UserError(
        Message("A worker has Busk {other}, this is Busk {own}.", other=version, own=__version__),
        Message("Install the same version on every worker."),
    )


def _register(client: Client, plugin: BodyProcesses) -> None:
    """Give the plugin to all workers, again if one is lost meanwhile. Raises UserError."""
    for tried in range(1, TRIES + 1):
        try:
            client.register_plugin(plugin)
            return
        except Exception as problem:  # whatever importing Busk raises on another machine
            if tried < TRIES and isinstance(problem, OSError):
                time.sleep(0.5 * tried)
                continue
            raise UserError(
                Message("The workers cannot run Busk {own}: {why}.", own=__version__, why=str(problem)),
                Message("Install the same version on every worker."),
            ) from problem


@contextmanager
def _client(run: Run) -> Iterator[Client]:
    _silence_dask()
    with dask.config.set({"distributed.scheduler.allowed-failures": 20}):
        if run.scheduler:
            try:
                client = Client(run.scheduler, set_as_default=False)
            except (OSError, ValueError) as problem:
                raise UserError(
                    Message("The scheduler {address} does not answer.", address=run.scheduler),
                    Message("Check the address, such as tcp://host:8786."),
                ) from problem
            with client:
                yield client
            return
        with local_cluster(run) as cluster, Client(cluster, set_as_default=False) as client:
            yield client


def _started(options: Mapping[str, Any]) -> LocalCluster:
    """Start a cluster, again if a worker is lost before it is there. Raises UserError."""
    for tried in range(1, TRIES + 1):
        try:
            return LocalCluster(**options)
        except RuntimeError as problem:
            if tried == TRIES:
                raise UserError(
                    Message("The workers could not be started: {why}.", why=reason_of(problem)),
                    Message("Check memory and disk, or use fewer processes (--workers)."),
                ) from problem
    raise AssertionError


def _silence_dask() -> None:
    """Keep the logs of Dask from the standard error: what concerns the user is a sentence."""
    for name in _LOGGERS:
        for handler in logging.getLogger(name).handlers:
            handler.setLevel(logging.CRITICAL + 1)


def local_cluster(run: Run) -> LocalCluster:
    """Start workers on this machine alone; they leave Ctrl+C to the command, which ends them."""
    options = {
        "n_workers": run.workers,
        "threads_per_worker": 1,
        "processes": True,
        "dashboard_address": "127.0.0.1:0",
        "scheduler_kwargs": {"dashboard": False},
        "memory_limit": f"{int(1e6 * (run.limits.memory_mb + 1000.0))}B",
        "silence_logs": logging.CRITICAL,
        "security": True,  # no other user of this machine can make the workers run code
    }
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        return _started(options)
    resource_tracker.ensure_running()  # started later it would take the mask off
    # The thread that starts workers, also in the place of lost ones, and they themselves inherit the mask.
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        return _started(options)
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
