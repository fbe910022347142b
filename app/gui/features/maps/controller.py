"""Maps of values on the body: which is shown, in what range, and what is pinned on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from app.gui.features.maps.band_coloring import BandPainter, BandValues
from app.gui.features.maps.legend import Legend, LegendPlacement
from app.gui.features.maps.values import MapValues, PressureSource, SymmetrySource, WornSource
from app.gui.viewport.body_view import BodyView
from app.gui.viewport.value_labels import ValueFlag, ValueFlags
from app.i18n.catalog import number
from app.i18n.lengths import length
from app.presenters.maps import (
    LEAST_OF_CUPS,
    LINE_MAPS,
    MAPS,
    BodyState,
    automatic_range,
    bridge_text,
    map_kinds,
    ramp_of,
)
from app.rendering.appearance import appearance_of
from app.rendering.camera import framing_place
from app.rendering.vertex_colors import Ramp
from core.geometry.mesh import Floats, Points
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.rendering.body_actor import BodyActor
    from app.rendering.scene import Scene


@dataclass(frozen=True)
class Pinned:
    """What a flag stands on: a vertex of the body, or a row of a line's band."""

    at: int
    line: str = ""


class MapsController(QObject):
    """Lay the map called ``name`` over the bodies that are seen; an empty name is none.

    ``chosen`` carries the name of the map that was chosen, or none.
    """

    chosen = Signal(str)

    def __init__(
        self, context: AppContext, pressures: PressureSource, symmetry: SymmetrySource, worn: WornSource
    ) -> None:
        super().__init__(context.session)
        self._context, self._view = context, context.view
        self._kinds = {kind.name: kind for kind in map_kinds()}
        self.name, self._last = "", MAPS[0]
        self._pressures, self._worn = pressures, worn
        self._seen = MapValues(self._view.beside, pressures, symmetry, worn)
        self.pinned: tuple[Pinned, ...] = ()
        self._flagged: tuple[Pinned, ...] = ()
        self._by_hand: dict[str, tuple[float, float]] = {}
        self._range, self._range_of = (0.0, 1.0), ""
        self._values: Floats = np.empty(0)
        self._on_bands: dict[BodyView, BandValues] = {}
        self._laid = False
        self._painted: WeakKeyDictionary[BodyActor, tuple[str, Ramp, bool]] = WeakKeyDictionary()
        self._painter = BandPainter()
        self.legend = Legend(list(self._kinds.values()), self._view)
        self.legend.hide()
        self._view.place(self.legend, "top-right", explains=True)
        self.flags = ValueFlags(self._view.viewport)
        self._place = LegendPlacement(self._view, self.legend, self.flags)
        self._connect()

    def _connect(self) -> None:
        self.legend.chosen.connect(self.choose)
        self.legend.range_set.connect(self.set_range)
        self.legend.range_freed.connect(self.free_range)
        self.legend.flags_cleared.connect(lambda: self._pin(()))
        # The view must have heard of the new theme before the map is painted anew.
        self.legend.theme_changed.connect(lambda: QTimer.singleShot(0, self, self.refresh))
        self.flags.pinned.connect(self.pin)
        self.flags.dragged.connect(self.unpin)
        tools = self._view.tools.actions_by_name
        tools["map"].triggered.connect(self.toggle)
        tools["next-map"].triggered.connect(self.cycle)
        # What the view shows of a frame is there before it is coloured.
        self._view.compared.connect(self.follow)

    @property
    def now(self) -> BodyState | None:
        """Return the values of the session's body, once a map was requested."""
        return self._seen.now

    # -- what is asked

    def toggle(self) -> None:
        """Take the map off, or lay the one that was seen last over the body again."""
        self.choose("" if self.name else self._last)

    def cycle(self) -> None:
        """Show the next map, and after the last one the first."""
        names = [name for name in MAPS if name != "worn" or self._worn.worn]
        self.choose(names[(names.index(self.name) + 1) % len(names) if self.name in names else 0])

    def choose(self, name: str) -> None:
        """Show a map by name, or none; what is pinned stays on its spot and tells the new map's value."""
        self.name = name
        if name in LINE_MAPS:
            self._view.set_layer("bands", True)
        if name:
            self._last = name
            self.legend.show_map(name)
        self.refresh()
        self.chosen.emit(name)

    def set_range(self, low: float, high: float) -> None:
        """Set the range of the shown map by hand."""
        self._by_hand[self.name] = low, high
        self.refresh()

    def free_range(self) -> None:
        """Let the range hold all values again."""
        self._by_hand.pop(self.name, None)
        self.refresh()

    def pin(self, place: Floats, line: str) -> None:
        """Pin the value at a place of the shown body, (3,) [mm], or of the line that lies there."""
        body = self._view.viewport.scene.body
        if self.now is None or body is None:
            return
        if line and self.name in LINE_MAPS:
            at = self._row_near(line, place)
            if at is not None:
                self._add(Pinned(at, line))
        elif not line and self.now.lies_on_skin(self.name):
            self._add(Pinned(_nearest(body.shown_points, place)))

    def _add(self, pinned: Pinned) -> None:
        if pinned not in self.pinned:
            self._pin((*self.pinned, pinned))

    def look_at_most(self) -> None:
        """Show the place of maximum pressure, with a flag."""
        listed = self._pressures.shown
        if listed is None or listed.highest is None:
            return
        self._view.set_after(True)
        self.choose("pressure")
        assert self.now is not None
        line = listed.highest.line
        if listed.highest.is_cup:
            at = _nearest(self.now.places, np.array(listed.highest.place))
            self._add(Pinned(at))
            place, normal = self.now.places[at], self.now.normals[at]
        else:
            values, worn = self._on_bands[self._view.beside.bodies[0]].values.get(line), listed.worn[line]
            if values is not None:
                self._add(Pinned(int(values.argmax()), line))
            place, normal = worn.places[worn.peak], worn.normals[worn.peak]
        view = self._view.viewport
        aspect = view.width() / max(view.height(), 1)
        view.glide_to(framing_place(view.scene.view, place, normal, aspect))

    def unpin(self, number: int) -> None:
        """Remove a flag that is shown: those of lines are not while a map lies on the skin."""
        gone = self._flagged[number]
        self._pin(tuple(each for each in self.pinned if each is not gone))

    def _pin(self, pinned: tuple[Pinned, ...]) -> None:
        self.pinned = pinned
        self.refresh()

    def _row_near(self, line: str, place: Floats) -> int | None:
        bands = self._view.viewport.scene.bands
        if line not in bands.names:
            return None
        spine, _ = bands.spine(line)
        row = int(np.linalg.norm(spine - place, axis=1).argmin())
        value, _ = self._on_bands[self._view.beside.bodies[0]].at(line, row)
        return None if np.isnan(value) else row

    # -- what is shown

    def refresh(self) -> None:
        """Update legend, colours and flags to the session's frame, and redraw the view."""
        self.follow()
        for body in self._view.beside.bodies:
            body.viewport.request_draw()

    def follow(self) -> None:
        """Update legend, colours and flags; the view is redrawn anyway."""
        frame = self._context.session.frame
        shown = bool(self.name) and frame is not None
        self._view.tools.set_shown("map", shown)
        self.legend.setVisible(shown)
        self.flags.listening = shown
        if frame is not None and shown:
            if self._seen.take(frame):
                self.pinned, self._painted = (), WeakKeyDictionary()
            self._read(frame)
        elif not self._laid:
            return
        else:
            self._on_bands = {}
        for body in self._view.beside.bodies:
            self._paint_skin(body)
            self._paint_bands(body)
        self._laid = shown
        self._show_flags()

    def _values_of(self, view: BodyView) -> Floats:
        now = self._seen.now_of(view)
        if now is None or now is self.now:
            return self._values
        return self._seen.on_skin(self.name, now) if now.lies_on_skin(self.name) else np.empty(0)

    def _read(self, frame: Frame) -> None:
        """Read the values off the bodies and choose the range that they are shown in."""
        assert self.now is not None
        bodies = self._view.beside.bodies
        # Bodies beside each other are compared: the same colour is the same value on all of them.
        self._values, self._on_bands, beside = np.empty(0), {}, []
        if self.name in LINE_MAPS:
            self._on_bands = {view: self._seen.on_bands(self.name, view) for view in bodies}
            beside = [each for shown in self._on_bands.values() for each in shown.values.values()]
            text = self._seen.note(self.name, self._on_bands[bodies[0]])
        else:
            text = self._seen.skin_note(self.name, frame, self._view.after)
        self.legend.show_note(text or self._kinds[self.name].note)
        if self.now.lies_on_skin(self.name):
            self._values = self._seen.on_skin(self.name, self.now)
        beside += [self._values_of(view) for view in bodies]
        values = np.concatenate([np.empty(0), *beside])
        least = LEAST_OF_CUPS if self.name in LINE_MAPS and len(self._values) else 0.0
        by_hand, (low, high) = self._by_hand.get(self.name), automatic_range(self.name, values, least)
        if frame.is_running and self._range_of == self.name:  # while a body moves the colours only widen
            low, high = min(low, self._range[0]), max(high, self._range[1])
        self._range, self._range_of = by_hand or (low, high), "" if by_hand else self.name
        ramp = self._ramp(self._view.viewport.scene)
        self.legend.show_range(*self._range, ramp.stops, by_hand is not None)

    def _ramp(self, scene: Scene) -> Ramp:
        return ramp_of(self.name, *self._range, appearance_of(scene.dark, scene.material).clay)

    def _paint_skin(self, view: BodyView) -> None:
        """Lay the map over one body; only where it moves, if nothing else has changed."""
        scene, now = view.viewport.scene, self._seen.now_of(view)
        body = scene.body
        if body is None or now is None:
            return
        on_skin = bool(self.name) and now.lies_on_skin(self.name)
        scene.cups.bare(on_skin)  # cloth would tint what lies on the skin
        if not on_skin or not (view.after or self.name == "sides"):
            if self._painted.pop(body, None) is not None:
                body.show_map(None)
            return
        ramp = self._ramp(scene)
        rows, fresh = now.rows(self.name), self._painted.get(body) != (self.name, ramp, view.after)
        if fresh:
            values = now.at_rest(self.name)
            if view.after:
                values[rows] = self._values_of(view)
            body.show_map(ramp(values))
            self._painted[body] = self.name, ramp, view.after
        elif view.after and now is self.now:
            body.recolour(rows, ramp(self._values))

    def _paint_bands(self, view: BodyView) -> None:
        """Colour the bands by their values, or give them their own colours back."""
        bands, shown = view.viewport.scene.bands, self._on_bands.get(view)
        # What lies on the skin is looked at: the bands, which say where the lines are, let it through.
        bands.fade(bool(self.name) and shown is None)
        if shown is not None and view.after:
            self._painter.paint(bands, shown, self._ramp(view.viewport.scene))
        else:
            self._painter.give_back(bands)

    def _show_flags(self) -> None:
        """Show the values that are pinned, where there are any."""
        told = {each: self._told(each) for each in self.pinned} if self.name else {}
        self._flagged = tuple(each for each, texts in told.items() if texts is not None)
        values = [each for each in told.values() if each is not None]
        self.flags.show_flags(flag for flag, _ in values)
        self.legend.show_value(values[-1][1] if values else None)
        self._place.consider()

    def _told(self, pinned: Pinned) -> tuple[ValueFlag, float] | None:
        """Return the flag that stands on a place now, and the value there, if there is one."""
        scene, now = self._view.viewport.scene, self.now
        assert now is not None
        assert scene.body is not None
        if not (self.name in LINE_MAPS if pinned.line else now.lies_on_skin(self.name)):
            return None
        if pinned.line:
            shown = self._on_bands[self._view.beside.bodies[0]]
            value, off = shown.at(pinned.line, pinned.at)
            if np.isnan(value) or not self._view.after:
                return None
            place = scene.bands.spine(pinned.line)[0][pinned.at]
            words = self._words(value) if np.isnan(off) else bridge_text(off)
            return ValueFlag(place, words), value
        values = now.at_rest(self.name)
        if self._view.after:
            values[now.rows(self.name)] = self._values
        value = float(values[pinned.at])
        place = scene.body.shown_points[pinned.at]
        return None if np.isnan(value) else (ValueFlag(place, self._words(value)), value)

    def _words(self, value: float) -> str:
        kind = self._kinds[self.name]
        if kind.unit == "mm":
            return length(value, kind.digits, kind.both_ways)
        return f"{number(value, kind.digits, kind.both_ways)} {kind.unit}"


def _nearest(points: Points, place: Floats) -> int:
    """Return which of points (n, 3) is nearest to a place, (3,)."""
    return int(np.linalg.norm(points - place, axis=1).argmin())
