"""Measures of the designer's own: as they are written, saved, and undone."""

from __future__ import annotations

import json

import pytest
from PySide6.QtWidgets import QApplication

from app.gui.session.document_editor import Editing
from core.document.custom_measures import OwnMeasure, own_measure
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.serialization import from_json, to_json
from core.errors import ProjectError, UserError

GORE = OwnMeasure("Gore", "straight", ("bust_point_left", "front_centre"))
RIBS = OwnMeasure("Ribs", "girth", ("fold_left",), -30.0)
PLAIN = Design(ScanSource("/scans/body.ply"))


def test_own_measures_are_written_as_they_are_read() -> None:
    assert own_measure("Gore = straight: bust_point_left, front_centre").marks == (
        "bust_point_left",
        "front_centre",
    )
    assert own_measure("Ribs=girth:waist_front+60") == OwnMeasure("Ribs", "girth", ("waist_front",), 60.0)
    assert own_measure("Ribs=girth:waist_front - 7.5").level == -7.5
    assert own_measure("Chest=girth:1250") == OwnMeasure("Chest", "girth", (), 1250.0)


def test_each_says_how_it_is_taken() -> None:
    assert GORE.text == "Yours: straight from bust point left to front centre."
    assert RIBS.text == "Yours: a tape, level, 30 mm below fold left."
    assert own_measure("Ribs=girth:waist_front+60").text == "Yours: a tape, level, 60 mm above waist front."
    assert own_measure("Ribs=girth:waist_front").text == "Yours: a tape, level, at waist front."
    told = own_measure("Chest=girth:1250").text
    assert told == "Yours: a tape, level, 1250 mm above the lowest point of the scan."


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
        own_measure(text)


def test_own_measures_are_kept_by_name_and_saved() -> None:
    design = PLAIN.with_own_measure(GORE).with_own_measure(RIBS)
    assert from_json(to_json(design)) == design
    other = OwnMeasure("Gore", "skin", GORE.marks)
    assert design.with_own_measure(other).own_measures == (other, RIBS)
    assert design.without_own_measure("Gore").own_measures == (RIBS,)
    renamed = OwnMeasure("Arc", "skin", GORE.marks)
    assert design.with_own_measure(renamed, former="Gore").own_measures == (renamed, RIBS)
    with pytest.raises(UserError, match="two measures"):
        design.with_own_measure(OwnMeasure("Ribs", "skin", GORE.marks), former="Gore")
    with pytest.raises(UserError, match="two measures"):
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
    document = Document.of(PLAIN).showing("B").with_design(PLAIN.with_own_measure(GORE))
    assert [design.own_measures for _, design in document.designs] == [(GORE,), (GORE,)]


class _Editing(Editing):
    """Editing that solves nothing."""

    def _submit(self, design: Design, fresh: bool = False) -> None:
        pass


def test_a_measure_is_added_and_removed_as_one_step_each(qapp: QApplication) -> None:
    editing = _Editing()
    editing.document = Document.of(PLAIN)
    editing.edit(lambda design: design.with_own_measure(GORE), "Gore")
    editing.edit(lambda design: design.without_own_measure("Gore"), "Gore removed")
    assert editing.document == Document.of(PLAIN)
    editing.undo_stack.undo()
    assert editing.document.design.own_measures == (GORE,)
    editing.undo_stack.undo()
    assert editing.document == Document.of(PLAIN)
    editing.undo_stack.redo()
    assert editing.document.design.own_measures == (GORE,)
