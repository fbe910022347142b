"""The history: every edit by name, and the settled results that are kept as long as the document is open."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtGui import QImage

from app.desks.present import kept_volume
from app.panels.history import HistoryPanel
from app.panels.picture_list import PictureRow
from app.showing.verdict_chip import state_title
from app.wording.words import number, tr
from core.design import Design
from core.frame import Frame

if TYPE_CHECKING:
    from app.main_window import MainWindow

MOST = 30
"""Settled results that are kept, the oldest go first."""

_CALM = 400
"""Milliseconds that a result has stood when its picture is taken: nobody is waiting for the window then."""

_PICTURE = 160


@dataclass(frozen=True, eq=False)
class _Snapshot:
    design: Design
    row: PictureRow


class HistoryDesk(QObject):
    """Fills the history panel, and goes back to what is clicked there as one step of undo."""

    def __init__(self, window: MainWindow, panel: HistoryPanel) -> None:
        super().__init__(window)
        self._window = window
        self._session = window.session
        self._panel = panel
        self._snapshots: deque[_Snapshot] = deque(maxlen=MOST)
        self._clock = QTimer(self, interval=_CALM, singleShot=True)
        self._clock.timeout.connect(self._take)

    def show_edits(self) -> None:
        """Show the names of all edits, and which of them stand."""
        stack = self._session.undo_stack
        self._panel.set_edits([stack.text(place) for place in range(stack.count())], stack.index())

    def jump(self, place: int) -> None:
        """Let the first ``place`` edits stand."""
        self._session.undo_stack.setIndex(place)

    def show_opened(self) -> None:
        """Begin anew with another document."""
        self._snapshots.clear()
        self.show_snapshots()
        self.show_edits()

    def note(self) -> None:
        """Hear of a frame: a result that has settled after an edit is kept once the window is calm."""
        if self._window.is_settled() and self._session.undo_stack.index() > 0 and not self._is_kept():
            self._clock.start()

    def show_snapshots(self) -> None:
        """Show the settled results, the newest first."""
        design = self._session.design
        self._panel.set_snapshots(
            [replace(each.row, present=each.design == design) for each in reversed(self._snapshots)]
        )

    def restore(self, place: int) -> None:
        """Make the design of a settled result the present one, as one edit."""
        snapshot = self._snapshots[len(self._snapshots) - 1 - place]
        said = tr("Back to: {edit}").format(edit=snapshot.row.title)
        self._session.edit(lambda _: snapshot.design, said)

    def close(self) -> None:
        """Stop the clock, and hear no more of edits: the stack tells its own end too."""
        self._clock.stop()
        self._session.undo_stack.indexChanged.disconnect(self.show_edits)

    def _is_kept(self) -> bool:
        return any(each.design == self._session.design for each in self._snapshots)

    def _take(self) -> None:
        frame, stack = self._session.frame, self._session.undo_stack
        if frame is None or not self._window.is_settled() or self._is_kept() or stack.index() == 0:
            return
        row = PictureRow(
            stack.text(stack.index() - 1), time.strftime("%H:%M:%S"), _figures(frame), self._picture()
        )
        self._snapshots.append(_Snapshot(frame.stages.design, row))
        self.show_snapshots()

    def _picture(self) -> QImage | None:
        view = self._window.view
        if not view.isVisible():
            return None
        return view.viewport.picture().scaledToHeight(_PICTURE, Qt.TransformationMode.SmoothTransformation)


def _figures(frame: Frame) -> tuple[str, ...]:
    """Return lift and volume error of a frame in words, and how its run stands."""
    lift = frame.marks.apex_z - frame.stages.rest_marks.apex_z
    error, _ = kept_volume(frame)
    return (
        tr("Lift of apex {lift} mm").format(lift=number(lift, 1, signed=True)),
        tr("Volume {percent} %, {state}").format(
            percent=number(error, 2, signed=True), state=state_title(frame.verdict.state)
        ),
    )
