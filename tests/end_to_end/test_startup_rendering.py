"""The 3D libraries come while the window is at work: who needs them waits, and without them it says so."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROJECT = "tests/releases/0.1.0/first.busk"

START = """
import sys
import threading
import time
from importlib.machinery import PathFinder
from PySide6.QtCore import QTimer
import app.gui.startup
from app.cli.main import main

faults, seen, began, go_on = [], [], time.monotonic(), app.gui.startup._go_on

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name != "pyvista.plotting.plotter":
            return None
        # Not here: while a module is searched for, no other thread can import anything.
        spec = PathFinder.find_spec(name, path)
        execute = spec.loader.exec_module
        spec.loader.exec_module = lambda module: (at_the_libraries(), execute(module))
        return spec

def begin(window, what):
    hook = sys.excepthook
    sys.excepthook = lambda kind, fault, trace: (faults.append(kind.__name__), hook(kind, fault, trace))
    go_on(window, what)
    windows.append(window)
    when_begun(window)
    look()

def look():
    window, = windows
    if is_over(window) or time.monotonic() > began + 300:
        print(window.view.viewport.shows_body, window.crash_handler.sheet, sorted(set(faults)), *seen)
        window.session.undo_stack.setClean()
        window.close()
    else:
        QTimer.singleShot(50, look)

windows = []
sys.meta_path.insert(0, Finder())
app.gui.startup._go_on = begin
"""

ASKED_FOR = """
half = threading.Event()

def at_the_libraries():
    half.set()
    time.sleep(0.5)

def when_begun(window):
    assert half.wait(300) and "pyvista.plotting" in sys.modules
    window.view.viewport.frame_all()
    window.preferences_controller.choose("theme", "dark")
    seen.append(window.view.picture().width() > 0)

def is_over(window):
    return window.is_settled()

main([sys.argv[1]])
"""

LATE = """
def at_the_libraries():
    # Whoever hears that a document is open may need a scene, before there is a frame.
    while (not windows or windows[0].session.frame is None) and time.monotonic() < began + 60:
        time.sleep(0.01)
    time.sleep(0.5)

def when_begun(window):
    pass

def is_over(window):
    return window.is_settled()

main([sys.argv[1]])
"""

MISSING = """
def at_the_libraries():
    raise ImportError("libGL.so.1: cannot open shared object file")

def when_begun(window):
    pass

def told(window):
    notices = window.notices
    return [each for each in (notices.notice(), *notices._waiting) if each and each.tone == "bad"]

def is_over(window):
    if seen:
        seen.append(len(told(window)))
    elif window.is_settled() and told(window):
        notice, = told(window)
        seen.extend([notice.sentence, "libGL.so.1" in notice.details])
        window.notices.clear()
        for _ in range(2):
            QTimer.singleShot(1, window.view.viewport.frame_all)
        return False
    return bool(seen)

main([sys.argv[1]])
"""


def told_by(script: str) -> str:
    command = [sys.executable, "-c", START + script, PROJECT]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=600)
    return done.stdout.strip() or done.stderr


@pytest.mark.parametrize(("script", "seen"), [(ASKED_FOR, " True"), (LATE, "")], ids=["asked for", "late"])
def test_who_needs_the_libraries_while_they_are_loaded_waits_for_them(script: str, seen: str) -> None:
    assert told_by(script) == f"True None []{seen}"


def test_where_there_are_no_such_libraries_it_is_said_once() -> None:
    said = "The 3D view is not available: its libraries could not be loaded."
    assert told_by(MISSING) == f"False None ['UserError'] {said} True 0"
