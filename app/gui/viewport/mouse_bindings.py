"""Mouse bindings of the 3D view, after those of other programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from PySide6.QtCore import Qt

from app.gui.session.settings import get_setting
from app.i18n.catalog import tr

ORBIT, PAN, ZOOM = "orbit", "pan", "zoom"

_LEFT, _MIDDLE, _RIGHT = Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton, Qt.MouseButton.RightButton
_NONE, _SHIFT, _CTRL = (
    Qt.KeyboardModifier.NoModifier,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.ControlModifier,
)
_HELD = _SHIFT | _CTRL


@dataclass(frozen=True)
class MouseBindings:
    """What a drag does by its button and the key held, and what the wheel does by the key held."""

    drags: Mapping[tuple[Qt.MouseButton, Qt.KeyboardModifier], str]
    wheel: Mapping[Qt.KeyboardModifier, str]

    def of_drag(self, button: Qt.MouseButton, held: Qt.KeyboardModifier) -> str:
        """Return orbit, pan or zoom, or an empty text where a drag does nothing."""
        return self.drags.get((button, held & _HELD), "")

    def of_wheel(self, held: Qt.KeyboardModifier) -> str:
        """Return orbit, pan or zoom."""
        return self.wheel.get(held & _HELD, ZOOM)


_WITH_LEFT = {(_LEFT, _NONE): ORBIT, (_LEFT, _SHIFT): PAN, (_LEFT, _CTRL): ZOOM}

PRESETS = {
    "busk": MouseBindings({**_WITH_LEFT, (_MIDDLE, _NONE): PAN, (_RIGHT, _NONE): ZOOM}, {_NONE: ZOOM}),
    "cad": MouseBindings(
        {(_LEFT, _NONE): ORBIT, (_MIDDLE, _NONE): ORBIT, (_MIDDLE, _CTRL): PAN, (_MIDDLE, _SHIFT): ZOOM}
        | {(_RIGHT, _NONE): PAN},
        {_NONE: ZOOM},
    ),
    "blender": MouseBindings(
        {(_LEFT, _NONE): ORBIT, (_MIDDLE, _NONE): ORBIT, (_MIDDLE, _SHIFT): PAN, (_MIDDLE, _CTRL): ZOOM},
        {_NONE: ZOOM, _SHIFT: PAN},
    ),
    "trackpad": MouseBindings(_WITH_LEFT, {_NONE: ORBIT, _SHIFT: PAN, _CTRL: ZOOM}),
}
"""The presets by name."""


def chosen_gestures() -> MouseBindings:
    """Return the gestures of the preset that the user has wished for."""
    return PRESETS.get(get_setting("mouse"), PRESETS["busk"])


def gestures_in_words(gestures: MouseBindings) -> list[tuple[str, str]]:
    """Return what a hand does in the view and what comes of it, ready to read."""
    acts = {ORBIT: tr("Rotate body"), PAN: tr("Move body"), ZOOM: tr("Zoom")}
    buttons = {_LEFT: tr("Left drag"), _MIDDLE: tr("Middle drag"), _RIGHT: tr("Right drag")}
    keys = {_NONE: "", _SHIFT: "Shift+", _CTRL: "Ctrl+"}
    drags = [(keys[held] + buttons[button], acts[act]) for (button, held), act in gestures.drags.items()]
    wheel = [(keys[held] + tr("Wheel"), acts[act]) for held, act in gestures.wheel.items()]
    return [
        *drags,
        *wheel,
        (tr("Double-click"), tr("Set rotation centre")),
        (tr("Click"), tr("Select the line of a band")),
        (f"{tr('Left drag')} ↑ ↓", tr("Selected band: shorten, lengthen")),
        (tr("Left drag"), tr("Section handle: move plane")),
        (f"Shift+{tr('Left drag')}", tr("Dragged band or section: fine steps (1/10)")),
    ]
