"""Measures of the designer's own: as they are written, saved, and undone."""

from __future__ import annotations

import json

import pytest
from PySide6.QtWidgets import QApplication

from app.gui.session.document_editor import DocumentEditor
from core.document.custom_measures import CustomMeasurement, parse_measurement
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.serialization import from_json, to_json
from core.errors import ProjectError, UserError

GORE = CustomMeasurement("Gore", "straight", ("bust_point_left", "front_centre"))
RIBS = CustomMeasurement("Ribs", "girth", ("fold_left",), -30.0)
PLAIN = Design(ScanSource("/scans/body.ply"))


def test_own_measures_are_written_as_they_are_read() -> None:
    assert parse_measurement("Gore = straight: bust_point_left, front_centre").marks == (
        "bust_point_left",
        "front_centre",
    )
    assert parse_measurement("Ribs=girth:waist_front+60") == CustomMeasurement(
        "Ribs", "girth", ("waist_front",), 60.0
    )
    assert parse_measurement("Ribs=girth:waist_front - 7.5").level == -7.5
    assert parse_measurement("Chest=girth:1250") == CustomMeasurement("Chest", "girth", (), 1250.0)


def test_each_says_how_it_is_taken() -> None:
    assert str(GORE.text) == "Custom: straight distance from bust point left to front centre."
    assert str(RIBS.text) == "Custom: horizontal tape, 30 mm below inframammary fold left."
    assert (
        str(parse_measurement("Ribs=girth:waist_front+60").text)
        == "Custom: horizontal tape, 60 mm above waist front."
    )
    assert str(parse_measurement("Ribs=girth:waist_front").text) == "Custom: horizontal tape at waist front."
    told = parse_measurement("Chest=girth:1250").text
    assert str(told) == "Custom: horizontal tape, 1250 mm above the lowest point of the scan."


@pytest.mark.parametrize(
    "text",
    [
        "Gore",
        "Gore=arc:bust_point_left,fold_left",
        "Gore=straight:bust_point_left",
        "Gore=straight:bust_point_left,bust_point_left",
        "Gore=skin:bust_point_left,nose",
        "=girth:1250",
        "Gore=girth:",
        "Gore=girth:fold_left+99999",
        f"{'long' * 20}=girth:5",
    ],
)
def test_what_cannot_be_measured_is_refused(text: str) -> None:
    with pytest.raises(UserError):
        parse_measurement(text)


def test_own_measures_are_kept_by_name_and_saved() -> None:
    design = PLAIN.with_custom_measurement(GORE).with_custom_measurement(RIBS)
    assert from_json(to_json(design)) == design
    other = CustomMeasurement("Gore", "skin", GORE.marks)
    assert design.with_custom_measurement(other).own_measures == (other, RIBS)
    assert design.without_custom_measurement("Gore").own_measures == (RIBS,)
    renamed = CustomMeasurement("Arc", "skin", GORE.marks)
    assert design.with_custom_measurement(renamed, former="Gore").own_measures == (renamed, RIBS)
    with pytest.raises(UserError, match="Two measurements"):
        design.with_custom_measurement(CustomMeasurement("Ribs", "skin", GORE.marks), former="Gore")
    with pytest.raises(UserError, match="Two measurements"):
        Design(PLAIN.scan, own_measures=(GORE, GORE))


def test_a_project_without_own_measures_is_written_as_before_there_were_any() -> None:
    text = to_json(PLAIN)
    assert "own_measures" not in json.loads(text)
    assert from_json(text) == PLAIN


@pytest.mark.parametrize("broken", [{"name": "a"}, 5, {"name": "a", "kind": "skin", "marks": "fold_left"}])
def test_broken_measures_are_refused(broken: object) -> None:
    text = json.loads(to_json(PLAIN)) | {"own_measures": [broken]}
    with pytest.raises(ProjectError):
        from_json(json.dumps(text))


def test_all_variants_are_measured_alike() -> None:
    document = Document.single(PLAIN).with_shown("B").with_design(PLAIN.with_custom_measurement(GORE))
    assert [design.own_measures for _, design in document.designs] == [(GORE,), (GORE,)]


class _Editing(DocumentEditor):
    """Editing that solves nothing."""

    def _submit(self, design: Design, fresh: bool = False) -> None:
        pass


def test_a_measure_is_added_and_removed_as_one_step_each(qapp: QApplication) -> None:
    editing = _Editing()
    editing.document = Document.single(PLAIN)
    editing.edit(lambda design: design.with_custom_measurement(GORE), "Gore")
    editing.edit(lambda design: design.without_custom_measurement("Gore"), "Gore removed")
    assert editing.document == Document.single(PLAIN)
    editing.undo_stack.undo()
    assert editing.document.design.own_measures == (GORE,)
    editing.undo_stack.undo()
    assert editing.document == Document.single(PLAIN)
    editing.undo_stack.redo()
    assert editing.document.design.own_measures == (GORE,)
