"""The table of measures as it is painted: where units stand, and what is no result."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QRect
from PySide6.QtGui import QImage
from pytestqt.qtbot import QtBot

from app.gui.features.measurements.table import HEAD, ROW, TOP, MeasurementsTable, cells
from app.presenters.measurements import MeasureView, as_table
from app.presenters.uncertainty import with_uncertainty
from core.measurements.uncertain_value import SOURCES, OutputUncertainties, Uncertainty

GIRTH = MeasureView("Bust", "mm", 900.0, 869.5, key="bust_girth", group="Girths", tip="By tape.")
LINE = MeasureView("Mid-bust", "mm", 422.3, 410.9, "along the line, side to side", group="Followed")


@pytest.fixture
def table(qtbot: QtBot) -> MeasurementsTable:
    table = MeasurementsTable()
    qtbot.addWidget(table)
    table.resize(300, 400)
    return table


def darkness(table: MeasurementsTable, place: QRect) -> int:
    """How much darker than its ground the darkest spot of a place is."""
    shown: QImage = table.grab(place).toImage()
    spots = [shown.pixelColor(x, y).lightness() for x in range(shown.width()) for y in range(shown.height())]
    return max(spots) - min(spots)


def test_the_unit_stands_beside_the_name_of_a_group_and_in_no_column(table: MeasurementsTable) -> None:
    table.set_rows([GIRTH])
    column = cells(table.width(), TOP, HEAD)[1].toRect().adjusted(0, 4, 0, -4)
    assert darkness(table, column) == 0, "the column After"
    beside = QRect(4 + table.fontMetrics().horizontalAdvance("Girths"), TOP + 4, 40, HEAD - 8)
    assert darkness(table, beside) > 40


def test_what_is_no_result_is_pale_and_has_no_bar(table: MeasurementsTable) -> None:
    before, after, change, bar = (cell.toRect() for cell in cells(table.width(), TOP + HEAD, ROW))
    shown = {}
    for doubtful in (False, True):
        table.set_rows([GIRTH], doubtful=doubtful)
        shown[doubtful] = [darkness(table, cell) for cell in (before, after, change, bar)]
    assert shown[True][0] == shown[False][0], "before is the body as it was scanned"
    for sure, pale in zip(shown[False][1:3], shown[True][1:3], strict=True):
        assert 20 < pale < 0.7 * sure
    assert shown[True][3] == 0


def test_a_table_that_is_given_away_notes_that_it_is_no_result() -> None:
    missing = MeasureView("Hip", "mm", None, None, key="hip_girth", note="not on the scan")
    rows = as_table([GIRTH, missing], "Overstrained: no result.")
    assert [row[-1] for row in rows[1:]] == [
        "Overstrained: no result.",
        "not on the scan; Overstrained: no result.",
    ]
    assert [row[-1] for row in as_table([GIRTH, missing])[1:]] == ["", "not on the scan"]


def test_a_length_says_that_no_plus_minus_is_worked_out() -> None:
    doubts = {"after:bust_girth": Uncertainty({"scan": 1.0})}
    known = OutputUncertainties(doubts, np.zeros(1), 0.2, 2.0, SOURCES, {}, "sliding")
    girth, line = with_uncertainty([GIRTH, LINE], known, faint=False)
    assert line.off == ()
    assert "only those of the bust points have an uncertainty" in line.told()
    assert girth.off[1] is not None
    assert "lengths of lines" not in girth.told()
