"""3D view as a widget: scene, camera moves by pointer and keys, rendering on demand."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QEasingCurve, QEvent, QObject, QPointF, Qt, QTimer, QVariantAnimation, Signal
from PySide6.QtGui import QImage, QResizeEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.gui.theme.stylesheet import tokens_of
from app.gui.viewport.canvas import Canvas
from app.gui.viewport.interaction import PointerInteraction
from app.gui.viewport.labels import Labels
from app.gui.viewport.overlay import Overlay, Pin
from app.rendering.appearance import CLAY
from app.rendering.camera import View, framing_points
from core.geometry.mesh import Floats, Points

if TYPE_CHECKING:
    from app.rendering.scene import Scene


GLIDE = 220
"""Duration of a move to another view [ms]."""


REST = 250
"""Stillness after which the picture is drawn smooth [ms]."""

_HEARD = ("band_clicked", "band_hovered", "pin_pressed", "pin_moved", "pin_released", "pin_hovered")


class CameraAnimation(QVariantAnimation):
    """Says by ``passed`` which views are seen on the way."""

    passed = Signal(View)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.setDuration(GLIDE)
        self.setEasingCurve(QEasingCurve.Type.OutCubic)
        self.setStartValue(0.0)
        self.setEndValue(1.0)
        self._ends = (View(), View())
        self.valueChanged.connect(lambda part: self.passed.emit(self._ends[0].towards(self._ends[1], part)))

    def go(self, start: View, end: View) -> None:
        """Start an animation."""
        self._ends = start, end
        self.start()

    @property
    def end(self) -> View:
        """Return the view that the last way leads to."""
        return self._ends[1]

    @property
    def running(self) -> bool:
        """Return whether the camera is on its way."""
        return self.state() == QVariantAnimation.State.Running


class Viewport(QWidget):
    """The 3D view with its scene and the overlay of pins and labels.

    ``band_clicked`` and ``band_hovered`` name a line (hovering off all lines: an empty name).
    ``pin_pressed``, ``pin_moved`` (name, place (3,) [mm] on the body at rest) and ``pin_released`` follow
    a dragged pin, ``pin_hovered`` the pointer (off all pins: an empty name). ``view_changed`` says that the
    camera has moved. Belongs to the thread of the window.

    The scene is made when it is first asked for; until then ``view`` is where it will be seen from.
    """

    band_clicked = Signal(str)
    band_hovered = Signal(str)
    pin_pressed = Signal(str)
    pin_moved = Signal(str, object)
    pin_released = Signal(str)
    pin_hovered = Signal(str)
    view_changed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.motion = True
        self._view = View()  # until there is a scene
        self._material = CLAY
        self._canvas = Canvas(self)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._canvas)
        self.overlay = Overlay(self._canvas)
        self._labels = Labels(self.overlay)
        self._pointer = PointerInteraction(self._canvas, self.overlay)
        self._scene: Scene | None = None
        self._rest = QTimer(self, singleShot=True, interval=REST)
        self._rest.timeout.connect(self._refine)
        self._glide = CameraAnimation(self)
        self._glide.passed.connect(self._look_from)
        self._fit: Callable[[float], View] | None = None
        self._open = True
        self._listen()

    def _listen(self) -> None:
        pointer = self._pointer
        pointer.turned.connect(self._turn)
        pointer.shifted.connect(self._shift)
        pointer.centred.connect(self.glide_to)
        pointer.band_hovered.connect(self.hover_band)
        for name in _HEARD:
            getattr(pointer, name).connect(getattr(self, name))

    @property
    def scene(self) -> Scene:
        """Return all that is drawn in 3D."""
        return self._scene or self._make_scene()

    @property
    def shows_body(self) -> bool:
        """Return whether there is a scene with a body."""
        return self._scene is not None and self._scene.body is not None

    def make(self) -> None:
        """Make the scene now, if it is not there."""
        self._scene = self.scene

    def _make_scene(self) -> Scene:
        plotter = self._canvas.make_plotter()
        from app.gui.viewport.antialiasing import Antialiasing  # noqa: PLC0415 (so does this)
        from app.rendering.scene import Scene  # noqa: PLC0415 (brings VTK along)

        self._scene = scene = Scene(plotter, tokens_of(self).dark, self.devicePixelRatioF())
        scene.set_camera(self._view)
        scene.set_material(self._material)
        self._canvas.draw_still(scene.static_actors)
        self._smoothing = Antialiasing(self._canvas, scene)
        self._pointer.look_at(scene)
        self.request_draw()
        return scene

    def forward_to(self, other: Viewport) -> None:
        """Let what the pointer does here be heard as if it were done on another viewport."""
        for name in _HEARD:
            getattr(self, name).connect(getattr(other, name))

    # -- drawing

    def request_draw(self) -> None:
        """Draw once when the event loop next turns, however often this is asked for."""
        if not self._open or self._scene is None:
            return
        self._smoothing.use("")
        self._rest.start()
        self._labels.place(self._scene)
        self._canvas.draw()

    def paint_later(self) -> None:
        """Let what the hand has done meanwhile go first: a large body takes its time to make and to paint."""
        self.setUpdatesEnabled(False)
        QTimer.singleShot(1, self, self.paint_at_once)

    def paint_at_once(self) -> None:
        """Wait for the hand no longer: a picture of what is not painted yet would be empty."""
        self.setUpdatesEnabled(True)

    def picture(self, labels: bool = True, fine: bool = True) -> QImage:
        """Return what is seen [device pixels], with its labels or without, at its best or as last drawn."""
        self.paint_at_once()
        self.make()
        if fine:
            self.request_draw()
            self._rest.stop()
            self._smoothing.use("ssaa")
        self.overlay.setVisible(labels)
        image = self.grab().toImage()
        self.overlay.show()
        return image

    def _refine(self) -> None:
        """Draw once more without stairs at the outlines, which is too slow while things move."""
        # FXAA looks nearly as good for a third of the time, but VTK has none where it draws by EGL.
        self._smoothing.use("ssaa" if self.scene.plotter.ren_win.IsA("vtkEGLRenderWindow") else "fxaa")
        self._canvas.draw()

    def close_view(self) -> None:
        """Release all 3D objects before the window closes. A second call does nothing."""
        if self._open:
            self._open = False
            self._glide.stop()
            self._rest.stop()
            self._pointer.let_go()
            self._canvas.let_go()
            if self._scene is not None:
                self._scene.plotter.close()

    # -- what is shown over the view

    def select_band(self, name: str | None) -> None:
        """Draw a white casing round one line, or round none."""
        self.scene.mark_bands(name or "", self.scene.bands.hovered)
        self.request_draw()

    def hover_band(self, name: str | None) -> None:
        """Draw a faint casing round one line, as the pointer does, or round none."""
        self.scene.mark_bands(self.scene.bands.selected, name or "")
        self.request_draw()

    def label_band(self, name: str | None, text: str = "", detail: str = "") -> None:
        """Write beside a line, or take the label away, when it is drawn the next time."""
        self._labels.set_band(name or "", text, detail)

    def set_pins(self, pins: Iterable[Pin], selected: str = "") -> None:
        """Show landmarks, at their places on the body at rest, as pins with labels, one of them selected."""
        self._labels.set_pins(pins, selected)
        self.request_draw()

    def watch_keys(self, watcher: QObject) -> None:
        """Let ``watcher`` filter the keys that are pressed while the view has the focus."""
        for each in (self, self._canvas):
            each.installEventFilter(watcher)

    def skin_at(self, place: QPointF) -> Floats | None:
        """Return the place of the body at rest, shape (3,) [mm], that is seen at a pixel, or None."""
        return None if self._scene is None else self._pointer.skin_at(place)

    def set_dark(self, dark: bool) -> None:
        """Repaint for the light or the dark theme."""
        if self._scene is not None:
            self._scene.set_dark(dark)
        self.request_draw()

    def set_material(self, material: str) -> None:
        """Paint the body as one of ``app.rendering.appearance.MATERIALS``."""
        self._material = material
        if self._scene is not None:
            self._scene.set_material(material)
        self.request_draw()

    # -- the camera

    @property
    def view(self) -> View:
        """Return the view of the scene."""
        return self._view if self._scene is None else self._scene.view

    @property
    def heading(self) -> View:
        """Return the target view of the camera, or the present one."""
        return self._glide.end if self._glide.running else self.view

    def set_view(self, name: str) -> None:
        """Move the camera to the side called ``name`` in ``app.rendering.camera.VIEWS``."""
        self._go(self.view.named(name))

    def set_parallel(self, parallel: bool) -> None:
        """Switch between parallel and perspective projection."""
        self._look_from(replace(self.view, parallel=parallel))

    def look_from(self, view: View) -> None:
        """Copy the camera of another viewport."""
        here = self.view
        if view != here:
            if (view.focus, view.distance) != (here.focus, here.distance):
                self._fit = None
            self._turn(view)

    def frame_all(self) -> None:
        """Glide to where the whole body is in the picture, and keep it there when the size changes."""
        self._fit = self.scene.framing_all
        self._go(self._fit(self._aspect()))

    def frame_points(self, points: Points, *margin: float) -> None:
        """Glide to places on the body, shape (k, 3) [mm], and keep them framed when the size changes.

        A ``margin`` [mm] round them is seen, or the usual one.
        """
        self._fit = lambda aspect: framing_points(self.scene.view, points, aspect, *margin)
        self._go(self._fit(self._aspect()))

    def glide_to(self, view: View) -> None:
        """Move the camera to another view."""
        self._fit = None
        self._go(view)

    def frame_bust(self) -> None:
        """Move the camera to the bust, and keep it framed when the size changes."""
        self._fit = self.scene.framing_bust
        self._go(self._fit(self._aspect()))

    def _go(self, view: View) -> None:
        self._glide.stop()
        if self.motion and self.isVisible() and self._scene is not None:
            self._glide.go(self.view, view)
        else:
            self._look_from(view)

    def _look_from(self, view: View) -> None:
        if self._scene is None:
            self._view = view
        else:
            self._scene.set_camera(view)
        self._moved()

    def _moved(self) -> None:
        self.request_draw()
        self.view_changed.emit()

    def _turn(self, view: View) -> None:
        self._glide.stop()
        self._look_from(view)

    def _shift(self, view: View) -> None:
        self._fit = None
        self._turn(view)

    def _aspect(self) -> float:
        return self.width() / max(self.height(), 1)

    # -- Qt's events

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Keep what was framed in the frame."""
        super().resizeEvent(event)
        self.overlay.setGeometry(self._canvas.rect())
        if self._fit is not None and self._open:
            self.scene.set_camera(self._fit(self._aspect()))
        self.request_draw()

    def changeEvent(self, event: QEvent) -> None:  # noqa: N802
        """Handle changes of the theme of the window."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and self._open:
            self.set_dark(tokens_of(self).dark)
