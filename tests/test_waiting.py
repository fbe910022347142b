"""Something of the window is seen at once: its place, before the libraries of the 3D view are loaded."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from PySide6.QtWidgets import QApplication
from window_tools import run_main, settled, undrawn

from app.dress.waiting import Waiting
from app.main_window import MainWindow

ROOT = Path(__file__).parent.parent


def test_the_place_of_the_window_is_painted_first_and_left_to_it(mannequin, monkeypatch):
    seen = []
    real = Waiting.shown.__func__

    def shown(kind):
        waiting = real(kind)
        windows = [each for each in QApplication.topLevelWidgets() if isinstance(each, MainWindow)]
        seen.append((waiting.painted, windows, waiting.geometry()))
        return waiting

    monkeypatch.setattr(Waiting, "shown", classmethod(shown))

    def script(window):
        undrawn(window)
        yield settled(window)
        assert not [each for each in QApplication.topLevelWidgets() if isinstance(each, Waiting)]

    assert run_main([str(mannequin)], script) == 0
    (painted, windows, place), *more = seen
    assert painted
    assert not windows
    assert not more
    assert place.width() >= 1180
    assert place.height() >= 700


def test_nothing_slow_is_loaded_before_the_place_is_painted():
    slow = ("pyvista", "app.asking.session", "app.main_window", "pyqtgraph", "matplotlib")
    code = f"import sys, app.cli, app.window; print(*[n for n in {slow} if n in sys.modules])"
    told = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert told.stdout.split() == []
