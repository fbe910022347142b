"""The tools that float on the 3D view: where to look from, what to show, before or after."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QWidget

from app.gui.widgets.basic import FloatingPanel, Segment, ToolButton, hairline
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

VIEWS = ("front", "left", "right", "back", "three-quarter", "top")


class Toolbar(FloatingPanel):
    """Tools that float; each is an action of ``actions_by_name``, for menus and shortcuts too.

    ``toggled`` carries a layer and whether it is wanted.
    """

    toggled = Signal(str, bool)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.actions_by_name: dict[str, QAction] = {}

    def set_shown(self, name: str, shown: bool) -> None:
        """Show whether a tool is on; nothing is emitted."""
        self.actions_by_name[name].setChecked(shown)

    def _add_layer(self, name: str, drawing: str, title: str, key: str) -> None:
        self._add(name, drawing, title, key, checkable=True)
        self.actions_by_name[name].triggered.connect(lambda on: self.toggled.emit(name, on))

    def _add(
        self, name: str, drawing: str, title: str, key: str, *, size: int = 20, checkable: bool = False
    ) -> None:
        action = self._add_action(name, title, key)
        action.setCheckable(checkable)
        tool = ToolButton(drawing, size=size, room=34, action=action)
        tool.setAccessibleName(title)
        self.row.addWidget(tool)

    def _add_action(self, name: str, title: str, key: str) -> QAction:
        """Return an action that menus and keys have, without a button."""
        action = self.actions_by_name[name] = QAction(title, self)
        action.setShortcut(key)
        set_tip(action, f"{title}  {key}")
        return action

    def _rule(self) -> None:
        rule = hairline(vertical=True)
        rule.setFixedHeight(20)
        self.row.addSpacing(5)
        self.row.addWidget(rule, alignment=Qt.AlignmentFlag.AlignVCenter)
        self.row.addSpacing(5)


class ViewTools(Toolbar):
    """Where to look from, the projection and the layers.

    ``view_chosen`` carries one of ``VIEWS``; ``toggled`` perspective, control-mesh, landmarks or bands with
    its state; ``fit_requested`` and ``picture_requested`` nothing.
    """

    view_chosen = Signal(str)
    fit_requested = Signal()
    picture_requested = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        titles = (
            tr("Front view"),
            tr("Left view"),
            tr("Right view"),
            tr("Back view"),
            tr("Three-quarter view"),
            tr("Top view"),
        )
        for key, (name, title) in enumerate(zip(VIEWS, titles, strict=True), start=1):
            self._add(name, f"view-{name}", title, str(key), size=24, checkable=True)
            self.actions_by_name[name].triggered.connect(lambda _=False, n=name: self._choose_view(n))
        self._rule()
        self._add_layer("perspective", "perspective", tr("Perspective"), "O")
        self._add("fit", "corners-out", tr("Fit all"), "Home")
        self.actions_by_name["fit"].triggered.connect(self.fit_requested)
        self._rule()
        self._add_layer("control-mesh", "control-mesh", tr("Control mesh"), "K")
        self._add_layer("landmarks", "map-pin", tr("Landmarks"), "M")
        self._add_layer("bands", "bands", tr("Bands and cups"), "B")
        self._add("section", "section-plane", tr("Section plane"), "P", checkable=True)
        self._add("map", "palette", tr("Map on the body"), "C", checkable=True)
        self._add_action("next-map", tr("Next map"), "Shift+C")
        colours = self._add_action("colours", tr("Scan colours"), "U")
        colours.setCheckable(True)
        colours.setEnabled(False)
        colours.triggered.connect(lambda on: self.toggled.emit("colours", on))
        self._add("picture", "camera", tr("Export image"), "Ctrl+Shift+P")
        self.actions_by_name["picture"].triggered.connect(self.picture_requested)

    def set_view(self, name: str | None) -> None:
        """Show which view the camera is in, or that it is in none; nothing is emitted."""
        for each in VIEWS:
            self.actions_by_name[each].setChecked(each == name)

    def _choose_view(self, name: str) -> None:
        self.set_view(name)
        self.view_chosen.emit(name)


class CompareTools(Toolbar):
    """Before or after in place, or both at once; ``way_chosen`` carries before, after, wipe or side.

    ``toggled`` carries ghost and whether it is wanted.
    """

    way_chosen = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._segment = Segment((("before", tr("Before")), ("after", tr("After"))))
        self._segment.chosen.connect(self.way_chosen)
        for name in ("before", "after"):
            set_tip(self._segment.button(name), tr("Original and reshaped body (Space)"))
        self.row.addWidget(self._segment)
        self.row.addSpacing(4)
        self._add_layer("ghost", "ghost", tr("Original outline"), "G")
        self._add_way("wipe", "wipe", tr("Swipe before / after"), "W")
        self._add_way("side", "columns", tr("Before and after side by side"), "D")
        self.set_way("after")

    def set_way(self, way: str) -> None:
        """Show how the bodies are looked at; nothing is emitted."""
        self._segment.set_choice(way)
        self.actions_by_name["ghost"].setEnabled(way != "before")  # there it has nothing to go behind
        for name in ("wipe", "side"):
            self.set_shown(name, way == name)

    def _add_way(self, name: str, drawing: str, title: str, key: str) -> None:
        self._add(name, drawing, title, key, checkable=True)
        self.actions_by_name[name].triggered.connect(lambda on: self.way_chosen.emit(name if on else "after"))
