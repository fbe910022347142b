"""The preferences: shown, stored, and applied at once where that is possible."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QApplication

from app.gui.application import chosen_dark, log_folder
from app.gui.features.preferences.dialog import PreferencesDialog
from app.gui.session.app_folders import show_folder, start_again
from app.gui.session.settings import DEFAULTS, get_setting, set_setting, wants_motion
from app.gui.theme.stylesheet import apply_theme
from app.gui.viewport.viewport import Viewport
from app.i18n.catalog import tr

if TYPE_CHECKING:
    from app.gui.context import AppContext


class PreferencesController(QObject):
    """Open the preferences, and apply each of them.

    ``may_leave`` asks about unsaved changes before a restart.
    """

    material_chosen = Signal(str)

    def __init__(self, context: AppContext, may_leave: Callable[[], bool]) -> None:
        super().__init__(context.session)
        self._context, self._may_leave = context, may_leave
        do = context.actions
        do.rule("edit")
        self.open = do.add("edit", tr("Preferences…"), "Ctrl+,", tr("Set language, theme, mouse and more"))
        self.open.setMenuRole(QAction.MenuRole.PreferencesRole)
        self.open.triggered.connect(self.show)
        do.end("edit", 2)
        do.add(
            "help",
            tr("Open log folder"),
            tip=tr("Show the folder that contains the error logs"),
            do=self.open_log,
        )
        for key, actions in (("theme", do.themes), ("language", do.languages)):
            for value, action in actions.items():
                action.triggered.connect(lambda _=False, key=key, value=value: self.choose(key, value))
        self._show_choices()
        self.set_motion()

    def show(self) -> None:
        """Show the preferences."""
        sheet = PreferencesDialog(self._context.window, {key: get_setting(key) for key in DEFAULTS})
        sheet.changed.connect(self.choose)
        sheet.log_requested.connect(self.open_log)
        sheet.open()

    def choose(self, key: str, value: str) -> None:
        """Keep a wish and do at once what can be done at once."""
        set_setting(key, value)
        app = QApplication.instance()
        if key == "theme" and isinstance(app, QApplication):
            apply_theme(app, chosen_dark(value))
        elif key in ("language", "unit"):
            text = tr("The language changes when Busk restarts.")
            if key == "unit":
                text = tr("The length unit changes when Busk restarts.")
            self._context.notifications.info(text, "", [(tr("Restart now"), self.restart)])
        elif key == "motion":
            self.set_motion()
        elif key == "material":
            self.material_chosen.emit(value)
        self._show_choices()

    def restart(self) -> None:
        """Start the program again on the same document, after a question about unsaved changes."""
        context = self._context
        if not self._may_leave():
            return
        document, design = context.session.path, context.session.design
        scan = "" if design is None or design.scan.member else design.scan.path
        context.session.undo_stack.setClean()  # what is unsaved was given up a moment ago
        if context.window.close():
            start_again(str(document or scan))

    def set_motion(self) -> None:
        """Let the views glide, or jump."""
        for view in self._context.view.findChildren(Viewport):
            view.motion = wants_motion()

    def open_log(self) -> None:
        """Show the folder of the log, if there is one."""
        show_folder(log_folder(), self._context.notifications.info)

    def _show_choices(self) -> None:
        for key, actions in (
            ("theme", self._context.actions.themes),
            ("language", self._context.actions.languages),
        ):
            actions.get(get_setting(key), actions[DEFAULTS[key]]).setChecked(True)
