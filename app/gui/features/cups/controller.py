"""Cups: chosen and shaped in their card, and what they do shown there."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.gui.features.cups.card import CupCard
from app.i18n.catalog import tr
from app.presenters.cups import NO_CUPS, change_text, fit_view, kind_text, kind_titles, with_kind
from core.document.design import Design
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext

MAP = "pressure"
"""The map that shows where cups press."""


class CupsController(QObject):
    """Show the cups of the design in a card, and make changes of them edits.

    ``map_requested`` carries the name of a map, or none.
    """

    map_requested = Signal(str)

    def __init__(self, context: AppContext, card: CupCard) -> None:
        super().__init__(context.session)
        self._session, self._card = context.session, card
        context.session.design_changed.connect(self._show_design)
        context.session.failed.connect(lambda _: self._show_present())
        card.kind_chosen.connect(self.choose)
        card.previewed.connect(self.preview)
        card.changed.connect(self.change)
        card.cancelled.connect(context.session.cancel_preview)
        card.map_requested.connect(lambda on: self.map_requested.emit(MAP if on else ""))
        self._add_actions(context)

    def choose(self, kind: str) -> None:
        """Choose a kind of cups, or none."""
        self._session.edit(lambda design: with_kind(design, kind), kind_text(kind))

    def preview(self, key: str, value: float) -> None:
        """Show a setting while it is dragged; nothing is committed."""
        if self._session.design is not None:
            self._session.preview(_with(self._session.design, key, value))

    def change(self, key: str, value: object) -> None:
        """Set a setting as one undo step; quick changes of the same one are one step."""
        self._session.edit(lambda design: _with(design, key, value), change_text(key, value), f"cup {key}")

    def show_frame(self, frame: Frame) -> None:
        """Show what the cups of a frame do."""
        self._card.show_fit(fit_view(frame), faint=frame.is_running)

    def show_map(self, name: str) -> None:
        """Show by the card whether its map lies on the body."""
        self._card.show_map(name == MAP)

    def _show_present(self) -> None:
        if self._session.design is not None:
            self._show_design(self._session.design)

    def _show_design(self, design: Design) -> None:
        self._card.show_design(design)
        self.kinds[NO_CUPS if design.cup is None else design.cup.kind].setChecked(True)

    def _add_actions(self, context: AppContext) -> None:
        """List the kinds of cups in the menu: each can be chosen by its name."""
        do = context.actions
        do.submenu("lines", "cups", tr("Cups"))
        self.kinds = do.group("cups", kind_titles())
        for kind, action in self.kinds.items():
            action.triggered.connect(lambda _=False, kind=kind: self._choose_and_show(context, kind))

    def _choose_and_show(self, context: AppContext, kind: str) -> None:
        context.navigation.show_step("lines")
        self.choose(kind)


def _with(design: Design, key: str, value: object) -> Design:
    """Return a design with one setting of its cups; one without cups stays."""
    if design.cup is None:
        return design
    return replace(design, cup=replace(design.cup, **{key: value}))  # type: ignore[arg-type]
