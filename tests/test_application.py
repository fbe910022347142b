"""The guards of the application: a log where one can be kept, and no fuss where none can."""

from __future__ import annotations

import logging
import sys
from pathlib import Path

import platformdirs
import pytest

from app.application import log_kept


def test_faults_are_logged_while_the_window_is_open(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(platformdirs, "user_log_dir", lambda *_, **__: str(tmp_path / "log"))
    hook = sys.excepthook
    with log_kept() as folder:
        assert sys.excepthook is not hook
        logging.error("a fault")
    assert sys.excepthook is hook
    assert "a fault" in (folder / "busk.log").read_text("utf-8")


def test_a_folder_that_cannot_be_written_to_does_not_keep_the_window_shut(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "home").write_text("no folder")
    monkeypatch.setattr(platformdirs, "user_log_dir", lambda *_, **__: str(tmp_path / "home" / "log"))
    with log_kept():
        logging.error("heard by nobody")
