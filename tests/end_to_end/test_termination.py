"""A signal that ends the program, as at a shutdown, loses no edit: the document is kept aside first."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import QSettings, QTimer
from PySide6.QtGui import QGuiApplication
from window_tools import Script, run_undrawn, settled

from app.cli.main import main
from app.gui.main_window import MainWindow
from core.document.storage.recovery import find_unsaved, load_unsaved, recovery_folder

FILE = Path(__file__)
RATIO = 0.9


def work(body: Path) -> int:
    """Edit once, print that this is done, and stay, with autosave an hour away; returns the exit code."""
    from app.gui.application import application  # noqa: PLC0415 (in the process that is ended)

    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # it may be ignored where tests are run, which is inherited
    app = application()
    QSettings().setValue("autosave", 3600.0)

    def look() -> None:
        for window in app.topLevelWidgets():
            if isinstance(window, MainWindow) and window.is_settled():
                clock.stop()
                window.session.commit_line("mid-bust", "Mid-bust line", RATIO)
                print("edited", flush=True)
                window.project_controller.open()  # a question stays open: the signal ends it too

    clock = QTimer(interval=20)
    clock.timeout.connect(look)
    clock.start()
    return main([str(body)])


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_signal_ends_the_program_and_the_last_edit_is_kept(
    name: str, tmp_path: Path, mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for kind in ("STATE", "DATA", "CONFIG"):
        monkeypatch.setenv(f"XDG_{kind}_HOME", str(tmp_path / kind))
    command = [sys.executable, str(FILE), str(mannequin)]
    helpers = os.pathsep.join(str(FILE.parents[at] / name) for at, name in ((2, ""), (1, "helpers")))
    env = {**os.environ, "PYTHONPATH": helpers}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=env) as program:
        try:
            assert program.stdout is not None
            assert program.stdout.readline() == "edited\n"
            program.send_signal(getattr(signal, name))
            code = program.wait(300)
        finally:
            program.kill()
    assert code == 128 + getattr(signal, name)
    (kept, recovery), *others = find_unsaved()[0]
    assert kept.document.design.ratio("mid-bust") == RATIO
    assert others == []
    recovery.remove()


@pytest.mark.usefixtures("empty_house")
def test_the_end_of_a_desktop_session_keeps_the_document_aside() -> None:
    QSettings().setValue("autosave", 3600.0)
    former = signal.getsignal(signal.SIGTERM)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        assert signal.getsignal(signal.SIGTERM) is not former
        app = QGuiApplication.instance()
        app.commitDataRequest.emit(None)
        assert not recovery_folder().exists(), "nothing is unsaved"
        window.session.commit_line("mid-bust", "Mid-bust line", RATIO)
        app.commitDataRequest.emit(None)
        (folder,) = recovery_folder().iterdir()
        assert load_unsaved(folder).document.design.lines == window.session.design.lines

    run_undrawn([], script)
    assert signal.getsignal(signal.SIGTERM) is former
    assert list(recovery_folder().iterdir()) == [], "the session went on, and the window was closed in order"


if __name__ == "__main__":
    sys.exit(work(Path(sys.argv[1])))
