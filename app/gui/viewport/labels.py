"""Pins and the label of a line, kept over their places in a scene."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from app.gui.viewport.overlay import BandLabel, Overlay, Pin

if TYPE_CHECKING:
    from app.rendering.scene import Scene


class Labels:
    """What is written over a scene; it is seen from when it is placed."""

    def __init__(self, overlay: Overlay) -> None:
        self._overlay = overlay
        self.band = ("", "", "")
        self._pins: tuple[Pin, ...] = ()
        self._selected = ""

    def set_band(self, name: str, text: str, detail: str) -> None:
        """Write beside a line; an empty or unknown name takes the label away."""
        self.band = name, text, detail

    def set_pins(self, pins: Iterable[Pin], selected: str) -> None:
        """Show landmarks, at their places on the body at rest, as pins with labels, one of them selected."""
        self._pins, self._selected = tuple(pins), selected

    def place(self, scene: Scene) -> None:
        """Let the pins ride on the skin, tell those behind the body, and keep the label at its line."""
        pins = self._pins
        if pins:
            places = scene.carried_points(np.array([pin.position for pin in pins]))
            pins = tuple(replace(pin, position=place) for pin, place in zip(pins, places, strict=True))
        self._overlay.set_pins(pins, self._selected)
        self._overlay.follow(scene.view, [pin.name for pin in pins if scene.hidden(pin.position)])
        self._overlay.set_band(self._label(scene))

    def _label(self, scene: Scene) -> BandLabel | None:
        name, text, detail = self.band
        if name not in scene.bands.names or not scene.is_visible("bands"):
            return None
        spine, _ = scene.bands.spine(name)
        return BandLabel(text, detail, scene.bands.colour(name), scene.band_anchor(name), spine)
