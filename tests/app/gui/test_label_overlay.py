"""Labels over the 3D view: they keep apart, stay inside, and follow the camera."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from PySide6.QtCore import QPointF
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from app.gui.theme.stylesheet import apply_theme
from app.gui.viewport.overlay import MARGIN, SPACING, Overlay, Pin, spread
from app.rendering.camera import View

WIDTH, HEIGHT = 500, 300


@pytest.fixture
def overlay(qtbot: QtBot) -> Iterator[Overlay]:
    app = QApplication.instance()
    assert isinstance(app, QApplication)
    apply_theme(app, dark=False)
    parent = QWidget()
    qtbot.addWidget(parent)
    overlay = Overlay(parent)
    overlay.resize(WIDTH, HEIGHT)
    yield overlay
    parent.close()


def crowd() -> list[Pin]:
    places = [np.array([side * 60.0, -130.0, z]) for side in (-1, 1) for z in (0.0, 4.0, 8.0)]
    return [Pin(str(i), "Lowest point", place, "ok", "90 %") for i, place in enumerate(places)]


@pytest.mark.parametrize("view", [View(), View(distance=300.0), View(focus=(0.0, 0.0, 300.0))])
def test_labels_of_crowded_pins_keep_apart_and_inside(overlay: Overlay, view: View) -> None:
    overlay.set_pins(crowd())
    overlay.follow(view, ())
    pills = overlay.pills()
    for column in (pills[:3], pills[3:]):
        gaps = np.diff(sorted(pill.center().y() for pill in column))
        assert gaps.min() >= SPACING - 1e-9
    assert all(pill.left() >= MARGIN - 1e-9 and pill.right() <= WIDTH - MARGIN + 1e-9 for pill in pills)
    assert all(pill.top() >= MARGIN - 1e-9 and pill.bottom() <= HEIGHT - MARGIN + 1e-9 for pill in pills)


def test_labels_stand_on_the_side_of_their_pins(overlay: Overlay) -> None:
    overlay.set_pins(crowd())
    overlay.follow(View(), ())
    pills = overlay.pills()
    assert max(pill.right() for pill in pills[:3]) < WIDTH / 2 < min(pill.left() for pill in pills[3:])


def test_the_pointer_takes_hold_of_the_nearest_pin_only_nearby(overlay: Overlay) -> None:
    view = View(focus=(0.0, -130.0, 0.0))
    overlay.set_pins(crowd())
    overlay.follow(view, ())
    x, y, _ = view.to_picture(crowd()[5].position, WIDTH, HEIGHT)[0]
    assert overlay.pin_at(QPointF(x, y - 1.0)) == "5"
    assert overlay.pin_at(QPointF(x, y - 40.0)) == ""
    overlay.follow(view, ["3", "4", "5"])
    assert overlay.pin_at(QPointF(x, y)) == "", "it is behind the body"
    overlay.set_pins(crowd(), "5")
    assert overlay.pin_at(QPointF(x, y)) == "5", "it was selected by name"
    overlay.set_pins([])
    assert overlay.pin_at(QPointF(x, y)) == ""


def test_labels_spread_about_their_places_in_order() -> None:
    assert spread([100.0, 200.0], 0.0, 300.0) == [100.0, 200.0]
    assert spread([200.0, 100.0], 0.0, 300.0) == [200.0, 100.0]
    assert spread([100.0, 100.0], 0.0, 300.0) == [100.0 - SPACING / 2, 100.0 + SPACING / 2]
    assert spread([5.0, 5.0], 20.0, 300.0) == [20.0, 20.0 + SPACING]
    assert spread([299.0, 299.0], 0.0, 300.0) == [300.0 - SPACING, 300.0]
    assert spread([], 0.0, 300.0) == []
