"""A worker process with limits: what takes too long or too much memory ends, and counts as a failure."""

from __future__ import annotations

import json
import os
import select
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

WORKER = Path(__file__).with_name("worker.py")

FAILURES = ("traceback", "hang", "memory", "crash")
"""Outcomes that must not be; a case may end well or be refused in a sentence."""

_TICKS = os.sysconf("SC_CLK_TCK")
_PAGE = os.sysconf("SC_PAGE_SIZE")
_WAIT = 0.05
_PATIENCE = 12.0  # so many times the limit of processor time may go by on a busy machine


@dataclass(frozen=True)
class Ending:
    """How a case ended, in words; the processor time [s] and the memory [MB] that it took."""

    outcome: str
    words: str
    seconds: float
    megabytes: float

    @property
    def failed(self) -> bool:
        return self.outcome in FAILURES

    @property
    def signature(self) -> tuple[str, str]:
        """What two failures of one cause have in common."""
        lines = self.words.strip().splitlines() or [""]
        places = [line.strip() for line in lines if line.lstrip().startswith("File ")]
        return self.outcome, places[-1] if places else lines[-1]


class Worker:
    """Runs cases within ``seconds`` of processor time and ``megabytes`` of memory each."""

    def __init__(self, seconds: float = 10.0, megabytes: float = 1000.0) -> None:
        self.seconds, self.megabytes = seconds, megabytes
        self._process: subprocess.Popen[bytes] | None = None

    def run(self, kind: str, recipe: Any) -> Ending:
        """Run a case; a worker that had to be ended is replaced."""
        process = self._process = self._process or self._started()
        assert process.stdin is not None
        assert process.stdout is not None
        before, start = self._used(process)[0], time.monotonic()
        process.stdin.write(json.dumps({"kind": kind, "recipe": recipe}).encode() + b"\n")
        process.stdin.flush()
        while True:
            ready, _, _ = select.select([process.stdout], [], [], _WAIT)
            if ready:
                return self._answer(process.stdout.readline())
            used, megabytes = self._used(process)
            if megabytes > self.megabytes:
                return self._ended(Ending("memory", "too much memory", used - before, megabytes))
            if used - before > self.seconds or time.monotonic() - start > _PATIENCE * self.seconds:
                return self._ended(Ending("hang", "too slow", used - before, megabytes))

    def close(self) -> None:
        """End the worker."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None

    def _answer(self, line: bytes) -> Ending:
        if not line:
            code = self._process.wait() if self._process else None
            return self._ended(Ending("crash", f"the worker ended with {code}", 0.0, 0.0))
        found = Ending(**json.loads(line))
        if found.megabytes > self.megabytes:
            return Ending("memory", found.words, found.seconds, found.megabytes)
        slow = found.seconds > self.seconds and not found.failed
        return Ending("hang", found.words, found.seconds, found.megabytes) if slow else found

    def _ended(self, ending: Ending) -> Ending:
        self.close()
        return ending

    def _started(self) -> subprocess.Popen[bytes]:
        one = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "NUMBA")}
        return subprocess.Popen(
            [sys.executable, str(WORKER)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=os.environ | one,
        )

    @staticmethod
    def _used(process: subprocess.Popen[bytes]) -> tuple[float, float]:
        """Return the processor time [s] and the memory [MB] of the worker; zero where nobody tells."""
        try:
            words = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
            return (int(words[11]) + int(words[12])) / _TICKS, int(words[21]) * _PAGE / 1e6
        except (OSError, IndexError):
            return 0.0, 0.0
