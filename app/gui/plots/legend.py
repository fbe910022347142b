"""The names of the curves, each behind a piece of its line."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QPointF
from PySide6.QtGui import QColor, QFontMetrics, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from app.gui.plots.painting import ROLE_COLORS
from app.gui.theme.stylesheet import font, tokens_of
from app.i18n.catalog import tr
from app.rendering.palette import Tokens

Entry = tuple[str, str, bool]
"""A name, the token of its colour, and whether its line is dashed."""


def run_title(control: str) -> str:
    """Return what the run of a volume control is called."""
    return {
        "adaptive": tr("Adaptive"),
        "conventional": tr("Conventional"),
        "accumulating": tr("Accumulating"),
        "none": tr("Volume free"),
    }[control]


def legend_entries(roles: Mapping[str, str], exact: bool, exact_is_main: bool) -> list[Entry]:
    """Return the names of these runs by their roles, and of the exact answer if there is one."""
    entries = [(run_title(name), ROLE_COLORS[role], False) for name, role in roles.items()]
    answer = (tr("Exact"), "accent" if exact_is_main else "exact_curve", True)
    return [*entries, answer] if exact else entries


def legend_width(entries: list[Entry]) -> int:
    """Return the room that a legend takes [px]."""
    wide = QFontMetrics(font("caption"))
    return sum(wide.horizontalAdvance(title) + 34 for title, _, _ in entries)


def paint_legend(painter: QPainter, entries: list[Entry], at: QPointF, tokens: Tokens) -> None:
    """Paint a legend from ``at`` to the right, the middle of its line at that height."""
    painter.setFont(font("caption"))
    x = at.x()
    for title, token, dashed in entries:
        pen = QPen(QColor(getattr(tokens, token)), 2)
        if dashed:
            pen.setDashPattern([2.5, 1.5])
        painter.setPen(pen)
        painter.drawLine(QPointF(x + 2, at.y()), QPointF(x + 18, at.y()))
        painter.setPen(QColor(tokens.text_quiet))
        painter.drawText(QPointF(x + 23, at.y() + 4), title)
        x += painter.fontMetrics().horizontalAdvance(title) + 34


class Legend(QWidget):
    """A legend of its own."""

    def __init__(self) -> None:
        super().__init__()
        self.entries: list[Entry] = []

    def show_entries(self, entries: list[Entry]) -> None:
        """Show these names."""
        if entries != self.entries:
            self.entries = entries
            self.setFixedSize(legend_width(entries), 18)
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        paint_legend(QPainter(self), self.entries, QPointF(0.0, self.height() / 2), tokens_of(self))
