"""The name that a file is saved under: always with an ending, and never over another file unasked."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget
from pytestqt.qtbot import QtBot

from app.keeping.dialogs import ask_save

KINDS = "PLY (*.ply);;OBJ (*.obj);;STL (*.stl)"


@pytest.fixture
def parent(qtbot: QtBot) -> QWidget:
    result = QWidget()
    qtbot.addWidget(result)
    return result


def save(parent: QWidget, monkeypatch: pytest.MonkeyPatch, typed: Path, kind: str) -> str:
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(typed), kind))
    return ask_save(parent, "Export", "body.ply", KINDS, ".ply")


@pytest.mark.parametrize(
    ("typed", "kind", "name"),
    [
        ("anna.stl", "PLY (*.ply)", "anna.stl"),
        ("anna.STL", "PLY (*.ply)", "anna.STL"),
        ("anna", "OBJ (*.obj)", "anna.obj"),
        ("anna", "", "anna.ply"),
        ("anna 12.5", "PLY (*.ply)", "anna 12.5.ply"),
    ],
)
def test_a_name_gets_the_ending_of_its_kind(
    parent: QWidget, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, typed: str, kind: str, name: str
) -> None:
    assert save(parent, monkeypatch, tmp_path / typed, kind) == str(tmp_path / name)


def test_no_name_stays_none(parent: QWidget, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: ("", ""))
    assert ask_save(parent, "Export", "body.ply", KINDS, ".ply") == ""


@pytest.mark.parametrize("answer", [QMessageBox.StandardButton.Yes, QMessageBox.StandardButton.No])
def test_another_file_is_only_replaced_when_asked(
    parent: QWidget, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, answer: QMessageBox.StandardButton
) -> None:
    (tmp_path / "anna.ply").write_text("another body")
    monkeypatch.setattr(QMessageBox, "question", lambda *_: answer)
    chosen = save(parent, monkeypatch, tmp_path / "anna", "PLY (*.ply)")
    assert chosen == (str(tmp_path / "anna.ply") if answer == QMessageBox.StandardButton.Yes else "")
