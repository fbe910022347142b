"""Every widget of the real window can be named, understood, read in full and reached without a mouse."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtCore import QSettings, Qt
from PySide6.QtGui import QAccessible
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractSlider,
    QApplication,
    QLabel,
    QLineEdit,
    QMenuBar,
    QPushButton,
    QScrollBar,
    QToolButton,
    QWidget,
)
from window_tools import Script, run_main, settled

from app.gui.features.lines.slider import LengthSlider
from app.gui.main_window import MainWindow

pytestmark = pytest.mark.usefixtures("empty_house")


@pytest.mark.parametrize("language", ["en", "ja"])
def test_all_that_can_be_used_has_a_name_a_tip_and_room_for_its_words(language: str) -> None:
    QSettings().setValue("language", language)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.strip.set_folded(False)
        lacks = set()
        for show in (
            *(lambda s=step: window.navigation.show_step(s) for step in window.rail.items),
            window.model_controller.show,
        ):
            show()
            window.notices.show_notice("bad", "Nothing is wrong.", "Go on.", lasting=True, details="at all")
            for _ in range(12):  # a row that has got another sentence takes its height a moment later
                yield lambda: True
            lacks |= set(shortcomings(window))
        assert not lacks, "\n".join(sorted(lacks))
        if language == "en":
            yield from without_a_mouse(window)

    assert run_main([], script) == 0


def shortcomings(window: QWidget) -> Iterator[str]:
    """Give what a usable widget lacks: a name for ears, a tip, room for its words."""
    for widget in window.findChildren(QWidget):
        if not widget.isVisible():
            continue
        chain = [widget]
        while chain[-1].parentWidget() not in (None, window):
            chain.append(chain[-1].parentWidget())
        where = " in ".join(type(each).__name__ for each in chain[:4])
        usable = widget.isEnabled() and widget.focusPolicy() != Qt.FocusPolicy.NoFocus
        if usable and not QAccessible.queryAccessibleInterface(widget).text(QAccessible.Text.Name):
            yield f"no name: {where}"
        if is_tool(widget) and not any(each.toolTip() for each in chain[:4]):
            yield f"no tip: {where}"
        room, needed = (widget.width(), widget.height()), room_needed(widget)
        if room[0] < needed[0] or room[1] < needed[1]:
            yield f"cut off: {widget.text()!r} {room} of {needed} in {where}"  # type: ignore[attr-defined]


def is_tool(widget: QWidget) -> bool:
    """Tell whether a widget does not say by itself what it is for: a button with words does."""
    if isinstance(widget, QPushButton):
        return widget.property("kind") in ("pull", "segment") or not widget.text()
    tools = (QToolButton, QLineEdit, QAbstractSlider)
    # The arrow of a menu bar that has no room is Qt's own.
    return (
        isinstance(widget, tools)
        and not isinstance(widget, QScrollBar | QMenuBar)
        and bool(widget.objectName() != "qt_menubar_ext_button")
    )


def room_needed(widget: QWidget) -> tuple[int, int]:
    """Return the width and height that all words of a label or button take."""
    if isinstance(widget, QLabel) and widget.text():
        if widget.wordWrap():
            return 0, widget.heightForWidth(widget.width())
        ignored = widget.sizePolicy().horizontalPolicy() == widget.sizePolicy().Policy.Ignored
        return 0 if ignored else widget.sizeHint().width(), widget.sizeHint().height()
    if isinstance(widget, QPushButton) and widget.text():
        return widget.fontMetrics().horizontalAdvance(widget.text()) + 4, widget.fontMetrics().height()
    return 0, 0


def without_a_mouse(window: MainWindow) -> Script:
    """From the scan to a result by keys alone: a step by its number, panes by F6, lines by arrows."""
    window.activateWindow()
    yield window.isActiveWindow
    ctrl, focus = Qt.KeyboardModifier.ControlModifier, QApplication.focusWidget
    window.notices.clear()
    for key, panel in (
        (Qt.Key.Key_1, window.scan),
        (Qt.Key.Key_2, window.landmarks),
        (Qt.Key.Key_3, window.lines),
    ):
        QTest.keyClick(window, key, ctrl)
        assert panel.isVisible()
    for _ in range(8):
        if window.inspector.isAncestorOf(focus()):
            break
        QTest.keyClick(focus(), Qt.Key.Key_F6)
    assert window.inspector.isAncestorOf(focus())
    for _ in range(30):
        if isinstance(focus(), LengthSlider):
            break
        QTest.keyClick(focus(), Qt.Key.Key_Tab)
    slider = focus()
    assert isinstance(slider, LengthSlider)
    before, count = slider.ratio(), window.session.undo_stack.count()
    QTest.keyClick(slider, Qt.Key.Key_Left, Qt.KeyboardModifier.ShiftModifier)
    assert slider.ratio() == pytest.approx(before - 0.01)
    assert window.session.undo_stack.count() == count + 1
    yield settled(window)
    QTest.keyClick(focus(), Qt.Key.Key_4, ctrl)
    assert window.result.isVisible()
    QTest.keyClick(focus(), Qt.Key.Key_Z, ctrl)
    assert window.session.undo_stack.index() == count
