"""Options of target shapes: locked lines, and inactive lines on trial."""

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
    from app.gui.context import AppContext
    from app.gui.features.target_shape.controller import TargetShapeController


class TargetOptions(QObject):
    """Leads out of what is missing, and tells what is only shown."""

    def __init__(self, context: AppContext, controller: TargetShapeController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        controller.card.helped.connect(self.help)
        controller.card.prioritized.connect(self.prioritize)
        controller.card.optional_chosen.connect(self.use_inactive)
        controller.card.limited.connect(self.limit_pressure)

    def prioritize(self, key: str, priority: str) -> None:
        """Set what a target counts for where not all of them can be met."""
        self._controller.all_wishes.priorities[key] = priority
        self._controller.steps.note()
        self._controller.ask()

    def limit_pressure(self, on: bool) -> None:
        """Keep to the usual limit of pressure, or to none."""
        self._controller.all_wishes.limit = None if on else math.inf
        self._controller.steps.note()
        self._controller.ask()

    def use_inactive(self, allowed: bool) -> None:
        """Let lines that are off be switched on, or not."""
        self._controller.all_wishes.optional = allowed
        self._controller.ask()

    def help(self) -> None:
        """Open presets or unlock lines when no line may change."""
        frame = self._context.session.frame
        regions = frame.stages.regions if frame is not None else ()
        lines = [name for region in regions for group in active_line_groups(region) for name in group]
        if not lines:
            self._controller.presets_requested.emit()
            return

        def unlocked(before: Design) -> Design:
            traits = (replace(before.line_settings(name), locked=False) for name in lines)
            return reduce(Design.with_line_settings, traits, before)

        self._context.session.edit(unlocked, tr("Active lines unlocked"))

    def is_tried_on(self, names: tuple[str, ...], shown: Design) -> bool:
        """Return whether the lengths of the ``shown`` design are only those of a result."""
        taken = self._context.session.design
        if not self._controller.is_open or taken is None:
            return False
        return any(abs(taken.ratio(name) - shown.ratio(name)) >= SAME for name in names)
