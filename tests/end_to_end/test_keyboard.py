"""The window with the keyboard alone: where it begins, where it goes on, and what Enter and Esc do."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAccessible, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from window_tools import Script, run_bodiless, run_main, settled

from app.gui.features.project.recovery import RecoveryView
from app.gui.main_window import MainWindow

pytestmark = pytest.mark.usefixtures("empty_house")


def press(key: Qt.Key, held: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    """Press a key where the keyboard is."""
    QTest.keyClick(QApplication.focusWidget(), key, held)


def begun(window: MainWindow) -> Script:
    """Wait until the sample stands in an active window."""
    yield settled(window)
    window.start_controller.tour.end()
    window.activateWindow()
    yield window.isActiveWindow


def test_after_opening_tab_goes_on_in_the_panel_and_a_step_by_key_ends_the_view_alone() -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        assert window.lines.hasFocus(), "not in the view, where Tab would hide the rest"
        press(Qt.Key.Key_Tab)
        assert window.inspector.isAncestorOf(QApplication.focusWidget())
        assert not window.actions_.alone.isChecked()
        window.actions_.alone.trigger()
        assert not window.inspector.isVisible()
        window.actions_.steps["lines"].trigger()
        assert window.inspector.isVisible()
        assert not window.actions_.alone.isChecked()
        window.actions_.steps["landmarks"].trigger()
        assert window.landmarks.hasFocus()
        press(Qt.Key.Key_Down)
        assert QApplication.focusWidget() is next(iter(window.landmarks.rows.values()))

    assert run_bodiless([], script) == 0


def test_the_model_is_entered_by_its_key_and_left_by_esc() -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        window.actions_.model.trigger()
        assert window.model.isAncestorOf(QApplication.focusWidget()) or window.model.hasFocus()
        press(Qt.Key.Key_Tab)
        assert window.model.isAncestorOf(QApplication.focusWidget())
        press(Qt.Key.Key_Escape)
        assert window.lines.hasFocus()
        window.view.compare_by("wipe")
        press(Qt.Key.Key_Escape)
        assert window.view.beside.way == "after"

    assert run_main([], script) == 0


def test_a_card_over_the_window_takes_the_keyboard_and_goes_by_esc_or_once_something_is_opened(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        desk, let_go = window.recovery_controller, []
        monkeypatch.setattr(desk, "_offers", [(object(), _Left(let_go))])
        desk.card.offer(RecoveryView("anna", "today", QImage()))
        assert desk.card.take.hasFocus()
        window.lines.setFocus()
        seen = set()
        for _ in range(120):
            press(Qt.Key.Key_Tab)
            seen.add(QApplication.focusWidget())
        assert {desk.card.take, desk.card.drop} <= seen
        window.lines.setFocus()
        press(Qt.Key.Key_Escape)
        assert not desk.card.isVisible()
        assert let_go == ["kept for the next start"]
        monkeypatch.setattr(desk, "_offers", [(_Kept(), _Left(let_go))])
        desk.card.offer(RecoveryView("anna", "today", QImage()))
        window.project_controller.open_sample("person")
        yield lambda: window.session.name == "person" and window.is_settled()
        assert not desk.card.isVisible()
        assert len(let_go) == 2

    assert run_main([], script) == 0


def test_enter_presses_the_button_that_has_the_keyboard_and_space_does_not_flip_the_body() -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        for key in (Qt.Key.Key_Return, Qt.Key.Key_Space):
            window.navigation.show_step("scan")
            window.rail.items["scan"].setFocus(Qt.FocusReason.TabFocusReason)
            door = window.rail.items["lines"]
            door.setFocus(Qt.FocusReason.TabFocusReason)
            way = window.view.beside.way
            press(key)
            assert window.inspector.panel() is not window.scan
            assert window.view.beside.way in (way, "after")

    assert run_main([], script) == 0


def test_the_keyboard_stays_with_a_line_whatever_is_done_to_it() -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        row = window.lines.rows["mid-bust"]
        window.selection.select_line("mid-bust")
        row.slider.setFocus()
        window.lines.do("lock")
        yield lambda: row.view.locked
        assert row.hasFocus()
        window.lines.do("lock")
        yield lambda: not row.view.locked
        assert row.slider.hasFocus()
        window.lines.do("rename")
        QTest.keyClicks(QApplication.focusWidget(), "Foundation")
        press(Qt.Key.Key_Return)
        yield lambda: row.view.title == "Foundation"
        assert row.slider.hasFocus()
        assert row.slider.accessibleName() == "Length of Foundation"
        assert row.slider.accessibleDescription().startswith(f"{row.slider.ratio() * 100:.1f} %, ")
        assert row.percent.accessibleName() == "Foundation: length in percent"

    assert run_bodiless([], script) == 0


def test_steps_and_tabs_are_heard_as_choices_and_sliders_as_what_they_mean() -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        for each in (window.rail.items["scan"], window.inspector.tabs.button("lines")):
            assert QAccessible.queryAccessibleInterface(each).role() == QAccessible.Role.RadioButton
        window.sections_controller.set_on(True)
        panel = window.sections_controller.panel
        assert panel.slider.accessibleDescription() == f"x = {panel.place.text()} mm"
        window.view.compare_by("wipe")
        assert window.view.panes.handle.accessibleDescription() == "50 %"
        panel.plot.setFocus(Qt.FocusReason.TabFocusReason)
        for _ in range(2):
            press(Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
        assert panel.plot.gap.endswith("mm")
        assert panel.plot.accessibleDescription() == panel.plot.gap

    assert run_main([], script) == 0


class _Kept:
    document = None


class _Left:
    """What was left behind, as far as it is left for the next start."""

    def __init__(self, told: list[str]) -> None:
        self._told = told

    def leave(self) -> None:
        self._told.append("kept for the next start")
