"""The Scan panel crops, mirrors and fills; each is one undo step and is saved with the project."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton
from window_tools import Script, run_bodiless, settled

from app.gui.main_window import MainWindow
from core.document.storage.project_file import open_project
from core.scan.body import read_scan
from core.scan.source import UNEDITED, ScanEdits
from tests.core.scan.test_hole_filling import pierced

pytestmark = pytest.mark.usefixtures("empty_house")


def edits(window: MainWindow) -> ScanEdits:
    assert window.session.design is not None
    return window.session.design.scan.edits


def type_level(field: object, text: str) -> None:
    field.selectAll()  # type: ignore[attr-defined]
    QTest.keyClicks(field, text)  # type: ignore[call-overload]
    QTest.keyClick(field, Qt.Key.Key_Return)  # type: ignore[call-overload]


def test_a_scan_is_cropped_mirrored_and_filled_step_by_step(tmp_path: Path, person: Path) -> None:
    whole = read_scan(person)
    holed = pierced(whole.mesh, (np.array([0.0, 30.0, 260.0]), 35.0))
    scan, project = tmp_path / "holed.ply", tmp_path / "edited.busk"
    trimesh.Trimesh(holed.vertices, holed.faces, process=False).export(scan)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("scan")
        panel, stack = window.scan.edits, window.session.undo_stack
        assert len(panel.fills) == 1
        panel.fills[0].findChild(QPushButton).click()
        yield settled(window)
        assert panel.fills == []
        assert len(edits(window).filled) == 1
        type_level(panel.low, "40")
        yield settled(window)
        assert edits(window).low == 40.0
        panel.sides.button("left").click()
        yield settled(window)
        assert window.session.frame is not None
        assert window.session.frame.stages.body.edits == edits(window)
        assert stack.count() == 3
        before = edits(window)
        type_level(panel.low, "320")  # nothing is left below the breasts: the last good state stays
        yield lambda: window.notices.notice() is not None and edits(window) == before
        yield settled(window)
        assert panel.low.text() == "40"
        assert stack.index() == 3
        window.session.save(project, None)
        yield lambda: stack.isClean() and project.exists()
        for _ in range(3):
            window.actions_.undo.trigger()
            yield settled(window)
        assert edits(window) == UNEDITED
        assert len(panel.fills) == 1

    assert run_bodiless([str(scan)], script) == 0
    kept = open_project(project).design.scan.edits
    assert (kept.low, kept.kept, len(kept.filled)) == (40.0, "left", 1)
