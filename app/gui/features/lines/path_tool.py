"""An own line is led through other control points: points are dragged, put at its ends, taken out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, QPointF

from app.gui.drawing_base import DrawingBase, meshes_of
from app.gui.features.lines.panel import LinesPanel
from app.gui.viewport.draw_card import DrawCard
from app.i18n.catalog import tr
from app.presenters.lines import line_colours, row_title
from core.document.design import Design
from core.document.drawn_lines import with_new_path
from core.document.lines import CustomLine
from core.errors import UserError
from core.geometry.mesh import Points

if TYPE_CHECKING:
    from app.gui.context import AppContext

_REACH = 16.0  # how near to a control point a click means it [px]


class LinePathTool(QObject):
    """Edit the path of one custom line; a linked partner that mirrors it is led likewise.

    A free line, which has no control points, is drawn again by ``draw_again``.
    """

    def __init__(
        self, context: AppContext, panel: LinesPanel, draw_again: Callable[[CustomLine], object]
    ) -> None:
        super().__init__(context.session)
        self._context, self._draw_again = context, draw_again
        self._sketching = DrawingBase(context, self, DrawCard(context.view))
        panel.path_requested.connect(self.begin)
        self._line: CustomLine | None = None
        self._steps: list[tuple[int, ...]] = []
        self._held, self._mesh_shown = -1, False
        hand = self._sketching.hand
        hand.grabs = self._grab
        hand.clicked.connect(self._click)
        hand.dragged.connect(lambda at: self._drag(at, keep=False))
        hand.dropped.connect(lambda at: self._drag(at, keep=True))
        self._sketching.connect_tool(self.keep, self.back, self.leave)
        context.session.design_changed.connect(self._check)

    @property
    def at_work(self) -> bool:
        """Return whether a path is being edited."""
        return self._sketching.at_work

    def begin(self, name: str) -> None:
        """Let the path of an own line be edited."""
        design, frame = self._context.session.design, self._sketching.frame
        if design is None or frame is None:
            return
        own = {line.name: line for line in design.own_lines}
        if name not in own or own[name].region not in meshes_of(frame):
            return
        # A free line has no control points to be led through, a band over both regions has two paths.
        if own[name].free or len(design.band_of(name)) > 1:
            self._draw_again(own[name])
            return
        self._line, self._steps = own[name], [own[name].points]
        self._context.navigation.show_step("lines")
        self._context.selection.select_line(name)
        self._mesh_shown = self._context.view.tools.actions_by_name["control-mesh"].isChecked()
        self._context.view.set_layer("control-mesh", True)
        self._sketching.begin(frame)
        self._show()

    def back(self) -> None:
        """Take the last change of the path back."""
        if len(self._steps) > 1:
            self._steps.pop()
            self._show()

    def leave(self) -> None:
        """Edit no longer; nothing is kept."""
        if self._sketching.at_work:
            self._context.view.set_layer("control-mesh", self._mesh_shown)
        self._sketching.end()

    def keep(self) -> None:
        """Let the line take the new path, as one undo step."""
        session, line, path = self._context.session, self._line, self._steps[-1]
        design = session.design
        if line is None or design is None:
            return
        self.leave()
        if path != line.points:
            text = tr("{line}: path changed").format(line=row_title(line.name, design))
            session.edit(lambda before: with_new_path(before, [replace(line, points=path)]), text)

    def _check(self, design: Design) -> None:
        """Leave the line once it is no longer the one that was begun with: it was undone, or removed."""
        if self._line not in design.own_lines:
            self.leave()

    # -- the hand

    def _points(self) -> Points:
        frame, line = self._context.session.frame, self._line
        if frame is None or line is None or line.region not in meshes_of(frame):
            return np.empty((0, 3))
        return meshes_of(frame)[line.region].mesh.vertices

    def _grab(self, at: QPointF) -> bool:
        path = self._steps[-1]
        self._held = self._sketching.nearest(self._points()[list(path)], at, _REACH)
        return self._held >= 0

    def _drag(self, at: QPointF, keep: bool) -> None:
        """Let the held point of the path stand at the control point under the pointer."""
        point, path = self._sketching.nearest(self._points(), at, 3.0 * _REACH), self._steps[-1]
        if point == path[self._held] and keep:
            self._take_away(self._held)  # it was not dragged but clicked
        elif point >= 0:
            self._try((*path[: self._held], point, *path[self._held + 1 :]), keep)

    def _click(self, at: QPointF) -> None:
        """Continue to a control point from the nearer end of the path."""
        point, path, points = (
            self._sketching.nearest(self._points(), at, _REACH),
            self._steps[-1],
            self._points(),
        )
        if point < 0:
            return
        to_start, to_end = (np.linalg.norm(points[point] - points[end]) for end in (path[0], path[-1]))
        self._try((point, *path) if to_start < to_end else (*path, point), keep=True)

    def _take_away(self, place: int) -> None:
        path = self._steps[-1]
        self._try((*path[:place], *path[place + 1 :]), keep=True)

    def _try(self, path: tuple[int, ...], keep: bool) -> None:
        """Show a path, and go on with it, if a line can take it."""
        assert self._line is not None
        try:
            replace(self._line, points=path)
        except UserError:
            self._show()
            return
        if keep:
            self._steps.append(path)
        self._show(path)

    def _show(self, path: tuple[int, ...] = ()) -> None:
        path, line, design = path or self._steps[-1], self._line, self._context.session.design
        if line is None or design is None:
            return
        card = self._sketching.card
        card.keep.setText(tr("Keep path"))
        card.keep.setEnabled(path != line.points)
        card.undo.setEnabled(len(self._steps) > 1)
        what = tr(
            "Drag a point of the line to another control point. Click next to an end to extend "
            "the line, on a point to remove it."
        )
        keys = tr("Enter: keep · Backspace: undo step · Esc: cancel")
        card.say(tr("Path of {line}").format(line=row_title(line.name, design)), what, keys)
        corners = self._points()[[*path, *path[:1] * line.closed]]
        colour = line_colours([each.name for each in design.own_lines], design)[line.name]
        self._sketching.draw(
            np.empty((0, 3)), self._sketching.laid(corners), self._points()[list(path)], colour
        )
