"""The landmarks of the bust, how sure each is, and the rule it was found by."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QButtonGroup, QVBoxLayout, QWidget

from app.parts import EmptyState, hairline, paint_card, sentence
from app.theme import font, label, tokens_of, tone_of
from app.words import say, tr


@dataclass(frozen=True)
class LandmarkView:
    """What is shown of a landmark; ``confidence`` 0..1, ``rule`` a sentence."""

    name: str
    title: str
    confidence: float
    rule: str


class LandmarksPanel(QWidget):
    """All landmarks, one row each; under them the rule of the selected one."""

    landmark_selected = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.rows: dict[str, LandmarkRow] = {}
        self._selected: str | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(14, 14, 14, 14)
        column.setSpacing(2)
        heading = label(tr("Landmarks"), "heading")
        heading.setContentsMargins(4, 0, 0, 0)
        self._summary = sentence()
        self._summary.setContentsMargins(4, 2, 0, 8)
        self._empty = EmptyState(
            "map-pin", tr("No landmarks yet"), tr("They are found on the scan. Open one first.")
        )
        self._list = QVBoxLayout()
        self._list.setSpacing(0)
        self._rule_box = QWidget()
        rule = QVBoxLayout(self._rule_box)
        rule.setContentsMargins(4, 10, 4, 0)
        rule.setSpacing(3)
        self._rule_title, self._rule = sentence("", "name"), sentence()
        rule.addWidget(hairline())
        rule.addSpacing(8)
        rule.addWidget(self._rule_title)
        rule.addWidget(self._rule)
        for each in (heading, self._summary, self._empty):
            column.addWidget(each)
        column.addLayout(self._list)
        column.addWidget(self._rule_box)
        column.addStretch(1)
        self._group = QButtonGroup(self)
        self.set_landmarks([])

    def set_landmarks(self, landmarks: Sequence[LandmarkView]) -> None:
        """Show these landmarks; rows stay the same widgets while names and order stay."""
        if [view.name for view in landmarks] != list(self.rows):
            self._rebuild(landmarks)
        for view in landmarks:
            self.rows[view.name].show_view(view)
        weak = sum(tone_of(view.confidence) != "ok" for view in landmarks)
        found = tr("All found.") if not weak else tr("All found. {count} should be looked at.")
        self._summary.setText(found.format(count=weak))
        self._summary.setVisible(bool(landmarks))
        self._empty.setVisible(not landmarks)
        self.select(self._selected if self._selected in self.rows else None)

    def select(self, name: str | None) -> None:
        """Show the rule of a landmark; nothing is emitted."""
        self._selected = name
        for each, row in self.rows.items():
            row.setChecked(each == name)
        self._rule_box.setVisible(name is not None)
        if name is not None:
            self._rule_title.setText(self.rows[name].view.title)
            self._rule.setText(say(self.rows[name].view.rule))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}.get(Qt.Key(event.key()))
        if step is None or not self.rows:
            super().keyPressEvent(event)
            return
        names = list(self.rows)
        here = names.index(self._selected) if self._selected in names else -1
        name = names[min(max(here + step, 0), len(names) - 1)]
        self.rows[name].setFocus(Qt.FocusReason.OtherFocusReason)
        self._choose(name)

    def _rebuild(self, landmarks: Sequence[LandmarkView]) -> None:
        for row in self.rows.values():
            self._list.removeWidget(row)
            row.deleteLater()
        self.rows = {view.name: LandmarkRow(view) for view in landmarks}
        self._group.setExclusive(False)
        for name, row in self.rows.items():
            self._list.addWidget(row)
            row.clicked.connect(lambda _=False, chosen=name: self._choose(chosen))

    def _choose(self, name: str) -> None:
        self.select(name)
        self.landmark_selected.emit(name)


class LandmarkRow(QAbstractButton):
    """A landmark: dot, name, bar and percent of confidence."""

    def __init__(self, view: LandmarkView) -> None:
        super().__init__()
        self.view = view
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setMinimumHeight(34)

    def sizeHint(self) -> QSize:
        type_ = font("name")
        self.setFont(type_)
        return QSize(self.fontMetrics().horizontalAdvance(self.text()) + 150, 34)

    def show_view(self, view: LandmarkView) -> None:
        """Show new values of the same landmark."""
        self.view = view
        self.setText(view.title)
        self.setToolTip(say(view.rule))
        self.setAccessibleName(f"{view.title} {view.confidence:.0%}")
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        paint_card(painter, self, "selected", 7)
        tone = getattr(tokens, tone_of(self.view.confidence))
        middle, right = self.height() / 2, self.width() - 10
        painter.setPen(QPen(QColor(tokens.raised), 1.5))
        painter.setBrush(QColor(tone))
        painter.drawEllipse(QPointF(14, middle), 5.5, 5.5)
        painter.setFont(font("name" if self.isChecked() else "body"))
        painter.setPen(QColor(tokens.text))
        left = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        painter.drawText(QRectF(28, 0, self.width() - 140, self.height()), left, self.text())
        painter.setFont(font("secondary", tabular=True))
        painter.setPen(QColor(tokens.text if self.isChecked() else tokens.text_quiet))
        percent = QRectF(right - 48, 0, 48, self.height())
        past = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight
        painter.drawText(percent, past, f"{self.view.confidence * 100:.0f} %")
        painter.setPen(Qt.PenStyle.NoPen)
        bar = QRectF(right - 48 - 52, middle - 1.5, 52, 3)
        painter.setBrush(QColor(tokens.groove))
        painter.drawRoundedRect(bar, 1.5, 1.5)
        bar.setWidth(52 * min(max(self.view.confidence, 0.0), 1.0))
        painter.setBrush(QColor(tone))
        painter.drawRoundedRect(bar, 1.5, 1.5)
