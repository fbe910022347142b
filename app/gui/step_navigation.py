"""The steps from scan to pattern pieces, down the left side of the window."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QAction, QColor, QKeySequence, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QAbstractButton, QButtonGroup, QVBoxLayout, QWidget

from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import ToolButton, paint_card
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr

STEP_ICONS = {
    "scan": "scan",
    "landmarks": "map-pin",
    "lines": "lines",
    "result": "result",
    "pattern": "pieces",
}
"""The steps in order, with their drawings."""

STATES = ("missing", "available", "done", "look", "bad")
"""A step has nothing to show yet, can be entered, is done, wants to be looked at, or shows no result."""


class StepNavigation(QWidget):
    """The five steps; none is ever locked, a missing one says what it waits for."""

    step_chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(77)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(4, 8, 5, 8)
        self._column.setSpacing(2)
        group = self._group = QButtonGroup(self)
        titles = (tr("Scan"), tr("Landmarks"), tr("Lines"), tr("Result"), tr("Pattern"))
        self.items: dict[str, StepButton] = {}
        for number, (step, title) in enumerate(zip(STEP_ICONS, titles, strict=True), start=1):
            item = StepButton(step, title, QKeySequence(f"Ctrl+{number}"))
            item.clicked.connect(lambda _=False, chosen=step: self.step_chosen.emit(chosen))
            group.addButton(item)
            self._column.addWidget(item)
            self.items[step] = item
        self._column.addStretch(1)

    def add_tool(self, drawing: str, action: QAction) -> ToolButton:
        """Place a small button at the foot, for what is no step, and return it."""
        tool = ToolButton(drawing, size=20, room=36, action=action)
        self._column.addWidget(tool, alignment=Qt.AlignmentFlag.AlignHCenter)
        return tool

    def set_current(self, step: str) -> None:
        """Show which step the window is in, or with an empty name that it is in none; nothing is emitted."""
        self._group.setExclusive(False)
        for name, item in self.items.items():
            item.setChecked(name == step)
        self._group.setExclusive(True)

    def current(self) -> str:
        """Return the step that the window is in, or an empty text."""
        return next((step for step, item in self.items.items() if item.isChecked()), "")

    def set_state(self, step: str, state: str, count: int = 0) -> None:
        """Show how a step stands, one of ``STATES``; ``count`` is how many things want a look."""
        self.items[step].set_state(state, count)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.fillRect(self.width() - 1, 0, 1, self.height(), QColor(tokens_of(self).line))


class StepButton(QAbstractButton):
    """One step: its drawing, its name, and a badge when it is done or wants a look."""

    def __init__(self, step: str, title: str, key: QKeySequence) -> None:
        super().__init__()
        self._drawing, self._state, self._count = STEP_ICONS[step], "missing", 0
        self.setText(title)
        self.setCheckable(True)
        self.setAutoExclusive(True)
        set_tip(self, f"{title}  {key.toString(QKeySequence.SequenceFormat.NativeText)}")
        self.setAccessibleName(title)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setFixedSize(self.sizeHint())

    def sizeHint(self) -> QSize:
        return QSize(68, 62)

    def state(self) -> str:
        """Return how the step stands, one of ``STATES``."""
        return self._state

    def set_state(self, state: str, count: int) -> None:
        """Show how the step stands."""
        if state not in STATES:
            raise ValueError(state)
        changed = (state, count) != (self._state, self._count)
        self._state, self._count = state, count
        texts = {
            "done": tr("done"),
            "look": tr("needs review"),
            "bad": tr("not valid"),
            "missing": tr("not available yet"),
        }
        self.setAccessibleDescription(texts.get(state, ""))
        if changed:
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        paint_card(painter, self, "pressed", 8)
        quiet = self._state == "missing" and not self.isChecked()
        ink = tokens.text if self.isChecked() else tokens.text_caption if quiet else tokens.text_quiet
        paint_icon(painter, self._drawing, ink, QRectF(self.width() / 2 - 12, 10, 24, 24))
        type_ = font("caption")
        type_.setWeight(type_.Weight.DemiBold if self.isChecked() else type_.Weight.Normal)
        painter.setFont(type_)
        painter.setPen(QColor(ink))
        painter.drawText(QRectF(0, 37, self.width(), 20), Qt.AlignmentFlag.AlignCenter, self.text())
        self._paint_badge(painter, QPointF(self.width() / 2 + 12, 12))

    def _paint_badge(self, painter: QPainter, at: QPointF) -> None:
        tones = {"done": "ok", "look": "warn", "bad": "bad"}
        if self._state not in tones:
            return
        tokens = tokens_of(self)
        painter.setPen(QPen(QColor(tokens.panel), 1.5))
        painter.setBrush(QColor(getattr(tokens, tones[self._state])))
        painter.drawEllipse(at, 7, 7)
        if self._state == "done":
            painter.setPen(QPen(QColor(tokens.panel), 1.5, c=Qt.PenCapStyle.RoundCap))
            tick = [QPointF(-2.8, 0.1), QPointF(-0.8, 2.1), QPointF(2.8, -1.9)]
            painter.drawPolyline(QPolygonF([at + each for each in tick]))
        elif self._count:
            type_ = font("axis")
            type_.setWeight(type_.Weight.Bold)
            painter.setFont(type_)
            painter.setPen(QColor(tokens.panel))
            painter.drawText(
                QRectF(at.x() - 8, at.y() - 8, 16, 16), Qt.AlignmentFlag.AlignCenter, str(self._count)
            )
