"""One line in the list, or a linked pair: name, set length, slider; opened also what was reached."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QEnterEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QApplication, QFrame, QHBoxLayout, QVBoxLayout, QWidget

from app.gui.features.lines.details import LineDetails
from app.gui.features.lines.slider import LengthSlider
from app.gui.theme.stylesheet import label, set_tag, tokens_of
from app.gui.widgets.basic import ToolButton, sentence, speak_value
from app.gui.widgets.line_widgets import LEAST, LineChip, LineTitle, SideMark
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import LengthEdit
from app.i18n.catalog import number, tr
from app.i18n.lengths import length
from app.presenters.length_limits import length_tip
from app.presenters.lines import LineView

__all__ = ["LineRow", "LineView"]


class LineRow(QFrame):
    """The row of one line or linked pair; lengths in its signals are shares of the rest length [1].

    ``decided`` carries a trait of the line and its value: title, colour, locked, linked, stiffness.
    """

    previewed = Signal(float)
    committed = Signal(float)
    cancelled = Signal()
    pressed = Signal()
    visibility_changed = Signal(bool)
    decided = Signal(str, object)
    path_requested = Signal()
    removed = Signal()
    elastic_requested = Signal()

    def __init__(self, view: LineView) -> None:
        super().__init__()
        self.view = view
        self._open = self._hovered = False
        self.slider = LengthSlider(view.color)
        self.percent, self.millimetres = LengthEdit("%"), LengthEdit("mm")
        self.details = LineDetails()
        self._build()
        self._connect()
        self.show_view(view)
        self.set_open(False)

    def show_view(self, view: LineView) -> None:
        """Show new values of the same line, without disturbing a drag or a number being typed.

        The keyboard stays in the row, however little of it can still be set.
        """
        has = QApplication.focusWidget()
        kept = has is self or has in (self.slider, self.percent, self.millimetres)
        self.view = view
        self.title.setText(view.pair_title if view.apart else view.title)  # its side stands beside it
        self._show_names(view.title)
        set_tip(self.title, f"{view.title}\n{tr('Rename (double-click or F2)')}")
        set_tag(self.title, "tone", "" if view.visible else "faint")
        self._side.show_side(view.apart)
        self.title.setMinimumWidth(LEAST - 22 if view.apart else LEAST)  # its mark takes no more room
        self._chip.show_line(view.color, view.width_mm, view.visible)
        self._show_slider(view)
        self._show_lengths(self._set_ratio())
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus if view.settable else Qt.FocusPolicy.TabFocus)
        if kept and not view.settable:
            self.setFocus(Qt.FocusReason.OtherFocusReason)
        self._tips[self.slider] = length_tip(*self.slider.ends())  # a typed length makes it reach further
        for each in (self.slider, self.percent, self.millimetres):
            each.setVisible(view.constrained)
            each.setEnabled(view.settable)
            set_tag(each, "tried", "yes" if view.tried else "")
            set_tip(each, _tip(view) or self._tips[each])
        if has is self and view.settable:
            self.slider.setFocus(Qt.FocusReason.OtherFocusReason)
        self._measure.setVisible(not view.constrained)
        self._measure.setText(length(view.reached_mm or view.rest_mm))
        self.note.setText(_still_words(view))
        self.note.setVisible(not view.constrained)
        if self._open:  # while the row is closed nobody sees them
            self.details.show_view(view)
        self._eye.show_icon("eye" if view.visible else "eye-slash")
        self._lock.show_icon("lock" if view.locked else "unlock")
        self._show_opened()

    def _show_names(self, title: str) -> None:
        """Tell ears whose row this is: several lines have the same fields."""
        if title == self.accessibleName():
            return
        self.setAccessibleName(title)
        self.slider.setAccessibleName(tr("Length of {line}").format(line=title))
        for field in (self.percent, self.millimetres):
            field.name_line(title)
        for tool in (self._link, self._eye, self._lock):
            tool.setAccessibleName(f"{title}: {tool.toolTip()}")

    def set_open(self, open_: bool) -> None:
        """Open or close the row."""
        if open_ and not self._open:
            self.details.show_view(self.view)
            self.details.show_lengths(self.view, self._set_ratio())
        self._open = open_
        self.slider.set_strong(open_)
        self._show_opened()
        self.update()

    def take_focus(self, reason: Qt.FocusReason) -> None:
        """Set the keyboard focus to the slider, or to the row if its length cannot be set."""
        (self.slider if self.view.settable else self).setFocus(reason)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.pressed.emit()
        self.take_focus(Qt.FocusReason.MouseFocusReason)

    def enterEvent(self, event: QEnterEvent) -> None:
        self._hover(True)

    def leaveEvent(self, event: QEvent) -> None:
        self._hover(False)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        card = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        if self._open:
            painter.setPen(QColor(tokens.outline))
            painter.setBrush(QColor(tokens.raised))
            painter.drawRoundedRect(card, 9, 9)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(self.view.color))
            painter.drawRoundedRect(QRectF(0, 12, 3, self.height() - 24), 1.5, 1.5)
        elif self._hovered:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.hover))
            painter.drawRoundedRect(card, 9, 9)
        if self.hasFocus():
            painter.setPen(QPen(QColor(tokens.accent), 2))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(card.adjusted(0.5, 0.5, -0.5, -0.5), 9, 9)
        self._paint_bracket(painter)

    def _paint_bracket(self, painter: QPainter) -> None:
        """Draw a half of the bracket that holds left and right together, the left one above the right one."""
        if self.view.apart:
            first, level = self.view.apart == "left", self._chip.geometry().center().y() + 0.5
            ends = (level, self.height() + 0.5) if first else (-0.5, level)
            painter.setPen(QPen(QColor(self.view.color), 1.5))
            painter.drawLine(QPointF(6, ends[0]), QPointF(6, ends[1]))
            painter.drawLine(QPointF(6, level), QPointF(10, level))

    def _build(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 8, 8, 6)
        column.setSpacing(2)
        head = QHBoxLayout()
        head.setSpacing(5)
        self._chip, self.title = LineChip(), LineTitle()
        self._both, self._side = label(tr("left + right"), "caption"), SideMark()
        self._link = ToolButton(
            "link", tr("Link both sides and copy this length to the other side (L)"), size=15, room=20
        )
        self._eye = ToolButton("eye", tr("Show or hide this line (H)"), size=15, room=20)
        self._lock = ToolButton(
            "unlock", tr("Lock or unlock the length of this line (Shift+L)"), size=16, room=22
        )
        self._measure = label("", "name", tabular=True)
        self._measure.setContentsMargins(0, 3, 6, 3)
        marks = QHBoxLayout()
        marks.setSpacing(0)
        for each in (self._link, self._eye, self._lock):
            marks.addWidget(each)
        head.addWidget(self._chip)
        head.addWidget(self.title)
        head.addWidget(self._side)
        head.addWidget(self._both)
        head.addLayout(marks)
        head.addStretch(1)
        for part in (self.percent, self.millimetres, self._measure):
            head.addWidget(part)
        self.note = sentence("", "caption")
        self.note.setContentsMargins(20, 0, 0, 2)
        self._tips: dict[QWidget, str] = {each: each.toolTip() for each in (self.percent, self.millimetres)}
        column.addLayout(head)
        for below in (self.slider, self.note, self.details):
            column.addWidget(below)

    def _connect(self) -> None:
        self.slider.previewed.connect(self._show_lengths)
        self.slider.previewed.connect(self.previewed)
        self.slider.sliderPressed.connect(self.pressed)
        self.slider.committed.connect(self._take)
        self.slider.cancelled.connect(self._put_back)
        for field in (self.percent, self.millimetres):
            field.entered.connect(self._take)
            field.opened.connect(self.pressed)
            field.closed.connect(self.slider.setFocus)
        self.title.renamed.connect(lambda title: self.decided.emit("title", title))
        self.title.closed.connect(lambda: self.take_focus(Qt.FocusReason.OtherFocusReason))
        self.details.decided.connect(self.decided)
        self.details.requested.connect(self._do)
        self.details.elastic_requested.connect(self.elastic_requested)
        self._eye.clicked.connect(lambda: self.visibility_changed.emit(not self.view.visible))
        self._link.clicked.connect(lambda: self.decided.emit("linked", True))
        self._lock.clicked.connect(lambda: self.decided.emit("locked", not self.view.locked))

    def _do(self, what: str) -> None:
        if what == "rename":
            self.title.begin()
        elif what == "reset":
            self._take(1.0)
        elif what == "path":
            self.path_requested.emit()
        else:
            self.removed.emit()

    def _take(self, ratio: float) -> None:
        self.slider.set_ratio(ratio)
        self._show_lengths(ratio)
        self.committed.emit(ratio)

    def _put_back(self) -> None:
        self._show_lengths(self.slider.ratio())
        self.cancelled.emit()

    def _show_slider(self, view: LineView) -> None:
        self.slider.set_color(view.color)
        self.slider.set_leeway(view.leeway, view.stale)
        self.slider.set_ratio(view.ratio)
        self.slider.set_reached(None if view.reached_mm is None else view.reached_mm / view.rest_mm)

    def _show_lengths(self, ratio: float) -> None:
        """Write a set length, which during a drag runs ahead of the view."""
        for field in (self.percent, self.millimetres):
            field.show_length(ratio, self.view.rest_mm, self.view.whole_mm)
        spoken = f"{number(ratio * 100)} %, {length(ratio * self.view.rest_mm)}"
        speak_value(self.slider, spoken)
        self.setAccessibleDescription(self._measure.text() if not self.view.constrained else spoken)
        if self._open:
            self.details.show_lengths(self.view, ratio)

    def _set_ratio(self) -> float:
        """Return the set length: during a drag the one in the hand."""
        return self.slider.ratio() if self.slider.isSliderDown() else self.view.ratio

    def _hover(self, hovered: bool) -> None:
        self._hovered = hovered
        self._show_opened()
        self.update()

    def _show_opened(self) -> None:
        """Show what only a row in hand has, and the marks that say something by being there."""
        in_hand = self._hovered or self._open
        self._both.setVisible(bool(self.view.sides) and not in_hand)
        self._link.setVisible(bool(self.view.apart) and not self._open)
        crowded = bool(self.view.apart) and not self._open
        self._eye.setVisible((in_hand and not crowded) or not self.view.visible)
        self._lock.setVisible((in_hand and self.view.constrained) or self.view.locked)
        self.details.setVisible(self._open)


def _still_words(view: LineView) -> str:
    """Return what a line on points that do not move is good for."""
    if view.elastic:
        words = tr(
            "Elastic: {elastic}. The line does not move the body but has contact pressure and a cut "
            "length: see the Garment tab."
        )
        return words.format(elastic=view.elastic)
    if view.own:
        return tr("On fixed points: measured only.")
    return tr("On the rib cage: measured only. To cut a band, choose an elastic on the Garment tab.")


def _tip(view: LineView) -> str:
    """Return what is said on hovering over a line's length instead of the usual."""
    if view.tried:
        return tr("Preview of the target shape. Choose Apply to accept.")
    return locked_tip() if view.locked else elastic_tip() if view.elastic else ""


def elastic_tip() -> str:
    """Return what the length of a line means that is made of an elastic."""
    return tr("Set the unstretched length of the elastic, in percent of the original front length.")


def locked_tip() -> str:
    """Return why the length of a line stays."""
    return tr("This line is locked: its length is kept. Unlock it with the lock button or Shift+L.")
