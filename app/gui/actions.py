"""Actions of the window by menu or key; a controller adds its own with ``add``."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence, QUndoGroup
from PySide6.QtWidgets import QWidget

from app.gui.menus import Menus
from app.i18n.catalog import LANGUAGES, tr, tr_context
from app.presenters.model_options import control_texts
from app.presenters.samples import SAMPLES

_VIEW_MENUS = {
    "compare": ("ghost", "wipe", "side"),
    "looks": ("front", "left", "right", "back", "three-quarter", "top", "perspective"),
    "layers": ("control-mesh", "landmarks", "bands", "section", "colours"),
}
"""What stands in a menu of its own within that of the view; the rest stands in that itself."""

_KEYS = QKeySequence.StandardKey


class Actions(Menus):
    """The actions that the window itself knows, by name."""

    def __init__(self, parent: QWidget, undo: QUndoGroup, view: Mapping[str, QAction]) -> None:
        super().__init__(parent)
        self._fill_file()
        self._fill_edit(undo)
        self._fill_view(view)
        self._fill_lines()
        self._fill_solve()
        self._fill_window()
        self._fill_help()

    def _fill_file(self) -> None:
        self.open = self.add("file", tr("Open…"), _KEYS.Open)
        self.recent = self.submenu("file", "recent", tr("Open recent"))
        self.submenu("file", "samples", tr("Open sample"))
        self.samples = {
            name: self.add("samples", tr_context("sample", title)) for name, title in SAMPLES.items()
        }
        self.rule("file")
        self.save = self.add("file", tr("Save"), _KEYS.Save, of_document=True)
        self.save_as = self.add("file", tr("Save as…"), "Ctrl+Shift+S", of_document=True)
        text = tr("Export body, lines, pattern strips, measurements, images or a turntable")
        self.export_any = self.add("file", tr("Export…"), "Ctrl+Shift+E", text, of_document=True)
        text = tr("Export the reshaped body with the last settings")
        self.export = self.add("file", tr("Export body…"), "Ctrl+E", text, of_document=True)
        self.rule("file")
        self.cancel = self.add("file", tr("Cancel current task"), "Esc")
        self.cancel.setEnabled(False)
        self.rule("file")
        self.quit = self.add("file", tr("Quit"), "Ctrl+Q")
        self.quit.setMenuRole(QAction.MenuRole.QuitRole)
        self.end("file", 4)

    def _fill_edit(self, undo: QUndoGroup) -> None:
        self.undo = undo.createUndoAction(self._parent, tr("Undo"))
        self.undo.setShortcut(_KEYS.Undo)
        self.redo = undo.createRedoAction(self._parent, tr("Redo"))
        self.redo.setShortcuts([QKeySequence("Ctrl+Shift+Z"), QKeySequence("Ctrl+Y")])
        for action in (self.undo, self.redo):
            self.place("edit", action)
        self.rule("edit")
        text = tr("Deactivate all unlocked lines")
        self.reset = self.add("edit", tr("Reset all lines"), "Ctrl+R", text, of_document=True)

    def _fill_view(self, view: Mapping[str, QAction]) -> None:
        text = tr("Switch between original and reshaped body")
        self.flip = self.add("view", tr("Before / after"), "Space", text, of_document=True)
        self.submenu("view", "compare", tr("Compare"))
        self.submenu("view", "looks", tr("View direction"))
        self.submenu("view", "layers", tr("Show"))
        self.rule("view")
        for name, action in view.items():
            self.place(next((menu for menu, held in _VIEW_MENUS.items() if name in held), "view"), action)
        self.rule("view")
        self.submenu("view", "theme", tr("Theme"))
        titles = {"system": tr("System default"), "light": tr("Light"), "dark": tr("Dark")}
        self.themes = self.group("theme", titles)
        self.submenu("view", "language", tr("Language"))
        self.languages = self.group("language", dict(LANGUAGES))
        self.end("view", 3)

    def _fill_lines(self) -> None:
        titles = {
            "straps": tr("Add straps over bust points"),
            "slings": tr("Add slings around breasts"),
            "obliques": tr("Add oblique side lines"),
            "rings": tr("Add rings around bust points"),
        }
        self.add_lines = {name: self.add("lines", title, of_document=True) for name, title in titles.items()}
        self.rule("lines")
        text = tr(
            "Click points on the body to draw a line. The line keeps the drawn curve or snaps to control "
            "points."
        )
        self.draw_line = self.add("lines", tr("Draw line"), "N", text, of_document=True)
        self.own_line = self.add("lines", tr("Add line through points…"), of_document=True)

    def _fill_solve(self) -> None:
        self.controls = self.group("solve", {name: text.menu for name, text in control_texts().items()})
        self.rule("solve")
        self.submenu("solve", "templates", tr("Control mesh"))
        counts = {name: tr("{count} polygons").format(count=name) for name in ("168", "120")}
        self.templates = self.group("templates", counts)
        self.rule("solve")
        text = tr("Model options: line, skin and volume behaviour")
        self.model = self.add("solve", tr("Model options…"), "Ctrl+M", text, of_document=True)

    def _fill_window(self) -> None:
        titles = {
            "scan": tr("Scan"),
            "landmarks": tr("Landmarks"),
            "lines": tr("Lines"),
            "result": tr("Result"),
            "pattern": tr("Pattern"),
        }
        self.steps = self.group("window", titles)
        for number, action in enumerate(self.steps.values(), start=1):
            action.setShortcut(f"Ctrl+{number}")
        self.rule("window")
        self.inspector = self.add("window", tr("Inspector"), "Ctrl+I", checkable=True)
        self.strip = self.add("window", tr("Live plot"), "Ctrl+J", checkable=True)
        text = tr("Show only the 3D view (Tab to restore)")
        self.alone = self.add("window", tr("3D view only"), "Tab", text, checkable=True)
        # Elsewhere Tab goes on to the next field: the layout gives this action to the view alone.
        self.alone.setShortcutContext(Qt.ShortcutContext.WidgetShortcut)
        self.full_screen = self.add("window", tr("Full screen"), "F11", checkable=True)
        self.next_pane = self.add("window", tr("Next pane"), "F6", tr("Move keyboard focus to the next pane"))
        text = tr("Move keyboard focus to the menu bar")
        self.add("window", tr("Menu bar"), "F10", text, do=self.enter_bar)
        self.rule("window")
        text = tr("Restore default panel sizes")
        self.reset_layout = self.add("window", tr("Reset layout"), tip=text)

    def _fill_help(self) -> None:
        text = tr("Open the user guide page for the current task in the browser")
        self.guide = self.add("help", tr("User guide"), _KEYS.HelpContents, text)
        text = tr("From a scan to a cut list, click by click")
        self.first_steps = self.add("help", tr("Quick start"), tip=text)
        self.rule("help")
        self.about = self.add("help", tr("About Busk"))
        self.about.setMenuRole(QAction.MenuRole.AboutRole)
        self.end("help", 1)
