"""Commands are found by words of the trade, by parts of words, in both languages."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from window_tools import Script, run_main, settled, undrawn

from app.gui.features.help.command_palette import CommandPalette, normalized
from app.gui.main_window import MainWindow
from app.i18n.search_terms import SYNONYMS

pytestmark = pytest.mark.usefixtures("empty_house")


def test_what_a_designer_types_is_found() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        titles = {action.text().replace("&", "") for _, action in window.actions_.all()}
        assert SYNONYMS.keys() <= titles, "each word leads somewhere"
        window.help_controller.find_command()
        sheet = window.findChild(CommandPalette)

        def first(typed: str) -> str:
            sheet.search.setText(typed)
            chosen = sheet.list.chosen()
            return chosen.title if chosen is not None else ""

        def found(typed: str) -> set[str]:
            sheet.search.setText(typed)
            rows = range(sheet.list.topLevelItemCount())
            return {sheet.list.topLevelItem(row).data(0, Qt.ItemDataRole.UserRole).title for row in rows}

        assert "Map on the body" in found("lif")
        assert first("リフト")
        assert first("unit") == first("インチ") == "Preferences"
        assert first("prin") == "Print image"
        for typed in ("waist", "bust", "report", "cup", "ＳＴＬ", "断面", "カップ", "レポート", "symm"):
            assert first(typed), typed
        assert "Result" in found("waist") & found("ウエスト") & found("hip"), "its measures stand there"
        assert first("Lines") == "Lines", "what begins so comes first"
        assert first("picture copy") == "Copy image"
        assert not first("zzz")
        sheet.reject()

    run_main([], script)


def test_letters_of_any_width_are_the_same() -> None:
    assert normalized("ＳＴＬ Ｆile") == "stl file"
