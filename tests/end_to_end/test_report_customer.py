"""A customer's name that is still being typed: it is neither lost nor does it go to somebody else."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtTest import QTest
from window_tools import Script, run_bodiless, settled

from app.gui.main_window import MainWindow
from core.document.storage.project_file import open_project

pytestmark = pytest.mark.usefixtures("empty_house")


def typed(window: MainWindow, name: str) -> None:
    """Type a name on the sheet, without Enter."""
    window.report_controller.open()
    window.report_controller.page.customer.setFocus()
    QTest.keyClicks(window.report_controller.page.customer, name)


def test_a_typed_name_does_not_go_to_the_next_document(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        desk = window.report_controller
        typed(window, "Clara")
        opened = []
        window.session.opened.connect(opened.append)
        window.session.open(str(mannequin))
        yield lambda: bool(opened)
        assert window.session.document.customer == ""
        assert not window.session.unsaved
        assert desk.page.customer.text() == ""
        assert not desk.is_open

    assert run_bodiless([str(mannequin)], script) == 0


def test_nothing_of_a_former_document_is_kept_or_shown(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        desk = window.report_controller
        desk.open()
        yield desk.page.does["pdf"].isEnabled
        assert desk.page.paper.leaves
        desk.leave()
        opened = []
        window.session.opened.connect(opened.append)
        window.session.open(str(mannequin))
        yield lambda: bool(opened)
        assert (desk.handout, desk.pages, desk._occlusion, desk._frame) == (None, None, None, None)
        desk.open()
        assert not desk.page.paper.leaves, "no sheet of a former customer stands there, however faint"
        yield desk.page.does["pdf"].isEnabled

    assert run_bodiless([str(mannequin)], script) == 0


def test_no_piece_of_a_former_document_is_listed(mannequin: Path) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("garment")
        window.session.commit_line("mid-bust", "Mid-bust", 0.9)
        yield settled(window)
        assert window.garment.view.worn
        listed = []
        window.session.opened.connect(lambda *_: window.session.frame_ready.connect(look))

        def look(*_: object) -> None:
            """Hear what is listed with each frame of the next document, after the desks."""
            listed.append(window.garment.view.worn)

        window.session.open(str(mannequin))
        yield lambda: bool(listed) and settled(window)()
        assert not any(listed)

    assert run_bodiless([str(mannequin)], script) == 0


def test_a_typed_name_is_saved_and_asked_about(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "dora.busk"
    asked = []
    monkeypatch.setattr("app.gui.features.project.controller.ask_save", lambda *_: str(path))
    monkeypatch.setattr(
        "app.gui.features.project.controller.ask_about_changes", lambda *_: asked.append(1) or "discard"
    )

    def script(window: MainWindow) -> Script:
        yield settled(window)
        typed(window, "Dora")
        window.actions_.save.trigger()
        assert window.session.finish_saving()
        assert open_project(path).customer == "Dora"
        assert window.project_controller.may_leave()
        assert not asked
        typed(window, "E")
        assert window.project_controller.may_leave()
        assert asked == [1], "what is typed is a change that would be lost"

    assert run_bodiless([str(mannequin)], script) == 0
