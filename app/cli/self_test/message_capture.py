"""What is otherwise only printed: faults in other threads, and what Qt complains of."""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_HARMLESS = ("This plugin does not support", "propagateSizeHints")
"""How messages begin that tell of the screen, not of us."""


@contextmanager
def hearing() -> Iterator[list[str]]:
    """Give the list of what is heard meanwhile."""
    from PySide6.QtCore import QtMsgType, qInstallMessageHandler  # noqa: PLC0415 (brings Qt along)

    heard: list[str] = []

    def hear_qt(kind: QtMsgType, where: Any, said: str) -> None:
        if kind not in (QtMsgType.QtDebugMsg, QtMsgType.QtInfoMsg) and not said.startswith(_HARMLESS):
            heard.append(f"Qt message: {said}")

    def hear_fault(fault: Any) -> None:
        heard.append(f"{fault.exc_type.__name__}: {fault.exc_value}")

    hooks = sys.excepthook, threading.excepthook, sys.unraisablehook
    former = qInstallMessageHandler(hear_qt)
    sys.excepthook = lambda kind, fault, trace: heard.append(f"{kind.__name__}: {fault}")
    threading.excepthook = sys.unraisablehook = hear_fault
    try:
        yield heard
    finally:
        sys.excepthook, threading.excepthook, sys.unraisablehook = hooks
        qInstallMessageHandler(former)
