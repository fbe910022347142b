"""Map values of the shown bodies: the session's own, and variants."""

from __future__ import annotations

from typing import Protocol
from weakref import WeakKeyDictionary

from app.gui.features.maps.band_coloring import BandValues, pressures_on, pulls_on
from app.gui.viewport.body_view import BodyView
from app.gui.viewport.comparison import ViewComparison
from app.i18n.catalog import tr
from app.presenters.maps import BodyState, pressure_note
from core.garment.pressure_list import PressureList
from core.geometry.mesh import Floats
from core.pipeline.live_solver import Frame


class PressureSource(Protocol):
    """Gives the map of contact pressure."""

    @property
    def shown(self) -> PressureList | None:
        """Return the pressures beside the cut list."""
        ...

    def of(self, frame: Frame) -> PressureList | None:
        """Return the pressures of a frame, once they are known."""
        ...

    def missing(self, frame: Frame) -> str:
        """Return why there are none, or nothing."""
        ...


class SymmetrySource(Protocol):
    """Gives the note of the map Left and right."""

    def note(self, frame: Frame, after: bool) -> str:
        """Return the note on a frame."""
        ...


class WornSource(Protocol):
    """Gives the map of a worn scan, if there is one."""

    @property
    def worn(self) -> object:
        """Return the scan, or None."""
        ...

    def values(self, frame: Frame) -> Floats:
        """Return predicted less real at the moving vertices, (r,) [mm]."""
        ...

    def note(self, frame: Frame) -> str:
        """Return the note on a frame, or nothing."""
        ...


class MapValues:
    """Reads maps off the bodies that ``beside`` shows; ``now`` is the session's own, once there is one."""

    def __init__(
        self,
        beside: ViewComparison,
        pressure: PressureSource,
        even: SymmetrySource,
        worn: WornSource,
    ) -> None:
        self._beside, self._pressure, self._even, self._worn = beside, pressure, even, worn
        self.now: BodyState | None = None
        self._others: WeakKeyDictionary[BodyView, BodyState] = WeakKeyDictionary()
        self._pressed: WeakKeyDictionary[BodyState, PressureList | None] = WeakKeyDictionary()

    def take(self, frame: Frame) -> bool:
        """Set the frame; returns whether it is of another body or fit than the last one."""
        if self.now is not None and self.now.belongs_to(frame):
            self.now.follow(frame)
            return False
        self.now = BodyState(frame)
        return True

    def now_of(self, view: BodyView) -> BodyState | None:
        """Return what is read off one of the bodies."""
        if view in self._beside.live or view.frame is None:
            return self.now
        now = self._others.get(view)
        if now is None or now.frame is not view.frame:
            now = self._others[view] = BodyState(view.frame)
        return now

    def on_skin(self, name: str, now: BodyState) -> Floats:
        """Return the values of a map on the skin of one of the bodies, at its ``rows`` (k,) [mm, %]."""
        return self._worn.values(now.frame) if name == "worn" else now.values(name)

    def skin_note(self, name: str, frame: Frame, after: bool) -> str:
        """Return what is to be said first of a map on the skin, or nothing."""
        if name == "sides":
            return self._even.note(frame, after)
        return self._worn.note(frame) if name == "worn" else ""

    def on_bands(self, name: str, view: BodyView) -> BandValues:
        """Return the values of a map on the bands of one of the bodies, or those of its former shape."""
        bands, now = view.viewport.scene.bands, self.now_of(view)
        if now is None:
            return BandValues({})
        if name == "pull":
            return pulls_on(bands, now.pulls())
        known = self._pressure.of(now.frame)
        self._pressed[now] = listed = known or self._pressed.get(now)
        return pressures_on(bands, listed.worn if listed else {}, stale=known is None)

    def note(self, name: str, shown: BandValues) -> str:
        """Return what is to be said first of a map on the session's own bands, or nothing."""
        if name == "pressure":
            listed = None if self.now is None else self._pressed.get(self.now)
            missing = "" if self.now is None else self._pressure.missing(self.now.frame)
            return missing or pressure_note(listed, shown.stale)
        return "" if shown.values else tr("No active elastic line has tension.")
