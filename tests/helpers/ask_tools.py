"""How tests ask for the result in the window."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QCoreApplication, QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from window_tools import settled

from app.gui.main_window import MainWindow
from app.gui.viewport.target_handle import TargetHandle


def wear(window: MainWindow, mid: float = 0.97, full: float = 0.98) -> Callable[[], bool]:
    """Wear both lines that move, with the answer that is there at once; pressures have no limit."""
    design = window.session.design
    assert design is not None
    worn = replace(design, volume="exact").with_line("mid-bust", mid).with_line("full-bust", full)
    window.session.edit(lambda _: worn, "Wear them")
    window.target_shape_controller.all_wishes.limit = math.inf
    return settled(window)


def answered(window: MainWindow) -> Callable[[], bool]:
    """The newest question has its full answer, which is previewed and drawn."""
    desk = window.target_shape_controller

    def done() -> bool:
        frame, answer = window.session.frame, desk.answer
        if answer is None or desk.work.at_work or desk._rest.isActive() or frame is None:
            return False
        wanted = answer.reply.design if answer.reply is not None else window.session.design
        return frame.stages.design == wanted and not frame.is_running

    return done


def type_wish(window: MainWindow, key: str, text: str) -> None:
    """Type over a field of the card, as a hand does."""
    field = window.target_shape_controller.card.wishes[key].field
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Return)


def drag(handle: TargetHandle, right: int, down: int, *, fine: bool = False, drop: bool = True) -> None:
    """Drag a handle over the picture by so many pixels."""
    keys = Qt.KeyboardModifier.ShiftModifier if fine else Qt.KeyboardModifier.NoModifier
    middle, way = handle.rect().center(), QPoint(right, down)
    QTest.mousePress(handle, Qt.MouseButton.LeftButton, keys, middle)
    where = handle.mapToGlobal(middle)
    for share in (0.5, 1.0):
        to = QPointF(where + way * share)
        here = QPointF(handle.mapFromGlobal(to.toPoint()))
        left = Qt.MouseButton.LeftButton
        moved = QMouseEvent(QEvent.Type.MouseMove, here, to, Qt.MouseButton.NoButton, left, keys)
        QCoreApplication.sendEvent(handle, moved)
    if drop:
        QTest.mouseRelease(handle, Qt.MouseButton.LeftButton, keys, handle.rect().center())
