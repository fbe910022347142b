"""The section plane: where it stands, its curves before and after, and how far they are apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from app.gui.features.sections.marks import apex_pairs, bands, bust_points, home, most_off, side_of
from app.gui.features.sections.panel import SectionPanel
from app.gui.file_export import write_file
from app.gui.plots.section_plot import SectionDrawing
from app.gui.viewport.plane_handle import PlaneHandle
from app.gui.viewport.viewport import Viewport
from app.gui.widgets.file_dialogs import ask_save
from app.i18n.catalog import tr
from app.i18n.lengths import length
from app.presenters.bust_shift import bust_shift
from app.presenters.maps import BodyState, section_text, sides_text
from app.presenters.plots import PLOT_INTERVAL
from app.presenters.status import is_result
from core.export.mesh import write_profile
from core.geometry.mesh import Floats
from core.geometry.planar_curves import AXES, Curve, Plane, Slicer, mirrored, nearest, protrusion
from core.measurements.uncertain_value import OutputUncertainties
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext

_NEAR = 25.0  # how near to a curve the pointer reads it [px]


class SectionsController(QObject):
    """Show one plane at a time; it goes through a bust point until it is moved by hand.

    ``curves`` are what is shown of the plane: before, after, and of the other side if that is asked for.
    ``uncertainty_of`` returns the uncertainties of a frame, ``profiles_in`` the target profiles in a plane.
    ``switched`` is emitted before the plane is shown or hidden.
    """

    switched = Signal()
    carrying_changed = Signal()

    def __init__(
        self,
        context: AppContext,
        uncertainty_of: Callable[[Frame], OutputUncertainties | None],
        profiles_in: Callable[[Plane], dict[str, Sequence[Floats]]],
    ) -> None:
        super().__init__(context.session)
        self._uncertainty_of, self._profiles_in = uncertainty_of, profiles_in
        self._mirrored = False
        self._context, self._view = context, context.view
        self.is_on = False
        self.axis = "x"
        self.curves: dict[str, tuple[Curve, ...]] = {}
        self._through = "left"
        self._by_hand: dict[str, float] = {}
        self._former: dict[str, float] | None = None  # ``_by_hand`` before a hand took the plane
        self._hand_at = 0.0  # where that hand is on the axis [mm]
        self._now: BodyState | None = None
        self._slicer: Slicer | None = None
        self._opposite: Slicer | None = None
        self._again = True
        self._place: Floats | None = None
        self._plot_clock = QTimer(self, interval=PLOT_INTERVAL, singleShot=True)
        self._plot_clock.timeout.connect(self._plot)
        self.panel = SectionPanel(self._view)
        self.panel.hide()
        self._view.place(self.panel, "bottom-left")
        self._connect()

    def _connect(self) -> None:
        panel = self.panel
        panel.axis_chosen.connect(self.choose_axis)
        panel.moved.connect(self.move_to)
        panel.through_requested.connect(self.go_through)
        panel.export_requested.connect(self.export)
        panel.closed.connect(lambda: self.set_on(False))
        panel.plot.pointed.connect(self._point)
        self._view.floating.rearranged.connect(self._give_room)
        self._view.tools.actions_by_name["section"].triggered.connect(self.set_on)
        self._view.viewport.pin_pressed.connect(self.follow_landmark)
        self._view.compared.connect(self.follow)

    def _give_room(self) -> None:
        if not self.panel.isHidden():
            self.panel.set_room(self._view.floating.headroom(self.panel))

    # -- what is asked

    def set_on(self, on: bool) -> None:
        """Show or hide the plane and its panel."""
        self.is_on = self._again = on
        self.switched.emit()
        self.refresh()

    def choose_axis(self, axis: str) -> None:
        """Let the plane stand across x, y or z."""
        self.axis, self._again = axis, True
        self.refresh()

    def move_to(self, at: float) -> None:
        """Move the plane along its axis by hand [mm]."""
        self._by_hand[self.axis] = at
        self.refresh()

    @property
    def carries(self) -> bool:
        """Return whether a hand has hold of the plane."""
        return self._former is not None

    def let_go(self) -> bool:
        """Place the plane back to where a hand took hold of it; returns whether one had."""
        if self._former is None:
            return False
        self._by_hand = self._former
        self._open_hand()
        self.refresh()
        return True

    def go_through(self, side: str) -> None:
        """Let the plane go through the left or the right bust point again."""
        self._through, self._again = side, True
        self._by_hand.clear()
        self.refresh()

    def follow_landmark(self, name: str) -> None:
        """Move the plane to the selected landmark if it is a bust point."""
        if name.startswith("bust_point_") and self.is_on:
            self.go_through(name.removeprefix("bust_point_"))

    def export(self) -> None:
        """Prompt for a file and write the curves."""
        name = f"{self._context.session.name}-{self.axis}.csv"
        path = ask_save(self._context.window, tr("Export curves as CSV…"), name, "CSV (*.csv)", ".csv")
        if not path or self._slicer is None:
            return
        plane, curves, text = self._slicer.plane, self.curves, tr("Curves exported to {name}.")
        write_file(
            self._context.notifications, "curves", path, lambda to: write_profile(to, plane, curves), text
        )

    # -- the handle in the view

    def _handle(self, viewport: Viewport) -> PlaneHandle:
        """Return the handle of the plane in one view, made when it is first wanted."""
        handle = viewport.findChild(PlaneHandle)
        if handle is None:
            handle = PlaneHandle(viewport)
            handle.taken.connect(self._take)
            handle.dragged.connect(self._pull)
            handle.dropped.connect(self._open_hand)
        return handle

    def _take(self) -> None:
        if self._slicer is not None:
            self._former, self._hand_at = dict(self._by_hand), self._slicer.plane.at
            self.carrying_changed.emit()

    def _pull(self, step: float) -> None:
        """Go along the axis with the hand [mm], but not out of the body."""
        if self._former is not None and self._now is not None:
            number, (low, high) = AXES.index(self.axis), self._now.box
            self._hand_at += step
            self.move_to(float(np.clip(self._hand_at, low[number], high[number])))

    def _open_hand(self) -> None:
        self._former = None
        self.carrying_changed.emit()

    # -- what is shown

    def show_map(self, name: str) -> None:
        """Show the curves of the other side too while left and right are compared by the map."""
        self._mirrored = name == "sides"
        self.refresh()

    def refresh(self) -> None:
        """Cut the body of the session's frame, show the curves, and have the view drawn."""
        self.follow()
        self._plot()
        for body in self._view.beside.live:
            body.viewport.request_draw()

    def show_spread(self) -> None:
        """Draw how far the curves may be off, as far as that is known."""
        if self.is_on and not self._plot_clock.isActive():
            self._plot_clock.start()

    def follow(self) -> None:
        """Cut the body of the session's frame, and show the curves; the view is being drawn anyway."""
        frame = self._context.session.frame
        shown = self.is_on and frame is not None
        self._view.tools.set_shown("section", shown)
        self.panel.setVisible(shown)
        if frame is not None and shown:
            self._cut(frame)
            self._draw()
        for body in () if shown else self._view.beside.live:
            if body.body is not None:
                body.viewport.scene.section.set_visible(False)
                self._handle(body.viewport).hide()

    def _cut(self, frame: Frame) -> None:
        if self._now is None or not self._now.belongs_to(frame):
            self._now, self._slicer, self._again = BodyState(frame), None, True
        else:
            self._now.follow(frame)
        now, plane = self._now, self._plane(frame)
        if self._slicer is None or self._slicer.plane != plane:
            self._slicer, self._opposite = Slicer(now.rest, plane), None
            self._before = self._slicer.curves(now.rest.vertices)
        self.curves = {"before": self._before, "after": self._slicer.curves(now.places)}
        if self._mirrored:
            self.curves["other"] = self._other_side(now, plane)

    def _other_side(self, now: BodyState, plane: Plane) -> tuple[Curve, ...]:
        """Return the curves of the shown body mirrored."""
        if plane.axis != "x":
            return mirrored(plane, self.curves["after"], now.sides.middle)
        if self._opposite is None:
            self._opposite = Slicer(now.rest, Plane("x", 2.0 * now.sides.middle - plane.at))
        return self._opposite.curves(now.places)

    def _plane(self, frame: Frame) -> Plane:
        at, control = self._by_hand.get(self.axis), frame.stages.control
        if at is None:
            mark = frame.stages.landmarks.points.get(f"bust_point_{self._through}")
            left, right = control.mesh.vertices[
                list(control.bust_points)
            ]  # a side without a breast has these
            place = mark.position if mark else left if self._through == "left" else right
            at = float(place[AXES.index(self.axis)])
        return Plane(self.axis, at)

    def _draw(self) -> None:
        assert self._now is not None
        assert self._slicer is not None
        plane, (low, high) = self._slicer.plane, self._now.box
        for body in self._view.beside.live:
            curves = self.curves["after" if body.after else "before"]
            body.viewport.scene.section.show(plane, low, high, curves)
            self._handle(body.viewport).show_plane(plane, low, high)
        if not self._plot_clock.isActive():
            self._plot_clock.start()

    def _plot(self) -> None:
        """Update the panel."""
        self._plot_clock.stop()
        if self._slicer is None or self._now is None or not self.is_on:
            return
        plane, (low, high) = self._slicer.plane, self._now.box
        self.panel.show_plane(plane.axis, plane.at, low[plane.number], high[plane.number])
        sides, now, curves = "other" in self.curves, self._now, self.curves
        roles = ("after", "other") if sides else ("before", "after")
        pairs = apex_pairs(now, plane, curves["other"], curves["after"]) if sides else bust_points(now, plane)
        spread = None if sides else self._uncertainty_of(now.frame)
        shown = self._profiles_in(plane)
        drawn = SectionDrawing(
            shown | {role: [curve.places for curve in curves[role]] for role in roles},
            pairs,
            home(now, plane),
            bands(now, self._slicer, curves, spread),
            spread is not None and not spread.whole,
            most_off(now, self._slicer, curves["after"], spread),
        )
        words = sides_text(plane.axis, pairs) if sides else self._words(spread)
        self.panel.show_curves(drawn, words, again=self._again)
        self._again = False
        self._point(self._place)

    def _words(self, spread: OutputUncertainties | None) -> str:
        assert self._now is not None
        assert self._slicer is not None
        frame, side = self._now.frame, side_of(self._now, self._slicer.plane)
        known = spread if spread is not None and spread.whole else None
        return section_text(self.axis, side, bust_shift(frame), known) if is_result(frame) else ""

    def _point(self, place: Floats | None) -> None:
        """Read how far the curves are apart at a place of the plot, (2,) [mm]."""
        self._place, plot = place, self.panel.plot
        plot.show_gap(None)
        foot = None if place is None else nearest(self.curves.get("after", ()), place)
        if place is None or foot is None:
            return
        away = np.linalg.norm(plot.to_pixels(foot.place) - plot.to_pixels(place))
        gap = protrusion(foot, self.curves["other" if "other" in self.curves else "before"])
        if away < _NEAR and gap is not None:
            plot.show_gap(gap[0], foot.place, length(gap[1], signed=True))
