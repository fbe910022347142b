"""The window's actions and the menus that hold them."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtGui import QAction, QActionGroup, QKeySequence, QUndoStack
from PySide6.QtWidgets import QMenu, QMenuBar, QWidget

from app.wording.samples import SAMPLES
from app.wording.words import LANGUAGES, tr

CONTROLS = ("adaptive", "conventional", "accumulating", "exact", "none")


class Actions:
    """All that can be asked of the window, by name; the roof connects them."""

    def __init__(self, parent: QWidget, undo_stack: QUndoStack) -> None:
        self._parent = parent
        keys = QKeySequence.StandardKey
        self.open = self._make(tr("Open…"), keys.Open)
        self.save = self._make(tr("Save"), keys.Save)
        self.save_as = self._make(tr("Save as…"), "Ctrl+Shift+S")
        self.export = self._make(
            tr("Export body…"), "Ctrl+E", tr("Write the body as it is shown: PLY, OBJ or STL")
        )
        self.cancel = self._make(tr("Cancel the work in hand"), "Esc")
        self.quit = self._make(tr("Quit"), "Ctrl+Q")
        self.undo = undo_stack.createUndoAction(parent, tr("Undo"))
        self.undo.setShortcut(keys.Undo)
        self.redo = undo_stack.createRedoAction(parent, tr("Redo"))
        self.redo.setShortcuts([QKeySequence("Ctrl+Shift+Z"), QKeySequence("Ctrl+Y")])
        self.reset = self._make(
            tr("Reset to scan"), "Ctrl+R", tr("Take all lines off: the body as it was scanned")
        )
        self.flip = self._make(tr("Before / after"), "Space", tr("Show the body at rest, or reshaped"))
        self.strip = self._make(tr("Live plot"), "Ctrl+J", checkable=True)
        self.model = self._make(
            tr("How the model works…"), "Ctrl+M", tr("Choose how lines, skin and volume act")
        )
        self.about = self._make(tr("About Busk"))
        self.add_lines = {name: self._make(title) for name, title in self._line_titles().items()}
        self.own_line = self._make(tr("Draw a line…"))
        self.samples = {name: self._make(tr(title)) for name, title in SAMPLES.items()}
        self.controls = self._group({name: self._control_title(name) for name in CONTROLS})
        self.templates = self._group(
            {name: tr("{count} polygons").format(count=name) for name in ("168", "120")}
        )
        self.themes = self._group({"system": tr("As the system"), "light": tr("Light"), "dark": tr("Dark")})
        self.languages = self._group(dict(LANGUAGES))
        for action in (*self._of_document(), self.cancel):
            action.setEnabled(False)

    def menu_bar(self, view: Mapping[str, QAction]) -> QMenuBar:
        """Return the menus; ``view`` are the actions of the floating tools."""
        bar = QMenuBar(self._parent)
        file = bar.addMenu(tr("File"))
        file.addAction(self.open)
        self.recent = file.addMenu(tr("Open recent"))
        self._fill(file.addMenu(tr("Open sample")), *self.samples.values())
        self._fill(file, None, self.save, self.save_as, self.export, None, self.cancel, None, self.quit)
        self._fill(bar.addMenu(tr("Edit")), self.undo, self.redo, None, self.reset)
        look = bar.addMenu(tr("View"))
        self._fill(look, self.flip, None, *view.values(), None, self.strip)
        self._fill(look.addMenu(tr("Theme")), *self.themes.values())
        self._fill(look.addMenu(tr("Language")), *self.languages.values())
        self.add_menu = bar.addMenu(tr("Lines"))
        self._fill(self.add_menu, *self.add_lines.values(), None, self.own_line)
        solve = bar.addMenu(tr("Solve"))
        self._fill(solve, *self.controls.values(), None)
        self._fill(solve.addMenu(tr("Control mesh")), *self.templates.values())
        self._fill(solve, None, self.model)
        self._fill(bar.addMenu(tr("Help")), self.about)
        return bar

    def enable_document(self) -> None:
        """Allow what needs an open body."""
        for action in self._of_document():
            action.setEnabled(True)

    def _of_document(self) -> tuple[QAction, ...]:
        document = (self.save, self.save_as, self.export, self.reset, self.flip, self.model)
        return (*document, *self.add_lines.values(), self.own_line)

    def _make(
        self,
        text: str,
        key: str | QKeySequence.StandardKey | None = None,
        tip: str = "",
        checkable: bool = False,
    ) -> QAction:
        action = QAction(text, self._parent)
        if key is not None:
            action.setShortcut(QKeySequence(key))
        if tip:
            action.setToolTip(tip)
            action.setStatusTip(tip)
        action.setCheckable(checkable)
        return action

    def _group(self, titles: Mapping[str, str]) -> dict[str, QAction]:
        group = QActionGroup(self._parent)
        actions = {name: self._make(title, checkable=True) for name, title in titles.items()}
        for name, action in actions.items():
            action.setData(name)
            group.addAction(action)
        return actions

    @staticmethod
    def _control_title(name: str) -> str:
        return {
            "adaptive": tr("Adaptive volume force"),
            "conventional": tr("Conventional volume force"),
            "accumulating": tr("Accumulating volume force"),
            "exact": tr("Exact answer"),
            "none": tr("No volume control"),
        }[name]

    @staticmethod
    def _line_titles() -> dict[str, str]:
        return {
            "straps": tr("Add straps over the bust points"),
            "slings": tr("Add slings round the breasts"),
            "obliques": tr("Add oblique lines from the sides"),
            "rings": tr("Add closed rings round the bust points"),
        }

    @staticmethod
    def _fill(menu: QMenu, *actions: QAction | None) -> None:
        for action in actions:
            if action is None:
                menu.addSeparator()
            else:
                menu.addAction(action)
