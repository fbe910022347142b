"""Notices and settings of safe mode."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from app.gui.viewport.opengl import graphics_work, spare_graphics, try_graphics
from app.i18n.catalog import tr

if TYPE_CHECKING:
    from app.gui.context import AppContext

_DRAWN_FOR = 1000
"""Milliseconds after which a window that is made, or a view that is drawn, has shown that it can be."""


class SafeMode(QObject):
    """Says once why the view is drawn safely; ``why`` is what ``begin_graphics`` answered."""

    def __init__(self, context: AppContext, why: str) -> None:
        super().__init__(context.session)
        self._context, self._why = context, why
        # While the start page waits, or a scan is read, nothing is drawn: an end then is not its fault.
        self._clock = QTimer(self, interval=_DRAWN_FOR, singleShot=True)
        self._clock.timeout.connect(self._stop)
        self._drawn = False
        if not why:
            self._clock.start()
        context.session.opened.connect(self._show_opened)

    def _show_opened(self) -> None:
        self._context.session.opened.disconnect(self._show_opened)
        if not self._why:
            if not self._clock.isActive():
                try_graphics()
            self._drawn = True
            self._clock.start()
            return
        texts = {
            "asked": tr("Safe mode: the 3D view does not use the graphics driver."),
            "failed": tr("Safe mode: Busk failed to start the 3D view twice."),
        }
        hint = tr("All features work; the 3D view is slower.")
        act = (tr("Use normal mode at next start"), graphics_work) if self._why == "failed" else None
        self._context.notifications.warn(texts[self._why], hint, [act] if act else ())

    def _stop(self) -> None:
        if self._drawn:
            graphics_work()
        else:
            spare_graphics()
