"""The selected line is made shorter or longer on the body itself: its band is pulled up or down."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QCursor, QHelpEvent

from app.gui.features.lines.panel import LinesPanel
from app.gui.features.lines.row import LineRow, locked_tip
from app.gui.features.lines.slider import LONGEST, RESISTANCE, SHORTEST, ends_for, resisted_ratio, wall_of
from app.gui.viewport.interaction import BandHandle
from app.gui.widgets.tooltip import hide_tip, show_tip
from app.i18n.catalog import tr
from app.presenters.length_limits import resistance_reason
from core.analysis.length_limits.zones import LengthLimits

if TYPE_CHECKING:
    from app.gui.context import AppContext

STEP = 0.001
"""How much shorter a line becomes for each pixel that its band is pulled up, as a share of its rest [1]."""


class BandDragController(QObject):
    """Preview the length while a band is dragged; ``commit`` makes it one undo step at the end.

    Only the selected band of the reshaped body is pulled: a body that is grabbed anywhere else turns.
    """

    carrying_changed = Signal()

    def __init__(
        self,
        context: AppContext,
        panel: LinesPanel,
        commit: Callable[[str, float], object],
        is_drawing: Callable[[], bool],
    ) -> None:
        super().__init__(context.session)
        self._context, self._session, self._panel = context, context.session, panel
        self._commit, self._is_drawing = commit, is_drawing
        self._viewport = context.view.viewport
        self._name = ""
        self._start = self._ratio = 1.0
        self._way = 0.0
        self._leeway: LengthLimits | None = None
        self._wall: float | None = None
        grip = self._viewport.findChild(BandHandle)
        assert grip is not None
        grip.cursor_of = self._cursor_of
        grip.taken.connect(self._take)
        grip.dragged.connect(self._pull)
        grip.dropped.connect(self._drop)
        # What is undone or opened meanwhile is another length than the hand has taken hold of.
        context.session.design_changed.connect(lambda _: self._open_hand())
        self._viewport.watch_keys(self)

    @property
    def carries(self) -> bool:
        """Return whether a band is in the hand."""
        return bool(self._name)

    def let_go(self) -> bool:
        """Restore the length of the line; returns whether one was dragged."""
        held = self._open_hand()
        if held:
            self._session.cancel_preview()
        return bool(held)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Show the possible actions on the band under the pointer."""
        if not isinstance(event, QHelpEvent) or event.type() != QEvent.Type.ToolTip:
            return False
        cursor = self._cursor_of(self._viewport.scene.bands.hovered)
        text = tr("Drag up to shorten, down to lengthen: 0.1 % per pixel (Shift 0.01 %, Esc cancels)")
        if cursor is not None:
            locked = cursor == Qt.CursorShape.ForbiddenCursor
            show_tip(event.globalPos(), locked_tip() if locked else text, self._viewport)
        return cursor is not None

    def _cursor_of(self, name: str) -> Qt.CursorShape | None:
        """Return how the pointer looks over a band that can be pulled, or is locked; None over any other."""
        context, row = self._context, self._row(name)
        if row is None or not row.view.constrained or name != context.view.selected_line:
            return None
        if not context.view.after or self._is_drawing():
            return None
        return Qt.CursorShape.SizeVerCursor if row.view.settable else Qt.CursorShape.ForbiddenCursor

    def _row(self, name: str) -> LineRow | None:
        """Return the row of a line, or of the pair it is linked in."""
        rows = self._panel.rows.values()
        return next((row for row in rows if name in row.view.names), None)

    def _take(self, name: str) -> None:
        row, design = self._row(name), self._session.design
        if row is None or design is None:
            return
        if row.view.locked:
            show_tip(QCursor.pos(), locked_tip(), self._viewport)
            return
        self._name, self._way = name, 0.0
        self._start = self._ratio = design.ratio(name)
        self._leeway = None if row.view.stale else row.view.leeway
        self._wall = wall_of(self._leeway, self._start, ends_for(self._start)[0])
        self.carrying_changed.emit()

    def _pull(self, pixels: float, fine: bool) -> None:
        if not self._name:
            return
        self._way += pixels
        wanted = self._start - STEP * self._way
        ratio = resisted_ratio(wanted, self._wall, STEP * RESISTANCE)
        self._tell(stopped=ratio != wanted and ratio == self._wall)
        ratio = min(max(ratio, min(SHORTEST, self._start)), max(LONGEST, self._start))
        ratio = round(ratio, 4 if fine else 3)
        if ratio != self._ratio:
            self._ratio = ratio
            self._session.preview_line(self._name, ratio)

    def _tell(self, stopped: bool) -> None:
        """Say why it goes no further without a stronger pull."""
        words = resistance_reason(self._leeway) if stopped else ""
        show_tip(QCursor.pos(), words, self._viewport)

    def _drop(self) -> None:
        name = self._open_hand()
        if name:
            self._commit(name, self._ratio)

    def _open_hand(self) -> str:
        """Hold nothing any longer; returns the line that was held."""
        name, self._name = self._name, ""
        if name:
            hide_tip(self._viewport)
            self.carrying_changed.emit()
        return name
