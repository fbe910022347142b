"""While a project is opened the window shows its stored picture, the stages and a way out."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtGui import QColor, QImage
from window_tools import Script, run_undrawn, settled

from app.gui.main_window import MainWindow
from app.gui.session.project_thumbnail import project_picture
from app.presenters.samples import sample_path
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.project_file import ScanFile, save_project

pytestmark = pytest.mark.usefixtures("empty_house")


def test_a_project_on_its_way_in_shows_its_picture_and_can_be_cancelled(tmp_path: Path) -> None:
    path = tmp_path / "anna.busk"
    picture = QImage(480, 456, QImage.Format.Format_RGB32)
    picture.fill(QColor("#AA3366"))
    scan = ScanFile("body.ply", Path(sample_path("person")).read_bytes())
    design = Document.single(Design(ScanSource(sample_path("person"))))
    save_project(path, design, scan, project_picture(picture, "settled"))

    def script(window: MainWindow) -> Script:
        cover, busy, words = window.view.cover, window.view.busy, window.lines._empty._missing
        yield settled(window)
        frame = window.session.frame
        window.session.open(str(path))
        yield cover.isVisible
        assert busy.isVisible(), "the stages are shown at once"
        assert "anna.busk" in words.text()
        assert cover.grab().toImage().pixelColor(cover.rect().center()).red() > 140
        busy.stop.click()
        yield cover.isHidden
        assert window.session.frame is frame, "what was open before stays"
        assert "anna.busk" not in words.text()
        window.session.open(str(path))
        yield lambda: window.session.name == "anna"
        assert cover.isHidden()

    assert run_undrawn([], script) == 0
