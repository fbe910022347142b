"""What the window promises about work: nothing is lost by a crash, a slip or a second window."""

from __future__ import annotations

import json
import os
import shutil
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QLockFile, QSettings
from window_tools import Script, drag, points, run_bodiless, run_main, settled

import app.gui.features.project.controller as project_files
import app.gui.features.project.recovery
import app.gui.features.variants.controller
from app.gui.main_window import MainWindow
from core.document.storage.backups import backups
from core.document.storage.project_file import open_project
from core.document.storage.recovery import find_unsaved, recovery_folder
from tests.end_to_end.test_jobs import endless

pytestmark = pytest.mark.usefixtures("empty_house")


def crash(window: MainWindow) -> None:
    """Leave behind what a window leaves that is killed: its folder, with nobody who holds it."""
    recovery = window.autosave_controller._recovery
    assert recovery is not None
    recovery.leave()
    window.autosave_controller._recovery = None


def test_a_crash_loses_nothing_and_the_next_start_offers_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    QSettings().setValue("autosave", 0.05)
    path = tmp_path / "anna.busk"
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(path))
    seen = []

    def first(window: MainWindow) -> Script:
        yield settled(window)
        window.project_controller.save()
        yield path.exists
        drag(window, "mid-bust", -20)
        yield settled(window)
        yield lambda: window.autosave_controller._kept is window.session.document
        crash(window)
        window.autosave_controller._clock.stop()
        seen.append((window.session.document, points(window).copy()))

    def again(window: MainWindow) -> Script:
        document, body = seen[0]
        card = window.recovery_controller.card
        yield card.isVisible
        assert "anna" in card.accessibleName()
        assert find_unsaved()[0] == [], "no other window may take what this one offers"
        card.take.click()
        yield lambda: window.session.name == "anna"
        yield settled(window)
        assert not card.isVisible()
        assert window.session.design.lines == document.design.lines
        assert np.abs(points(window) - body).max() < 0.3
        assert "*" in window.windowTitle(), "it is as unsaved as it was"
        assert window.autosave_controller._recovery is not None
        assert list(recovery_folder().iterdir()) == [window.autosave_controller._recovery.folder]
        window.project_controller.save()
        assert window.session.finish_saving()
        assert open_project(path).design.lines == document.design.lines

    run_bodiless([], first)
    (folder,) = recovery_folder().iterdir()
    assert json.loads((folder / "document.json").read_text())["project"] == str(path)
    assert (folder / "picture.png").exists()
    run_bodiless([], again)
    assert list(recovery_folder().iterdir()) == []


@pytest.mark.usefixtures("fine_samples")
def test_what_is_not_restored_stays_until_it_is_discarded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(app.gui.features.project.recovery, "may_discard", lambda *_: True)

    def first(window: MainWindow) -> Script:
        yield settled(window)
        window.session.commit_line("mid-bust", "Mid-bust line", 0.9)
        assert Path(window.rescue()).is_dir()
        crash(window)

    def later(window: MainWindow) -> Script:
        yield window.recovery_controller.card.isVisible
        window.recovery_controller.card.later.emit()
        assert not window.recovery_controller.card.isVisible()

    def discard(window: MainWindow) -> Script:
        yield window.recovery_controller.card.isVisible
        yield settled(window)
        window.target_shape_controller.begin()
        assert not window.recovery_controller.card.isVisible(), "it would lie on the handles"
        window.target_shape_controller.leave()
        assert window.recovery_controller.card.isVisible(), "the offer stands again when the asking is over"
        window.recovery_controller.card.drop.click()
        assert not window.recovery_controller.card.isVisible()

    for script in (first, later, discard):
        run_bodiless([], script)
    assert list(recovery_folder().iterdir()) == []


def test_a_broken_recovery_is_told_and_rescue_never_raises(monkeypatch: pytest.MonkeyPatch) -> None:
    folder = recovery_folder() / "20260101-000000-x"
    folder.mkdir(parents=True)
    (folder / "document.json").write_text("{")

    def script(window: MainWindow) -> Script:
        notice = window.notices.notice()
        assert notice is not None
        assert "x.broken" in notice.hint
        yield settled(window)
        monkeypatch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError(28, "No space left")))
        assert window.rescue() == ""

    run_bodiless([], script)
    shutil.rmtree(recovery_folder())


def test_saving_waits_for_no_disk_and_closing_waits_for_saving(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, disk = tmp_path / "anna.busk", threading.Event()
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(path))
    sync = os.fsync
    monkeypatch.setattr(os, "fsync", lambda file: (disk.wait(60), sync(file)))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.commit_line("mid-bust", "Mid-bust line", 0.9)
        assert window.project_controller.save()
        assert not path.exists()
        window.session.commit_line("mid-bust", "Mid-bust line", 0.8)
        yield settled(window)  # all goes on
        assert window.status._saved.text() == "Saving…"
        threading.Timer(0.2, disk.set).start()
        monkeypatch.setattr(project_files, "ask_about_changes", lambda *_: "discard")
        assert window.close()
        assert open_project(path).design.ratio("mid-bust") == 0.9

    run_bodiless([], script)


def test_two_windows_and_a_change_from_outside_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, project: Path, mannequin: Path
) -> None:
    path, asked = tmp_path / "lotte.busk", []
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(path))
    answers = iter(("overwrite", "stay", "overwrite"))
    monkeypatch.setattr(
        app.gui.features.project.controller,
        "ask_overwrite",
        lambda *what: asked.append(what[1:]) or next(answers),
    )

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.project_controller.save()
        assert window.session.finish_saving()
        assert not [each for each in backups() if each.project == path]
        other = QLockFile(str(tmp_path / ".lotte.busk.lock"))
        assert not other.tryLock(0), "it is this window's"
        path.write_bytes(project.read_bytes())
        window.session.commit_line("mid-bust", "Mid-bust line", 0.9)
        window.project_controller.save()
        assert window.session.finish_saving()
        assert asked == [("lotte", False)]
        (former,) = [each for each in backups() if each.project == path]
        assert former.path.read_bytes() == project.read_bytes(), "what was outside can be had back"
        window.project_controller.save()
        assert window.session.finish_saving()
        assert asked == [("lotte", False)], "its own version is no surprise"
        path.chmod(0o400)
        window.session.commit_line("mid-bust", "Mid-bust line", 0.91)
        former = path.read_bytes()
        for written in (False, True):
            assert bool(window.project_controller.save()) == written
            assert window.session.finish_saving() == written
            assert asked.pop() == ("lotte", True), "who protected it is asked"
            assert (path.read_bytes() != former) == written
        window.autosave_controller._lock.release()
        assert other.tryLock(0)
        window.project_controller.open_file(str(path))
        yield lambda: window.notices.notice() is not None
        notice = window.notices.notice()
        assert notice is not None
        assert "lotte is already open in another window" in notice.sentence
        window.notices.close_notice()
        assert window.session.save(str(path), None)
        assert window.session.finish_saving()
        assert window.notices.notice() is None, "who has opened it anyway is not told at each save"
        notice.actions[0][1]()
        assert window.session.path is None
        assert "*" in window.windowTitle()
        other.unlock()

    run_bodiless([], script)


def test_the_history_goes_back_to_edits_and_results() -> None:
    def script(window: MainWindow) -> Script:
        panel, session = window.history, window.session
        yield settled(window)
        for ratio in (0.95, 0.9):
            drag(window, "mid-bust", -20)
            yield settled(window)
            yield lambda count=1 + (ratio == 0.9): panel.snapshots.count() == count
        assert panel.edits.item(0).text() == "Opened"
        assert panel.edits.count() == 3
        short = session.design
        panel.edits.itemClicked.emit(panel.edits.item(1))
        assert session.undo_stack.index() == 1
        long = session.design
        assert long != short
        yield settled(window)
        assert panel.snapshots.count() == 2, "no result is kept twice"
        panel.snapshots.itemActivated.emit(panel.snapshots.item(0))
        assert session.design == short
        assert session.undo_stack.undoText().startswith("Restored: ")
        session.undo_stack.undo()
        assert session.design == long
        for _ in range(5):
            session.commit_line("full-bust", "Full-bust line", session.design.ratio("full-bust") - 0.01)
        assert session.undo_stack.index() == 2, "quick turns of a wheel are one edit"
        session.undo_stack.undo()
        assert session.design == long

    run_bodiless([], script)


def test_variants_are_chosen_undone_and_seen_side_by_side(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def script(window: MainWindow) -> Script:
        session, segment, area = window.session, window.variants_controller.segment, window.view
        yield settled(window)
        assert "copy of A" in segment.button("B").toolTip()
        segment.button("B").click()
        drag(window, "mid-bust", -20)
        yield settled(window)
        short = session.design
        session.undo_stack.undo()
        session.undo_stack.undo()
        assert segment.button("A").isChecked()
        assert list(session.document.variants) == ["A"]
        session.undo_stack.setIndex(2)
        window.variants_controller.show_side_by_side()
        yield lambda: area.beside.way == "variants"
        assert len(area.beside.bodies) == 2
        beside = area.beside.bodies[1].frame
        assert beside is not None
        assert beside.stages.design == session.document.variants["A"]
        assert beside.verdict.state == "settled"
        segment.button("A").click()
        yield lambda: area.beside.bodies[1].frame.stages.design == short
        assert session.save(str(tmp_path / "ab.busk"), None)
        assert session.finish_saving()
        assert list(open_project(tmp_path / "ab.busk").variants) == ["A", "B"]
        yield from the_history_goes_back_in_the_variant_of_a_result(window)
        session.remove_variant("B")
        assert area.beside.way == "after"
        window.variants_controller.choose("B")
        window.variants_controller.choose("A")
        monkeypatch.setattr(app.gui.features.variants.controller, "converged_frame", endless([]))
        window.variants_controller._solved.clear()
        window.variants_controller.show_side_by_side()
        assert len([job for job in window.jobs.at_work() if job.waited]) == 1
        session.opened.emit(session.frame)
        assert not [job for job in window.jobs.at_work() if job.waited], "it is of another document"

    run_main([], script)


def the_history_goes_back_in_the_variant_of_a_result(window: MainWindow) -> Script:
    session, panel = window.session, window.history
    yield settled(window)
    session.commit_line("full-bust", "Full-bust line", 0.97)
    yield settled(window)
    yield lambda: panel.snapshots.count() > 0 and panel.snapshots.item(0).text().startswith("A: Full-bust")
    kept = session.design
    window.variants_controller.choose("B")
    placed = session.design.with_placed("bust_point_left", (0.1, 0.2, 0.3))
    session.edit(lambda _: placed, "placed since")
    before = session.document.variants
    panel.snapshots.itemActivated.emit(panel.snapshots.item(0))
    assert session.document.shown == "A"
    assert session.document.variants["B"] == before["B"]
    assert session.design == replace(kept, placed=placed.placed), "where landmarks are is said of both"
    session.undo_stack.undo()
    session.undo_stack.undo()
    yield settled(window)
