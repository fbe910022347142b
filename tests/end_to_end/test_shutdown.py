"""Nothing of a window is left when it is closed, whatever it was doing."""

from __future__ import annotations

import gc
import os
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QPointF, QSettings
from PySide6.QtWidgets import QApplication
from shiboken6 import isValid
from window_tools import Script, drag, run_main, settled

import app.gui.features.project.controller as project_files
from app.gui.main_window import MainWindow
from app.presenters.samples import sample_design
from core.document.storage.recovery import recovery_folder
from tests.end_to_end.test_jobs import endless

pytestmark = pytest.mark.usefixtures("empty_house")

DRAWN = ("vtkRenderWindow", "vtkXOpenGLRenderWindow", "vtkRenderer", "vtkOpenGLRenderer", "vtkActor")


def left_over() -> Counter[str]:
    """Count what a window may leave: threads, timers at work, widgets, what was drawn, temporary files.

    Of objects of Python only those made since the last ``gc.freeze()`` are seen.
    """
    gc.collect()
    found = Counter(f"thread {thread.name}" for thread in threading.enumerate())
    for each in gc.get_objects():
        kind = type(each).__name__  # not isinstance: a proxy would be asked for what it no longer holds
        if kind == "QTimer" and isValid(each) and each.isActive():
            found["a timer at work"] += 1
        elif kind.removesuffix("_") in DRAWN or kind == "Plotter":
            found[kind] += 1
    found.update(f"widget {type(each).__name__}" for each in QApplication.topLevelWidgets())
    found.update(f"file {name}" for name in os.listdir(tempfile.gettempdir()) if "busk" in name)
    return found


def looked_at(window: MainWindow) -> Script:
    """A map, flags on it, a section, a wipe and a line that is being drawn, turn by turn."""
    tools = window.view.tool_actions
    for name in ("map", "section", "ghost", "wipe"):
        tools[name].trigger()
    window.convergence_controller.slow.trigger()
    window.session.commit_line("mid-bust", "Mid-bust", 0.9)
    yield lambda: window.session.frame.stages.design is window.session.design
    window.draw_tool.begin()
    window.draw_tool._sketching.hand.clicked.emit(QPointF(300.0, 300.0))


def beside(window: MainWindow) -> Script:
    """Two variants side by side, with the preferences and the search for commands open."""
    window.variants_controller.segment.button("B").click()
    drag(window, "mid-bust", -20)
    yield settled(window)
    window.variants_controller.show_side_by_side()
    yield lambda: window.view.beside.way == "variants"
    window.preferences_controller.show()
    window.actions_.about.trigger()
    window.actions_.menus["lines"].popup(window.pos())


def in_hand(window: MainWindow) -> Script:
    """A handle and a pin in the hand, and a job that takes its time."""
    drag(window, "mid-bust", -20, release=False)
    window.view.tool_actions["side"].trigger()
    yield lambda: True
    window.jobs.run("Endless", endless([]), print, print, waited=True)
    window.view.viewport.pin_pressed.emit("bust_point_left")
    place = window.session.frame.stages.landmarks.position("bust_point_left")
    window.view.viewport.pin_moved.emit("bust_point_left", place + 3.0)
    yield lambda: True


def loading(window: MainWindow) -> Script:
    """Another body that is being read."""
    window.session.open_design(sample_design("person"))
    yield lambda: window.session._solving.at_work


def writing(window: MainWindow) -> Script:
    """A project that is being saved, and edits that are being kept aside, on a slow disk."""
    window.session.commit_line("mid-bust", "Mid-bust", 0.9)
    yield lambda: window.autosave_controller._writing.at_work
    assert window.project_controller.save()
    window.session.commit_line("mid-bust", "Mid-bust", 0.95)
    assert window.session._saving.at_work


def at_first(window: MainWindow) -> Script:
    """The tour of the first start."""
    QSettings().clear()
    window.start_controller.take_tour()
    yield settled(window)


@pytest.mark.parametrize("state", [looked_at, beside, in_hand, loading, writing, at_first])
def test_a_closed_window_leaves_nothing(
    state: Callable[[MainWindow], Script],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    sync = os.fsync
    monkeypatch.setattr(project_files, "ask_save", lambda *_: str(tmp_path / "anna.busk"))
    monkeypatch.setattr(project_files, "ask_about_changes", lambda *_: "discard")
    if state is writing:
        QSettings().setValue("autosave", 0.01)
        monkeypatch.setattr(os, "fsync", lambda file: (time.sleep(0.3), sync(file)))
    gc.freeze()
    before = left_over()

    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield from state(window)
        window.session.commit_line("full-bust", "Full bust", 0.97)
        # The script ends as if all were saved: it is not, and closing asks.
        monkeypatch.setattr(window.session.undo_stack, "setClean", lambda: None)

    run_main([], script)
    assert [record.getMessage() for record in caplog.records] == []
    assert left_over() - before == Counter()
    assert not recovery_folder().exists() or list(recovery_folder().iterdir()) == []
    assert {path.name for path in tmp_path.iterdir()} <= {"anna.busk"}, "no lock and no half a file"
