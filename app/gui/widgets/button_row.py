"""A row of buttons under a table."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import SignalInstance
from PySide6.QtWidgets import QHBoxLayout, QWidget

from app.gui.widgets.basic import button
from app.gui.widgets.tooltip import set_tip


def button_row(choices: Iterable[tuple[str, str, SignalInstance]], top: int = 0) -> QWidget:
    """Return buttons from the left: text, tip and what is emitted; ``top`` is the room over them [px]."""
    holder = QWidget()
    row = QHBoxLayout(holder)
    row.setContentsMargins(0, top, 0, 0)
    row.setSpacing(6)
    for text, tip, signal in choices:
        press = button(text)
        set_tip(press, tip)
        press.clicked.connect(signal)
        row.addWidget(press)
    row.addStretch(1)
    return holder
