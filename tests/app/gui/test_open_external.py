"""What other programs are started with: nothing of the frozen Busk."""

import os
import sys
from pathlib import Path

import pytest
from PySide6.QtGui import QDesktopServices

from app.gui.session.app_folders import environment_of_others, open_outside

INSIDE = "/opt/busk/_internal"


@pytest.fixture
def frozen(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    monkeypatch.setattr(sys, "_MEIPASS", INSIDE, raising=False)
    monkeypatch.delenv("LD_LIBRARY_PATH_ORIG", raising=False)
    monkeypatch.setenv("LD_LIBRARY_PATH", INSIDE)
    monkeypatch.setenv("QT_PLUGIN_PATH", f"{INSIDE}/PySide6/Qt/plugins")
    monkeypatch.setenv("PATH", os.pathsep.join((INSIDE, "/usr/bin", "/bin")))
    return monkeypatch


def test_libraries_of_the_frozen_program_are_hidden_and_stand_there_again(frozen: pytest.MonkeyPatch) -> None:
    before = dict(os.environ)
    with environment_of_others():
        assert "LD_LIBRARY_PATH" not in os.environ
        assert "QT_PLUGIN_PATH" not in os.environ
        assert os.environ["PATH"] == os.pathsep.join(("/usr/bin", "/bin"))
    assert dict(os.environ) == before


def test_what_stood_there_before_busk_stands_there_for_others(frozen: pytest.MonkeyPatch) -> None:
    frozen.setenv("LD_LIBRARY_PATH_ORIG", "/opt/vendor/lib")
    with environment_of_others():
        assert os.environ["LD_LIBRARY_PATH"] == "/opt/vendor/lib"
    assert os.environ["LD_LIBRARY_PATH"] == INSIDE


def test_from_source_nothing_is_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LD_LIBRARY_PATH", "/opt/vendor/lib")
    before = dict(os.environ)
    with environment_of_others():
        assert dict(os.environ) == before


def test_it_is_hidden_while_the_desktop_is_asked(frozen: pytest.MonkeyPatch, tmp_path: Path) -> None:
    asked: list[tuple[str, bool]] = []

    def answer(url: object) -> bool:
        asked.append((url.toLocalFile(), "LD_LIBRARY_PATH" in os.environ))
        return len(asked) == 1

    frozen.setattr(QDesktopServices, "openUrl", answer)
    assert [open_outside(tmp_path), open_outside(tmp_path)] == [True, False]
    assert asked == [(str(tmp_path), False)] * 2
