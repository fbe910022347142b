"""Crash handler: stores the design and shows one dialog."""

from __future__ import annotations

import logging
import sys
import threading
import traceback
from collections import Counter
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QWidget

from app.gui.features.help.about import as_text
from app.gui.features.help.system_info import system_info
from app.gui.widgets.basic import Disclosure, sentence
from app.gui.widgets.dialog import Dialog, text_viewer
from app.gui.widgets.notification_bar import REFUSED
from app.i18n.catalog import tr
from core.errors import UserError, as_exception

if TYPE_CHECKING:
    from app.gui.context import AppContext


class CrashDialog(Dialog):
    """Says that something went wrong, where the design was kept, and what can be done."""

    quit_requested = Signal()

    def __init__(self, parent: QWidget, kept: str, trace: str, machine: str) -> None:
        super().__init__(parent, tr("An internal error occurred in Busk"), (620, 0))
        self._trace, self._machine = trace, machine
        text = (
            tr("A copy of your design is stored until the design is saved or discarded: {place}").format(
                place=kept
            )
            if kept
            else tr("Your design is still open. Save it under a new name.")
        )
        self.said = sentence(text, "body")
        self.body.addWidget(self.said)
        self.body.addWidget(sentence(tr("You can continue. If the error occurs again, restart Busk.")))
        self._unfold = Disclosure(tr("Details for a bug report"))
        self._unfold.setAccessibleName(tr("Details for a bug report"))
        self.details = text_viewer(self.report(), tr("Details for a bug report"), code=True)
        self.details.setMinimumHeight(220)
        self.details.hide()
        self._unfold.toggled.connect(self._show_details)
        self.body.addWidget(self._unfold)
        self.body.addWidget(self.details, 1)
        self.body.addStretch(0)
        self.copy = self.add_button(tr("Copy details"), self._copy)
        self.leave = self.add_button(tr("Quit"), self._quit)
        self.go_on = self.add_button(tr("Continue"), self.accept, "primary")
        self.go_on.setFocus()

    def report(self) -> str:
        """Return what somebody who is to mend it has to know."""
        return f"{self._trace}\n{self._machine}"

    def add_details(self, trace: str) -> None:
        """Take in one more fault, while this one is still asked about."""
        self._trace = f"{self._trace}\n{trace}"
        self.details.setPlainText(self.report())

    def _show_details(self, shown: bool) -> None:
        self.details.setVisible(shown)
        self.fit()

    def _copy(self) -> None:
        QGuiApplication.clipboard().setText(self.report())
        self.copy.setText(tr("Copied"))

    def _quit(self) -> None:
        self.accept()
        self.quit_requested.emit()


_LOGGED = 3  # times that one fault is written to the log
_TOLD = 5  # different faults that are asked about in a session


class CrashHandler(QObject):
    """Handle faults in slots, events and threads while a window is open.

    One fault may come again sixty times a second: it is told once, and written down a few times. Of a
    UserError, which says itself what to do, a notice tells.
    """

    _fell = Signal(object, str)

    def __init__(self, context: AppContext, rescue: Callable[[], str]) -> None:
        super().__init__(context.session)
        self._context, self._rescue = context, rescue
        self._seen: Counter[str] = Counter()
        self.sheet: CrashDialog | None = None
        self._hooks = sys.excepthook, threading.excepthook
        sys.excepthook, threading.excepthook = self._note, self._note_in_thread
        # The fault may have come in a thread, or while something was being painted: it is told afterwards.
        self._fell.connect(self._tell, Qt.ConnectionType.QueuedConnection)
        context.session.opened.connect(self._tell_anew)

    def close(self) -> None:
        """Stop handling faults."""
        sys.excepthook, threading.excepthook = self._hooks

    def note(self, fault: Exception) -> None:
        """Record a fault that was caught elsewhere."""
        self._note(type(fault), fault, fault.__traceback__)

    def _note(self, kind: type[BaseException], fault: BaseException, trace: TracebackType | None, /) -> None:
        if not issubclass(kind, Exception):
            self._hooks[0](kind, fault, trace)
            return
        where = traceback.extract_tb(trace)[-1:]
        name = f"{kind.__name__} {where[0].filename}:{where[0].lineno}" if where else kind.__name__
        self._seen[name] += 1
        if self._seen[name] <= _LOGGED:
            self._hooks[0](kind, fault, trace)
        if self._seen[name] == 1 and len(self._seen) <= _TOLD:
            self._fell.emit(fault, "".join(traceback.format_exception(kind, fault, trace)))

    def _note_in_thread(self, args: threading.ExceptHookArgs, /) -> None:
        fault = as_exception(args.exc_value or RuntimeError())  # SystemExit would pass in silence
        self._note(type(fault), fault, args.exc_traceback)

    def _tell(self, fault: Exception, trace: str) -> None:
        """Keep the design aside, then say what happened; a second fault joins the first."""
        if isinstance(fault, UserError):
            notifications = self._context.notifications
            notifications.show("bad", fault.message, fault.hint, lasting=True, details=trace, topic=REFUSED)
            return
        if self.sheet is not None:
            self.sheet.add_details(trace)
            return
        sheet = self.sheet = CrashDialog(
            self._context.window, self._keep_aside(), trace, self._about_machine()
        )
        sheet.quit_requested.connect(self._context.window.close)
        sheet.finished.connect(self._forget)
        sheet.open()

    def _tell_anew(self) -> None:
        """Let notices come again: those that stood there went with the document before."""
        for name in [name for name in self._seen if name.startswith(UserError.__name__)]:
            del self._seen[name]

    def _keep_aside(self) -> str:
        """Return where the design has been kept, or an empty text."""
        try:
            return self._rescue()
        except Exception:
            # Whatever is broken here, the question must still be asked.
            logging.exception("the design could not be kept aside")
            return ""

    def _about_machine(self) -> str:
        try:
            return as_text(system_info(self._context.window))
        except Exception:
            logging.exception("the machine could not be looked at")
            return tr("unknown")

    def _forget(self) -> None:
        self.sheet = None
