"""The dialogs of files: where they begin, what they offer, endings, questions, their language."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings, QStandardPaths, QTimer
from PySide6.QtWidgets import QApplication, QDialogButtonBox, QFileDialog, QLabel, QLineEdit, QWidget
from pytestqt.qtbot import QtBot

from app.gui.application import application
from app.gui.features.help import system_info as machine
from app.gui.session.app_folders import shown_folder
from app.gui.widgets.dialog import Dialog, ask, ask_name
from app.gui.widgets.file_dialogs import (
    ask_about_changes,
    ask_open,
    ask_save,
    free_name,
    last_folder,
    remember_folder,
)

KINDS = "PLY (*.ply);;OBJ (*.obj);;STL (*.stl)"


@pytest.fixture
def parent(qtbot: QtBot) -> QWidget:
    QSettings().clear()
    result = QWidget()
    qtbot.addWidget(result)
    return result


def save(parent: QWidget, monkeypatch: pytest.MonkeyPatch, typed: Path, kind: str) -> str:
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(typed), kind))
    return ask_save(parent, "Export", "body.ply", KINDS, ".ply")


def when_asked(do: Callable[[Dialog], None]) -> None:
    """Do something with the sheet that asks next."""

    def answer() -> None:
        sheet = QApplication.activeModalWidget()
        assert isinstance(sheet, Dialog)
        do(sheet)
        sheet.reject()

    QTimer.singleShot(0, answer)


def press(words: str) -> Callable[[Dialog], None]:
    return lambda sheet: next(each for each in buttons(sheet) if each.text() == words).click()


def buttons(sheet: Dialog) -> list:
    return [sheet.foot.itemAt(k).widget() for k in range(1, sheet.foot.count())]


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


@pytest.mark.parametrize("answer", ["Replace", "Cancel"])
def test_another_file_is_only_replaced_when_asked(
    parent: QWidget, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, answer: str
) -> None:
    (tmp_path / "anna.ply").write_text("another body")
    when_asked(press(answer))
    chosen = save(parent, monkeypatch, tmp_path / "anna", "PLY (*.ply)")
    assert chosen == (str(tmp_path / "anna.ply") if answer == "Replace" else "")


def test_dialogs_begin_where_files_of_their_kind_were_last(
    parent: QWidget, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    scans, projects, gone = tmp_path / "scans", tmp_path / "projects", tmp_path / "gone"
    for folder in (scans, projects):
        folder.mkdir()
    monkeypatch.setattr(QStandardPaths, "writableLocation", lambda _: str(tmp_path))
    offered: list[str] = []

    def choose(path: Path) -> None:
        for name in ("getOpenFileName", "getSaveFileName"):
            monkeypatch.setattr(
                QFileDialog, name, lambda _, title, at, *__: offered.append(at) or (str(path), "")
            )

    choose(scans / "anna.ply")
    remember_folder("opened", ask_open(parent))
    choose(projects / "anna.busk")
    ask_save(parent, "Save as", "anna.busk", "Projects (*.busk)", ".busk")
    ask_open(parent)
    choose(gone / "anna.png")
    ask_save(parent, "Export image", "anna.png", "PNG (*.png)", ".png")
    (projects / "anna.png").touch()
    ask_save(parent, "Export image", "anna.png", "PNG (*.png)", ".png")
    assert last_folder("written") == projects, "what is gone is no place to begin"
    ask_save(parent, "Save as", str(scans / "anna.busk"), "Projects (*.busk)", ".busk")
    assert [Path(at) for at in offered] == [
        tmp_path,
        tmp_path / "anna.busk",
        scans,
        projects / "anna.png",
        projects / "anna 2.png",
        scans / "anna.busk",
    ]


def test_a_folder_is_told_without_the_name_of_its_owner(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "home", lambda: Path("/houses/anna"))
    assert shown_folder(Path("/houses/anna/.local/share/Busk")) == "~/.local/share/Busk"
    assert shown_folder(Path("/houses/annabel")) == "/houses/annabel"
    monkeypatch.setattr(machine, "folders", lambda: [("Log", Path("/houses/anna/log"))])
    monkeypatch.setattr(sys, "executable", "/houses/anna/busk/.venv/bin/python")
    widget = QWidget()
    text = str(machine.system_info(widget))
    widget.deleteLater()
    assert "~/log" in text
    assert "anna" not in text


def test_a_free_name_is_counted_on(tmp_path: Path) -> None:
    assert free_name(tmp_path, "anna.png") == tmp_path / "anna.png"
    for name in ("anna.png", "anna 2.png"):
        (tmp_path / name).touch()
    assert free_name(tmp_path, "anna.png") == tmp_path / "anna 3.png"


@pytest.mark.parametrize(
    ("words", "answer"), [("Save", "save"), ("Don't save", "discard"), ("Cancel", "stay")]
)
def test_the_question_offers_three_ways_in_words(parent: QWidget, words: str, answer: str) -> None:
    seen = []

    def look(sheet: Dialog) -> None:
        seen.extend(each.text() for each in sheet.findChildren(QLabel))
        assert [each.icon().isNull() for each in buttons(sheet)] == [True] * 3
        press(words)(sheet)

    when_asked(look)
    assert ask_about_changes(parent, "Customer 0412") == answer
    assert "Save the changes to Customer 0412?" in seen


def test_enter_gives_the_first_answer_and_escape_none(parent: QWidget) -> None:
    when_asked(lambda sheet: next(each for each in buttons(sheet) if each.isDefault()).click())
    assert ask(parent, "Both?", "", [("yes", "Yes"), ("no", "No")]) == "yes"
    when_asked(lambda sheet: sheet.reject())
    assert ask(parent, "Both?", "", [("yes", "Yes"), ("no", "No")]) == ""


def test_enter_loses_nothing_that_cannot_be_brought_back(parent: QWidget) -> None:
    for name in ("replace", "delete", "discard"):
        when_asked(lambda sheet: next(each for each in buttons(sheet) if each.isDefault()).click())
        assert ask(parent, "Lose it?", "", [(name, "Yes")]) == ""


def test_a_name_that_is_asked_for_is_not_empty(parent: QWidget) -> None:
    def type_nothing(sheet: Dialog) -> None:
        sheet.findChild(QLineEdit).setText("  ")
        assert not buttons(sheet)[-1].isEnabled()

    when_asked(type_nothing)
    assert ask_name(parent, "Save lines as preset", "Name", "Custom lines", 60) == ""
    when_asked(press("Save"))
    assert ask_name(parent, "Save lines as preset", "Name", " Custom lines ", 60) == "Custom lines"


def test_dialogs_of_the_toolkit_speak_the_language_of_the_window(qapp: QApplication) -> None:
    try:
        application(language="ja")
        box = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel)
        assert box.buttons()[0].text() == "キャンセル"
        files = QFileDialog()
        files.setOption(QFileDialog.Option.DontUseNativeDialog)
        words = [label.text() for label in files.findChildren(QLabel)]
        assert words
        assert not any("Look in" in each or "Files of" in each for each in words), words
    finally:
        application(language="en")
    box = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel)
    assert box.buttons()[0].text().replace("&", "") == "Cancel"
