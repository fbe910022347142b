"""Batch runs in the menu and in the status bar; all else is made when their window is first shown."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.gui.features.batch.indicator import BatchIndicator
from app.gui.widgets.dialog import ask
from app.i18n.catalog import tr

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.batch.workspace import BatchWorkspace


class BatchController(QObject):
    """Show the window of batch runs, which may be closed while a run goes on.

    ``indicator`` belongs into the status bar; ``may_leave`` confirms unsaved changes of the open document.
    """

    def __init__(self, context: AppContext, may_leave: Callable[[], bool]) -> None:
        super().__init__(context.session)
        self._context, self._may_leave = context, may_leave
        self.indicator = BatchIndicator()
        self.indicator.press.clicked.connect(self.show)
        self.workspace: BatchWorkspace | None = None
        text = tr("Compute a design on many scans: table, distributions and files of results")
        context.actions.add("file", tr("Batch…"), tip=text, do=self.show)

    def show(self) -> None:
        """Show the window, as it was when it was closed."""
        if self.workspace is None:
            from app.gui.features.batch.workspace import BatchWorkspace  # noqa: PLC0415 (many libraries)

            self.workspace = BatchWorkspace(self._context, self._may_leave)
            self.workspace.progressed.connect(self.indicator.show_run)
        self.workspace.show()

    def may_quit(self) -> bool:
        """Confirm that a run which goes on may be stopped."""
        if self.workspace is None or not self.workspace.run.is_running:
            return True
        question = tr("A batch run is in progress. Stop it and quit?")
        text = tr("The results so far are kept. A run with the same folder continues them.")
        return ask(self._context.window, question, text, [("quit", tr("Stop and quit"))]) == "quit"

    def close(self) -> None:
        """Stop the run and close its window."""
        if self.workspace is not None:
            self.workspace.close()
