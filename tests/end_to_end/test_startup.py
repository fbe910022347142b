"""The window itself comes first, painted and at work; the 3D libraries and the body follow."""

from __future__ import annotations

import subprocess
import sys
import weakref
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QPaintEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QWidget
from pytestqt.qtbot import QtBot
from window_tools import Script, run_main, settled, small_view

import app.gui.startup
from app.gui.main_window import MainWindow
from app.gui.session.gc_control import GarbageCollection
from app.gui.session.jobs import Jobs
from app.gui.widgets import first_paint

ROOT = Path(__file__).parents[2]
LATER = ("pyvista", "vtkmodules", "pyvistaqt", "matplotlib", "PIL", "ezdxf", "trimesh", "numba")
LATER += ("shapely", "core.pattern.garment")
LATER += ("scipy.interpolate", "scipy.optimize", "app.rendering.scene", "app.rendering.offscreen")

UNTIL_PAINTED = f"""
import sys
import app.gui.startup
from app.cli.main import main

def painted(window, what):
    print(*(name for name in {LATER!r} if name in sys.modules), "and no more")
    window.close()

app.gui.startup._go_on = painted
main(["resources/samples/mannequin.ply"])
"""


def test_what_takes_long_to_load_is_loaded_when_the_window_is_painted() -> None:
    command = [sys.executable, "-c", UNTIL_PAINTED]
    told = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "and no more"


def test_the_window_is_at_work_before_there_is_a_body(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    go_on, seen = app.gui.startup._go_on, []

    def painted(window: MainWindow, what: str) -> None:
        seen.append(window.session.frame)
        assert window.isVisible()
        use_it(window)
        assert window.view.viewport._scene is None, "nobody had to wait for it"
        window.view.viewport.grab()
        go_on(window, what)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        scene = window.view.viewport.scene
        assert scene.view.name == "left"
        assert scene.view.parallel
        assert scene.material == "graphite"
        assert [scene.is_visible(part) for part in ("control", "ghost", "bands")] == [True, False, True]
        assert window.inspector.panel() is window.history
        assert not window.view.after
        assert scene.body is not None
        assert (scene.body.shown_points == scene.body.rest.vertices).all()

    monkeypatch.setattr(app.gui.startup, "_go_on", painted)
    assert run_main([str(mannequin)], script) == 0
    assert seen == [None]


def use_it(window: MainWindow) -> None:
    """Go through the steps, open a tab, wish for a view: all of it as ever."""
    for name in ("scan", "landmarks", "result", "lines"):
        window.actions_.steps[name].trigger()
        assert window.rail.current() == name
    tabs = {each.text(): each for each in window.inspector.tabs.findChildren(QAbstractButton)}
    QTest.mouseClick(tabs["History"], Qt.MouseButton.LeftButton)
    assert window.inspector.panel() is window.history
    view = window.view
    view.tools.actions_by_name["control-mesh"].trigger()
    view.tools.actions_by_name["perspective"].trigger()
    view.viewport.set_view("left")
    window.view_controller.choose_material("graphite")
    view.set_after(False)
    window.preferences_controller.choose("theme", "dark")
    window.preferences_controller.choose("theme", "light")
    QTest.mouseClick(view.viewport.overlay.parentWidget(), Qt.MouseButton.LeftButton)
    assert view.viewport.skin_at(view.viewport.rect().center().toPointF()) is None


def test_an_empty_view_is_the_ground_of_the_scene_to_come(qtbot: QtBot) -> None:
    view = small_view(qtbot, 200, 150)
    before, after = view.grab().toImage(), view.picture()
    for x, y in ((100, 75), (5, 5), (20, 140), (100, 5)):
        shades = [before.pixelColor(x, y), after.pixelColor(x, y)]
        assert max(abs(a - b) for a, b in zip(*(each.getRgb() for each in shades), strict=True)) <= 3
    view.close_view()


def test_what_waits_for_the_first_paint_is_done_once_whether_it_comes_or_not(
    qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[str] = []
    shown, hidden = QWidget(), QWidget()
    for each in (shown, hidden):
        qtbot.addWidget(each)
    first_paint.when_painted(shown, lambda: done.append("shown"))
    monkeypatch.setattr(first_paint, "_PATIENCE", 50)
    first_paint.when_painted(hidden, lambda: done.append("hidden"))
    shown.show()
    assert done == []
    qtbot.waitUntil(lambda: len(done) == 2)
    shown.repaint()
    qtbot.wait(80)
    assert sorted(done) == ["hidden", "shown"]


def test_what_is_spared_from_the_search_is_no_garbage(qtbot: QtBot) -> None:
    parent = QWidget()
    qtbot.addWidget(parent)
    housekeeping = GarbageCollection(parent)
    ring = Ring()
    ring.itself, gone = ring, weakref.ref(ring)
    del ring
    housekeeping.spare()
    housekeeping.close()
    assert gone() is None


class Ring:
    """Something that only the search for garbage takes away."""

    itself: Ring


def test_a_window_that_is_closed_at_once_begins_nothing(qtbot: QtBot) -> None:
    begun: list[str] = []
    window = QWidget()
    qtbot.addWidget(window)
    first_paint.when_painted(window, lambda: begun.append("libraries"))
    window.show()
    QApplication.sendEvent(window, QPaintEvent(window.rect()))
    window.close()
    qtbot.wait(50)
    assert begun == []
    jobs = Jobs(window)
    jobs.close()
    job = jobs.run("Loading", lambda _: begun.append("job"), lambda _: None)
    in_pieces = jobs.run_pieces("Drawing", (begun.append("piece") for _ in range(1)), lambda _: None)
    qtbot.wait(20)
    assert not job.wanted
    assert not in_pieces.wanted
    assert begun == []
    assert jobs.at_work() == []
