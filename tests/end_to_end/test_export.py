"""The sheet of what can be exported, through the real main(): what it shows, remembers and refuses."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
import pyvista as pv
from export_tools import choose, opened, saved_as, told, written
from PySide6.QtCore import QSettings, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog, QWidget
from window_tools import Script, run_bodiless, settled

import app.gui.features.export.controller
import app.rendering.offscreen
from app.gui.features.export.dialog import ExportDialog
from app.gui.main_window import MainWindow
from app.presenters.export import exports

pytestmark = pytest.mark.usefixtures("empty_house")


@pytest.mark.usefixtures("fine_samples")
def test_a_body_is_exported_by_keys_alone_in_the_unit_that_was_chosen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "anna.ply"
    asked = saved_as(monkeypatch, path)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        QTest.keyClick(
            window, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
        )
        yield lambda: isinstance(QApplication.activeModalWidget(), ExportDialog)
        sheet: Any = QApplication.activeModalWidget()
        yield told(sheet)
        assert sheet._contents.text() == "32,873 points, 65,742 triangles, in m, y-up"
        assert sheet._name.text() == "mannequin-body.glb"
        has: list[QWidget] = []
        for _ in range(20):  # once round: every choice and both buttons take the keyboard, by their names
            QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Tab)
            has.append(QApplication.focusWidget())
        assert all(each.accessibleName() or each.text() for each in has)  # type: ignore[attr-defined]
        for field in sheet.fields.values():
            assert any(field.isAncestorOf(each) for each in has)
        choose(sheet, "format", "ply")
        choose(sheet, "unit", "cm")
        yield told(sheet)
        assert sheet._contents.text().endswith("in cm, z-up")
        sheet.save.setFocus()
        QTest.keyClick(sheet.save, Qt.Key.Key_Return)
        yield written(window)
        assert window.notices.notice().sentence == "anna.ply saved, in cm, z-up."
        assert QApplication.activeModalWidget() is None
        body = pv.read(path)
        rest = window.session.frame.stages.body.mesh
        low, high = rest.vertices.min(axis=0), rest.vertices.max(axis=0)
        assert body.bounds[5] - body.bounds[4] == pytest.approx((high - low)[2] / 10.0, abs=0.01)

    run_bodiless([], script)
    kinds = asked[0][3].split(";;")
    assert kinds[0] == "PLY (*.ply)"
    assert set(kinds) == {f"{kind} (*.{kind.lower()})" for kind in ("GLB", "OBJ", "PLY", "STL")}


@pytest.mark.usefixtures("fine_samples")
def test_choices_are_remembered_for_each_thing_and_each_format(tmp_path: Path) -> None:
    def first(window: MainWindow) -> Script:
        yield settled(window)
        sheet = opened(window, "measures")
        choose(sheet, "unit", "in")
        of_measures = list(sheet.fields.values())
        sheet.items["body"].click()
        assert not any(field.isVisible() for field in of_measures), "they would shine through"
        assert sheet.focusWidget() is sheet.items["body"]
        choose(sheet, "format", "obj")
        choose(sheet, "axes", "y-up")
        sheet.reject()

    def again(window: MainWindow) -> Script:
        yield settled(window)
        choices = window.export_controller._choices
        sheet = opened(window)
        assert sheet.items["body"].isChecked()
        assert choices.values("body") == {"format": "obj", "shape": "", "unit": "mm", "axes": "y-up"}
        assert choices.values("body", "stl")["axes"] == "z-up", "other programs ask for other axes"
        assert choices.values("body", "glb") == {"format": "glb", "shape": ""}, "glTF has a unit of its own"
        assert choices.values("measures")["unit"] == "in"
        sheet.reject()

    run_bodiless([], first)
    run_bodiless([], again)


@pytest.mark.parametrize(
    "kept",
    [
        "",
        "no JSON",
        "[1]",
        '{"what": "no such", "body/format": 7, "body.glb/unit": "ell"}',
        '{"body/format": []}',
    ],
)
def test_settings_that_are_no_choices_are_forgotten(kept: str) -> None:
    choices = app.gui.features.export.controller.ExportSettings(kept)
    assert choices.export.what == "body"
    assert choices.values("body") == {"format": "glb", "shape": ""}
    assert choices.values("body", "ply") == {"format": "ply", "shape": "", "unit": "mm", "axes": "z-up"}
    choices.choose("turntable", "size", "480x540")
    manner = app.gui.features.export.controller.ExportSettings(choices.text).manner("turntable")
    assert (manner.size, manner.frames, manner.seconds) == ((480, 540), 36, 6.0)
    assert json.loads(choices.text)["turntable/size"] == "480x540"


def test_everything_that_is_offered_is_written_in_every_format(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also by a name whose ending is another format than the chosen one: then it is that one."""

    def script(window: MainWindow) -> Script:
        yield settled(window)
        for export in exports():
            for kind in export.formats:
                if export.what in ("picture", "turntable"):
                    continue
                path = tmp_path / f"{export.what}.{kind}"
                saved_as(monkeypatch, path)
                sheet = opened(window, export.what)
                yield told(sheet)
                sheet.save.click()
                yield written(window)
                assert window.notices.notice().tone == "ok", window.notices.notice()
                assert path.stat().st_size > 100
                window.notices.clear()

    run_bodiless([], script)
    assert len(list(tmp_path.iterdir())) == 4 + 5 + 2 + 2 + 1 + 4 + 1


def test_what_cannot_be_exported_says_why_and_is_not_offered(tmp_path: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.reset_lines()
        yield settled(window)
        for what in ("lines", "flat"):
            sheet = opened(window, what)
            yield told(sheet)
            assert sheet._doubt.text() == "No active lines. Set a line length first."
            assert not sheet.save.isEnabled()
            sheet.items["body"].click()
            yield told(sheet)
            assert sheet.save.isEnabled()
            assert not sheet._doubt.isVisible()
            sheet.reject()

    run_bodiless([], script)


def test_a_folded_body_is_told_before_it_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    saved_as(monkeypatch, tmp_path / "anna.stl")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.lines_controller.commit_length("mid-bust", 0.5)
        yield settled(window)
        sheet = opened(window, "body")
        yield told(sheet)
        assert sheet._doubt.text() == "Folded: do not use this shape for production."
        assert sheet.save.isEnabled()
        choose(sheet, "shape", "before")
        yield told(sheet)
        assert not sheet._doubt.isVisible(), "the body at rest is as it was scanned"
        sheet.reject()
        window.actions_.export.trigger()
        said = [each.sentence for each in (window.notices.notice(), *window.notices._waiting)]
        assert len(said) == 2, "that of the fold itself, and of the file"
        assert "Folded: do not use this shape for production." in said
        yield lambda: window.notices.notice().sentence == "anna.stl saved, in mm, z-up."
        assert window.notices.more.text() == "2 more"

    run_bodiless([], script)


def test_a_name_with_another_ending_is_that_format_with_the_unit_chosen_for_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        sheet = opened(window, "control")
        choose(sheet, "format", "obj")
        choose(sheet, "unit", "in")
        choose(sheet, "format", "stl")
        saved_as(monkeypatch, tmp_path / "anna.OBJ")
        sheet.save.click()
        yield written(window)
        assert window.notices.notice().sentence == "anna.OBJ saved, in inches, z-up."

    run_bodiless([], script)
    assert (tmp_path / "anna.OBJ").read_text().count("\nf ") == 168


def test_an_ending_that_nothing_has_is_put_behind_the_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    typed = {"body": "anna.txt", "picture": "anna.jpg", "turns": "a.b"}
    names = iter(str(tmp_path / name) for name in typed.values())
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *how: (next(names), how[3].split(";;")[0]))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        for what in typed:
            opened(window, what).save.click()
            yield written(window)
            assert window.notices.notice().tone == "ok"
            window.notices.clear()

    run_bodiless([], script)
    written_files = {path.name for path in tmp_path.iterdir()}
    assert written_files == {"anna.txt.glb", "anna.jpg.png", "a.b.csv"}


def test_it_speaks_japanese_and_no_word_is_cut(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    QSettings().setValue("language", "ja")
    saved_as(monkeypatch, tmp_path / "anna.smis")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        for export in exports():
            sheet = opened(window, export.what)
            yield told(sheet)
            assert "ボディ" in sheet.items["body"].text()
            assert sheet.minimumSizeHint().width() <= sheet.width() <= window.width()
            assert sheet.minimumSizeHint().height() <= sheet.height() <= window.height()
            sheet.reject()
        opened(window, "measures").save.click()
        yield written(window)
        assert "保存しました" in window.notices.notice().sentence

    try:
        run_bodiless([], script)
    finally:
        QSettings().setValue("language", "en")
    titles = [m.get("full_name") for m in ElementTree.parse(tmp_path / "anna.smis").getroot().iter("m")]
    assert any("（左）" in title for title in titles if title)
