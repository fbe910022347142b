"""Fields that are typed into: what is understood, and what is said of what is not."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.gui.widgets.line_widgets import StiffnessField
from app.gui.widgets.value_edit import LengthEdit, Refusal, ValueEdit

pytestmark = pytest.mark.usefixtures("qapp")


@pytest.mark.parametrize(
    ("text", "unit", "ratio"),
    [
        ("94", "%", 0.94),
        (" 94 % ", "mm", 0.94),
        ("-6%", "%", 0.94),
        ("−6", "%", 0.94),
        ("+2%", "%", 1.02),
        ("-20mm", "%", 0.95),
        ("380", "mm", 0.95),
        ("38,0cm", "%", 0.95),
        ("15in", "%", 0.9525),
        ("９４％", "%", 0.94),
    ],
)
def test_lengths_as_they_are_typed(text: str, unit: str, ratio: float) -> None:
    assert number_field(unit)._read(text) == pytest.approx(ratio)


@pytest.mark.parametrize(
    "text", ["", "680mm", "tight", "94 mmm", "--6", "49.9", "130.1", "-60%", "1 200 mm", "94%%"]
)
def test_what_is_no_length_is_refused(text: str) -> None:
    with pytest.raises(
        ValueError,
        match=r"is not a valid length|of its original length"
        r"|Enter a length from|Enter a front length: 380.0mm",
    ):
        number_field("%")._read(text)


def number_field(unit: str) -> LengthEdit:
    """Return the field of a line that is 400 mm long, of a band of 700 mm."""
    field = LengthEdit(unit)
    field.name_line("Waist")
    field.show_length(1.0, 400.0, 700.0)
    return field


def test_a_refusal_says_under_the_field_what_can_be_typed_and_goes_with_the_next_letter(qtbot: QtBot) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    window.resize(400, 300)
    field = number_field("%")
    field.setParent(window)
    field.move(300, 20)
    window.show()
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, "680mm")
    QTest.keyClick(field, Qt.Key.Key_Return)
    (card,) = window.findChildren(Refusal)
    assert card.isVisible()
    assert card.text().startswith("Front length of Waist: 200 to 520 mm; full length: 500")
    assert field.accessibleDescription() == card.text()
    assert window.rect().contains(card.geometry())
    assert card.y() >= field.geometry().bottom()
    QTest.keyClicks(field, "3")
    assert not card.isVisible()
    assert field.accessibleDescription() == ""


@pytest.mark.parametrize("text", ["soft", "0.001", "1e9"])
def test_a_stiffness_that_cannot_be_names_its_range(text: str) -> None:
    with pytest.raises(ValueError, match="Enter a stiffness from"):
        StiffnessField()._read(text)


@pytest.mark.parametrize(
    ("text", "mm"), [("-3cm", -30.0), ("12", 12.0), ("12 mm", 12.0), ("−1.5in", -38.1), ("1,5 cm", 15.0)]
)
def test_a_field_of_millimetres_takes_other_units_of_length(qtbot: QtBot, text: str, mm: float) -> None:
    field, heard = ValueEdit("mm", "Place", widest="−888.8"), []
    qtbot.addWidget(field)
    field.entered.connect(heard.append)
    for typed in (text, "3 kg"):
        field.selectAll()
        field.insert(typed)
        field.setModified(True)
        qtbot.keyClick(field, Qt.Key.Key_Return)
    assert heard == [pytest.approx(mm)], "kilograms are refused"
    assert "3 kg" in field.accessibleDescription()


def test_fields_of_several_lines_are_told_apart_by_ear() -> None:
    field, stiffness = number_field("mm"), StiffnessField()
    stiffness.name_line("Waist")
    assert field.accessibleName() == "Waist: length in millimetres"
    assert stiffness.accessibleName() == "Waist: stiffness"
