"""How the program begins, whoever calls it: a terminal, a desktop, a console of few letters, none at all."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import QCoreApplication, QUrl
from PySide6.QtGui import QFileOpenEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMessageBox
from window_tools import Script, drag, run_main, settled, undrawn

import app.gui.features.project.controller as project_files
from app.cli import environment as surroundings
from app.cli.environment import is_seen_in_window, path_of, set_up_streams
from app.cli.main import BAD_INPUT, INTERRUPTED, main
from app.gui.application import Application, hand_files_to
from app.gui.main_window import MainWindow
from app.gui.widgets.notification_bar import NotificationBar

ROOT = Path(__file__).parents[2]


def said_by(window: MainWindow) -> str:
    notice = window.findChild(NotificationBar).notice()
    return "" if notice is None else f"{notice.sentence} {notice.hint}"


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ("file:///bodies/anna/design%20of%20anna.busk", "/bodies/anna/design of anna.busk"),
        ("file://localhost/bodies/anna/a.busk", "/bodies/anna/a.busk"),
        ("FILE:/bodies/a.busk", "/bodies/a.busk"),
        ("file:///bodies/%E3%81%82%E3%82%93.busk", "/bodies/あん.busk"),
        ("anna 試し.busk", "anna 試し.busk"),
        ("100%25.busk", "100%25.busk"),
        ("file.busk", "file.busk"),
    ],
)
@pytest.mark.skipif(sys.platform == "win32", reason="paths begin otherwise")
def test_a_file_may_be_handed_over_as_a_url(text: str, path: str) -> None:
    assert path_of(text) == path


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_file_that_is_not_there_is_told_where_it_is_seen(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("stdin", "stdout", "stderr"):
        monkeypatch.setattr(sys, name, None if name == "stdin" else io.StringIO())
    monkeypatch.setattr(surroundings, "has_display", lambda: True)
    assert is_seen_in_window("gone.busk")
    assert is_seen_in_window("folder/gone")
    assert not is_seen_in_window("slove"), "that is no file but a word mistyped"
    with monkeypatch.context() as patch:
        patch.setattr(surroundings, "has_display", lambda: False)
        assert not is_seen_in_window("gone.busk")
    monkeypatch.setattr(sys, "stderr", _Terminal())
    assert not is_seen_in_window("gone.busk")
    assert main(["gone.busk"]) == BAD_INPUT
    assert "gone.busk is neither" in sys.stderr.getvalue()


@pytest.mark.usefixtures("empty_house")
def test_a_double_click_on_what_cannot_be_opened_is_answered_in_the_window(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "folder.busk").mkdir()
    monkeypatch.setattr("app.cli.main.is_seen_in_window", lambda _: True)

    def script(window: MainWindow) -> Script:
        yield lambda: window.start_controller.page.isVisible() and bool(said_by(window))
        heard.append(said_by(window))

    heard: list[str] = []
    for name in ("gone.busk", "gone.ply", "folder.busk"):
        assert run_main([str(tmp_path / name)], script) == 0
    assert heard[0].startswith(f"Project {tmp_path / 'gone.busk'} does not exist.")
    assert heard[1].startswith(f"{tmp_path / 'gone.ply'} does not exist.")
    assert "folder.busk cannot be read" in heard[2]


@pytest.mark.usefixtures("empty_house")
def test_files_that_the_desktop_wants_opened_come_to_the_window(
    qapp: QApplication, project: Path, person: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on macOS: one before there is a window, one while there are unsaved changes."""
    assert isinstance(qapp, Application)
    asked: list[str] = []
    monkeypatch.setattr(
        project_files,
        "ask_about_changes",
        lambda _, name: asked.append(name) or answer[0],
    )
    answer = ["stay"]

    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield lambda: window.session.name == person.stem
        yield settled(window)
        assert not asked
        drag(window, "mid-bust", -20)
        yield lambda: window.session.unsaved
        ask_for(project)
        yield lambda: bool(asked)
        assert (asked, window.session.name) == ([person.stem], person.stem)
        answer[0] = "discard"
        ask_for(project)
        yield lambda: len(asked) == 2 and said_by(window) != ""

    def ask_for(path: Path) -> None:
        QCoreApplication.sendEvent(qapp, QFileOpenEvent(QUrl.fromLocalFile(str(path))))

    ask_for(person)
    QTest.qWait(20)
    run_main([], script)
    ask_for(project)
    QTest.qWait(20)
    heard: list[str] = []
    hand_files_to(heard.append)
    hand_files_to(None)
    assert heard == [str(project)], "after the window it is kept again"


def test_a_program_without_streams_says_in_a_box_why_it_does_not_begin(
    qapp: QApplication, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[tuple[str, str]] = []
    monkeypatch.setattr(QMessageBox, "exec", lambda box: shown.append((box.text(), box.informativeText())))
    monkeypatch.setattr(surroundings, "has_display", lambda: True)
    for name in ("stdin", "stdout", "stderr", "__stderr__"):
        monkeypatch.setattr(sys, name, None)
    assert main(["--no-such-word"]) == BAD_INPUT
    assert shown == [("Unrecognized arguments: --no-such-word.", "See 'busk --help'.")]
    assert main(["detect", "gone.ply"]) == BAD_INPUT
    assert len(shown) == 1, "nobody is there to close the box of a command"
    with pytest.raises(SystemExit):
        main(["--version"])
    for stream in (sys.stdout, sys.stderr):
        stream.close()


def test_letters_that_a_console_does_not_have_end_nothing(mannequin: Path, tmp_path: Path) -> None:
    scan = tmp_path / "試し.ply"
    scan.write_bytes(mannequin.read_bytes())
    code = "import sys; from app.cli.main import main; sys.exit(main(sys.argv[1:]))"
    missing = ["detect", str(tmp_path / "無し.ply")]
    for coding, words in (("ascii", ["measure", str(scan)]), ("cp1252", missing), ("cp932", missing)):
        world = {**os.environ, "PYTHONIOENCODING": coding}
        done = subprocess.run(
            [sys.executable, "-c", code, *words], cwd=ROOT, env=world, capture_output=True, check=False
        )
        assert b"Traceback" not in done.stderr, done.stderr.decode(coding)
        assert done.returncode == (0 if words[0] == "measure" else BAD_INPUT)


def test_streams_are_left_alone_where_they_can_write_everything(monkeypatch: pytest.MonkeyPatch) -> None:
    narrow = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", narrow)
    monkeypatch.setattr(sys, "stderr", None)
    set_up_streams()
    print("−20 °")
    print("nobody hears", file=sys.stderr)
    narrow.flush()
    sys.stderr.close()
    assert narrow.buffer.getvalue() == b"?20 ?" + os.linesep.encode()


def test_what_libraries_find_out_has_a_place_even_without_a_home(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def homeless(*_: object, **__: object) -> Path:
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.setattr(sys, "frozen", True, raising=False)
    for name in ("MPLCONFIGDIR", "NUMBA_CACHE_DIR"):
        monkeypatch.setenv(name, "")
        monkeypatch.delenv(name)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    set_up_streams()
    kept = Path(os.environ["MPLCONFIGDIR"])
    assert kept.is_relative_to(tmp_path)
    assert not list(tmp_path.iterdir()), "made when there is something to keep"
    monkeypatch.setattr(surroundings.os, "access", lambda *_: False)
    set_up_streams()
    assert not Path(os.environ["MPLCONFIGDIR"]).is_relative_to(tmp_path / "Busk")
    monkeypatch.setattr(surroundings.platformdirs, "user_cache_path", homeless)
    set_up_streams()
    assert Path(os.environ["MPLCONFIGDIR"]).parent.is_dir()


@pytest.mark.parametrize(
    ("told", "set_to"), [({"LC_ALL": "C"}, "LC_ALL"), ({"LANG": "C"}, "LC_CTYPE"), ({}, "LC_CTYPE")]
)
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="locales have other names")
def test_letters_are_those_of_unicode_where_no_language_is_set(
    told: dict[str, str], set_to: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("LC_ALL", "LC_CTYPE", "LANG"):
        monkeypatch.setenv(name, told.get(name, ""))
    set_up_streams()
    assert os.environ[set_to] == "C.UTF-8"
    monkeypatch.setenv(set_to, "ja_JP.UTF-8")
    set_up_streams()
    assert os.environ[set_to] == "ja_JP.UTF-8"


def test_an_interrupt_ends_a_command_without_a_traceback(
    mannequin: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("app.cli.commands.detect.read_body", interrupted)
    assert main(["detect", str(mannequin)]) == INTERRUPTED
    assert capsys.readouterr() == ("", "")
