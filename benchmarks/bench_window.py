"""A slider dragged in the real window: how often the view follows, how soon, and where the time goes.

Run: QT_QPA_PLATFORM=xcb xvfb-run -a -s "-screen 0 2600x1500x24" python benchmarks/bench_window.py [SCAN]
with [--seconds 6] [--view 900x600] [--control adaptive] [--pins]; on a display of your own without xvfb-run.

A timer moves the mouse over the slider of the mid-bust line every 16 ms, to and fro between 100 % and 88 %.
A move is answered when the window is painted with a body of its length or of a later one. Prints frames of
the view a second, milliseconds from a move to its picture, and milliseconds of each part per frame: by the
clock, and by the processor in the thread that did it. With software OpenGL everything else that runs on the
machine counts heavily: compare only runs that took turns.
"""

from __future__ import annotations

import argparse
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PySide6.QtCore import QEvent, QEventLoop, QPoint, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pyvistaqt import QtInteractor

from app.cli.commands.picture import wait_until
from app.gui.application import application
from app.gui.features.lines.panel import LinesPanel
from app.gui.frame_dispatch import FrameDispatch, ThrottledDispatch
from app.gui.main_window import MainWindow
from app.gui.plots.canvas import PlotCanvas
from app.gui.startup import open_window
from app.gui.viewport.canvas import Canvas
from app.gui.viewport.overlay import Overlay
from app.gui.viewport.view_area import ViewArea
from app.gui.viewport.viewport import Viewport
from app.rendering.display import off_screen
from core.document.design import Design, ScanSource
from core.mechanics.solver_comparison import SolverComparison
from core.pipeline import live_solver as live
from core.pipeline.live_solver import LiveSolver

SAMPLE = Path(__file__).parent.parent / "resources" / "samples" / "mannequin.ply"
LINE, SHORTEST, EVERY, SWING = "mid-bust", 0.88, 16, 2.0
WATCHED: tuple[tuple[str, Any, str], ...] = (
    ("solver: new lengths", SolverComparison, "retarget"),
    ("solver: turns", SolverComparison, "advance"),
    ("solver: frame", live, "make_frame"),
    ("show frame", FrameDispatch, "show_frame"),
    ("  view", ViewArea, "show_frame"),
    ("    ask to draw", Viewport, "request_draw"),
    ("  list of lines", LinesPanel, "set_lines"),
    ("  plots, figures", ThrottledDispatch, "flush"),
    ("paint window", MainWindow, "event"),
    ("  3D", QtInteractor, "paintGL"),
    ("  3D image", Canvas, "_render"),
    ("  overlay", Overlay, "paintEvent"),
    ("  curves", PlotCanvas, "paintEvent"),
)
"""What is timed; indented parts belong to the one above."""


class Stopwatch:
    """Seconds that each of ``WATCHED`` takes while ``running``; ``painted`` is called after each paint."""

    def __init__(self) -> None:
        self.running = False
        self.painted: Callable[[], None] = lambda: None
        self.wall: dict[str, float] = defaultdict(float)
        self.processor: dict[str, float] = defaultdict(float)
        self.calls: dict[str, int] = defaultdict(int)
        for name, owner, method in WATCHED:
            setattr(owner, method, self._timed(name, owner, getattr(owner, method)))

    def _timed(self, name: str, owner: Any, work: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*args: Any, **options: Any) -> Any:
            painting = owner is MainWindow and args[1].type() == QEvent.Type.UpdateRequest
            if not self.running or (owner is MainWindow and not painting):
                return work(*args, **options)
            wall, processor = time.perf_counter(), time.thread_time()
            try:
                return work(*args, **options)
            finally:
                self.wall[name] += time.perf_counter() - wall
                self.processor[name] += time.thread_time() - processor
                self.calls[name] += 1
                if painting:
                    self.painted()

        return timed


class Drag:
    """A hand on the slider of one line, and the answers to its moves; ``waits`` [s]."""

    def __init__(self, window: MainWindow, watch: Stopwatch) -> None:
        self._window, self._watch = window, watch
        self._slider = window.lines.rows[LINE].slider
        self._asked = 0
        submit = LiveSolver.submit

        def noted(*args: Any, **options: Any) -> int:
            self._asked = submit(*args, **options)
            return self._asked

        LiveSolver.submit = noted  # type: ignore[method-assign]
        self._moved_at: dict[int, float] = {}
        self._shown = window.session.frame
        self.waits: list[float] = []
        self.frames = 0

    def run(self, seconds: float) -> None:
        """Press, move for some seconds, let go."""
        self._watch.painted = self._painted
        self._start = time.perf_counter()
        QTest.mousePress(self._slider, Qt.MouseButton.LeftButton, pos=self._at(1.0))
        hand = QTimer(interval=EVERY, timerType=Qt.TimerType.PreciseTimer)
        hand.timeout.connect(self._move)
        loop = QEventLoop()
        QTimer.singleShot(round(1000 * seconds), loop.quit)
        hand.start()
        self._watch.running = True
        loop.exec()
        self._watch.running = False
        hand.stop()
        QTest.mouseRelease(self._slider, Qt.MouseButton.LeftButton, pos=self._at(1.0))

    def _move(self) -> None:
        swing = (time.perf_counter() - self._start) / SWING % 1.0
        ratio = 1.0 - (1.0 - SHORTEST) * (1.0 - abs(2.0 * swing - 1.0))
        now, before = time.perf_counter(), self._asked
        QTest.mouseMove(self._slider, self._at(ratio))
        if self._asked != before:
            self._moved_at[self._asked] = now

    def _painted(self) -> None:
        frame = self._window.session.frame
        if frame is None or frame is self._shown:
            return
        self._shown = frame
        self.frames += 1
        now = time.perf_counter()
        for revision in [each for each in self._moved_at if each <= frame.revision]:
            self.waits.append(now - self._moved_at.pop(revision))

    def _at(self, ratio: float) -> QPoint:
        return QPoint(round(self._slider.x_of(ratio)), self._slider.height() // 2)


def sized(window: MainWindow, width: int, height: int) -> None:
    """Give the window the size in which its view has the wanted one, and wait until it is at rest."""
    window.resize(1300, 900)
    window.show()
    wait_until(lambda: window.is_settled() and window.view.is_shaded, QApplication.processEvents)
    view = window.view
    window.resize(window.width() + width - view.width(), window.height() + height - view.height())
    pause = time.monotonic() + 1.0
    wait_until(lambda: time.monotonic() > pause, QApplication.processEvents)
    print(f"view {view.width()} x {view.height()} in a window of {window.width()} x {window.height()}")


def report(drag: Drag, watch: Stopwatch, seconds: float, processor: float) -> None:
    """Print what was measured."""
    waits = 1e3 * np.array(drag.waits)
    each = 1e3 * processor / max(drag.frames, 1)
    print(f"{drag.frames / seconds:.1f} frames/s, {each:.0f} ms of processor each")
    print(f"move to picture: median {np.median(waits):.0f}, 95 % {np.quantile(waits, 0.95):.0f} ms")
    print(f"{'ms a frame':24}{'clock':>9}{'processor':>11}{'calls/s':>9}")
    for name, _, _ in WATCHED:
        wall, own = (1e3 * part[name] / max(drag.frames, 1) for part in (watch.wall, watch.processor))
        print(f"{name:24}{wall:9.2f}{own:11.2f}{watch.calls[name] / seconds:9.1f}")


def main() -> None:
    off_screen()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scan", nargs="?", default=str(SAMPLE))
    parser.add_argument("--seconds", type=float, default=6.0)
    parser.add_argument("--view", default="900x600")
    parser.add_argument("--control", default="adaptive")
    parser.add_argument("--pins", action="store_true")
    asked = parser.parse_args()
    application(language="en", dark=False)
    watch = Stopwatch()
    window = open_window(Design(ScanSource(asked.scan), volume=asked.control))
    sized(window, *map(int, asked.view.split("x")))
    if asked.pins:
        window.view.set_layer("landmarks", True)
    drag, begun = Drag(window, watch), time.process_time()
    drag.run(asked.seconds)
    report(drag, watch, asked.seconds, time.process_time() - begun)
    window.session.undo_stack.setClean()
    window.close()


if __name__ == "__main__":
    main()
