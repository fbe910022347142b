"""A line is drawn on the body, from click to click over the skin; it keeps its curve or snaps to points."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, QPointF, QSignalBlocker

from app.gui.drawing_base import DrawingBase, meshes_of
from app.gui.features.lines.add_lines import AddLinesController
from app.gui.features.lines.line_draw_card import LineDrawCard
from app.gui.features.lines.panel import LinesPanel
from app.gui.session.jobs import Job
from app.i18n.catalog import tr
from app.i18n.lengths import length
from app.presenters.lines import LINE_COLOURS, line_colours, row_title
from app.presenters.messages import kind_of
from core.control_mesh.path_snapping import Snapped
from core.document.design import Design
from core.document.drawn_lines import Laid, both_sides, lay_curve, lines_of, with_new_path
from core.document.free_lines import FreeCurve
from core.document.lines import CustomLine
from core.errors import UserError
from core.geometry.geodesic import SurfacePaths
from core.geometry.mesh import Points
from core.pipeline.live_solver import Frame
from core.scan.body import Body

if TYPE_CHECKING:
    from app.gui.context import AppContext

_REACH = 12.0  # how near to the first point a click closes the line [px]
_WIDE = 25.0  # a line further off than this is told to lie outside the control mesh [mm]


class LineDrawTool(QObject):
    """Draw custom lines: ``begin``, clicks, Enter, and Enter again to keep the line that is proposed."""

    def __init__(self, context: AppContext, panel: LinesPanel, add: AddLinesController) -> None:
        super().__init__(context.session)
        self._context, self._add = context, add
        self._viewport = context.view.viewport
        self._card = LineDrawCard(context.view)
        self._sketching = DrawingBase(context, self, self._card)
        panel.draw_requested.connect(self.begin)
        context.actions.draw_line.triggered.connect(self.begin)
        self._ways: tuple[Body, SurfacePaths] | None = None
        self._job: Job | None = None
        self._job_body: Body | None = None
        self._places: list[Points] = []
        self._curve: list[Points] = []
        self._found: Laid | None = None
        self._wanted: tuple[list[Points], bool] = ([], False)
        self._again: CustomLine | None = None
        hand, card = self._sketching.hand, self._card
        hand.clicked.connect(self._click)
        hand.hovered.connect(self._hover)
        self._sketching.connect_tool(self.go_on, self.back, self.leave)
        card.moved.connect(self._move)
        card.snap.toggled.connect(self._choose)

    @property
    def at_work(self) -> bool:
        """Return whether a line is being drawn."""
        return self._sketching.at_work

    def begin(self) -> None:
        """Let a line be drawn; until the skin is ready for it clicks are joined straight."""
        self._begin(None)

    def begin_again(self, line: CustomLine) -> None:
        """Let the course of a line be drawn anew; it keeps all else."""
        self._begin(line)

    def _begin(self, again: CustomLine | None) -> None:
        frame = self._sketching.frame
        if frame is None:
            return
        self._context.navigation.show_step("lines")
        self._places, self._curve, self._found, self._again = [], [], None, again
        self._prepare(frame.stages.body)
        self._sketching.begin(frame)
        self._show()

    def back(self) -> None:
        """Take the last step back: the line that is proposed, or the last point."""
        if self._found is not None:
            self._found = None
        elif self._places:
            self._places.pop()
            del self._curve[max(len(self._places) - 1, 0) :]
        self._show()

    def leave(self) -> None:
        """Draw no longer; nothing is kept."""
        self._places, self._curve, self._found, self._again = [], [], None, None
        self._sketching.end()

    def go_on(self) -> None:
        """Propose the line that was drawn, or keep the one that is proposed."""
        if self._found is None:
            self._propose(closed=False)
        else:
            self._keep(self._found)

    def _prepare(self, body: Body) -> None:
        """Make the skin of a body ready, unless it is or a job is at it that nobody cancelled."""
        if self._ways is not None and self._ways[0] is not body:
            self._ways = None
        jobs = self._context.jobs
        if self._ways is None and (self._job not in jobs.at_work() or self._job_body is not body):
            jobs.cancel(self._job)
            self._job_body = body
            self._job = jobs.run(
                tr("Preparing skin for drawing…"),
                lambda _: SurfacePaths(body.mesh),
                lambda ways: self._take_ways(body, ways),
                self._context.session.failed.emit,
            )

    def _take_ways(self, body: Body, ways: object) -> None:
        assert isinstance(ways, SurfacePaths)
        frame = self._context.session.frame
        if frame is None or frame.stages.body is not body:
            return
        self._ways = body, ways
        self._curve = [self._way(*ends) for ends in zip(self._places, self._places[1:], strict=False)]
        if self._sketching.at_work:
            self._show()

    def _click(self, at: QPointF) -> None:
        if self._found is not None:
            return
        if self._closes(at):
            self._propose(closed=True)
            return
        place = self._viewport.skin_at(at)
        if place is None:
            return
        if self._places:
            self._curve.append(self._way(self._places[-1], place))
        self._places.append(place)
        self._show()

    def _hover(self, at: QPointF) -> None:
        """Show how the line would go on to the pointer."""
        if self._found is not None or not self._places:
            return
        place = self._places[0] if self._closes(at) else self._viewport.skin_at(at)
        if place is not None:
            self._draw([*self._curve, self._way(self._places[-1], place)])

    def _closes(self, at: QPointF) -> bool:
        return len(self._places) > 2 and self._sketching.nearest(np.array(self._places[:1]), at, _REACH) == 0

    def _way(self, start: Points, end: Points) -> Points:
        if self._ways is None:
            return np.stack([start, end])
        try:
            return self._ways[1].path(start, end)
        except UserError as problem:
            self._context.session.failed.emit(problem)
            return np.stack([start, end])

    def _propose(self, closed: bool) -> None:
        """Propose the line that was drawn; nothing changes if there is none."""
        if not self._curve:
            return
        last = [self._way(self._places[-1], self._places[0])] if closed else []
        self._wanted = [*self._curve, *last], closed
        if self._fit():
            self._curve += last
        self._show()

    def _fit(self, pulling: bool = False) -> bool:
        """Fit a line to what was drawn, as it is or to control points, and tell whether there is one.

        ``pulling`` wants one through control points that can move.
        """
        frame = self._context.session.frame
        if frame is None:
            return False
        (pieces, closed), snapped = self._wanted, self._card.snap.isChecked()
        skin, meshes = frame.stages.body.mesh, meshes_of(frame)
        try:
            self._found = lay_curve(skin, meshes, pieces, closed, snapped=snapped, pulling=pulling)
        except UserError as problem:
            self._context.session.failed.emit(problem)
            return False
        return True

    def _move(self) -> None:
        """Let what was drawn snap to the nearest control points that can pull."""
        if self._found is not None:
            with QSignalBlocker(self._card.snap):
                self._card.snap.setChecked(True)
            self._fit(pulling=True)
            self._show()

    def _choose(self) -> None:
        """Fit what was drawn anew, as it was chosen."""
        if self._found is not None:
            self._fit()
        self._show()

    def _keep(self, found: Laid) -> None:
        """Add the line, and its mirror image if that is wished and another line; or give one its course."""
        session, card, again = self._context.session, self._card, self._again
        design = session.design
        if design is None:
            return
        if again is not None:
            self.leave()
            text = tr("{line}: path changed").format(line=row_title(again.name, design))
            session.edit(lambda before: _led_along(before, again.name, found), text)
            return
        taken = {*LINE_COLOURS, *(kind_of(line.name) for line in design.own_lines)}
        name = next(f"line {count}" for count in range(1, 1000) if f"line {count}" not in taken)
        lines = both_sides(name, found, design.template) if card.both.isChecked() else lines_of(name, found)
        self.leave()
        self._add.take(lines)

    # -- what is seen

    def _show(self) -> None:
        card, found, design = self._card, self._found, self._context.session.design
        card.both.setVisible(found is not None and self._again is None)
        card.keep.setText(tr("Keep line") if found else tr("Done"))
        card.keep.setEnabled(found is not None or len(self._places) > 1)
        card.undo.setEnabled(bool(self._places))
        card.move_.setVisible(found is not None and not any(part.is_movable for part in found.values()))
        if found is not None:
            keys = tr("Enter: keep · Backspace: continue drawing · Esc: cancel")
            card.say(tr("Keep this line?"), "\n".join(_fit_words(found)), keys)
        else:
            what = tr(
                "Click points on the body: the line follows the skin from point to point. Drag "
                "to rotate the body. Outside the reshaped regions a line is only measured."
            )
            keys = tr(
                "Enter or double-click: finish · first point: close · Backspace: undo step · Esc: cancel"
            )
            title = tr("Draw line")
            if self._again is not None and design is not None:
                title = tr("Path of {line}").format(line=row_title(self._again.name, design))
            card.say(title, what, keys)
        self._draw(self._curve)

    def _laid(self, part: Snapped | FreeCurve, region: str, frame: Frame) -> Points:
        """Return where a part of the proposed line is on the skin, (k, 3) [mm]."""
        if isinstance(part, FreeCurve):
            return part.shown
        corners = [*part.path, *part.path[:1] * part.closed]
        return self._sketching.laid(meshes_of(frame)[region].mesh.vertices[corners])

    def _colour(self) -> str:
        """Return the colour that the line has or will have."""
        design = self._context.session.design
        names = [line.name for line in design.own_lines] if design is not None else []
        if self._again is not None:
            return line_colours(names, design)[self._again.name]
        return line_colours([*names, "new"])["new"]

    def _draw(self, curve: list[Points]) -> None:
        frame, found = self._context.session.frame, self._found
        path = np.empty((0, 3))
        if found is not None and frame is not None:
            path = np.concatenate([self._laid(part, region, frame) for region, part in found.items()])
        drawn = np.concatenate(curve) if curve else np.empty((0, 3))
        points = np.array(self._places).reshape(-1, 3) if found is None else np.empty((0, 3))
        self._sketching.draw(drawn, path, points, self._colour())


def _led_along(design: Design, name: str, found: Laid) -> Design:
    """Return the design with the band of a line along another curve; it keeps all else."""
    shoulder = {line.name for line in design.own_lines if line.over_shoulder}
    lines = lines_of(design.band_of(name)[0], found)
    over = (replace(line, over_shoulder=line.name in shoulder and not line.closed) for line in lines)
    return with_new_path(design, list(over))


def _fit_words(found: Laid) -> list[str]:
    """Return how a line lies to what was drawn, and what it does not do."""
    parts = found.values()
    off = max(part.deviation for part in parts)
    if any(isinstance(part, FreeCurve) for part in parts):
        texts = [tr("Deviation from the drawn curve: up to {length}.").format(length=length(off))]
        if any(isinstance(part, FreeCurve) and part.cut for part in parts):
            texts.append(tr("The part outside the control mesh was removed: the body is fixed there."))
    else:
        what = tr("Snapped to the control mesh; maximum deviation {length}.")
        if off > _WIDE:
            what = tr("Lines run only on the control mesh; maximum deviation {length}.")
        texts = [what.format(length=length(off, 0))]
    if len(found) > 1:
        texts.append(tr("One band over bust and waist: both parts share one length."))
    if not any(part.is_movable for part in parts):
        texts.append(tr("All points are fixed: the line is measured only and does not reshape the body."))
    return texts
