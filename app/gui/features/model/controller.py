"""The options of the model: shown in their panel and menus, and changed there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.gui.features.model.panel import ModelPanel, ModelRow
from app.presenters.model_options import present_values
from core.document.design import Design
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext

PANEL = "model"
"""The name of the panel in the inspector."""


class ModelController(QObject):
    """Show the options of the model, and make changes of them edits of the design."""

    def __init__(self, context: AppContext, panel: ModelPanel, door: ModelRow) -> None:
        super().__init__(context.session)
        self._context, self._panel, self._door = context, panel, door
        session, do = context.session, context.actions
        session.design_changed.connect(self._show_design)
        session.opened.connect(lambda _: self.close())
        panel.changed.connect(session.change)
        door.clicked.connect(lambda _: self.show())
        do.model.triggered.connect(self.show)
        for actions, choose in (
            (do.controls, session.choose_control),
            (do.templates, session.choose_template),
        ):
            for name, action in actions.items():
                action.triggered.connect(lambda _=False, choose=choose, name=name: choose(name))

    def show(self) -> None:
        """Show the panel in the place of the lines; the effect of its options is seen beside it."""
        navigation = self._context.navigation
        navigation.show_step("lines")
        navigation.show_panel(PANEL)
        navigation.focus_panel()

    def close(self) -> None:
        """Show the lines again, if the panel is shown."""
        if self._context.navigation.panel == PANEL:
            self._context.navigation.show_panel("lines")

    def show_frame(self, frame: Frame) -> None:
        """Show the gain of a frame and its limit."""
        self._panel.set_gain(frame.stages.gain, frame.stages.gain_limit)

    def _show_design(self, design: Design) -> None:
        do = self._context.actions
        do.controls[design.volume].setChecked(True)
        do.templates[design.template].setChecked(True)
        present = present_values(design)
        self._panel.set_values(present)
        self._door.set_values(present)
