"""The view itself: the body's material, what is framed, the space bar."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.gui.context import RESHAPED
from app.gui.session.settings import get_setting, set_setting
from app.gui.viewport.compare_key import CompareKey
from app.i18n.catalog import tr
from app.presenters.maps import map_kinds

if TYPE_CHECKING:
    from app.gui.context import AppContext


class ViewController(QObject):
    """Show the body that a step is about, and add to the menu of the view what has no button on it.

    ``map_requested`` carries the map that is chosen in the menu; ``material_shown`` is emitted when the body
    is of another material.
    """

    map_requested = Signal(str)
    material_shown = Signal()

    def __init__(self, context: AppContext, show_variants: Callable[[], object]) -> None:
        super().__init__(context.session)
        self._context, self._view = context, context.view
        do = context.actions
        CompareKey(context.window, do.flip, context.view, show_variants)
        text = tr("Zoom to the selected line or landmark")
        do.submenu("view", "zoom", tr("Zoom"))
        self.fit = do.add("zoom", tr("Zoom to selection"), "F", text, do=self._view.frame_selection)
        parts = {"bust": tr("Zoom to bust"), "waist": tr("Zoom to waist"), "seat": tr("Zoom to seat")}
        for key, (part, title) in enumerate(parts.items(), start=1):
            do.add("zoom", title, f"Shift+{key}", do=partial(self._view.frame_part, part), of_document=True)
        self._add_maps()
        for name, title in (("variants", tr("Table of variants")), ("history", tr("History"))):
            do.add("window", title, do=partial(self._open_tab, name), of_document=True)
        do.submenu("view", "material", tr("Material"))
        titles = {"clay": tr("Clay"), "plaster": tr("Plaster"), "graphite": tr("Graphite")}
        self.materials = do.group("material", titles)
        for name, action in self.materials.items():
            action.triggered.connect(lambda _=False, name=name: self.choose_material(name))
        self._show_material(get_setting("material"))
        context.navigation.step_shown.connect(self._show_step)

    def _add_maps(self) -> None:
        """List the maps: each can be asked for by its name."""
        do = self._context.actions
        do.submenu("view", "maps", tr("Maps"))
        titles = {"": tr("No map")} | {kind.name: kind.title for kind in map_kinds()}
        self.maps = do.group("maps", titles)
        for name, action in self.maps.items():
            action.triggered.connect(lambda _=False, name=name: self.map_requested.emit(name))
        self.show_map("")

    def show_map(self, name: str) -> None:
        """Show in the menu which map lies on the body."""
        self.maps[name].setChecked(True)

    def _show_step(self, step: str) -> None:
        """Show the body that a step is about, with its layers."""
        reshaped = step in RESHAPED
        self._view.set_after(reshaped)
        self._view.set_layer("bands", reshaped and step != "pattern")  # seams lie where they are
        self._view.set_layer("landmarks", step == "landmarks")
        # Colours of the skin and seams help to place landmarks; lines show best on clay.
        self._view.set_layer("colours", not reshaped)

    def _open_tab(self, name: str) -> None:
        self._context.navigation.show_step("lines")
        self._context.navigation.show_panel(name)

    def choose_material(self, name: str) -> None:
        """Show the body in another material, now and in later sessions."""
        set_setting("material", name)
        self._show_material(name)

    def _show_material(self, name: str) -> None:
        name = name if name in self.materials else "clay"
        self.materials[name].setChecked(True)
        self._view.set_material(name)
        self.material_shown.emit()
