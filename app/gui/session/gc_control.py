"""Python's search for garbage, kept in the window's thread."""

from __future__ import annotations

import gc

from PySide6.QtCore import QObject, QTimer

_OFTEN = 1000
"""Milliseconds between two looks at what is young."""

_SELDOM = 30
"""Every so many looks, what is old is looked at too."""


class GarbageCollection(QObject):
    """Looks for garbage by a clock of its own, as long as a window is open.

    Left to itself Python does it in whatever thread is at work, and the solver's would destroy Qt and VTK
    objects there, which they do not survive.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        gc.disable()
        gc.freeze()
        self._looks = 0
        self._clock = QTimer(self, interval=_OFTEN)
        self._clock.timeout.connect(self._look)
        self._clock.start()

    def spare(self) -> None:
        """Exclude present objects from collection: libraries and parts of the window stay."""
        gc.collect()
        gc.freeze()

    def close(self) -> None:
        """Restore the collection of Python, once the solver's thread has ended."""
        self._clock.stop()
        gc.unfreeze()
        gc.enable()

    def _look(self) -> None:
        self._looks += 1
        gc.collect(2 if self._looks % _SELDOM == 0 else 1)
