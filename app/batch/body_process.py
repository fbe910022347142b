"""A process that computes bodies one by one: requests and rows are lines of JSON.

It is started by ``app.batch.body_worker``, which ends it when a body takes too long or too much memory. The
first line holds the designs and the wanted files, each other one a body; it ends with its input.
"""

from __future__ import annotations

import json
import os
import queue
import sys
import threading
import time
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TextIO

import psutil
from threadpoolctl import threadpool_limits

from app.batch.batch_design import BatchDesign, design_of_data
from app.batch.body_files import BodyFiles, Writer
from app.batch.inputs import file_digest
from app.batch.one_body import Row, compute_row, plain_row
from app.batch.schema import CRASHED
from core import __version__
from core.messages import Message, join
from core.pipeline.build import Stages


class BodyComputer:
    """Computes rows of ``designs`` and writes ``files``."""

    def __init__(self, designs: list[BatchDesign], files: BodyFiles) -> None:
        self._designs, self._files = designs, files
        self._last: tuple[str, str] | None = None
        self._stages: Stages | None = None

    def answer(self, request: Mapping[str, Any]) -> Row:
        """Return the whole row of a requested body: ``file`` is read, ``scan`` is what it is called.

        Its files are written below ``out`` if the request names it.
        """
        start, path = time.perf_counter(), Path(request["file"])
        design, digest = self._designs[request["variant"]], file_digest(path)
        if self._last != (request["file"], digest):
            self._last, self._stages = (request["file"], digest), None
        try:
            row = self._row(design, path, request)
        except Exception as problem:  # of one body: the run goes on
            why = f"{type(problem).__name__}: {problem}".rstrip(": ")
            sentence = join((Message("The computation failed ({why}).", why=why), Message("Check the scan.")))
            row = {"state": CRASHED, "message": str(sentence)}
        row |= {"scan": request["scan"], "scan_sha256": digest, "variant": design.name}
        memory = psutil.Process().memory_info().rss / 1e6
        return plain_row(
            {**row, "seconds": time.perf_counter() - start, "memory_mb": memory, "busk_version": __version__}
        )

    def _row(self, design: BatchDesign, path: Path, request: Mapping[str, Any]) -> Row:
        result = compute_row(design, path, self._stages)
        self._stages = result.stages or self._stages
        if result.solution is None:
            return result.row
        files = replace(self._files, out=Path(request["out"])) if "out" in request else self._files
        named = files.write(result.solution, request["scan"], design.name)
        doubts = " ".join(filter(None, (result.row.get("doubts"), named.pop("doubts", ""))))
        return {**result.row, **named, "doubts": doubts}


def serve(writers: Mapping[str, Writer]) -> None:
    """Answer requests until the input ends: also in the middle of a body, when the parent has gone."""
    answers = os.fdopen(os.dup(1), "w", encoding="ascii")
    os.dup2(2, 1)  # what libraries print must not be taken for an answer
    waiting: queue.SimpleQueue[str] = queue.SimpleQueue()
    threading.Thread(target=_read, args=(sys.stdin, waiting), daemon=True).start()
    setup = json.loads(waiting.get())
    designs = [design_of_data(each) for each in setup["designs"]]
    computer = BodyComputer(designs, BodyFiles(Path(setup["out"]), setup["files"], writers))
    _send(answers, {"busk_version": __version__})
    with threadpool_limits(1):
        while True:
            _send(answers, computer.answer(json.loads(waiting.get())))


def _read(requests: TextIO, waiting: queue.SimpleQueue[str]) -> None:
    for line in requests:
        waiting.put(line)
    os._exit(0)


def _send(answers: TextIO, values: Mapping[str, Any]) -> None:
    answers.write(json.dumps(values) + "\n")
    answers.flush()
