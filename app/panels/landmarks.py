"""The landmarks of the body, how sure each is, and the rule it was found by."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QAbstractButton,
    QButtonGroup,
    QFrame,
    QHBoxLayout,
    QScrollArea,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from app.dress.parts import Disclosure, EmptyState, button, hairline, paint_card, sentence
from app.dress.theme import font, label, set_tag, tokens_of, tone_of
from app.wording.words import say, tr


@dataclass(frozen=True)
class LandmarkView:
    """What is shown of a landmark; ``confidence`` 0..1, ``group`` bust, under or further.

    ``absent``: it was not found, and can be placed.
    """

    name: str
    title: str
    confidence: float
    rule: str
    group: str = "bust"
    by_hand: bool = False
    absent: bool = False


class LandmarksPanel(QWidget):
    """All landmarks, one row each; under them the rule of the selected one.

    ``reset_asked`` names the landmarks, a tuple, that are to be found again; ``place_asked`` one that was not
    found and is to be placed.
    """

    landmark_selected = Signal(str)
    place_asked = Signal(str)
    reset_asked = Signal(object)

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
        self._summary.setContentsMargins(4, 2, 0, 6)
        self._empty = EmptyState(
            "map-pin", tr("No landmarks yet"), tr("They are found on the scan. Open one first.")
        )
        for each in (heading, self._summary, self._empty):
            column.addWidget(each)
        column.addWidget(self._list(), 1)
        column.addWidget(self._foot())
        column.addStretch(0)
        self._group = QButtonGroup(self)
        self.set_landmarks([])

    def _list(self) -> QScrollArea:
        inside = QWidget()
        inside.setProperty("scrolled", "true")
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 6, 0)
        column.setSpacing(0)
        self._groups: dict[str, QVBoxLayout] = {}
        self._heads: dict[str, QWidget] = {
            "bust": label(tr("Bust"), "caption"),
            "under": label(tr("Folds and breast roots"), "caption"),
            "further": Disclosure(tr("Further landmarks")),
        }
        self.further = QWidget()
        for name, head in self._heads.items():
            head.setContentsMargins(4, 8, 0, 3)
            column.addWidget(head)
            holder = self.further if name == "further" else QWidget()
            rows = self._groups[name] = QVBoxLayout(holder)
            rows.setContentsMargins(0, 0, 0, 0)
            rows.setSpacing(0)
            column.addWidget(holder)
        disclosure = self._heads["further"]
        assert isinstance(disclosure, Disclosure)
        disclosure.toggled.connect(self.further.setVisible)
        self.further.hide()
        column.addStretch(1)
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._area.setWidget(inside)
        return self._area

    def _foot(self) -> QWidget:
        self._rule_box = QWidget()
        rule = QVBoxLayout(self._rule_box)
        rule.setContentsMargins(4, 8, 4, 12)
        rule.setSpacing(3)
        self._rule_title, self._rule = sentence("", "name"), sentence()
        self._hint = sentence(role="caption")
        self.place = button(tr("Place it"))
        self.reset, self.reset_all = button(tr("Find it again")), button(tr("Find all again"), "quiet")
        self.place.clicked.connect(lambda: self.place_asked.emit(self._selected))
        self.reset.clicked.connect(lambda: self.reset_asked.emit((self._selected,)))
        self.reset_all.clicked.connect(lambda: self.reset_asked.emit(self._placed()))
        buttons = QHBoxLayout()
        for each in (self.place, self.reset, self.reset_all):
            buttons.addWidget(each)
        buttons.addStretch(1)
        rule.addWidget(hairline())
        rule.addSpacing(8)
        for part in (self._rule_title, self._rule, self._hint):
            rule.addWidget(part)
        rule.addSpacing(4)
        rule.addLayout(buttons)
        return self._rule_box

    def set_landmarks(
        self, landmarks: Sequence[LandmarkView], doubts: Sequence[str] = (), *, placing: bool = True
    ) -> None:
        """Show these landmarks and the ``doubts`` about them; rows stay while names and order stay.

        ``placing``: those that are absent can be placed.
        """
        self._placing = placing
        if [view.name for view in landmarks] != list(self.rows):
            self._rebuild(landmarks)
        for view in landmarks:
            self.rows[view.name].show_view(view)
        absent = any(view.absent for view in landmarks)
        self._summary.setText(" ".join(map(say, doubts)) or tr("All found."))
        set_tag(self._summary, "tone", "warn" if doubts else "")
        self._summary.setVisible(bool(doubts) or (bool(landmarks) and not absent))
        self._empty.setVisible(not landmarks)
        self._area.setVisible(bool(landmarks))
        for name, head in self._heads.items():
            head.setVisible(any(view.group == name for view in landmarks))
        self.select(self._selected if self._selected in self.rows else None)

    def select(self, name: str | None) -> None:
        """Show the rule of a landmark; nothing is emitted."""
        self._selected = name
        for each, row in self.rows.items():
            row.setChecked(each == name)
        placed = self._placed()
        self._rule_box.setVisible(name is not None or bool(placed))
        for part in (self._rule_title, self._rule, self._hint):
            part.setVisible(name is not None)
        absent = name is not None and self.rows[name].view.absent
        self.place.setVisible(absent and self._placing)
        self.reset.setVisible(name in placed)
        self.reset_all.setVisible(bool(placed) and placed != (name,))
        if name is not None:
            view = self.rows[name].view
            self._rule_title.setText(view.title)
            self._rule.setText(say(view.rule))
            drag = tr("Drag its pin over the skin to correct it.")
            self._hint.setText(tr("Puts a pin in the middle of the view.") if absent else drag)
            self._hint.setVisible(self._placing or not absent)
            if view.group == "further":
                self._open_further()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        step = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}.get(Qt.Key(event.key()))
        names = [name for name, row in self.rows.items() if row.isVisible()]
        if step is None or not names:
            super().keyPressEvent(event)
            return
        here = names.index(self._selected) if self._selected in names else -1
        name = names[min(max(here + step, 0), len(names) - 1)]
        self.rows[name].setFocus(Qt.FocusReason.OtherFocusReason)
        self._area.ensureWidgetVisible(self.rows[name])
        self._choose(name)

    def _placed(self) -> tuple[str, ...]:
        return tuple(name for name, row in self.rows.items() if row.view.by_hand)

    def _open_further(self) -> None:
        disclosure = self._heads["further"]
        assert isinstance(disclosure, Disclosure)
        disclosure.setChecked(True)

    def _rebuild(self, landmarks: Sequence[LandmarkView]) -> None:
        for row in self.rows.values():
            row.setParent(None)
            row.deleteLater()
        self.rows = {view.name: LandmarkRow(view) for view in landmarks}
        self._group.setExclusive(False)
        for name, row in self.rows.items():
            self._groups[row.view.group].addWidget(row)
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
        # A button would rather widen the list than be narrower than it likes: the figures would be cut off.
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
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
        self.setAccessibleName(f"{view.title} {self._words()}")
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        paint_card(painter, self, "selected", 7)
        tone = tokens.accent if self.view.by_hand else getattr(tokens, tone_of(self.view.confidence))
        middle, right = self.height() / 2, self.width() - 10
        painter.setPen(QPen(QColor(tokens.text_caption if self.view.absent else tokens.raised), 1.5))
        painter.setBrush(Qt.BrushStyle.NoBrush if self.view.absent else QColor(tone))
        painter.drawEllipse(QPointF(14, middle), 5.5, 5.5)
        painter.setFont(font("name" if self.isChecked() else "body"))
        painter.setPen(QColor(tokens.text_quiet if self.view.absent else tokens.text))
        left = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        room = self.width() - 28 - (70 if self.view.by_hand else 90 if self.view.absent else 112)
        title = painter.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, room)
        painter.drawText(QRectF(28, 0, room, self.height()), left, title)
        painter.setFont(font("secondary", tabular=True))
        painter.setPen(QColor(tokens.text if self.isChecked() else tokens.text_quiet))
        past = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight
        painter.drawText(QRectF(right - 110, 0, 110, self.height()), past, self._words())
        if self.view.by_hand or self.view.absent:
            return
        painter.setPen(Qt.PenStyle.NoPen)
        bar = QRectF(right - 48 - 52, middle - 1.5, 52, 3)
        painter.setBrush(QColor(tokens.groove))
        painter.drawRoundedRect(bar, 1.5, 1.5)
        bar.setWidth(52 * min(max(self.view.confidence, 0.0), 1.0))
        painter.setBrush(QColor(tone))
        painter.drawRoundedRect(bar, 1.5, 1.5)

    def _words(self) -> str:
        if self.view.absent:
            return tr("not found")
        return tr("by hand") if self.view.by_hand else f"{self.view.confidence * 100:.0f} %"
