"""Sizes in letters: what the sources say of each girth, and what they do not say."""

import pytest

from core.measurements.definitions import DEFINITIONS
from core.measurements.sizes import letter_sizes

TABLES = {table.key: table for table in letter_sizes().tables}


@pytest.mark.parametrize(
    ("key", "girth", "letters"),
    [
        *[("briefs", cm, {"S", "M"}) for cm in (87, 88, 89, 90)],
        *[("briefs", cm, {"M", "L"}) for cm in (92, 93.5, 95)],
        ("briefs", 82, {"S"}),
        ("briefs", 91, {"M"}),
        ("briefs", 97, {"L", "LL"}),
        ("briefs", 105, {"LL", "3L"}),
        ("briefs", 110, {"3L"}),
        ("tops", 72, {"S"}),
        ("tops", 80, {"S", "M"}),
        ("tops", 87, {"M", "L"}),
        ("tops", 94, {"L"}),
    ],
)
def test_letters_are_those_that_the_sources_name(key: str, girth: float, letters: set[str]) -> None:
    assert set(TABLES[key].sizes(10.0 * girth)) == letters


def test_the_nearest_letter_comes_first_and_outside_there_is_none() -> None:
    assert TABLES["briefs"].sizes(871.0) == ("S", "M")
    assert TABLES["briefs"].sizes(899.0) == ("M", "S")
    assert TABLES["briefs"].sizes(819.9) == TABLES["briefs"].sizes(1100.1) == ()
    assert TABLES["tops"].sizes(950.0) == ()


def test_tables_go_by_measures_that_there_are_and_tell_their_doubts() -> None:
    for table in TABLES.values():
        assert DEFINITIONS[table.girth].unit == "mm"
        assert table.title.ja
        assert [step.least for step in table.steps] == sorted(step.least for step in table.steps)
    assert len(letter_sizes().sources) == 2
    assert any("Girdles" in doubt.en for doubt in letter_sizes().doubts)
