"""How tests sit in front of the real window: the real main(), driven from inside its event loop."""

from __future__ import annotations

import inspect
import sys
import time
from collections.abc import Callable, Generator
from types import TracebackType

import numpy as np
import pytest
from PySide6.QtCore import QCoreApplication, QPoint, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot
from shiboken6 import isValid

from app.cli.main import main
from app.gui.main_window import MainWindow
from app.gui.viewport.viewport import Viewport
from core.errors import UserError

PATIENCE = 90.0
"""Seconds that a script waits for one thing: a limit for what hangs, not for a machine with other work."""

Script = Generator[Callable[[], bool], None, None]


Kinds = tuple[type[Exception], ...]


def run_main(arguments: list[str], script: Callable[[MainWindow], Script], expected: Kinds = ()) -> int:
    """Start ``busk`` and play ``script``, which yields what to wait for; at its end the window is closed.

    The window is small, and the camera jumps where it would fly. A fault in a slot, an event or a thread,
    which the window survives, is raised at the end; but not one of the ``expected`` kinds, nor a UserError,
    which the window is to show.
    """
    player, faults = _Player(script), []

    def note(_: type[BaseException], fault: BaseException, __: TracebackType | None) -> None:
        if not isinstance(fault, (UserError, *expected)):
            faults.append(fault)

    QTimer.singleShot(0, player.begin)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "__excepthook__", note)  # where all hooks of the program end
        code = main(arguments)
        QCoreApplication.sendPostedEvents(None, 0)
    if player.fault is not None:
        raise player.fault from next(iter(faults), None)
    if faults:
        raise faults[0]
    assert player.ended, "the window was closed before the script was over"
    return code


def run_undrawn(arguments: list[str], script: Callable[[MainWindow], Script], expected: Kinds = ()) -> int:
    """Do as ``run_main``, with no 3D view drawn from the start."""

    def unseen(window: MainWindow) -> Script:
        undrawn(window)
        yield from script(window)

    return run_main(arguments, unseen, expected)


def run_bodiless(arguments: list[str], script: Callable[[MainWindow], Script], expected: Kinds = ()) -> int:
    """Do as ``run_main``, with no body in the 3D view."""

    def unseen(window: MainWindow) -> Script:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(window.view, "prepare", lambda *_: None)
            window.frames.order.remove(window.view.show_frame)
            yield from script(window)

    return run_main(arguments, unseen, expected)


def settled(window: MainWindow) -> Callable[[], bool]:
    """The design of the session is solved to the end and has been drawn."""

    return window.is_settled


def undrawn(window: MainWindow) -> None:
    """Draw no 3D view, which takes most of the time where a test does not ask for it."""
    canvas = window.view.viewport.overlay.parentWidget()
    assert canvas is not None
    canvas.setUpdatesEnabled(False)


def drag(window: MainWindow, name: str, pixels: int, release: bool = True) -> None:
    """Drag the handle of a line's slider, as a hand does."""
    slider = window.lines.rows[name].slider
    start = QPoint(round(slider.x_of(slider.ratio())), slider.height() // 2)
    QTest.mousePress(slider, Qt.MouseButton.LeftButton, pos=start)
    for step in range(1, 6):
        QTest.mouseMove(slider, start + QPoint(pixels * step // 5, 0))
    if release:
        QTest.mouseRelease(slider, Qt.MouseButton.LeftButton, pos=start + QPoint(pixels, 0))


def points(window: MainWindow) -> np.ndarray:
    """Where the moving part of the shown body is."""
    frame = window.session.frame
    assert frame is not None
    return frame.points


class _Player:
    def __init__(self, script: Callable[[MainWindow], Script]) -> None:
        self._script = script
        self.fault: BaseException | None = None
        self.ended = False
        self._deadline = time.monotonic() + PATIENCE
        self._window: MainWindow | None = None
        self._waiting: Callable[[], bool] = lambda: True
        self._timer = QTimer(interval=5)
        self._timer.timeout.connect(self._look)

    def begin(self) -> None:
        self._timer.start()

    def _look(self) -> None:
        try:
            self._step()
        except StopIteration:
            self.ended = True
            self._finish()
        except BaseException as fault:
            self.fault = fault
            self._finish()

    def _step(self) -> None:
        if self._window is None:
            windows = [each for each in QApplication.topLevelWidgets() if isinstance(each, MainWindow)]
            if not windows:
                return self._check_patience()
            self._window = windows[0]
            self._window.resize(self._window.minimumSize())  # half the pixels: there is no GPU
            self._window.view.viewport.motion = False
            self._play = self._script(self._window)
        if not self._waiting():
            return self._check_patience()
        self._deadline = time.monotonic() + PATIENCE
        self._waiting = next(self._play)
        return None

    def _check_patience(self) -> None:
        if time.monotonic() > self._deadline:
            raise TimeoutError(f"the window does not get there: {self._where()}")

    def _where(self) -> str:
        """Return the line of the script, or of a part of it, that waits."""
        play = self._play if self._window is not None else None
        while play is not None and inspect.isgenerator(play.gi_yieldfrom):
            play = play.gi_yieldfrom
        frame = play.gi_frame if play is not None else None
        return "no window is open" if frame is None else f"{frame.f_code.co_name}, line {frame.f_lineno}"

    def _finish(self) -> None:
        self._timer.stop()
        if self._window is not None and isValid(self._window):
            self._window.session.undo_stack.setClean()
            # The last window's end is the end of main(); a second quit would wait for the next event loop.
            self._window.close()
        else:
            QApplication.quit()


def small_view(qtbot: QtBot, width: int, height: int) -> Viewport:
    """A 3D view of its own that is shown, in which the camera jumps where it would fly."""
    view = Viewport()
    qtbot.addWidget(view)
    view.motion = False
    view.resize(width, height)
    view.show()
    qtbot.waitExposed(view)
    return view
