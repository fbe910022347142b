"""Steps of what is asked for: undo and redo go through them before they go through those of the design."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QUndoCommand, QUndoGroup, QUndoStack

from app.gui.features.target_shape.targets import PRESSURE, Targets
from app.gui.session.session import Session
from app.i18n.catalog import listed, tr
from app.presenters.target_shape import target_title

if TYPE_CHECKING:
    from app.gui.features.target_shape.controller import TargetShapeController


@dataclass(frozen=True, eq=False)
class _State:
    """Wishes as they were once, and what the handles dragged then."""

    wishes: Targets
    kind: str

    def changed_from(self, other: _State) -> list[str]:
        """Return the keys of what is asked for, or drawn, in one of both otherwise than in the other."""
        one, two = self.wishes, other.wishes
        keys = dict.fromkeys((*two.figures, *one.figures, *two.drawn, *one.drawn))
        changed = [key for key in keys if one.of_key(key) != two.of_key(key)]
        return changed + ([PRESSURE] if one.limit != two.limit else [])


class _Step(QUndoCommand):
    """One step from a state to another, which has been done when it is pushed."""

    def __init__(self, steps: TargetUndo, before: _State, after: _State, words: str) -> None:
        super().__init__(words)
        self._steps, self._before, self._after = steps, before, after
        self._done = True

    def redo(self) -> None:
        if not self._done:
            self._steps.show(self._after)

    def undo(self) -> None:
        self._done = False
        self._steps.show(self._before)


class TargetUndo(QObject):
    """Keeps a step by ``note`` whenever something else is asked for; they end with the card.

    Once one is kept, undo and redo of the window mean these steps and leave the design alone, until it is
    edited itself.
    """

    def __init__(self, session: Session, group: QUndoGroup, controller: TargetShapeController) -> None:
        super().__init__(controller)
        self._controller = controller
        self._group, self._others = group, session.undo_stack
        self.stack = QUndoStack(self)
        self._group.addStack(self.stack)
        self._last = self._state()

    def forget(self) -> None:
        """Restart with the current targets: undo then applies to the design."""
        self.stack.clear()
        self._last = self._state()
        self._group.setActiveStack(self._others)

    def note(self) -> None:
        """Keep a step if something else is asked for than before."""
        before, self._last = self._last, self._state()
        changed = self._last.changed_from(before)
        if changed:
            titles = [
                tr("Contact pressure limit") if key == PRESSURE else target_title(key) for key in changed
            ]
            self.stack.push(_Step(self, before, self._last, listed(titles)))
            self._group.setActiveStack(self.stack)

    def show(self, state: _State) -> None:
        """Restore earlier targets."""
        self._last = state
        self._controller.handles.let_go()
        self._controller.all_wishes = _copy(state.wishes)
        self._controller.drawing.turn_to(state.kind)

    def _state(self) -> _State:
        return _State(_copy(self._controller.all_wishes), self._controller.handles.kind)


def _copy(wishes: Targets) -> Targets:
    figures, priorities = dict(wishes.figures), dict(wishes.priorities)
    curves, drawn = dict(wishes.curves), dict(wishes.drawn)
    return replace(wishes, figures=figures, curves=curves, drawn=drawn, priorities=priorities)
