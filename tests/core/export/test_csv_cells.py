"""Cells of tables: no text of a project is a formula in the spreadsheet that opens it."""

from __future__ import annotations

import pytest

from core.export.csv_cells import cell


@pytest.mark.parametrize("text", ["=1+1", "+cmd|'/C calc'!A0", "@SUM(A1)", "-2+3", "\t=1", "-", "+A1"])
def test_what_looks_like_a_formula_stays_a_text(text: str) -> None:
    assert cell(text) == f"'{text}"


@pytest.mark.parametrize("text", ["+3.5", "-0,2", "+12 %", "-1 234", "Anna", "a=b", "", "10-12"])
def test_figures_and_plain_texts_stay_as_they_are(text: str) -> None:
    assert cell(text) == text


def test_other_values_are_written_short() -> None:
    assert [cell(each) for each in (None, True, 1.23456789, 7, ("a", 0.5))] == [
        "",
        "true",
        "1.23457",
        7,
        "a 0.5",
    ]
