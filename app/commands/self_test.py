"""The installed program tests itself on the sample: one line a part, exit code 0 if all is well."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import numpy as np

from app.commands.picture import draw_picture
from app.wording.samples import sample_design
from core.design import Design
from core.document import Document
from core.errors import UserError
from core.live import Failure, Frame, LiveSolver
from core.project import open_project, save_project

_PATIENCE = 120.0

T = TypeVar("T")


def run_self_test() -> int:
    """Open the sample, move a line, wait, save, reopen, compare, draw; print a line a part."""
    with _solver() as solver, tempfile.TemporaryDirectory(prefix="busk-") as folder:
        design = sample_design()
        opened = _part("opens the sample", lambda: _settled(solver, design))
        moved_design = design.with_line("mid-bust", 0.93)
        moved = _part("moves a line and settles", lambda: _settled(solver, moved_design))
        _check(moved.verdict.words == "settled", f"the solution is {moved.verdict.words}")
        _check(abs(moved.error_ml) < 1.0, f"the volume is off by {moved.error_ml:.2f} ml")
        _check(bool(np.abs(moved.points - opened.points).max() > 1.0), "the body did not follow the line")
        path = Path(folder) / "self-test.busk"
        _part("saves", lambda: save_project(path, Document.of(moved_design), moved.stages.scan, None))
        again_design = _part("reopens", lambda: open_project(path).design)
        again = _part("solves again", lambda: _fresh_answer(again_design))
        apart = float(np.abs(again.points - moved.points).max())
        # Both runs have settled, on different ways: one from rest, one from the sample's length.
        _check(apart < 0.3, f"the reopened body differs by {apart:.3f} mm")
        _part("draws a picture", lambda: _picture(moved_design, Path(folder) / "picture.png"))
    print("all is well")
    return 0


def _fresh_answer(design: Design) -> Frame:
    with _solver() as solver:
        return _settled(solver, design)


def _picture(design: Design, path: Path) -> None:
    draw_picture(design, path, size=(320, 240))
    _check(path.stat().st_size > 2000, "the picture is empty")


def _settled(solver: LiveSolver, design: Design) -> Frame:
    """Return the last frame of a design, when no more turns are made."""
    revision = solver.submit(design, fresh=True)
    patience = time.monotonic() + _PATIENCE
    while time.monotonic() < patience:
        answer = solver.latest()
        if isinstance(answer, Failure):
            raise answer.error
        if answer is not None and answer.revision == revision and not answer.at_work:
            return answer
        time.sleep(0.005)
    raise UserError("The solver gives no answer.", "Report this with the version and the machine.")


@contextmanager
def _solver() -> Iterator[LiveSolver]:
    solver = LiveSolver()
    try:
        yield solver
    finally:
        solver.stop()


def _part(what: str, work: Callable[[], T]) -> T:
    start = time.perf_counter()
    result = work()
    print(f"  {what}: {time.perf_counter() - start:.2f} s")
    return result


def _check(holds: bool, sentence: str) -> None:
    if not holds:
        raise UserError(f"Self-test: {sentence}.", "Report this with the version and the machine.")
