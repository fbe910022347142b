"""Lengths in millimetres, centimetres and inches: as they are shown, and as they are typed."""

from __future__ import annotations

import pytest
from pytestqt.qtbot import QtBot

from app.gui.features.lines.row import LineRow, LineView
from app.gui.widgets.value_edit import LengthEdit, ValueEdit
from app.i18n.lengths import length, read_length, use_unit
from app.presenters.bust_shift import up_text
from app.presenters.measurements import MeasureView, as_table, length_uncertainty
from app.presenters.variants import VariantValues
from app.report.text import value_text

UNITS = ("mm", "cm", "in")


@pytest.mark.parametrize(
    ("text", "mm"),
    [
        ("692mm", 692.0),
        ("69.2cm", 692.0),
        ("27.2in", 690.88),
        ('27.2"', 690.88),
        ("27.2 inch", 690.88),
        ("27 1/4 in", 692.15),
        ('27-1/4"', 692.15),
        ("27¼ in", 692.15),
        ("−3/8in", -9.525),
        ("０．６９２ｍ", 692.0),
        ("−1,5 cm", -15.0),
    ],
)
def test_a_typed_unit_counts_whatever_unit_is_shown(text: str, mm: float) -> None:
    for unit in UNITS:
        use_unit(unit)
        assert read_length(text) == pytest.approx(mm)


@pytest.mark.parametrize(
    "text", ["", "mm", "3 kg", "1e5", "12mm34", "--3", "27 1/", "271/4", "1.5 1/2", "1/0"]
)
def test_what_is_not_a_length_is_none(text: str) -> None:
    assert read_length(text) is None


@pytest.mark.parametrize("unit", UNITS)
@pytest.mark.parametrize("mm", [0.0, -3.14, 692.0, 1234.5])
def test_a_shown_length_reads_back_within_its_last_decimal(unit: str, mm: float) -> None:
    use_unit(unit)
    shown = length(mm)
    assert shown.endswith(f" {unit}")
    assert read_length(shown.replace(",", "")) == pytest.approx(mm, abs=0.128)
    assert read_length(shown.split()[0].replace(",", "")) == pytest.approx(mm, abs=0.128)


@pytest.mark.parametrize(
    ("mm", "shown"),
    [
        (0.0, "0 in"),
        (0.7, "0 in"),
        (-0.9, "−1/16 in"),
        (12.0, "1/2 in"),
        (25.4, "1 in"),
        (692.0, "27\N{NO-BREAK SPACE}1/4 in"),
        (25.39 * 2, "2 in"),
        (26_000.0, "1,023\N{NO-BREAK SPACE}5/8 in"),
    ],
)
def test_whole_millimetres_are_inches_and_sixteenths_that_can_be_typed_again(mm: float, shown: str) -> None:
    use_unit("in")
    assert length(mm, 0) == shown
    assert length(abs(mm), 0, signed=True) == ("+" if round(abs(mm) * 16 / 25.4) else "") + shown.strip("−")
    assert read_length(shown.replace(",", "")) == pytest.approx(mm, abs=25.4 / 32 + 1e-9)


def test_no_plus_minus_is_nothing() -> None:
    use_unit("in")
    assert (length_uncertainty(0.1), length_uncertainty(3.0), length_uncertainty(14.0)) == (
        "± 0.01",
        "± 0.12",
        "± 0.55",
    )


def test_an_unknown_unit_leaves_millimetres() -> None:
    use_unit("furlong")
    assert length(692.0) == "692.0 mm"


def test_fields_show_and_take_the_unit_in_use(qtbot: QtBot) -> None:
    use_unit("in")
    place, heard = ValueEdit("mm", "Place", widest="−888.8"), []
    qtbot.addWidget(place)
    place.show_value(254.0)
    assert place.text() == "10.00"
    assert (place._read("10"), place._read("250mm")) == (254.0, 250.0)
    of_line = LengthEdit("mm")
    qtbot.addWidget(of_line)
    of_line.name_line("Waist")
    of_line.entered.connect(heard.append)
    of_line.show_length(1.0, 508.0, 762.0)
    assert (of_line.text(), of_line.accessibleName()) == ("20.00", "Waist: length in inches")
    assert of_line._read("19") == pytest.approx(0.95)
    assert of_line._read("482.6mm") == pytest.approx(0.95)
    assert of_line._read("19 1/2") == of_line._read('19½"') == pytest.approx(0.975)
    assert of_line._read("-1/2") == pytest.approx(0.975), "shorter by that"
    assert ValueEdit("%", "Share", widest="+100")._read("12") == 12.0, "other units stay"


def test_a_line_is_shown_in_the_unit_in_use(qtbot: QtBot) -> None:
    use_unit("cm")
    row = LineRow(LineView("waist", "Waist", "#C2466E", 0.9, 400.0, 380.0, True, True, 600.0))
    qtbot.addWidget(row)
    row.set_open(True)
    texts = " ".join(each.text() for each in row.findChildren(type(row._measure)))
    assert "38.00" in texts
    assert "mm" not in texts


def test_measures_agree_in_their_columns_and_files_keep_millimetres() -> None:
    row = MeasureView("Bust", "mm", 1000.04, 1010.06, plus_minus=3.0, estimate=True)
    cells = as_table([row])
    for unit, change in (("cm", "+1.01"), ("in", "+0.40")):
        use_unit(unit)
        assert row.written(row.change, signed=True) == change
        before, after = (float(row.written(each).replace(",", "")) for each in (row.before, row.after))
        assert row.change is not None
        assert float(row.written(row.change)) == pytest.approx(after - before, abs=1e-9)
        assert unit in row.caption
        assert row.spoken().count(unit) == 3
        assert as_table([row])[1][2:6] == cells[1][2:6]


def test_other_units_than_millimetres_are_left_alone() -> None:
    use_unit("in")
    assert MeasureView("Volume", "ml", 500.0, 600.0).spoken() == "Volume: 500 ml → 600 ml"
    assert VariantValues("%", 1, False, (94.0,)).written(0) == "94.0 %"
    assert VariantValues("mm", 1, True, (25.4,)).written(0) == "+1.00 in"
    assert (value_text(25.4, 1), value_text(25.4, 1, "mm")) == ("25.4", "1.00")
    assert up_text(25.4, 2.54).split() == ["1.00", "±", "0.10", "in", "up"]
