"""Ask for the result: wishes are met by lengths of lines, which are seen before they are taken."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.panels.ask_card import AskCard
from core.aims.figure import Goal

if TYPE_CHECKING:
    from app.main_window import MainWindow


class AskDesk(QObject):
    """Opens the card in which the result is asked for, by ``begin``."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._goals: tuple[Goal, ...] = ()
        self.card = AskCard(window.view)
        window.view.place(self.card, "bottom")
        self.card.left.connect(self.leave)

    @property
    def is_open(self) -> bool:
        """Whether something is being asked for."""
        return not self.card.isHidden()

    def begin(self, goals: Sequence[Goal] = ()) -> None:
        """Open the card, with ``goals`` wished for already."""
        if self._window.session.frame is None:
            return
        self._goals = tuple(goals)
        self._window.desk.go_to("lines")
        self.card.show()

    def leave(self) -> None:
        """Ask no longer; nothing has changed."""
        self.card.hide()
