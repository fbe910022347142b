"""The panel of the pattern in a low window: the list stays in sight beside a long card."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint
from pytestqt.qtbot import QtBot

from app.gui.features.pattern.panel import LIST_ROWS, PatternPanel
from app.presenters.pattern import PieceRow
from core.document.garment_pattern import GarmentPattern
from core.pattern.block_library import find_block

TIGHT = "Strain of 16.9 % on 95 % of the area exceeds 8 %, the limit of Cup tricot, stable."


def row(name: str, reason: str = TIGHT) -> PieceRow:
    overstrained = reason == TIGHT
    return PieceRow(
        name,
        name.capitalize(),
        "Cup tricot",
        101.0,
        16.9,
        8.0,
        not reason,
        reason,
        "",
        (6.1, -0.4),
        overstrained,
    )


@pytest.fixture
def panel(qtbot: QtBot) -> PatternPanel:
    """The panel as high as in a window of 700 pixels, with nine pieces."""
    shown = PatternPanel()
    qtbot.addWidget(shown)
    shown.resize(337, 630)
    shown.show_plan(GarmentPattern(find_block("two-part-cup")), "Two-part cup")
    shown.show_verdict("7 pieces do not fit their cloth.", "warn", "9 pieces.")
    shown.show_pieces([row(f"piece {number}") for number in range(9)], faint=False, selected="")
    shown.show()
    return shown


def in_sight(panel: PatternPanel) -> list[str]:
    """The pieces of the list that are seen whole."""
    view = panel._column.viewport()
    tops = [(each, each.mapTo(view, QPoint(0, 0)).y()) for each in panel.list.buttons]
    return [each.row.name for each, top in tops if top >= 0 and top + each.height() <= view.height()]


def test_a_card_with_all_its_fixes_leaves_the_list_and_the_selected_piece(
    panel: PatternPanel, qtbot: QtBot
) -> None:
    panel.piece_card.show_piece(row("piece 7"), (), "", 0.0)
    panel.select_piece("piece 7")
    panel.piece_card.show_fixes([f"Dart from the wire at {at}°: 7.2 % (limit 8 %)." for at in range(4)])
    qtbot.waitUntil(lambda: "piece 7" in in_sight(panel))
    assert len(in_sight(panel)) >= LIST_ROWS
    cards, press = panel._cards.viewport(), panel.piece_card.suggest

    def has_scrolled() -> bool:
        return 0 < press.mapTo(cards, QPoint(0, press.height())).y() <= cards.height()

    qtbot.waitUntil(has_scrolled)
    assert len(in_sight(panel)) >= LIST_ROWS


def test_a_card_without_fixes_is_as_high_as_it_is(panel: PatternPanel, qtbot: QtBot) -> None:
    panel.piece_card.show_piece(row("piece 0", ""), (), "", 0.0)
    cards = panel._cards
    qtbot.waitUntil(lambda: cards.verticalScrollBar().maximum() == 0 and cards.height() > 0)
    assert len(in_sight(panel)) > LIST_ROWS


@pytest.mark.parametrize(
    ("reason", "facts"), [(TIGHT, 0), ("Cannot be flattened without folds.", 1), ("", 1)]
)
def test_a_card_has_the_strain_once(panel: PatternPanel, reason: str, facts: int) -> None:
    panel.piece_card.show_piece(row("piece 0", reason), (), "", 0.0)
    card = panel.piece_card
    assert card.facts.text().count("16.9 %") == facts
    assert (card.reason.text() + card.facts.text()).count("16.9 %") == 1
    assert "Area 101 cm²" in card.facts.text()
