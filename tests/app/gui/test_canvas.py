"""What VTK draws in: with a graphics card and without one the window shows the same picture."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from PySide6.QtGui import QGuiApplication, QImage
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from app.gui.theme.stylesheet import apply_theme
from app.gui.viewport import canvas
from app.gui.viewport.viewport import Viewport
from core.geometry.mesh import Mesh


def picture(qtbot: QtBot) -> np.ndarray:
    """The colours of a ball in a view of its own, (height, width, 3)."""
    app = QApplication.instance()
    assert isinstance(app, QApplication)
    apply_theme(app, dark=False)
    view = Viewport()
    qtbot.addWidget(view)
    view.resize(300, 200)
    view.show()
    qtbot.waitExposed(view)
    # The scene comes to a window that is seen already.
    window = view.winId()
    assert view.scene.body is None
    qtbot.wait(50)
    assert view.winId() == window, "no new window, which would be seen"
    assert view._canvas.painted is not canvas.has_graphics_card()
    ball = pv.Icosphere(radius=150.0, nsub=4)
    view.scene.show_body(Mesh(ball.points + np.array([120.0, 0.0, 40.0]), ball.regular_faces))
    view.motion = False
    view.frame_all()
    image = view.picture().convertToFormat(QImage.Format.Format_RGBX8888)
    view.close_view()
    colours = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.width(), 4)
    return colours[..., :3].astype(float)


def test_with_and_without_a_graphics_card_the_picture_is_the_same(
    qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    if QGuiApplication.platformName() == "offscreen":
        pytest.skip("Qt has no OpenGL there")
    pictures = []
    for card in (True, False):
        monkeypatch.setattr(canvas, "has_graphics_card", lambda card=card: card)
        pictures.append(picture(qtbot))
    assert np.abs(pictures[0] - pictures[1]).max() <= 2.0


def test_only_what_moved_in_3d_is_drawn_anew_without_a_card(
    qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(canvas, "has_graphics_card", lambda: False)
    view = Viewport()
    qtbot.addWidget(view)
    view.resize(300, 200)
    drawn: list[str] = []
    draw = view._canvas._render
    monkeypatch.setattr(view._canvas, "_render", lambda: drawn.append("drawn") or draw())
    view.show()
    qtbot.waitExposed(view)
    assert view.scene.body is None
    qtbot.waitUntil(lambda: bool(drawn))
    while drawn:  # until all of its beginning has been painted
        drawn.clear()
        qtbot.wait(50)
    view.overlay.repaint()
    assert drawn == []
    view.request_draw()
    qtbot.waitUntil(lambda: drawn == ["drawn"])
    view.close_view()
