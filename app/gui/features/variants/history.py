"""History of edits: list with images, and the controller that goes back to a state."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QModelIndex, QObject, QPersistentModelIndex, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QImage, QPainter, QPen
from PySide6.QtWidgets import QListWidgetItem, QSplitter, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label, tokens_of
from app.gui.widgets.basic import sentence
from app.gui.widgets.thumbnail_list import VIEW, RowPainter, ThumbnailList, ThumbnailRow, ThumbnailRowPainter
from app.i18n.catalog import colon, number, tr
from app.presenters.assessment import AssessmentView
from app.presenters.bust_shift import bust_sentence, bust_shift
from app.presenters.status import TONES, is_result
from core.document.design import Design
from core.document.document import Document
from core.garment.assessment import PENDING
from core.pipeline.frame import Frame
from core.pipeline.warnings import controlled_volume

if TYPE_CHECKING:
    from app.gui.context import AppContext


MOST = 30
"""Results that are kept, the oldest go first."""

_CALM = 400
"""Milliseconds that a result has stood when its picture is taken: nobody is waiting for the window then."""

_PICTURE = 160


class HistoryPanel(QWidget):
    """Two lists: ``jumped`` carries the number of edits that shall stand, ``restored`` that of a snapshot."""

    jumped = Signal(int)
    restored = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.edits, self.snapshots = ThumbnailList(_EditRow(self)), ThumbnailList(ThumbnailRowPainter(self))
        self.edits.setAccessibleName(tr("History"))
        self.snapshots.setAccessibleName(tr("Results"))
        self._hint = sentence(tr("Results of all edits are kept here until Busk closes."))
        self._hint.setContentsMargins(4, 2, 4, 8)
        self._parts = QSplitter(Qt.Orientation.Vertical)
        self._parts.setHandleWidth(1)
        self._parts.setChildrenCollapsible(False)
        for title, *inside in (
            (tr("History"), self.edits),
            (tr("Results"), self._hint, self.snapshots),
        ):
            self._parts.addWidget(_part(title, inside))
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 2, 12, 4)
        column.addWidget(self._parts)
        for rows, signal in ((self.edits, self.jumped), (self.snapshots, self.restored)):
            rows.itemClicked.connect(lambda item, rows=rows, signal=signal: signal.emit(rows.row(item)))
            rows.itemActivated.connect(lambda item, rows=rows, signal=signal: signal.emit(rows.row(item)))
        self.set_edits([], 0)
        self.set_snapshots([])

    def set_edits(self, names: Sequence[str], present: int) -> None:
        """Show the names of all edits, the first ``present`` of them stand, the others are undone."""
        rows = [tr("Opened"), *names]
        self.edits.clear()
        for place, name in enumerate(rows):
            item = QListWidgetItem(name, self.edits)
            item.setData(VIEW, place - present)
            self.edits.mark(item, place == present)
        self.edits.scrollToItem(self.edits.item(present))

    def set_snapshots(self, views: Sequence[ThumbnailRow]) -> None:
        """Show snapshots, the newest first."""
        if views and self._hint.isVisibleTo(self):
            half = self._parts.height() // 2
            self._parts.setSizes([half, half])
        self._hint.setVisible(not views)
        self.snapshots.setVisible(bool(views))
        self.snapshots.show_rows(views)


def _part(title: str, inside: Sequence[QWidget]) -> QWidget:
    part = QWidget()
    column = QVBoxLayout(part)
    column.setContentsMargins(0, 0, 0, 8)
    column.setSpacing(4)
    heading = label(title, "heading")
    heading.setContentsMargins(4, 10, 0, 2)
    column.addWidget(heading)
    for each in inside:
        column.addWidget(each, 1 if isinstance(each, ThumbnailList) else 0)
    column.addStretch(0)
    return part


class _EditRow(RowPainter):
    """The name of an edit beside a dot: full where the document stands, hollow where it was undone."""

    def paint_row(self, painter: QPainter, area: QRectF, index: QModelIndex | QPersistentModelIndex) -> None:
        tokens, ahead = tokens_of(self.widget), int(index.data(VIEW))
        dot = QRectF(area.left() + 9, area.center().y() - 3.5, 7, 7)
        color = QColor(tokens.accent if ahead == 0 else tokens.control)
        painter.setPen(QPen(color, 1.4))
        painter.setBrush(color if ahead <= 0 else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(dot)
        words = area.adjusted(27, 0, -8, 0)
        token = "text_caption" if ahead > 0 else "text"
        self.write(
            painter, words, index.data(Qt.ItemDataRole.DisplayRole), "name" if ahead == 0 else "body", token
        )


@dataclass(frozen=True, eq=False)
class _Snapshot:
    variant: str
    design: Design
    row: ThumbnailRow

    def within(self, document: Document) -> Document:
        """Return the document gone back to this; beside other variants the body stays, it is theirs too."""
        there = document.with_shown(self.variant)
        if len(there.designs) == 1:
            return there.with_design(self.design)
        body = there.design
        return there.with_design(replace(self.design, scan=body.scan, placed=body.placed))


class HistoryController(QObject):
    """Fill the history panel, and go back to what is clicked there as one step of undo."""

    def __init__(
        self, context: AppContext, panel: HistoryPanel, assess: Callable[[Frame], AssessmentView]
    ) -> None:
        super().__init__(context.session)
        self._context = context
        self._session = context.session
        self._panel, self._assess = panel, assess
        self._snapshots: deque[_Snapshot] = deque(maxlen=MOST)
        self._clock = QTimer(self, interval=_CALM, singleShot=True)
        self._clock.timeout.connect(self._take)
        self._session.undo_stack.indexChanged.connect(self.show_edits)
        self._session.design_changed.connect(lambda _: self.show_snapshots())
        panel.jumped.connect(self.jump)
        panel.restored.connect(self.restore)

    def show_edits(self) -> None:
        """Show the names of all edits, and which of them stand."""
        stack = self._session.undo_stack
        self._panel.set_edits([stack.text(place) for place in range(stack.count())], stack.index())

    def jump(self, place: int) -> None:
        """Let the first ``place`` edits stand."""
        self._session.undo_stack.setIndex(place)

    def show_opened(self) -> None:
        """Restart with another document."""
        self._snapshots.clear()
        self.show_snapshots()
        self.show_edits()

    def note(self) -> None:
        """Record a frame: the result of an edit is kept once the window is idle."""
        if (
            self._context.session.is_converged
            and self._session.undo_stack.index() > 0
            and not self._is_kept()
        ):
            self._clock.start()

    def show_snapshots(self) -> None:
        """Show the results, the newest first."""
        document = self._session.document
        if document is None:
            self._panel.set_snapshots([])
            return
        self._panel.set_snapshots(
            [
                replace(each.row, title=_title(each, document), present=each.within(document) == document)
                for each in reversed(self._snapshots)
            ]
        )

    def restore(self, place: int) -> None:
        """Restore a result in its variant, as one edit."""
        snapshot, document = self._snapshots[len(self._snapshots) - 1 - place], self._session.document
        if document is not None:
            text = tr("Restored: {edit}").format(edit=_title(snapshot, document))
            self._session.go_back(snapshot.within(document), text)

    def close(self) -> None:
        """Stop the clock."""
        self._clock.stop()

    def _is_kept(self) -> bool:
        document = self._session.document
        return document is not None and any(
            (each.variant, each.design) == (document.shown, document.design) for each in self._snapshots
        )

    def _take(self) -> None:
        frame, stack, document = self._session.frame, self._session.undo_stack, self._session.document
        if (
            frame is None
            or document is None
            or not self._context.session.is_converged
            or self._is_kept()
            or stack.index() == 0
        ):
            return
        if not self._context.view.isVisible():
            # The sheet lies over the body: its picture is taken once that is seen again.
            self._clock.start()
            return
        overall = self._assess(frame)
        if overall.level == PENDING:
            self._clock.start()
            return
        row = ThumbnailRow(
            stack.text(stack.index() - 1),
            time.strftime("%H:%M:%S"),
            _figures(frame, overall.headline),
            self._picture(),
            mark=TONES[overall.level],
        )
        self._snapshots.append(_Snapshot(document.shown, frame.stages.design, row))
        self.show_snapshots()

    def _picture(self) -> QImage:
        picture = self._context.view.viewport.picture(fine=False)
        return picture.scaledToHeight(_PICTURE, Qt.TransformationMode.SmoothTransformation)


def _title(snapshot: _Snapshot, document: Document) -> str:
    """Return what led to a result, with its variant where there are several."""
    several = len(document.designs) > 1 or snapshot.variant != document.shown
    return f"{snapshot.variant}{colon()}{snapshot.row.title}" if several else snapshot.row.title


def _figures(frame: Frame, headline: str) -> tuple[str, ...]:
    """Return the verdict on a frame, where its bust points are and its volume error in words."""
    if not is_result(frame):
        return headline, tr("Not valid for production")
    percent = number(controlled_volume(frame)[0], 2, signed=True)
    text = tr("{state}, volume {percent} %").format(percent=percent, state=headline)
    return text, bust_sentence(bust_shift(frame))
