"""The pointer over the 3D view: a turntable by drags, lines and pins under it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QPointF, Qt, Signal
from PySide6.QtGui import QMouseEvent, QNativeGestureEvent, QWheelEvent
from PySide6.QtWidgets import QWidget

from app.gui.viewport.mouse_bindings import ORBIT, PAN, ZOOM, chosen_gestures
from app.gui.viewport.overlay import Overlay
from app.rendering.camera import View
from core.geometry.mesh import Floats

if TYPE_CHECKING:
    from app.rendering.scene import Scene


FINE = 0.1
"""What is left of a pull while Shift is held [1]."""


class BandHandle(QObject):
    """What a pointer pulls at; ``cursor_of`` tells how it looks over a band, None where that is not pulled.

    ``taken`` names the band, ``dragged`` carries how far it went up since [px], a tenth of it with Shift, and
    whether that was held; ``dropped`` says that the hand is open again.
    """

    taken = Signal(str)
    dragged = Signal(float, bool)
    dropped = Signal()

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.cursor_of: Callable[[str], Qt.CursorShape | None] = lambda _: None
        self._name = ""

    def reach(self, name: str) -> bool:
        """Prepare to drag a band; returns whether it can be dragged."""
        self._name = name if name and self.cursor_of(name) is not None else ""
        return bool(self._name)

    def takes(self, way: QPointF) -> bool:
        """Take what was reached for, if the pointer goes up or down; going across turns the body."""
        held = bool(self._name) and abs(way.y()) > abs(way.x())
        if held:
            self.taken.emit(self._name)
        return held

    def pull(self, step: QPointF, held: Qt.KeyboardModifier) -> None:
        """Drag by some pixels, y downwards."""
        fine = bool(held & Qt.KeyboardModifier.ShiftModifier)
        self.dragged.emit(-step.y() * (FINE if fine else 1.0), fine)


TURN = 0.4
"""Degrees that the body turns for each pixel that the pointer is dragged."""

NOTCH = 1.15
"""How much larger a notch of the wheel makes the body."""

NOTCH_PIXELS, WHEEL_PIXELS = 30.0, 40.0
"""Pixels of a drag that scale as much as a notch of the wheel, and of a notch that turns or moves."""

_NONE = Qt.KeyboardModifier.NoModifier
_HELD = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.ControlModifier
_CLICK = 3.0  # pixels that the pointer may stray within a click


class PointerInteraction(QObject):
    """Reads the pointer over a canvas, from when it can ``look_at`` a scene on it.

    ``turned`` asks for a view from the same distance, ``shifted`` for one that frames something else, and
    ``centred`` for a glide to a new centre of turning; the other signals are the viewport's. Whoever lets
    bands be pulled finds ``band_grip`` among the children of the viewport.
    """

    turned = Signal(View)
    shifted = Signal(View)
    centred = Signal(View)
    band_clicked = Signal(str)
    band_hovered = Signal(str)
    pin_pressed = Signal(str)
    pin_moved = Signal(str, object)
    pin_released = Signal(str)
    pin_hovered = Signal(str)

    def __init__(self, canvas: QWidget, overlay: Overlay) -> None:
        super().__init__(canvas)
        self._canvas = canvas
        self._overlay = overlay
        self.band_grip = BandHandle(self)
        self._pressed = QPointF()
        self._last = QPointF()
        self._grip = self._drags = ""
        self._pin = ""
        self._hovered = self._hovered_pin = ""
        self._reads = False
        # Now, though there is no scene yet: what listens to the canvas after this one comes before it.
        canvas.installEventFilter(self)

    def look_at(self, scene: Scene) -> None:
        """Read the pointer over this scene from now on."""
        self._scene, self._reads = scene, True

    def let_go(self) -> None:
        """Read the pointer no longer."""
        self._canvas.removeEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Take the pointer over the canvas."""
        if watched is not self._canvas or not self._reads:
            return super().eventFilter(watched, event)
        kind = event.type()
        handlers: dict[QEvent.Type, Callable[..., None]] = {
            QEvent.Type.MouseButtonPress: self._press,
            QEvent.Type.MouseMove: self._drag,
            QEvent.Type.MouseButtonRelease: self._release,
            QEvent.Type.MouseButtonDblClick: self._centre,
            QEvent.Type.Wheel: self._wheel,
            QEvent.Type.NativeGesture: self._pinch,
            QEvent.Type.Leave: self._leave,
        }
        if kind not in handlers:
            return False
        handlers[kind](event)
        return True

    def _press(self, event: QMouseEvent) -> None:
        if self._is_other(event):
            return
        self._pressed = self._last = event.position()
        self._drags = chosen_gestures().of_drag(event.button(), event.modifiers())
        left, held = event.button() == Qt.MouseButton.LeftButton, event.modifiers() & _HELD
        plain = left and not held
        self._pin = self._overlay.pin_at(event.position()) if plain else ""
        reaches = left and not self._pin and held in (_NONE, Qt.KeyboardModifier.ShiftModifier)
        pulls = self.band_grip.reach(self._band_at(event.position()) if reaches else "")
        self._grip = "pin" if self._pin else "click" if plain or pulls else self._drags
        if self._pin:
            self.pin_pressed.emit(self._pin)

    def _drag(self, event: QMouseEvent) -> None:
        step = event.position() - self._last
        if self._grip == "click" and (event.position() - self._pressed).manhattanLength() > _CLICK:
            self._grip = "band" if self.band_grip.takes(event.position() - self._pressed) else self._drags
        if self._grip in (ORBIT, PAN, ZOOM):
            self._move(self._grip, step, self._pressed)
        elif self._grip == "pin" and (event.position() - self._pressed).manhattanLength() > _CLICK:
            self._drag_pin(event.position())
        elif self._grip == "band":
            self.band_grip.pull(step, event.modifiers())
        elif not self._grip:
            self._hover(event.position())
        if self._grip != "click":
            self._last = event.position()

    def _move(self, act: str, step: QPointF, at: QPointF) -> None:
        """Turn, move or scale what is seen by a drag of so many pixels, about the place it began at."""
        view = self._scene.view
        if act == ORBIT:
            self.turned.emit(view.orbit(-TURN * step.x(), TURN * step.y()))
        elif act == PAN:
            self.shifted.emit(view.pan(step.x(), step.y(), self._canvas.height()))
        else:
            self._zoom(-step.y() / NOTCH_PIXELS, at)

    def _release(self, event: QMouseEvent) -> None:
        if self._is_other(event):
            return
        if self._grip == "click":
            name = self._band_at(event.position())
            if name:
                self.band_clicked.emit(name)
        if self._grip == "pin":
            self.pin_released.emit(self._pin)
        if self._grip == "band":
            self.band_grip.dropped.emit()
        self._grip = self._pin = ""

    def _is_other(self, event: QMouseEvent) -> bool:
        """Return whether this is not the button of the hand that holds a pin or a band: it would lose it."""
        return self._grip in ("pin", "band") and event.button() != Qt.MouseButton.LeftButton

    def _centre(self, event: QMouseEvent) -> None:
        """Make the place under the pointer the centre of turning."""
        place = self._skin_at(event.position())
        if place is not None and event.button() == Qt.MouseButton.LeftButton:
            self.centred.emit(self._scene.view.centred(place))

    def _wheel(self, event: QWheelEvent) -> None:
        act, turned = chosen_gestures().of_wheel(event.modifiers()), event.angleDelta()
        if act == ZOOM:
            # With Shift or Alt held some systems turn the wheel sideways.
            self._zoom((turned.y() or turned.x()) / 120.0, event.position())
        else:
            self._move(act, QPointF(turned) * WHEEL_PIXELS / 120.0, event.position())

    def _pinch(self, event: QNativeGestureEvent) -> None:
        """Scale by two fingers that move apart on a trackpad."""
        if event.gestureType() == Qt.NativeGestureType.ZoomNativeGesture:
            self._zoom(math.log(max(1.0 + event.value(), 0.1), NOTCH), event.position())

    def _zoom(self, notches: float, at: QPointF) -> None:
        half = self._canvas.height() / 2.0
        x, y = (at.x() - self._canvas.width() / 2.0) / half, (half - at.y()) / half
        self.shifted.emit(self._scene.view.zoom(NOTCH**notches, x, y))

    def _leave(self, event: QEvent) -> None:
        self._set_hovered("")

    def _hover(self, place: QPointF) -> None:
        pin = self._overlay.pin_at(place)
        name = "" if pin else self._band_at(place)
        shape = Qt.CursorShape.PointingHandCursor if pin or name else Qt.CursorShape.ArrowCursor
        pulled = self.band_grip.cursor_of(name) if name else None
        self._canvas.setCursor(shape if pulled is None else pulled)
        self._set_hovered(name, pin)

    def _set_hovered(self, name: str, pin: str = "") -> None:
        if name != self._hovered:
            self._hovered = name
            self.band_hovered.emit(name)
        if pin != self._hovered_pin:
            self._hovered_pin = pin
            self.pin_hovered.emit(pin)

    def skin_at(self, place: QPointF) -> Floats | None:
        """Return the place of the body at rest, shape (3,) [mm], that is seen at a pixel, or None."""
        skin = self._skin_at(place)
        return None if skin is None else self._scene.at_rest(skin[None])[0]

    def _drag_pin(self, place: QPointF) -> None:
        skin = self.skin_at(place)
        if skin is not None:
            self.pin_moved.emit(self._pin, skin)

    def _band_at(self, place: QPointF) -> str:
        return self._scene.band_at(place.x(), place.y(), self._canvas.width(), self._canvas.height())

    def _skin_at(self, place: QPointF) -> Floats | None:
        view = self._scene.view
        start, sight = view.ray(place.x(), place.y(), self._canvas.width(), self._canvas.height())
        return self._scene.hit_body(start, start + 3.0 * view.distance * sight)
