"""A batch run as a process of the command: started, followed line by line, and stopped."""

from __future__ import annotations

import json
import os
import signal
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from PySide6.QtCore import QObject, QProcess, QProcessEnvironment, Signal

from app.batch.batch_design import BatchDesign
from app.batch.design_file import write_designs
from app.batch.schema import DESIGN
from app.i18n.catalog import language, tr
from app.presenters.batch import error_text

_ALL_DONE, _SOME_LEFT, _BAD_INPUT = 0, 3, 2  # exit codes of the command
_PATIENCE_MS = 30_000  # for a run to write its tables when the program ends

DONE, STOPPED, FAILED = "done", "stopped", "failed"
"""Ends of a run."""


@dataclass(frozen=True)
class RunRequest:
    """What is to be run: ``scans`` as the command takes them, ``designs``, and the folder of results.

    ``files`` are those that are wanted of each body beside its picture: "body" and "report". With ``retry``
    bodies that failed or ran out of time are computed again.
    """

    scans: Sequence[str]
    designs: Sequence[BatchDesign]
    out: Path
    workers: int
    files: frozenset[str] = frozenset()
    retry: bool = False


class BatchRun(QObject):
    """One run at a time.

    ``changed`` with its progress, ``rows_added`` carries rows as the command prints them, ``ended`` one of
    DONE, STOPPED and FAILED; of one that failed ``error`` is message and hint.
    """

    changed = Signal()
    rows_added = Signal(list)
    ended = Signal(str)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.done = self.total = 0
        self.rate, self.seconds_left = 0.0, None
        self.error = ("", "")
        self.is_stopping = False
        self._process: QProcess | None = None
        self._folder: TemporaryDirectory[str] | None = None
        self._read = b""

    @property
    def is_running(self) -> bool:
        """Return whether a run goes on."""
        return self._process is not None

    @property
    def fraction(self) -> float | None:
        """Return the share of rows that are done, None before the first progress."""
        return self.done / self.total if self.total else None

    def start(self, request: RunRequest) -> None:
        """Start the command. Raises UserError if the designs cannot be handed over."""
        self.done = self.total = 0
        self.rate, self.seconds_left = 0.0, None
        self.error, self.is_stopping, self._read = ("", ""), False, b""
        self._folder = TemporaryDirectory(prefix="busk-batch-", ignore_cleanup_errors=True)
        designs = Path(self._folder.name) / DESIGN
        write_designs(designs, request.designs, private=True)
        process = self._process = QProcess(self)
        process.setProcessEnvironment(_environment())
        if hasattr(process, "setUnixProcessParameters"):
            # A program that was started in the background ignores Ctrl+C, and so would the run.
            process.setUnixProcessParameters(QProcess.UnixProcessFlag.ResetSignalHandlers)
        process.readyReadStandardOutput.connect(self._take)
        process.finished.connect(lambda *_: self._end())
        process.errorOccurred.connect(self._fail_to_start)
        program, *words = [*_program(), *_words(request, designs)]
        process.start(program, words)
        self.changed.emit()

    def stop(self) -> None:
        """End the run as Ctrl+C does: the results so far stay."""
        process = self._process
        if process is None or self.is_stopping:
            return
        self.is_stopping = True
        if os.name == "nt":
            process.kill()  # a process without a console gets no Ctrl+C; written rows stay
        elif process.processId() > 0:  # 0, of one that has just ended, would be this program too
            os.kill(process.processId(), signal.SIGINT)
        self.changed.emit()

    def close(self) -> None:
        """Stop the run, and wait until it has written its tables."""
        process = self._process
        if process is None:
            return
        self.blockSignals(True)
        self.stop()
        if not process.waitForFinished(_PATIENCE_MS):
            process.kill()
            process.waitForFinished(_PATIENCE_MS)
        self._tidy()

    def _take(self) -> None:
        if self._process is None:
            return
        *lines, self._read = (self._read + bytes(self._process.readAllStandardOutput().data())).split(b"\n")
        for line in lines:
            try:
                event = json.loads(line)
            except ValueError:
                continue  # of a library that prints
            if isinstance(event, dict):
                self._handle(event)

    def _handle(self, event: dict[str, Any]) -> None:
        kind = event.get("event")
        if kind == "rows":
            self.rows_added.emit(event["rows"])
        elif kind == "progress":
            self.done, self.total = event["done"], event["total"]
            self.rate, self.seconds_left = event["rows_per_s"], event["seconds_left"]
            self.changed.emit()
        elif kind == "error":
            self.error = error_text(event)

    def _fail_to_start(self, problem: QProcess.ProcessError) -> None:
        if problem == QProcess.ProcessError.FailedToStart and self._process is not None:
            self.error = tr("The batch run could not be started."), self._process.errorString()
            self._end()

    def _end(self) -> None:
        process = self._process
        if process is None:
            return
        self._take()
        code, stopped = process.exitCode(), self.is_stopping
        printed = bytes(process.readAllStandardError().data()).decode("utf-8", "replace").strip()
        crashed = process.exitStatus() == QProcess.ExitStatus.CrashExit
        process.deleteLater()
        self._tidy()
        if stopped:
            how = STOPPED
        elif code in (_ALL_DONE, _SOME_LEFT) and not crashed and not self.error[0]:
            how = DONE
        else:
            how = FAILED
            if not self.error[0]:
                last = printed.splitlines()[-1] if printed else ""
                self.error = tr("The batch run ended unexpectedly. The results so far are kept."), last
        self.changed.emit()
        self.ended.emit(how)

    def _tidy(self) -> None:
        self._process, self.is_stopping = None, False
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None


def _program() -> list[str]:
    """Return the program that takes commands: the frozen one, or this source."""
    return [sys.executable] if getattr(sys, "frozen", False) else [sys.executable, "-P", "-m", "app"]


def _words(request: RunRequest, designs: Path) -> list[str]:
    words = ["batch", *(os.path.abspath(scan) for scan in request.scans), "--design", str(designs)]
    words += ["--out", str(request.out), "--workers", str(request.workers), "--json", "--rows"]
    words += ["--retry"] if request.retry else []
    words += ["--body"] if "body" in request.files else []
    return [*words, "--report", language()] if "report" in request.files else words


def _environment() -> QProcessEnvironment:
    """Return the environment of the command: this source is found from every folder."""
    result = QProcessEnvironment.systemEnvironment()
    places = [str(Path(__file__).parents[4]), *filter(None, [os.environ.get("PYTHONPATH")])]
    result.insert("PYTHONPATH", os.pathsep.join(places))
    return result
