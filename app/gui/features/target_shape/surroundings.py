"""What is around the card while the result is asked for: locked lines, and those that are only tried on."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import reduce
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.i18n.catalog import tr
from app.presenters.target_shape import SAME
from core.document.design import Design
from core.pipeline.active_lines import active_line_groups

if TYPE_CHECKING:
    from app.gui.features.target_shape.controller import AskDesk
    from app.gui.main_window import MainWindow


class AskAround(QObject):
    """Leads out of what is missing, and tells what is only shown."""

    def __init__(self, window: MainWindow, desk: AskDesk) -> None:
        super().__init__(desk)
        self._window, self._desk = window, desk
        desk.card.helped.connect(self.help)
        desk.card.prioritized.connect(self.prioritize)
        desk.card.optional_chosen.connect(self.use_inactive)
        desk.card.limited.connect(self.limit_pressure)

    def prioritize(self, key: str, priority: str) -> None:
        """Set what a target counts for where not all of them can be met."""
        self._desk.all_wishes.priorities[key] = priority
        self._desk.steps.note()
        self._desk.ask()

    def limit_pressure(self, on: bool) -> None:
        """Keep to the usual limit of pressure, or to none."""
        self._desk.all_wishes.limit = None if on else math.inf
        self._desk.steps.note()
        self._desk.ask()

    def use_inactive(self, allowed: bool) -> None:
        """Let lines that are off be switched on, or not."""
        self._desk.all_wishes.optional = allowed
        self._desk.ask()

    def help(self) -> None:
        """Lead out of it when no line may change: to sets of lines, or to unlocked ones."""
        frame = self._window.session.frame
        groups = active_line_groups(frame.stages) if frame is not None else ()
        lines = [name for group in groups for name in group]
        if not lines:
            self._window.preset_desk.show_menu()
            return

        def unlocked(before: Design) -> Design:
            traits = (replace(before.line_settings(name), locked=False) for name in lines)
            return reduce(Design.with_line_settings, traits, before)

        self._window.session.edit(unlocked, tr("Worn lines unlocked"))

    def first(self, waits: str) -> str:
        """Return what has to be done before a sheet can be made; ``waits`` if nothing is asked for."""
        if not self._desk.is_tried_on:
            return waits
        return tr("The sheet is of what is applied: apply what is asked for, or cancel it, first.")

    def is_tried_on(self, names: tuple[str, ...], shown: Design) -> bool:
        """Tell whether the lengths of lines in the ``shown`` design are only those of an answer."""
        taken = self._window.session.design
        if not self._desk.is_open or taken is None:
            return False
        return any(abs(taken.ratio(name) - shown.ratio(name)) >= SAME for name in names)
