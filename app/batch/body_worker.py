"""The parent of a process that computes bodies: ends it when a body takes too long or too much memory."""

from __future__ import annotations

import json
import os
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import psutil

from app.batch.inputs import file_digest
from app.batch.one_body import Row
from app.batch.schema import CRASHED, TIMEOUT
from core import __version__
from core.messages import Message, join

START_SECONDS = 120.0
"""Time for a process to start [s]: on a cluster, libraries may come from a slow disk."""

_POLL = 0.05  # seconds between two looks at memory and time

_PROCESS = "app.cli.body_process"
"""The module of the process, which also knows how reports are written."""

_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


@dataclass(frozen=True)
class Limits:
    """What one body may take: ``seconds``, and ``memory_mb`` of its process [MB]."""

    seconds: float = 300.0
    memory_mb: float = 4000.0


def _environment() -> dict[str, str]:
    """Return the environment of a process that computes bodies."""
    places = [str(Path(__file__).parents[2]), *filter(None, [os.environ.get("PYTHONPATH")])]
    values = {**os.environ, **_ONE_THREAD, "PYTHONPATH": os.pathsep.join(places)}
    # Dask lets its workers give memory back at once, and get it anew: a body takes a third longer with that.
    values.pop("MALLOC_TRIM_THRESHOLD_", None)
    return values


class _LostError(Exception):
    """The process has ended or was ended; ``state`` is that of the row."""

    def __init__(self, state: str, *sentences: Message) -> None:
        super().__init__(str(join(sentences)))
        self.state = state


def lost_row(request: Mapping[str, Any], message: str) -> Row:
    """Return the row of a requested body whose process or worker was lost."""
    return {
        "scan": request["scan"],
        "scan_sha256": file_digest(Path(request["file"])),
        "variant": request["name"],
        "state": CRASHED,
        "message": message,
        "busk_version": __version__,
    }


class BodyWorker:
    """Computes bodies in a process of its own, which is started anew when it is lost.

    ``setup`` is its first line, as JSON: see ``app.batch.engine.Run``.
    """

    def __init__(self, setup: str, limits: Limits) -> None:
        self._setup, self._limits = setup, limits
        self._process: subprocess.Popen[str] | None = None
        self._answers: queue.SimpleQueue[str] = queue.SimpleQueue()

    @property
    def process_id(self) -> int | None:
        """Return the number of the process, None if there is none."""
        return None if self._process is None else self._process.pid

    def compute(self, request: Mapping[str, Any]) -> Row:
        """Return the row of a request; one that is lost is a row with a sentence."""
        start = time.perf_counter()
        try:
            self._start()
            self._send(json.dumps(request))
            row: Row = json.loads(self._answer(self._limits.seconds))
            return row
        except _LostError as lost:
            self.close()
            return {
                **lost_row(request, str(lost)),
                "state": lost.state,
                "seconds": time.perf_counter() - start,
            }

    def close(self) -> None:
        """End the process, if there is one."""
        process, self._process = self._process, None
        if process is None:
            return
        process.kill()
        process.wait()
        for stream in (process.stdin, process.stdout):
            assert stream is not None
            with suppress(OSError):  # what was not sent cannot be sent any more
                stream.close()

    def _start(self) -> None:
        if self._process is not None and self._process.poll() is None:
            return
        self.close()  # one that ended while it had nothing to do
        # Without -P a file in the working folder could take the place of a library.
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", _PROCESS],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            encoding="ascii",
            env=_environment(),
            start_new_session=True,  # Ctrl+C is for the command
        )
        self._answers = queue.SimpleQueue()
        assert self._process.stdout is not None
        threading.Thread(target=_read, args=(self._process.stdout, self._answers), daemon=True).start()
        self._send(self._setup)
        try:
            self._answer(START_SECONDS)
        except _LostError as lost:
            raise _LostError(
                CRASHED,
                Message("The process that computes bodies could not be started."),
                Message("Check Busk and the memory of this machine, then use --retry."),
            ) from lost

    def _send(self, line: str) -> None:
        assert self._process is not None
        assert self._process.stdin is not None
        with suppress(OSError):  # a process that has ended is seen by its missing answer
            self._process.stdin.write(line + "\n")
            self._process.stdin.flush()

    def _answer(self, seconds: float) -> str:
        """Wait for an answer, and watch time and memory. Raises _LostError."""
        assert self._process is not None
        end = time.monotonic() + seconds
        while True:
            try:
                line = self._answers.get(timeout=max(min(_POLL, end - time.monotonic()), 0.0))
            except queue.Empty:
                self._check(end, seconds)
                continue
            if line:
                return line
            raise _LostError(
                CRASHED,
                Message("The process that computed this body ended unexpectedly."),
                Message("Check scan and memory."),
            )

    def _check(self, end: float, seconds: float) -> None:
        assert self._process is not None
        if time.monotonic() >= end:
            raise _LostError(
                TIMEOUT,
                Message("No result within {seconds} s.", seconds=f"{seconds:g}"),
                Message("Reduce the scan, or allow more time."),
            )
        with suppress(psutil.Error):  # ended: the missing answer is seen next
            if psutil.Process(self._process.pid).memory_info().rss > 1e6 * self._limits.memory_mb:
                raise _LostError(
                    CRASHED,
                    Message(
                        "The body needs more than {memory} MB of memory.",
                        memory=f"{self._limits.memory_mb:g}",
                    ),
                    Message("Reduce the scan, or allow more memory."),
                )


def _read(stream: IO[str], answers: queue.SimpleQueue[str]) -> None:
    with suppress(ValueError, OSError):  # closed by the other thread
        for line in stream:
            answers.put(line)
    answers.put("")
