"""Rows of a batch run in words: doubt, filters and order; distributions in the unit in use."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from app.i18n.catalog import using_language
from app.i18n.lengths import using_unit
from app.presenters.batch import (
    ALL,
    DOUBTFUL,
    FAILED,
    BatchRow,
    Cells,
    batch_row,
    counts_text,
    duration_text,
    error_text,
    paths_text,
    progress_text,
)
from app.presenters.batch_distribution import PlottedColumn, distribution, plotted_columns

NUMBERS = ("lift_left_mm", "lift_right_mm", "bust_mm", "underbust_mm")
CELLS = Cells({name: place for place, name in enumerate(NUMBERS)}, "jp")


def row(scan: str = "scans/anna.ply", **values: Any) -> BatchRow:
    usual = {"scan": scan, "variant": "bra", "state": "done", "verdict": "good"}
    return batch_row({**usual, **values}, NUMBERS)


GOOD = row(bust_mm=880.4, underbust_mm=740.0, lift_left_mm=2.0, lift_right_mm=4.0, band_jp="75", cup_jp="C")
WARNED = row("scans/berta.ply", doubts="Check the fold.", bust_mm=950.0, underbust_mm=800.0)
REFUSED = row("scans/carla.ply", state="refused", verdict=None, message="carla.ply is empty.")


def test_cells_show_lengths_in_the_unit_in_use_and_nothing_where_nothing_is_known() -> None:
    texts = {name: CELLS.text(GOOD, name) for name in CELLS.titles()}
    assert texts["scan"] == "anna.ply"
    assert (texts["bust"], texts["underbust"], texts["lift"]) == ("880", "740", "+3.0")
    assert texts["size"] == "C75"
    assert texts["verdict"] == "No problems found"
    assert CELLS.tip(GOOD, "lift") == "Left +2.0, right +4.0"
    with using_unit("in"):
        assert CELLS.text(GOOD, "bust") == "34\N{NO-BREAK SPACE}11/16"
        assert CELLS.titles()["bust"] == "Bust in"
    assert {CELLS.text(REFUSED, name) for name in ("bust", "underbust", "lift", "size")} == {""}
    assert CELLS.text(REFUSED, "verdict") == "Refused"


def test_the_most_doubtful_have_the_largest_doubt() -> None:
    bad = row(verdict="bad")
    assert REFUSED.doubt > bad.doubt > row(verdict="caution").doubt > WARNED.doubt > GOOD.doubt == 0


@pytest.mark.parametrize(
    ("only", "passing"),
    [(ALL, [GOOD, WARNED, REFUSED]), (DOUBTFUL, [WARNED, REFUSED]), (FAILED, [REFUSED])],
)
def test_filters(only: str, passing: list[BatchRow]) -> None:
    assert [each for each in (GOOD, WARNED, REFUSED) if each.holds([], only)] == passing


def test_every_word_has_to_be_found_somewhere() -> None:
    assert WARNED.holds(["berta", "fold"], ALL)
    assert not WARNED.holds(["anna", "fold"], ALL)


def test_unknown_values_are_sorted_last_and_sizes_by_band_and_cup() -> None:
    keys = [CELLS.sort_key(each, "bust") for each in (REFUSED, WARNED, GOOD)]
    assert sorted(keys) == [keys[2], keys[1], keys[0]]
    larger = row(bust_mm=920.0, underbust_mm=740.0, band_jp="75", cup_jp="E")
    assert CELLS.sort_key(larger, "size") > CELLS.sort_key(GOOD, "size")
    assert CELLS.sort_key(REFUSED, "size")[0]


def test_counts_and_progress_in_both_languages() -> None:
    assert counts_text([GOOD, WARNED, REFUSED]) == "No problems found: 2, Refused: 1"
    assert progress_text(3, 40, 0.5, 74.0) == "3 of 40, 30 per minute, 1 min 14 s left"
    assert progress_text(0, 40, 0.0, None) == "0 of 40"
    assert duration_text(7300.0) == "2 h 1 min"
    with using_language("ja"):
        assert progress_text(3, 40, 0.5, 74.0) == "3 / 40、毎分 30、残り 1 分 14 秒"


def test_paths_are_counted() -> None:
    assert [paths_text(each) for each in ([], ["a"], ["a", "b"], ["a", "b", "c"])] == [
        "",
        "a",
        "a and 1 other",
        "a and 2 others",
    ]


def test_an_error_of_the_command_is_shown_in_the_language_in_use() -> None:
    event = {
        "message": "…",
        "sentences": [
            ["Another run is writing to {folder}.", {"folder": "out"}],
            ["Choose another folder.", {}],
        ],
    }
    assert error_text(event) == ("Another run is writing to out.", "Choose another folder.")
    with using_language("ja"):
        assert error_text(event)[1] == "別のフォルダーを選んでください。"
    assert error_text({"message": "It failed."}) == ("It failed.", "")


def test_columns_have_titles_by_group() -> None:
    columns = [
        ("bust_mm", "mm"),
        ("bust_after_mm", "mm"),
        ("tension_mid-bust_n", "N"),
        ("area_wing left_cm2", "cm2"),
    ]
    measures = {"bust_mm": ("bust_girth", False), "bust_after_mm": ("bust_girth", True)}
    found = [(each.group, each.heading, each.of_scan) for each in plotted_columns(columns, measures)]
    assert found == [
        ("Original body", "Bust girth [mm]", True),
        ("Reshaped body", "Bust girth [mm]", False),
        ("Mid-bust", "Tension [N]", False),
        ("Areas of pieces", "wing left [cm²]", False),
    ]


def test_a_distribution_holds_every_known_value_once() -> None:
    chance = np.random.default_rng(4)
    values = chance.normal(900.0, 40.0, 200)
    rows = [row(f"{place}.ply", bust_mm=float(each)) for place, each in enumerate(values)]
    column = PlottedColumn("bust_mm", "", "Bust girth", "mm", of_scan=True)
    twice = [*rows, *(row(each.scan, variant="other", bust_mm=each.numbers[2]) for each in rows), REFUSED]
    shown = distribution(twice, column, 2, ["bra", "other"])
    assert shown is not None
    ((title, counts),) = shown.series
    assert (title, counts.sum()) == ("", 200)
    assert np.allclose(counts, np.histogram(values, shown.edges)[0])
    assert shown.summary[0].startswith(f"n 200, mean {values.mean():.1f}, SD {values.std(ddof=1):.1f}")
    with using_unit("cm"):
        other = distribution(rows, column, 2, ["bra"])
        assert other is not None
        assert np.isclose(other.edges[-1], 0.1 * shown.edges[-1], rtol=0.05)
        assert other.heading == "Bust girth [cm]"


def test_variants_are_series_of_their_own() -> None:
    rows = [row(bust_mm=1.0), row(bust_mm=2.0, variant="B"), REFUSED]
    shown = distribution(rows, PlottedColumn("x", "", "X", "N"), 2, ["bra", "B"])
    assert shown is not None
    assert [name for name, _ in shown.series] == ["bra", "B"]
    assert distribution([REFUSED], PlottedColumn("x", "", "X", "N"), 2, ["bra"]) is None
