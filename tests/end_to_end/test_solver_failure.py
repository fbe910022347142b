"""When the solver fails nothing is lost, everything can be saved, and the computation can be repeated."""

from __future__ import annotations

import logging
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QLabel
from window_tools import Script, drag, run_undrawn, settled

import app.gui.features.project.controller as project_files
from app.gui.main_window import MainWindow
from core.document.storage.project_file import open_project
from core.document.storage.recovery import load_unsaved
from tests.app.gui.test_solver_faults import Faults, edit

pytestmark = pytest.mark.usefixtures("empty_house")


def sentences(window: MainWindow) -> list[str]:
    """All notices, the shown one first."""
    bar = window.notices
    return [each.sentence for each in (bar.notice(), *bar._waiting) if each]


@pytest.mark.parametrize("error", [RuntimeError("a fault"), MemoryError()], ids=["fault", "memory"])
def test_a_solver_that_fails_for_long_loses_nothing(
    error: Exception, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    QSettings().setValue("autosave", 0.05)
    path = tmp_path / "anna.busk"
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(path))
    caplog.set_level(logging.CRITICAL)

    def script(window: MainWindow) -> Script:
        session, keeping, bar = window.session, window.autosave_controller, window.notices
        yield settled(window)
        edit(session, 20)
        yield settled(window)
        faults = Faults(monkeypatch, error)
        session.commit_line("mid-bust", "Mid-bust line", 0.9)
        yield lambda: bar.notice() is not None
        assert ("memory" in bar.notice().sentence) == isinstance(error, MemoryError)
        assert type(error).__name__ in bar.notice().details
        assert window.strip._state == "stale"
        assert window.rail.items["result"].state() == "available", "no tick on what is not computed"
        assert window.lines.rows["mid-bust"].slider.ratio() == pytest.approx(0.9), "as it is set"
        assert "Converged" not in window.status._facts.text()
        window.report_controller.open()
        assert window.report_controller.page.state.text().startswith("The shape could not be computed")
        window.report_controller.leave()
        drag(window, "full-bust", -20)
        yield lambda: session.failure.revision == session._revision
        session.undo_stack.undo()
        session.undo_stack.redo()
        for _ in range(3):
            bar.notice().actions[0][1]()
            yield lambda: session.failure.revision == session._revision
        assert len(sentences(window)) == 1, "one notice, however often it fails"
        document = session.document
        assert (session.undo_stack.index(), session.unsaved) == (22, True)
        yield lambda: keeping._kept is document
        kept = load_unsaved(keeping._recovery.folder)
        assert kept.document.design.lines == document.design.lines
        assert window.project_controller.save()
        assert session.finish_saving()
        assert open_project(path).design.lines == document.design.lines
        assert not session.unsaved
        window.navigation.show_step("result")
        window.maps_controller.choose("pressure")
        words = [
            each.text() for each in (window.result.summary, *window.findChildren(QLabel)) if each.isVisible()
        ]
        assert not [each for each in words if "rests" in each], "nothing comes by waiting"
        faults.end()
        bar.notice().actions[0][1]()
        yield settled(window)
        assert sentences(window) == []
        assert window.strip._state != "stale"
        assert session.document is document

    run_undrawn([], script)
