"""The menu of all that can be wished for while the result is asked for."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QMenu

from app.gui.widgets.file_dialogs import ask_file
from app.gui.widgets.menu import Menu, pull_down
from app.i18n.catalog import tr
from app.presenters.target_shape import profile_title, target_title
from core.analysis.inverse_design.bust_quantities import EVEN, GIRTH
from core.analysis.inverse_design.lower_quantities import SEAT_EVEN

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.target_shape.controller import TargetShapeController

_BOTH = ("lift", "out", "apex lift", "apex out", GIRTH)
_SIDED_BELOW = ("buttock lift", "buttock out", "fold lift")
_BELOW = ("waist girth", "belly girth", "belly out", "hip girth", *_SIDED_BELOW)


class TargetMenu(QObject):
    """Offers figures that are not wished for yet, and profiles from tables."""

    def __init__(self, context: AppContext, controller: TargetShapeController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        self.menu = Menu(context.window)

    def show(self) -> None:
        """Open the menu under its button."""
        self.fill()
        pull_down(self.menu, self._controller.card.add)

    def fill(self) -> None:
        """List what can be wished for besides what is."""
        self.menu.clear()
        self._offer(self.menu, _BOTH)
        frame = self._context.session.frame
        below = frame is not None and frame.stages.lower is not None
        if below:
            self._offer(self.menu.add_submenu(tr("Waist, hips and seat")), _BELOW)
        sided = (*(name for name in _BOTH if name != GIRTH), *(_SIDED_BELOW if below else ()))
        for side, title in (("left", tr("Left side only")), ("right", tr("Right side only"))):
            self._offer(self.menu.add_submenu(title), tuple(f"{name} {side}" for name in sided))
        even = (*EVEN.names, *(SEAT_EVEN.names if below else ()))
        self._offer(self.menu.add_submenu(tr("Left relative to right")), even)
        self.menu.addSeparator()
        for side in ("left", "right"):
            if f"profile {side}" not in self._controller.drawn:
                self.menu.addAction(profile_title(side), partial(self._controller.drawing.begin, side))
            words = tr("{profile} from file…").format(profile=profile_title(side))
            self.menu.addAction(words, partial(self.ask_profile, side))

    def ask_profile(self, side: str) -> None:
        """Prompt for a table, and add its profile as a target."""
        path = ask_file(self._context.window, tr("Profile from file"))
        if path:
            self._controller.drawing.take_table(side, path)

    def _offer(self, menu: QMenu, names: tuple[str, ...]) -> None:
        for name in names:
            if name not in self._controller.wishes:
                menu.addAction(target_title(name), partial(self._add, name))

    def _add(self, name: str) -> None:
        """Show a figure as it is now, to be typed over."""
        self._controller.add(name)
