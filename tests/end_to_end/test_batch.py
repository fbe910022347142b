"""A batch run from the window: nothing blocks, rows open their bodies, and what is stopped goes on later."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import Script, run_bodiless, settled

from app.batch.batch_design import batch_design
from app.batch.schema import DESIGN
from app.batch.store import ResultStore
from app.gui.features.batch.dialog import BatchDialog
from app.gui.features.batch.workspace import BatchWorkspace
from app.gui.main_window import MainWindow
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.project_file import read_scan_file, save_project

pytestmark = pytest.mark.usefixtures("empty_house")


@pytest.fixture(autouse=True)
def answers(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Answer the question about a run that goes on; at the end it is stopped."""
    given = ["quit"]
    monkeypatch.setattr("app.gui.features.batch.controller.ask", lambda *_: given[0])
    return given


@pytest.fixture
def scans(tmp_path: Path, mannequin: Path, person: Path) -> Path:
    """A folder of two good scans and a broken one."""
    folder = tmp_path / "scans"
    folder.mkdir()
    shutil.copy(mannequin, folder / "anna.ply")
    shutil.copy(person, folder / "berta.ply")
    (folder / "broken.ply").write_bytes(b"")
    return folder


def opened(window: MainWindow) -> tuple[BatchWorkspace, BatchDialog]:
    window.batch_controller.show()
    workspace = window.batch_controller.workspace
    assert workspace is not None
    workspace.dialog.setup.workers = 1
    return workspace, workspace.dialog


def ended(workspace: BatchWorkspace) -> Callable[[], bool]:
    return lambda: not workspace.run.is_running


def notice(dialog: BatchDialog) -> str:
    shown = dialog.notices.notice()
    return "" if shown is None else f"{shown.sentence} {shown.hint}"


def has_rows(workspace: BatchWorkspace, count: int) -> Callable[[], bool]:
    return lambda: len(workspace.model.shown) >= count


def test_a_run_goes_on_while_its_window_is_closed_and_rows_open_bodies(scans: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        workspace, dialog = opened(window)
        assert not dialog.run.isEnabled()
        assert dialog.empty.isVisible()
        workspace.choose_scans([str(scans)])
        yield lambda: "3 scans" in dialog.setup.scan_field.accessibleDescription()
        out = dialog.setup.out
        assert out == scans.parent / "scans mannequin batch"
        dialog.run.click()
        assert dialog.stop.isVisible()
        assert not dialog.setup.isEnabled()
        dialog.close()
        yield lambda: "of 3" in window.batch_controller.indicator.press.text()
        window.batch_controller.indicator.press.click()
        assert dialog.isVisible()
        yield has_rows(workspace, 3)
        yield ended(workspace)
        assert not window.batch_controller.indicator.isVisible()
        assert dialog.progress.text() == "Run finished."
        assert dialog.run.isVisible()
        assert dialog.page.isEnabled()
        first = workspace.model.shown[0]
        assert (first.name, first.verdict) == ("broken.ply", "Refused")
        assert "empty" in first.remarks
        dialog.doubtful.click()
        assert [row.name for row in workspace.model.shown] == ["anna.ply", "berta.ply", "broken.ply"]
        assert dialog.card.plot.shown is not None
        assert sum(counts.sum() for _, counts in dialog.card.plot.shown.series) == 2
        dialog.search.setText("berta")
        assert [row.name for row in workspace.model.shown] == ["berta.ply"]
        dialog.search.clear()
        design = window.session.design
        dialog.table.setCurrentIndex(workspace.model.index(1, 0))
        QTest.keyClick(dialog.table, Qt.Key.Key_Return)
        yield lambda: window.session.name == "berta"
        assert design is not None
        assert window.session.design is not None
        assert window.session.design.lines == design.lines
        assert Path(window.session.design.scan.path) == scans / "berta.ply"
        assert workspace.choice.designs()[0].name == "mannequin", "the design of the run stays chosen"

    assert run_bodiless([], script) == 0


def test_a_stopped_run_keeps_its_results_and_goes_on(scans: Path, answers: list[str]) -> None:
    for number in range(3):
        shutil.copy(scans / "anna.ply", scans / f"copy {number}.ply")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        workspace, dialog = opened(window)
        workspace.choose_scans([str(scans)])
        dialog.run.click()
        yield has_rows(workspace, 1)
        answers[0] = ""
        window.close()
        assert window.isVisible(), "quitting is confirmed while a run goes on"
        answers[0] = "quit"
        dialog.stop.click()
        assert not dialog.stop.isEnabled()
        yield ended(workspace)
        assert "stopped" in dialog.progress.text()
        yield has_rows(workspace, 1)
        kept, out = len(workspace.model.shown), dialog.setup.out
        assert out is not None
        assert json.loads((out / "summary.json").read_text())["rows"] == kept
        dialog.run.click()
        yield ended(workspace)
        yield has_rows(workspace, 6)
        assert len(workspace.model.shown) == 6
        assert dialog.progress.text() == "Run finished."

    assert run_bodiless([], script) == 0


def test_the_results_of_another_design_are_shown_and_not_mixed(scans: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        workspace, dialog = opened(window)
        workspace.choose_scans([str(scans / "anna.ply")])
        dialog.run.click()
        yield ended(workspace)
        yield has_rows(workspace, 1)
        out = dialog.setup.out
        assert out is not None
        stored = (out / DESIGN).read_text()
        window.session.edit(lambda design: design.with_line("mid-bust", 0.9), "shorter")
        workspace.choice.choose_open()
        dialog.run.click()
        assert "another design" in notice(dialog)
        assert not workspace.run.is_running
        assert (out / DESIGN).read_text() == stored
        workspace.use_new_folder()
        assert dialog.setup.out == out.with_name(f"{out.name} 2")
        assert not workspace.model.shown
        workspace.open_results(out)
        yield has_rows(workspace, 1)
        assert workspace.choice.designs()[0].design.lines[0].ratio > 0.9

    assert run_bodiless([], script) == 0


def test_rows_of_the_command_open_with_the_lengths_of_their_body(tmp_path: Path, person: Path) -> None:
    project, out = tmp_path / "clara.busk", tmp_path / "results"
    save_project(
        project,
        Document.single(Design(ScanSource(str(person)))),
        read_scan_file(ScanSource(str(person))),
        None,
    )
    before = project.read_bytes()
    store = ResultStore(out, [batch_design("bra", Design(ScanSource("")), ["mid-bust=-20mm"], [], [])])
    known = {"scan_sha256": "d", "variant": "bra", "state": "done", "verdict": "good"}
    store.add([{"scan": str(person), **known}, {"scan": "clara.busk", **known}])
    store.flush()
    store.close()

    def script(window: MainWindow) -> Script:
        yield settled(window)
        session = window.session
        workspace, dialog = opened(window)
        workspace.open_results(out)
        yield has_rows(workspace, 2)
        assert dialog.setup.design_field.accessibleDescription() == "bra (design of the results)"
        rows = {row.name: row for row in workspace.model.shown}
        workspace.open_row(rows[person.name])
        yield lambda: session.design is not None and Path(session.design.scan.path) == person
        assert session.design is not None
        assert 0.9 < session.design.ratio("mid-bust") < 1.0
        workspace.open_row(rows["clara.busk"])
        yield lambda: session.design is not None and bool(session.design.scan.member)
        assert session.design is not None
        assert session.design.ratio("mid-bust") < 1.0
        assert session.path is None, "saving asks for a place: the project is that of the customer"
        assert not session.unsaved
        assert project.read_bytes() == before

    assert run_bodiless([], script) == 0


def test_stored_rows_are_shown_also_if_a_run_starts_before_they_are_read(
    scans: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.gui.features.batch.run.BatchRun.start", lambda *_: None)
    design = batch_design("bra", Design(ScanSource("")), ["mid-bust=95%"], [], [])
    store = ResultStore(tmp_path / "results", [design])
    store.add([{"scan": "a.ply", "scan_sha256": "d", "variant": "bra", "state": "done", "verdict": "good"}])
    store.flush()
    store.close()

    def script(window: MainWindow) -> Script:
        yield settled(window)
        workspace, _ = opened(window)
        workspace.choose_scans([str(scans)])
        workspace.choice.keep([design])
        workspace.choose_out(tmp_path / "results")
        workspace.start()
        yield has_rows(workspace, 1)

    assert run_bodiless([], script) == 0


def test_closing_the_program_ends_a_run(scans: Path) -> None:
    left = []

    def script(window: MainWindow) -> Script:
        yield settled(window)
        workspace, dialog = opened(window)
        workspace.choose_scans([str(scans)])
        dialog.run.click()
        yield has_rows(workspace, 1)
        left.append((workspace.run, dialog.setup.out))

    assert run_bodiless([], script) == 0
    ((run, out),) = left
    assert not run.is_running
    summary = json.loads((out / "summary.json").read_text())
    assert summary["interrupted"] or summary["rows"] == 3, "the run may have been faster"


def test_without_the_packages_a_sentence_shows_how_to_get_them(
    scans: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.gui.features.batch.workspace.missing_packages", lambda: ["dask", "pyarrow"])

    def script(window: MainWindow) -> Script:
        yield settled(window)
        workspace, dialog = opened(window)
        assert "dask, pyarrow" in notice(dialog)
        assert "extra batch" in notice(dialog)
        workspace.choose_scans([str(scans)])
        assert not dialog.run.isEnabled()

    assert run_bodiless([], script) == 0
