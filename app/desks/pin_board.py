"""The landmarks as pins on the view: which are shown, which is selected, which is being dragged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from app.desks.present_scan import PINNED, kind_of, landmark_title
from app.showing.overlay import Pin
from app.showing.viewport import Viewport
from core.landmark import Landmark
from core.mesh import Points


class PinBoard:
    """Keeps the pins of every viewport on which the body of the document is seen, the first one in front."""

    def __init__(self, viewports: Sequence[Viewport]) -> None:
        self._viewports = tuple(viewports)
        self._landmarks: Mapping[str, Landmark] = {}
        self._shown = False
        self._selected = ""
        self._dragged: tuple[str, Points] | None = None

    def set_viewports(self, viewports: Sequence[Viewport]) -> None:
        """Show the pins on these from now on."""
        self._viewports = tuple(viewports)
        self._show()

    def set_landmarks(self, landmarks: Mapping[str, Landmark]) -> None:
        """Show these landmarks; a pin that is being dragged drops back."""
        if landmarks is not self._landmarks:
            self._landmarks, self._dragged = landmarks, None
            self._show()

    def set_shown(self, shown: bool) -> None:
        """Show or hide all pins."""
        self._shown = shown
        self._show()

    def select(self, name: str) -> None:
        """Mark one landmark's pin, and draw the curve that it was read from."""
        self._selected = name
        self._show()

    def drag(self, name: str, place: Points) -> None:
        """Let a pin follow the pointer to a place of the body at rest, shape (3,) [mm]."""
        self._dragged = name, place
        self._show()

    def put(self, name: str) -> None:
        """Put the pin of a landmark that was not found in the middle of the view, to be dragged away."""
        place = self._viewports[0].skin_in_the_middle()
        if place is not None:
            self._selected, self._dragged = name, (name, place)
            self._show()

    def dropped(self) -> tuple[str, Points] | None:
        """Return which pin was let go and where, if it was moved."""
        return self._dragged

    def drop_back(self) -> None:
        """Put a dragged pin back to where its landmark is."""
        if self._dragged is not None:
            self._dragged = None
            self._show()

    def _show(self) -> None:
        """Show the pins of the bust and of the selected landmark, with the curve that this was read from."""
        found = self._landmarks if self._shown else {}
        pins = {
            mark.name: Pin(mark.name, landmark_title(mark.name), mark.position, mark.confidence)
            for mark in found.values()
            if kind_of(mark.name) in PINNED or mark.by_hand or mark.name == self._selected
        }
        if self._shown and self._dragged is not None:
            name, place = self._dragged
            sure = found[name].confidence if name in found else 0.0
            pins[name] = Pin(name, landmark_title(name), place, sure)
        chosen = None if self._dragged else found.get(self._selected)
        for viewport in self._viewports:
            if viewport.scene.body is not None:
                viewport.scene.show_trace(chosen.evidence if chosen else np.empty((0, 3)))
            viewport.set_pins(pins.values(), self._selected)
