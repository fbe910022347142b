"""Whom a design is for: saved in the project, of every variant alike, undone, and never solved for."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.serialization import from_json, from_texts, to_json, to_texts
from core.document.storage.project_file import ScanFile, open_project, save_project
from core.errors import ProjectError, UserError
from tests.core.document.test_custom_measures import _Editing

PLAIN = Design(ScanSource("a.ply"))
ANNA = replace(PLAIN, customer="Anna K., 0412 \N{EM DASH} 佐藤")


def test_the_customer_is_saved_with_every_variant(tmp_path: Path) -> None:
    document = Document.single(PLAIN).with_shown("B").with_design(ANNA.with_line("mid-bust", 0.9))
    assert [design.customer for _, design in document.designs] == [ANNA.customer] * 2
    path = tmp_path / "anna.busk"
    save_project(path, document, ScanFile("a.ply", b"ply"), None)
    again = open_project(path)
    assert again.customer == ANNA.customer
    assert {design.customer for _, design in again.designs} == {ANNA.customer}


def test_projects_of_nobody_are_as_they_were() -> None:
    assert "customer" not in json.loads(to_json(PLAIN))
    assert from_json(to_json(PLAIN)).customer == ""
    assert json.loads(to_json(ANNA))["format"] == 1, "older programs keep what they do not know"


def test_what_her_tape_takes_off_is_hers_too(tmp_path: Path) -> None:
    tight = replace(PLAIN, worn_tight_mm=12.5)
    assert tight.is_equivalent(PLAIN)
    document = Document.single(PLAIN).with_shown("B").with_design(tight)
    assert {design.worn_tight_mm for _, design in from_texts(to_texts(document)).designs} == {12.5}
    assert "worn_tight_mm" not in json.loads(to_json(PLAIN))
    with pytest.raises(UserError):
        replace(PLAIN, worn_tight_mm=21.0)


@pytest.mark.parametrize("name", ["\ud800", "An\nna", "A\x07", "a" * 121])
def test_a_customer_that_cannot_be_printed_is_refused(name: str) -> None:
    with pytest.raises(UserError, match="customer"):
        from_json(json.dumps(json.loads(to_json(PLAIN)) | {"customer": name}))


def test_wide_spaces_are_part_of_names() -> None:
    assert replace(PLAIN, customer="山田\u3000花子").customer == "山田\u3000花子"
    assert CustomMeasurement("胸\u3000幅", "girth", (), 900.0).name == "胸\u3000幅"


def test_a_customer_that_is_no_text_is_refused() -> None:
    with pytest.raises(ProjectError):
        from_json(json.dumps(json.loads(to_json(PLAIN)) | {"customer": 7}))


def test_a_document_is_read_as_it_was_written() -> None:
    document = Document.single(ANNA).with_shown("C")
    assert from_texts(to_texts(document)) == document


@pytest.mark.usefixtures("qapp")
def test_naming_the_customer_is_one_step_that_leaves_the_run_alone() -> None:
    editing = _Editing()
    editing.document = Document.single(PLAIN)
    editing.change({"customer": "Anna"}, "Customer Anna")
    assert editing.document.customer == "Anna"
    assert editing.design is not None
    assert editing.design.is_equivalent(PLAIN)
    editing.undo_stack.undo()
    assert editing.document == Document.single(PLAIN)
