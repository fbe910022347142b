"""A line is drawn on the body: from click to click over the skin, then it snaps to the control mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, QPointF

from app.asking.jobs import Job
from app.lining.sketching import Sketching
from app.presenting.lines import LINE_COLOURS, kind_of, line_colours
from app.wording.words import number, tr
from core.body import Body
from core.design_lines import OwnLine
from core.errors import UserError
from core.geodesic import SkinWays
from core.mesh import Points
from core.own_lines import mirrored
from core.snapping import Snapped, snap
from core.template import read_template

if TYPE_CHECKING:
    from app.main_window import MainWindow

_REACH = 12.0  # how near to the first point a click closes the line [px]
_WIDE = 25.0  # a line further off than this is told to lie outside the control mesh [mm]


class LineDrawing(QObject):
    """Draws own lines: ``begin``, clicks, Enter, and Enter again to keep what it snapped to."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._sketching = Sketching(window, self)
        self._ways: tuple[Body, SkinWays] | None = None
        self._job: Job | None = None
        self._job_body: Body | None = None
        self._places: list[Points] = []
        self._curve: list[Points] = []
        self._snapped: Snapped | None = None
        self._wanted: tuple[Points, bool] = (np.empty((0, 3)), False)
        hand, card = self._sketching.hand, self._sketching.card
        hand.clicked.connect(self._click)
        hand.hovered.connect(self._hover)
        hand.asked.connect(lambda what: {"keep": self.go_on, "back": self.back, "leave": self.leave}[what]())
        card.kept.connect(self.go_on)
        card.back.connect(self.back)
        card.left.connect(self.leave)
        card.moved.connect(self._move)
        self._sketching.lost.connect(self.leave)

    @property
    def at_work(self) -> bool:
        """Whether a line is being drawn."""
        return self._sketching.at_work

    def begin(self) -> None:
        """Let a line be drawn; until the skin is ready for it clicks are joined straight."""
        frame = self._sketching.frame
        if frame is None:
            return
        self._window.desk.go_to("lines")
        self._places, self._curve, self._snapped = [], [], None
        self._prepare(frame.stages.body)
        self._sketching.begin(frame)
        self._show()

    def back(self) -> None:
        """Take the last step back: what it snapped to, or the last point."""
        if self._snapped is not None:
            self._snapped = None
        elif self._places:
            self._places.pop()
            del self._curve[max(len(self._places) - 1, 0) :]
        self._show()

    def leave(self) -> None:
        """Draw no longer; nothing is kept."""
        self._places, self._curve, self._snapped = [], [], None
        self._sketching.end()

    def go_on(self) -> None:
        """Let the line snap to the control mesh, or keep what it has snapped to."""
        if self._snapped is None:
            self._snap(closed=False)
        else:
            self._keep(self._snapped)

    def _prepare(self, body: Body) -> None:
        """Make the skin of a body ready, unless it is or a job is at it that nobody cancelled."""
        if self._ways is not None and self._ways[0] is not body:
            self._ways = None
        jobs = self._window.jobs
        if self._ways is None and (self._job not in jobs.at_work() or self._job_body is not body):
            jobs.cancel(self._job)
            self._job_body = body
            self._job = jobs.run(
                tr("Preparing the skin for drawing"),
                lambda _: SkinWays(body.mesh),
                lambda ways: self._take_ways(body, ways),
                self._window.session.failed.emit,
            )

    def _take_ways(self, body: Body, ways: object) -> None:
        assert isinstance(ways, SkinWays)
        frame = self._window.session.frame
        if frame is None or frame.stages.body is not body:
            return
        self._ways = body, ways
        self._curve = [self._way(*ends) for ends in zip(self._places, self._places[1:], strict=False)]
        if self._sketching.at_work:
            self._show()

    def _click(self, at: QPointF) -> None:
        if self._snapped is not None:
            return
        if self._closes(at):
            self._snap(closed=True)
            return
        place = self._window.view.viewport.skin_at(at)
        if place is None:
            return
        if self._places:
            self._curve.append(self._way(self._places[-1], place))
        self._places.append(place)
        self._show()

    def _hover(self, at: QPointF) -> None:
        """Show how the line would go on to the pointer."""
        if self._snapped is not None or not self._places:
            return
        place = self._places[0] if self._closes(at) else self._window.view.viewport.skin_at(at)
        if place is not None:
            self._draw([*self._curve, self._way(self._places[-1], place)])

    def _closes(self, at: QPointF) -> bool:
        return len(self._places) > 2 and self._sketching.nearest(np.array(self._places[:1]), at, _REACH) == 0

    def _way(self, start: Points, end: Points) -> Points:
        if self._ways is None:
            return np.stack([start, end])
        try:
            return self._ways[1].way(start, end)
        except UserError as problem:
            self._window.session.failed.emit(problem)
            return np.stack([start, end])

    def _snap(self, closed: bool) -> None:
        frame = self._window.session.frame
        if frame is None or not self._curve:
            return
        last = [self._way(self._places[-1], self._places[0])] if closed else []
        curve = np.concatenate([*self._curve, *last])
        self._wanted = curve[:-1] if closed else curve, closed
        try:
            self._snapped = snap(frame.stages.control, *self._wanted)
        except UserError as problem:
            self._window.session.failed.emit(problem)
        else:
            self._curve += last
        self._show()

    def _move(self) -> None:
        """Let what was drawn snap to the nearest path that can pull."""
        frame = self._window.session.frame
        if frame is None or self._snapped is None:
            return
        try:
            self._snapped = snap(frame.stages.control, *self._wanted, pulling=True)
        except UserError as problem:
            self._window.session.failed.emit(problem)
        self._show()

    def _keep(self, snapped: Snapped) -> None:
        """Add the line, and its mirror image if that is wished and another line."""
        session, card = self._window.session, self._sketching.card
        design = session.design
        if design is None:
            return
        template = read_template(design.template)
        other = mirrored(snapped.path, template)
        taken = {*LINE_COLOURS, *(kind_of(line.name) for line in design.own_lines)}
        name = next(f"line {count}" for count in range(1, 1000) if f"line {count}" not in taken)
        lines: tuple[OwnLine, ...] = (OwnLine(name, snapped.path, snapped.closed),)
        if card.both.isChecked() and set(other) != set(snapped.path):
            sides = (
                (snapped.path, other)
                if template.column[list(snapped.path)].mean() > 0
                else (other, snapped.path)
            )
            lines = tuple(
                OwnLine(f"{name} {side}", path, snapped.closed)
                for side, path in zip(("left", "right"), sides, strict=True)
            )
        self.leave()
        self._window.line_maker.take(lines)

    # -- what is seen

    def _show(self) -> None:
        card, snapped = self._sketching.card, self._snapped
        card.both.setVisible(snapped is not None)
        card.keep.setText(tr("Keep line") if snapped else tr("Done"))
        card.keep.setEnabled(snapped is not None or len(self._places) > 1)
        card.undo.setEnabled(bool(self._places))
        card.move_.setVisible(snapped is not None and not snapped.pulls)
        if snapped is None:
            what = tr(
                "Click on the body: the line follows the skin from click to click. A drag turns the body."
                " Off the breasts a line is only measured."
            )
            keys = tr(
                "Enter or double click: done · first point: close it · Backspace: one back · Esc: leave"
            )
            card.say(tr("Draw a line"), what, keys)
        else:
            what = tr("It follows the control mesh, off what you drew by up to {mm} mm.")
            if snapped.off > _WIDE:
                what = tr("It can follow the control mesh only: off what you drew by up to {mm} mm.")
            off = what.format(mm=number(snapped.off, 0))
            if not snapped.pulls:
                off += "\n" + tr("No point of it can move, so it is only measured and pulls nothing.")
            card.say(tr("Keep this line?"), off, tr("Enter: keep · Backspace: draw on · Esc: leave"))
        self._draw(self._curve)

    def _next_colour(self) -> str:
        """Return the colour that a new line will have."""
        design = self._window.session.design
        names = [line.name for line in design.own_lines] if design is not None else []
        return line_colours([*names, "new"])["new"]

    def _draw(self, curve: list[Points]) -> None:
        frame, snapped = self._window.session.frame, self._snapped
        path = np.empty((0, 3))
        if snapped is not None and frame is not None:
            corners = [*snapped.path, *snapped.path[:1] * snapped.closed]
            path = self._sketching.laid(frame.stages.control.mesh.vertices[corners])
        drawn = np.concatenate(curve) if curve else np.empty((0, 3))
        points = np.array(self._places).reshape(-1, 3) if snapped is None else np.empty((0, 3))
        self._sketching.draw(drawn, path, points, self._next_colour())
