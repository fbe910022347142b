"""The tour through the window: the lifted bust, the steps, cups or lines, verdict, report, and a girdle."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QPoint, QRect, Qt, QTimer
from PySide6.QtWidgets import QWidget

from app.gui.features.project.recent_files import end_first_start
from app.gui.widgets.coach_mark import CoachMark
from app.gui.widgets.focus_chain import bring_in
from app.i18n.catalog import tr
from app.presenters.bust_shift import bust_shift, up_text
from app.presenters.samples import WHOLE_TRUNK, opened_sample

if TYPE_CHECKING:
    from app.gui.main_window import MainWindow

_SETTLED = 250
"""Stillness of view and notices after which the card takes its place again [ms]."""


@dataclass(frozen=True)
class TourStop:
    """A stop of the tour: ``place`` is what its sentence is about, ``report`` whether it opens the report.

    ``part`` is what has to be scrolled to first, if anything; ``sample`` the sample that it opens.
    """

    title: str
    words: str
    place: Callable[[], QRect]
    report: bool = False
    part: QWidget | None = None
    sample: str = ""


class Tour(QObject):
    """Leads through its stops; the window can be used meanwhile. Where it ended counts as seen."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._place = -1
        self.mark = CoachMark(window)
        self.mark.advanced.connect(self._go)
        self.mark.skipped.connect(self.end)
        self._points = QTimer(self, interval=_SETTLED, singleShot=True)
        self._points.timeout.connect(self._point)
        window.view.viewport.view_changed.connect(self._points.start)

    @property
    def place(self) -> int:
        """Return the index of the shown step, from 0; -1 without a tour."""
        return self._place

    def begin(self) -> None:
        """Start with the first step."""
        self._place = 0
        for part in self._watched():
            part.installEventFilter(self)
        self._show()

    def begin_when_settled(self) -> None:
        """Start once the opened body has converged."""
        self._window.session.frame_ready.connect(self._begin_if_settled)

    def end(self) -> None:
        """End the tour for good."""
        self._place = -1
        for part in self._watched():
            part.removeEventFilter(self)
        self.mark.leave()
        self._window.navigation.focus_panel()
        end_first_start()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Keep the card beside its target when the size of the window changes, and off the notices."""
        if event.type() in (QEvent.Type.Resize, QEvent.Type.Move, QEvent.Type.Show, QEvent.Type.Hide):
            QTimer.singleShot(0, self, self._point)
        return False

    def _begin_if_settled(self) -> None:
        if self._window.session.is_converged:
            self._window.session.frame_ready.disconnect(self._begin_if_settled)
            self.begin()

    def _go(self, step: int) -> None:
        self._place = max(self._place + step, 0)
        if self._place < len(self._stops()):
            self._show()
        else:
            self.end()

    def _show(self) -> None:
        stops = self._stops()
        stop = stops[self._place]
        self._window.navigation.show_step("lines")
        self._window.strip.set_folded(False)
        if stop.report:
            self._window.report_controller.open()
        elif stop.sample:
            self._window.report_controller.close()
            self._open_sample(stop.sample)
        if stop.part is not None:
            bring_in(stop.part)
        self.mark.show_step(self._place, len(stops), stop.title, stop.words)
        self._point()
        self.mark.setFocus(Qt.FocusReason.OtherFocusReason)
        # What was folded away a moment ago has its place only then.
        QTimer.singleShot(0, self, self._point)

    def _open_sample(self, name: str) -> None:
        """Open a sample, unless it is open or the user keeps the present document."""
        window = self._window
        if opened_sample(window.session.design) != name:
            window.session.opened.connect(self._wait_for_rows, Qt.ConnectionType.SingleShotConnection)
            window.project_controller.open_sample(name)

    def _wait_for_rows(self) -> None:
        QTimer.singleShot(_SETTLED, self, self._show_girdle)

    def _show_girdle(self) -> None:
        """Show all of the opened body, and the row of its waist."""
        window = self._window
        if self._place >= 0 and (waist := window.lines.rows.get("waist")) is not None:
            window.view.viewport.frame_all()
            bring_in(waist)
            self._point()

    def _watched(self) -> tuple[QWidget, ...]:
        return self._window, self._window.notices, self._window.report_controller.page

    def _point(self) -> None:
        if self._place >= 0:
            reports = [stop.report for stop in self._stops()]
            if self._window.report_controller.is_open and not reports[self._place]:
                # Opened meanwhile, it covers what the other stops are about.
                self._place = reports.index(True)
                self._show()
                return
            # Not over the menus: they can be opened meanwhile, as all else can.
            room = self._window.rect().adjusted(0, self._window.top.geometry().bottom() + 1, 0, 0)
            self.mark.point_at(self._stops()[self._place].place(), room, self._clear())

    def _stops(self) -> tuple[TourStop, ...]:
        girdle = [self._stop_at_a_girdle()] if opened_sample(self._window.session.design) else []
        return (*self._stops_beside_the_body(), *self._stops_of_the_result(), *girdle)

    def _stops_beside_the_body(self) -> tuple[TourStop, ...]:
        window = self._window
        frame = window.session.frame
        assert frame is not None, "a tour is of a body"
        return (
            TourStop(
                tr("Before and after"),
                tr(
                    "Bust point displacement: {move}. Press Space, or click Before and After, "
                    "to switch between original and reshaped body."
                ).format(move=up_text(bust_shift(frame).mean.up)),
                lambda: self._place_of(window.view.compare),
            ),
            TourStop(
                tr("Four steps"),
                tr(
                    "Open any of the steps from scan to result at any time. To open your own "
                    "scan, drop its file on the window or press Ctrl+O."
                ),
                lambda: self._place_of(*window.rail.items.values()),
            ),
            self._stop_to_drag(),
        )

    def _stop_to_drag(self) -> TourStop:
        window = self._window
        design = window.session.design
        if design is not None and design.cup is not None and design.cup.kind == "moulded":
            slider = window.cups.rows["lift"].slider
            return TourStop(
                tr("Drag a slider"),
                tr(
                    "Drag the round handle of Lift slightly to the right: the cups become higher, and the "
                    "breasts follow. Bust movement is shown below the body. Ctrl+Z undoes the change."
                ),
                lambda: self._place_of(slider),
                part=slider,
            )
        return TourStop(
            tr("Drag a line"),
            tr(
                "Drag the round handle slightly to the left: the line becomes shorter and presses "
                "harder. Bust movement is shown below the body. Ctrl+Z undoes the change."
            ),
            lambda: self._place_of(window.lines.rows.get(window.view.selected_line, window.lines)),
        )

    def _stops_of_the_result(self) -> tuple[TourStop, ...]:
        return (
            TourStop(
                tr("Overall verdict"),
                tr(
                    "Overall verdict of all checks: convergence, skin strain, contact pressure and fit. "
                    "Click the verdict for reasons and fixes. Contact pressures are estimates, probably "
                    "too high: check them on a sample garment."
                ),
                self._verdict_place,
            ),
            TourStop(
                tr("Fitting report"),
                tr(
                    "Verdict, bust lift and cut list with images: print the report or save it as "
                    "a PDF. Esc returns to the body."
                ),
                lambda: self._place_of(self._window.report_controller.page.does["pdf"]),
                report=True,
            ),
        )

    def _stop_at_a_girdle(self) -> TourStop:
        lines = self._window.lines
        return TourStop(
            tr("Waist, hips and seat"),
            tr(
                "The sample Whole trunk opens with a bra and a girdle. Drag the slider of Waist: its length "
                "is that of the whole band. Your own scan must reach to mid-thigh."
            ),
            lambda: self._place_of(lines.rows.get("waist", lines)),
            sample=WHOLE_TRUNK,
        )

    # -- places on the window

    def _clear(self) -> Sequence[QRect]:
        """Return what the card must not cover."""
        window = self._window
        notices = [self._place_of(window.notices)] if window.notices.isVisible() else []
        if window.report_controller.is_open:
            page = window.report_controller.page
            return [*notices, self._place_of(page.paper), *map(self._place_of, page.does.values())]
        parts = window.rail, window.inspector, window.view.tools, window.view.compare
        beside = [self._place_of(each) for each in parts if each.isVisible()]
        return [*notices, *beside, self._body_place(), self._verdict_place()]

    def _place_of(self, *parts: QWidget) -> QRect:
        places = [QRect(part.mapTo(self._window, QPoint(0, 0)), part.size()) for part in parts]
        return reduce(QRect.united, places)

    def _body_place(self) -> QRect:
        """Return where the part of the body that lines shape is seen."""
        frame, viewport = self._window.session.frame, self._window.view.viewport
        assert frame is not None, "a tour is of a body"
        points = frame.all_points
        spots = viewport.scene.view.to_picture(points, viewport.width(), viewport.height())
        low, high = (QPoint(*map(int, each)) for each in (spots[:, :2].min(axis=0), spots[:, :2].max(axis=0)))
        return (
            QRect(low, high)
            .translated(viewport.mapTo(self._window, QPoint(0, 0)))
            .intersected(self._place_of(viewport))
        )

    def _verdict_place(self) -> QRect:
        """Return where the verdict stands with its values and its first reason, beside the plots."""
        strip = self._place_of(self._window.strip)
        return strip.adjusted(0, 0, self._place_of(self._window.strip.plots[0]).left() - strip.right() - 1, 0)
