"""What changes with the next start of the program, the button for it, and what is kept until then."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QRect, QSettings, QSize
from PySide6.QtWidgets import QPushButton
from window_tools import Script, run_bodiless, settled

import app.gui.features.preferences.controller
import app.gui.widgets.file_dialogs
from app.gui.features.help.command_palette import normalized
from app.gui.main_window import MainWindow
from app.gui.widgets.coach_mark import _beside
from app.i18n.catalog import use_language
from app.presenters.messages import line_title

pytestmark = pytest.mark.usefixtures("empty_house")


def test_a_language_is_found_in_any_other_and_changes_by_a_button(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun: list[str] = []
    monkeypatch.setattr(app.gui.features.preferences.controller, "start_again", begun.append)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.hide()
        window.show()
        assert window.strip.is_folded(), "in a low window the plots are folded away"
        window.layout_.keep()
        assert QSettings().value("window/folded") == "false", "in a higher window they are not"
        for typed in ("japanese", "日本語", "language"):
            found = [each for each in window.help_controller.commands() if normalized(typed) in each.words]
            assert "日本語" in [each.title for each in found], typed
        window.preferences_controller.choose("language", "ja")
        (restart,) = (b for b in window.notices.findChildren(QPushButton) if b.text() == "Restart now")
        restart.click()
        yield lambda: bool(begun)

    assert run_bodiless([str(mannequin)], script) == 0
    assert begun == [str(mannequin)]


def test_names_that_the_program_gives_are_in_the_language_of_the_window() -> None:
    assert line_title("line 3") == "Line 3"
    use_language("ja")
    assert line_title("line 3") == "ライン 3"
    assert "ライン 3" in line_title("line 3 left")
    assert line_title("line of mine") == "Line of mine"
    assert line_title("full-bust") == "トップバスト"


def test_a_card_beside_a_column_covers_none_of_it() -> None:
    room, card, rail = QRect(0, 44, 1180, 656), QSize(320, 180), QRect(0, 44, 77, 280)
    column = QRect(0, 44, 77, 656)
    assert not QRect(_beside(rail, card, room, [column]), card).intersects(column)
