"""Random steps through the real window end where a model does; benchmarks/walk_test.py goes further."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings
from walk_steps import Walker
from window_tools import Script, run_main, settled, undrawn

import app.gui.session.document_editor
from app.gui.main_window import MainWindow

pytestmark = pytest.mark.usefixtures("empty_house")

STEPS, EVERY, SEED = 100, 100, 7


def test_a_random_walk_through_the_window_ends_where_its_model_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        app.gui.session.document_editor, "PAUSE", -1.0
    )  # every edit is one step, however quick
    for name in ("ask_save", "ask_open", "ask_about_changes", "ask_overwrite"):
        monkeypatch.setattr(app.gui.features.project.controller, name, None)  # brought back after the walk
    QSettings().setValue("autosave", 0.05)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        undrawn(window)
        walker = Walker(window, tmp_path, random.Random(SEED))
        yield from walker.walk(STEPS, EVERY)
        assert walker.far[0] < 1e-9
        assert walker.far[1] < 0.3

    run_main([], script)
