"""What the window promises about files: saved, reopened, exported, and nothing lost when one is bad."""

from __future__ import annotations

import json
import stat
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from PySide6.QtGui import QImage
from window_tools import Script, drag, points, run_bodiless, settled

import app.gui.features.export.controller
import app.gui.features.project.controller as project_files
from app.gui.main_window import MainWindow
from app.presenters.samples import sample_design
from core.document.document import Document
from core.document.storage.backups import backups
from core.document.storage.project_file import ScanFile, open_project, save_project

pytestmark = pytest.mark.usefixtures("empty_house")


def test_a_project_is_saved_and_reopened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "customer 0412.busk"
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(path))
    seen = []

    def first(window: MainWindow) -> Script:
        yield settled(window)
        drag(window, "mid-bust", -20)
        drag(window, "full-bust", -10)
        yield settled(window)
        assert "*" in window.windowTitle()
        window.actions_.save.trigger()
        assert "*" not in window.windowTitle()
        seen.append((window.session.design, points(window).copy()))

    def again(window: MainWindow) -> Script:
        yield settled(window)
        assert window.session.name == "customer 0412"
        assert window.session.design is not None
        assert window.session.design.lines == seen[0][0].lines
        assert np.abs(points(window) - seen[0][1]).max() < 0.3

    run_bodiless([], first)
    with zipfile.ZipFile(path) as archive:
        assert set(archive.namelist()) == {"design.json", "scan/mannequin.ply", "preview.png"}
        assert json.loads(archive.read("design.json"))["format"] == 1
        assert QImage.fromData(archive.read("preview.png")).width() == 480
    run_bodiless([str(path)], again)


@pytest.mark.skipif(sys.platform == "win32", reason="links and access rights of POSIX")
def test_a_project_behind_a_link_is_saved_where_it_lies(tmp_path: Path) -> None:
    path, link = tmp_path / "bodies" / "anna.busk", tmp_path / "anna.busk"
    path.parent.mkdir()
    design = sample_design()
    scan = ScanFile("mannequin.ply", Path(design.scan.path).read_bytes())
    save_project(path, Document.single(design), scan, None)
    path.chmod(0o640)
    link.symlink_to("bodies/anna.busk")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        drag(window, "mid-bust", -20)
        yield settled(window)
        window.actions_.save.trigger()
        assert window.session.finish_saving()
        assert not window.session.changed_elsewhere
        drag(window, "mid-bust", -10)
        yield settled(window)
        window.actions_.save.trigger()
        assert window.session.finish_saving()

    run_bodiless([str(link)], script)
    assert link.is_symlink()
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    lengths = [open_project(each).design.ratio("mid-bust") for each in (path, *(b.path for b in backups()))]
    assert len(set(lengths)) == 3, "as it is, as it was saved before, and as it was opened"


@pytest.mark.usefixtures("fine_samples")
def test_the_shown_body_is_exported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        for ending in ("ply", "obj", "stl"):
            path = tmp_path / f"body.{ending}"
            monkeypatch.setattr(
                app.gui.features.export.controller, "ask_save", lambda *_, path=path: str(path)
            )
            window.actions_.export.trigger()
            yield path.exists
            body = trimesh.load(path, process=False)
            assert len(body.faces) == 65742
            frame = window.session.frame
            assert frame is not None
            if ending != "stl":
                moved = np.asarray(body.vertices)[frame.stages.moving.vertices]
                assert np.abs(moved - frame.points).max() < 1e-3

    run_bodiless([], script)


def test_an_export_that_failed_is_told_until_it_succeeds(
    person: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    nowhere, project, body = tmp_path / "nowhere" / "a.ply", tmp_path / "a.busk", tmp_path / "a.ply"

    def script(window: MainWindow) -> Script:
        def tone() -> str:
            notice = window.notices.notice()
            return notice.tone if notice is not None else ""

        yield settled(window)
        monkeypatch.setattr(app.gui.features.export.controller, "ask_save", lambda *_: str(nowhere))
        window.actions_.export.trigger()
        yield lambda: tone() == "bad"
        monkeypatch.setattr(project_files, "ask_save", lambda *_: str(project))
        window.actions_.save.trigger()
        yield project.exists
        assert window.session.finish_saving()
        yield lambda: "Saved" in window.status._saved.text()
        assert tone() == "bad", "a save writes no body"
        monkeypatch.setattr(app.gui.features.export.controller, "ask_save", lambda *_: str(body))
        window.actions_.export.trigger()
        yield lambda: tone() == "ok"
        window.notices.close_notice()
        assert tone() in ("", "warn"), "no failure waits behind it"
        window.session.open(str(person))
        yield lambda: window.session.name == "person"
        assert window.status._saved.text() == "", "this one was never saved"

    run_bodiless([], script)


def test_a_bad_scan_leaves_everything_as_it_was(tmp_path: Path) -> None:
    broken = tmp_path / "broken.ply"
    broken.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        design, at_start = window.session.design, points(window).copy()
        window.project_controller.open_file(str(broken))
        yield lambda: window.notices.notice() is not None
        notice = window.notices.notice()
        assert notice is not None
        assert notice.tone == "bad"
        assert notice.hint
        yield settled(window)
        assert window.session.design is design
        assert np.abs(points(window) - at_start).max() < 0.2

    run_bodiless([], script)


def test_the_file_that_was_refused_last_is_the_one_that_is_told(tmp_path: Path, project: Path) -> None:
    notes, cut = tmp_path / "notes.ply", tmp_path / "cut.busk"
    notes.write_text("to buy: thread")
    cut.write_bytes(project.read_bytes()[:900])

    def script(window: MainWindow) -> Script:
        yield settled(window)
        for path in (notes, cut, notes):
            window.project_controller.open_file(str(path))
            yield (
                lambda path=path: (
                    window.notices.notice() is not None and (path.name in window.notices.notice().sentence)
                )
            )
            yield settled(window)
            assert window.notices.more.isHidden(), "what was refused before was asked for before"

    run_bodiless([], script)


def test_a_save_that_fails_elsewhere_leaves_what_is_saved_here_saved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, mannequin: Path
) -> None:
    saved, scan = tmp_path / "customer.busk", ScanFile(mannequin.name, mannequin.read_bytes())
    save_project(saved, Document.single(sample_design()), scan, None)
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(tmp_path / "nowhere" / "a.busk"))
    told: list[object] = []

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.not_saved.connect(told.append)
        window.actions_.save_as.trigger()
        yield lambda: len(told) == 1
        assert not window.session.unsaved, "all of it is in the file that was opened"
        assert "*" not in window.windowTitle()
        drag(window, "mid-bust", -20)
        yield settled(window)
        window.actions_.save_as.trigger()
        yield lambda: len(told) == 2
        assert window.session.unsaved

    run_bodiless([str(saved)], script)


@pytest.mark.parametrize("last", ["discard", "save"])
def test_closing_asks_about_changes(last: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, answers = tmp_path / "kept.busk", ["stay", last]
    monkeypatch.setattr(project_files, "ask_about_changes", lambda *_: answers.pop(0))
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(path))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        drag(window, "mid-bust", -20)
        yield settled(window)
        assert not window.close()
        assert window.isVisible()
        assert not path.exists()
        assert window.close()
        assert path.exists() == (last == "save")

    run_bodiless([], script)
    assert not answers
    if last == "save":
        assert open_project(path).design.ratio("mid-bust") < 0.95


def test_a_project_that_cannot_be_opened_at_start_is_told(tmp_path: Path) -> None:
    (tmp_path / "broken.busk").write_bytes(b"no zip at all")

    def script(window: MainWindow) -> Script:
        yield lambda: window.notices.notice() is not None
        assert window.session.frame is None
        assert not window.actions_.save.isEnabled()

    run_bodiless([str(tmp_path / "broken.busk")], script)


@pytest.mark.usefixtures("fine_samples")
def test_an_edit_while_another_scan_is_read_does_not_mix_the_two(person: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.open(str(person))
        window.lines.length_previewed.emit("mid-bust", 0.9)
        window.lines.length_committed.emit("mid-bust", 0.9)
        yield settled(window)
        frame, design = window.session.frame, window.session.design
        assert frame is not None
        assert design is not None
        assert frame.stages.scan.name == design.scan.name == "mannequin.ply"
        assert len(frame.stages.body.mesh.faces) == 65742
        assert design.ratio("mid-bust") == 0.9, "who goes on working loses nothing"
        notice = window.notices.notice()
        assert notice is not None
        assert "person.ply was not opened" in notice.sentence

    run_bodiless([], script)
