"""Presets in the window: over the list stands what is worn and, lastingly, what it leaves out."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget
from window_tools import Script, run_bodiless, run_undrawn, settled

from app.gui.features.lines import presets as preset_desk
from app.gui.main_window import MainWindow
from core.document.design import Design, ScanSource
from core.garment.presets import built_in, is_active, user_file, with_preset

pytestmark = pytest.mark.usefixtures("empty_house")


def test_the_worn_preset_stands_over_the_list_with_what_it_leaves_out() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        head = window.lines.head
        assert head.presets.text() == "Presets"
        assert head.note.isHidden()
        head.presets.click()
        menu = window.actions_.menus["presets"]
        yield menu.isVisible
        bodysuit = next(each for each in menu.actions() if each.text().startswith("Bodysuit"))
        assert "gusset" in bodysuit.toolTip(), "said before it is worn"
        bodysuit.trigger()
        menu.close()
        yield settled(window)
        assert head.presets.text() == bodysuit.text()
        assert head.note.isVisible()
        assert "gusset" in head.note.text()
        window.lines_controller.commit_length("mid-bust", 0.93)
        assert head.presets.text() == bodysuit.text(), "another length, the same set"
        window.lines_controller.commit_length("mid-bust", 1.0)
        assert head.presets.text() == "Presets"
        assert head.note.isHidden()

    run_undrawn([], script)


def test_a_preset_is_replaced_only_by_one_who_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    names: list[str] = []
    answers: list[str] = []
    asked: list[str] = []
    monkeypatch.setattr(preset_desk, "ask_name", lambda *_: names.pop(0))
    monkeypatch.setattr(preset_desk, "ask", lambda _, question, *__: asked.append(question) or answers.pop(0))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        names[:] = ["Longline"]
        window.presets_controller.ask()
        first = user_file("Longline").read_bytes()
        assert not asked, "there is none of that name"
        window.lines_controller.commit_length("mid-bust", 0.9)
        names[:], answers[:] = ["Longline", ""], [""]
        window.presets_controller.ask()
        assert asked == ["Replace the preset Longline?"]
        assert user_file("Longline").read_bytes() == first
        assert not names, "the name was asked for again"
        names[:], answers[:] = ["Longline"], ["replace"]
        window.presets_controller.ask()
        assert user_file("Longline").read_bytes() != first

    run_bodiless([], script)


def test_the_button_that_adds_offers_only_what_adds_and_is_lit_no_longer() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        add, menu = window.lines.head.add, window.add_lines_controller.menu
        lit(add)
        add.click()
        yield menu.isVisible
        asked = {action.text() for action in menu.actions()}
        assert window.actions_.add_lines["straps"].text() in asked
        assert not any("name" in words or "Lock" in words for words in asked)
        menu.close()
        assert not add.underMouse()

    run_bodiless([], script)


def lit(button: QWidget) -> None:
    button.setAttribute(Qt.WidgetAttribute.WA_UnderMouse, True)


def test_each_preset_is_told_from_the_others() -> None:
    bare = Design(ScanSource(""))
    for preset in built_in():
        worn = with_preset(bare, preset)
        assert [each.title for each in built_in() if is_active(worn, each)] == [preset.title]
    assert not any(is_active(bare, each) for each in built_in())
