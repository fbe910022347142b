"""The landmarks as pins on the view: which are shown, which is selected, which is being dragged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from app.gui.viewport.overlay import Pin
from app.gui.viewport.viewport import Viewport
from app.i18n.catalog import tr
from app.presenters.landmarks import PINNED, Spot, kind_of, landmark_title, landmark_view
from core.geometry.mesh import Points
from core.landmarks.types import Landmark


class LandmarkPins:
    """Keeps the pins of every viewport on which the body of the document is seen, the first one in front.

    ``accepted`` are places that contradict their rules and have been found right.
    """

    def __init__(self, viewports: Sequence[Viewport]) -> None:
        self._viewports = tuple(viewports)
        self._landmarks: Mapping[str, Landmark] = {}
        self.accepted: set[Spot] = set()
        self._shown = False
        self._selected = ""
        self._hovered = ""
        self._carried: Mapping[str, Points] = {}
        self._offered: tuple[str, ...] | None = None

    def set_viewports(self, viewports: Sequence[Viewport]) -> None:
        """Show the pins on these from now on."""
        self._viewports = tuple(viewports)
        self._show()

    def set_landmarks(self, landmarks: Mapping[str, Landmark]) -> None:
        """Show these landmarks; a pin that is being carried stays where it is."""
        if landmarks is not self._landmarks:
            self._landmarks = landmarks
            self._show()

    def set_shown(self, shown: bool) -> None:
        """Show or hide all pins."""
        self._shown = shown
        self._show()

    def select(self, name: str) -> None:
        """Mark one landmark's pin, and draw the curve that it was read from."""
        self._selected = name
        self._show()

    def hover(self, name: str) -> None:
        """Draw the curve that a landmark was read from instead of the selected one's; no name ends it."""
        if name != self._hovered:
            self._hovered = name
            self._show()

    def offer(self, chosen: tuple[str, ...] | None) -> None:
        """Show every landmark in front, to choose from; some are ``chosen`` already. None ends it."""
        if chosen != self._offered:
            self._offered = chosen
            self._show()

    def carry(self, places: Mapping[str, Points]) -> None:
        """Let pins follow the pointer to places of the body at rest, each of shape (3,) [mm]."""
        self._carried = dict(places)
        self._show()

    def put(self, name: str) -> None:
        """Place the pin of a landmark that was not found in the middle of the view, to be carried away."""
        place = self._viewports[0].skin_at(self._viewports[0].rect().toRectF().center())
        if place is not None:
            self._selected, self._carried = name, {name: place}
            self._show()

    def chosen(self) -> tuple[str, Points | None]:
        """Return the selected pin and where it is, shape (3,) [mm], None if it is not shown."""
        name = self._selected
        found = self._landmarks.get(name)
        place = self._carried.get(name, None if found is None else found.position)
        return name, place if self._shown else None

    def drop_back(self) -> None:
        """Place carried pins back to where their landmarks are."""
        if self._carried:
            self._carried = {}
            self._show()

    def _show(self) -> None:
        """Show the pins of the bust and of the selected landmark, with the curve that this was read from."""
        if self._offered is not None:
            self._show_offered(self._offered)
            return
        found = self._landmarks if self._shown else {}
        pins = {
            mark.name: self._pin(mark)
            for mark in found.values()
            if kind_of(mark.name) in PINNED or mark.by_hand or mark.name == self._selected
        }
        for name, place in self._carried.items() if self._shown else ():
            pins[name] = Pin(name, landmark_title(name), place, "accent", tr("manual"))
        chosen = found.get(self._hovered or self._selected) if not self._carried else None
        for viewport in self._viewports:
            if viewport.shows_body:
                viewport.scene.show_trace(chosen.evidence if chosen else np.empty((0, 3)))
            viewport.set_pins(pins.values(), self._selected)

    def _show_offered(self, chosen: tuple[str, ...]) -> None:
        """Show all pins on the first viewport alone: there is the hand that chooses."""
        pins = [
            Pin(name, landmark_title(name), mark.position, "accent" if name in chosen else "control", "")
            for name, mark in self._landmarks.items()
        ]
        for viewport in self._viewports:
            if viewport.shows_body:
                viewport.scene.show_trace(np.empty((0, 3)))
            viewport.set_pins(pins if viewport is self._viewports[0] else (), chosen[-1] if chosen else "")

    def _pin(self, mark: Landmark) -> Pin:
        view = landmark_view(mark.name, mark, self.accepted)
        return Pin(mark.name, view.title, mark.position, view.tone, view.state)
