"""One constraining line in the list: name, set length, slider; opened also what was reached."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QEvent, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QEnterEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.dress.parts import ToolButton, hairline, sentence
from app.dress.theme import font, label, set_tag, tokens_of
from app.panels.length_slider import LengthSlider
from app.panels.number_field import NumberField
from app.wording.words import number, tr

_OFF = 5e-6  # a set length nearer to the rest length than this means that the line is not worn
_GAP_SEEN, _GAP_LARGE = 0.005, 0.02  # shares of the set length above which a gap is amber, red


@dataclass(frozen=True)
class LineView:
    """What a row shows of a line; lengths [mm], ``ratio`` = set over rest length [1].

    ``rest_mm`` is the rest length of the free front part, ``whole_mm`` that of the whole closed band.
    ``reached_mm`` is None before a run. A line that is not ``constrained`` is only measured; an ``own`` one
    can be removed.
    """

    name: str
    title: str
    color: str
    ratio: float
    rest_mm: float
    reached_mm: float | None
    constrained: bool
    visible: bool
    whole_mm: float
    own: bool = False


class LineChip(QWidget):
    """The colour of a line, as an outline only while the line is hidden."""

    def __init__(self, color: str) -> None:
        super().__init__()
        self._color, self._filled = color, True
        self.setFixedSize(QSize(14, 14))

    def set_filled(self, filled: bool) -> None:
        """Fill the chip, or leave the outline."""
        self._filled = filled
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        rim = QColor("#FFFFFF")
        rim.setAlpha(97 if tokens_of(self).dark else 0)
        outline = QColor(self._color).lighter(150) if tokens_of(self).dark else QColor(self._color)
        painter.setPen(QPen(rim, 1) if self._filled else QPen(outline, 1.5))
        painter.setBrush(QColor(self._color) if self._filled else Qt.BrushStyle.NoBrush)
        painter.drawRoundedRect(QRectF(0.75, 2.75, 12.5, 8.5), 3, 3)


class LineRow(QFrame):
    """The row of one line; lengths in its signals are shares of the rest length [1]."""

    previewed = Signal(float)
    committed = Signal(float)
    cancelled = Signal()
    pressed = Signal()
    visibility_changed = Signal(bool)
    removed = Signal()

    def __init__(self, view: LineView) -> None:
        super().__init__()
        self.view = view
        self._open = self._hovered = False
        self.slider = LengthSlider(view.color)
        self.percent, self.millimetres = NumberField("%"), NumberField("mm")
        self._build()
        self._connect()
        self.show_view(view)
        self.set_open(False)

    def show_view(self, view: LineView) -> None:
        """Show new values of the same line, without disturbing a drag or a number being typed."""
        self.view = view
        self._name.setText(view.title)
        self._name.setToolTip(view.title if view.own else "")
        set_tag(self._name, "tone", "" if view.visible else "faint")
        self._chip.set_filled(view.visible)
        self._show_lengths(self.slider.ratio() if self.slider.isSliderDown() else view.ratio)
        self.slider.set_ratio(view.ratio)
        self.slider.set_reached(None if view.reached_mm is None else view.reached_mm / view.rest_mm)
        for each in (self.slider, self.percent, self.millimetres):
            each.setVisible(view.constrained)
        self._measure.setVisible(not view.constrained)
        self._measure.setText(f"{number(view.reached_mm or view.rest_mm)} mm")
        self._foot.setVisible(not view.constrained)
        self._details.setVisible(self._open and view.constrained)
        self._eye.show_icon("eye" if view.visible else "eye-slash")
        self._show_eye()

    def set_open(self, open_: bool) -> None:
        """Open or close the row."""
        self._open = open_
        self._details.setVisible(open_ and self.view.constrained)
        self._show_eye()
        self.update()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.pressed.emit()
        (self.slider if self.view.constrained else self).setFocus(Qt.FocusReason.MouseFocusReason)

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

    def _build(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 8, 8, 6)
        column.setSpacing(2)
        self._details = _Details()
        head = QHBoxLayout()
        head.setSpacing(8)
        self._chip = LineChip(self.view.color)
        self._name = _Title()
        self._eye = ToolButton("eye", tr("Show or hide this line (H)"), size=16, room=24)
        self._measure = label("", "name", tabular=True)
        self._measure.setContentsMargins(0, 3, 6, 3)
        head.addWidget(self._chip)
        head.addWidget(self._name)
        head.addWidget(self._eye)
        head.addStretch(1)
        head.addWidget(self.percent)
        head.addWidget(self.millimetres)
        head.addWidget(self._measure)
        still = tr("On points that do not move: measured only.")
        note = still if self.view.own else tr("On the rib cage: measured, it does not move.")
        self._note = sentence(note, "caption")
        self._foot = QWidget()
        foot = QHBoxLayout(self._foot)
        foot.setContentsMargins(22, 0, 4, 4)
        self._bins = (remove_button(), self._details.bin)
        foot.addWidget(self._note, 1)
        foot.addWidget(self._bins[0], alignment=Qt.AlignmentFlag.AlignTop)
        self.slider.setAccessibleName(tr("Length of {line}").format(line=self.view.title))
        self.slider.setToolTip(
            tr("Length of the front part, 80 to 112 % of its rest.\n← → 0.1 %, Shift 1 %, Alt 0.01 %")
        )
        column.addLayout(head)
        column.addWidget(self.slider)
        column.addWidget(self._foot)
        column.addWidget(self._details)

    def _connect(self) -> None:
        self.slider.previewed.connect(self._show_lengths)
        self.slider.previewed.connect(self.previewed)
        self.slider.sliderPressed.connect(self.pressed)
        self.slider.committed.connect(self._take)
        self.slider.cancelled.connect(self._put_back)
        for field in (self.percent, self.millimetres):
            field.entered.connect(self._take)
            field.opened.connect(self.pressed)
            field.left.connect(self.slider.setFocus)
        for each in self._bins:
            each.clicked.connect(self.removed)
        self._eye.clicked.connect(lambda: self.visibility_changed.emit(not self.view.visible))

    def _take(self, ratio: float) -> None:
        self.slider.set_ratio(ratio)
        self._show_lengths(ratio)
        self.committed.emit(ratio)

    def _put_back(self) -> None:
        self._show_lengths(self.slider.ratio())
        self.cancelled.emit()

    def _show_lengths(self, ratio: float) -> None:
        """Write a set length, which during a drag runs ahead of the view."""
        for field in (self.percent, self.millimetres):
            field.show_length(ratio, self.view.rest_mm, self.view.whole_mm)
        self._details.show_lengths(self.view, ratio)

    def _hover(self, hovered: bool) -> None:
        self._hovered = hovered
        self._show_eye()
        self.update()

    def _show_eye(self) -> None:
        self._eye.setVisible(self._hovered or self._open or not self.view.visible)
        for each in self._bins:
            each.setVisible(self.view.own and self._open)


class _Details(QWidget):
    """Set, reached and gap of an open row, and what the length is a part of."""

    def __init__(self) -> None:
        super().__init__()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 4, 4, 8)
        grid.setHorizontalSpacing(8)
        grid.setVerticalSpacing(1)
        self._values: list[QLabel] = []
        for place, title in enumerate((tr("Set"), tr("Reached"), tr("Gap"))):
            grid.addWidget(label(title, "caption"), 0, place)
            value = label("", "heading", tabular=True)
            value.setTextFormat(Qt.TextFormat.RichText)
            grid.addWidget(value, 1, place)
            self._values.append(value)
            grid.setColumnStretch(place, 1)
        grid.addWidget(hairline(), 2, 0, 1, 3)
        grid.setRowMinimumHeight(2, 17)
        self._part = sentence("", "caption")
        self._whole = sentence("", "caption")
        self.bin = remove_button()
        grid.addWidget(self._part, 3, 0, 1, 3)
        grid.addWidget(self._whole, 4, 0, 1, 3)
        grid.addWidget(self.bin, 3, 2, 2, 1, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignTop)

    def show_lengths(self, view: LineView, ratio: float) -> None:
        """Show a set length, as a share of the rest length, and what ``view`` reached."""
        set_mm = ratio * view.rest_mm
        whole_mm = view.whole_mm - view.rest_mm + set_mm
        worn = abs(ratio - 1.0) > _OFF
        self._values[0].setText(_figure(number(set_mm), "mm"))
        front, own = (
            tr("{percent} % of the front part, side to side"),
            tr("{percent} % of its length at rest"),
        )
        part = (own if view.own else front).format(percent=number(ratio * 100))
        self._whole.setVisible(view.whole_mm > view.rest_mm)
        self._part.setText(part if worn else tr("At 100 % the line is off: it measures and does not pull."))
        whole = tr("Whole band: {set} of {rest} mm ({percent} %)")
        percent = number(whole_mm / view.whole_mm * 100)
        self._whole.setText(whole.format(set=number(whole_mm), rest=number(view.whole_mm), percent=percent))
        self._show_reached(view.reached_mm, set_mm, worn)

    def _show_reached(self, reached_mm: float | None, set_mm: float, worn: bool) -> None:
        reached, gap, tone = "–", "–", ""
        if reached_mm is not None:
            off = reached_mm - set_mm
            share = abs(off) / set_mm
            reached = _figure(number(reached_mm), "mm")
            gap = _figure(number(off, signed=True), f"mm&nbsp; {number(share * 100)} %")
            if worn and share > _GAP_SEEN:
                tone = "bad" if share > _GAP_LARGE else "warn"
        self._values[1].setText(reached)
        self._values[2].setText(gap)
        set_tag(self._values[2], "tone", tone)


def remove_button() -> ToolButton:
    """Return the button that removes an own line."""
    return ToolButton("trash", tr("Remove this line (Del)"), size=16, room=24)


class _Title(QLabel):
    """The name of a line; where there is no room for it, its beginning."""

    def __init__(self) -> None:
        super().__init__()
        self.setFont(font("name"))
        self.setProperty("role", "name")
        self.setMinimumWidth(40)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        shown = painter.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, self.width())
        painter.drawText(self.rect(), Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, shown)


def _figure(value: str, unit: str) -> str:
    """Return a number with its unit behind it in small type, as rich text."""
    return f'{value} <span style="font-size:11px; font-weight:400">{unit}</span>'
