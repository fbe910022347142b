"""The guards of the application: a log where one can be kept, and no fuss where none can."""

from __future__ import annotations

import logging
import sys
from pathlib import Path

import platformdirs
import pytest

import app.gui.session.log_file
from app.gui.application import log_kept


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


def raised() -> None:
    """Raise a fault, always at one place."""
    raise ValueError("a fault")


def test_the_log_is_limited_and_a_fault_that_repeats_is_collapsed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(platformdirs, "user_log_dir", lambda *_, **__: str(tmp_path))
    monkeypatch.setattr(app.gui.session.log_file, "MOST_BYTES", 20_000)
    (tmp_path / "crash.log").write_text("x" * 30_000)
    with log_kept():
        for _ in range(5000):
            try:
                raised()
            except ValueError:
                logging.exception("unexpected fault")
        text = (tmp_path / "busk.log").read_text("utf-8")
        assert text.count("ValueError: a fault") == 6, "three times, then at 10, 100 and 1000"
        assert "unexpected fault (1000 times)" in text
        for number in range(5000):
            logging.error("message %d of many", number)
    sizes = {path.name: path.stat().st_size for path in tmp_path.iterdir()}
    assert set(sizes) == {"busk.log", "busk.log.1", "crash.log", "crash.log.1"}
    assert sizes["busk.log"] + sizes["busk.log.1"] <= 40_000
    assert "message 4999 of many" in (tmp_path / "busk.log").read_text("utf-8")
    assert sizes["crash.log"] == 0


def test_a_log_that_another_window_holds_open_stays_limited(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def held(*_: object) -> None:
        raise PermissionError("held open")

    monkeypatch.setattr(app.gui.session.log_file, "MOST_BYTES", 20_000)
    log = app.gui.session.log_file.LimitedLog(tmp_path / "busk.log")
    monkeypatch.setattr("os.rename", held)
    for number in range(5000):
        log.emit(logging.LogRecord("busk", logging.ERROR, "", 0, "message %d", (number,), None))
    log.close()
    assert (tmp_path / "busk.log").stat().st_size <= 20_000
    assert "message 4999" in (tmp_path / "busk.log").read_text("utf-8")
