"""The section plane's panel: curves before and after, where the plane is, and how far bust points moved."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QObject, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QSlider, QStyle, QStyleOptionSlider, QVBoxLayout, QWidget

from app.gui.plots.live_plot import QuantityTitle
from app.gui.plots.section_plot import SectionDrawing, SectionPlot, paint_band
from app.gui.session.settings import get_setting, set_setting
from app.gui.theme.stylesheet import font, label, tokens_of
from app.gui.widgets.basic import FloatingPanel, ToolButton, speak_value
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import tr
from app.i18n.lengths import arrow_step, length, length_unit
from app.presenters.plots import Quantity

STEPS = 2
"""Places of the slider in a step of an arrow key."""

NARROW, WIDE = 196, 244
"""Least and largest width of the plot, which leaves the body the rest of the view [px]."""

SPACING = 4
"""Between the parts of the panel [px]."""

_SHARE = 0.26  # of the view's width that the plot takes between these
_FLAT = 0.78  # its height by its width
_ROOMY = 224  # a narrower panel leaves the axis' letter to the slider


class SectionPanel(FloatingPanel):
    """Title, plot, place of the plane and what the curves are; folded, only title and place.

    The plot is the smaller the smaller the view is that the panel lies on.

    ``axis_chosen`` carries x, y or z; ``moved`` a place on it [mm]; ``through_requested`` left or right: the
    bust point that the plane is to go through.
    """

    axis_chosen = Signal(str)
    moved = Signal(float)
    through_requested = Signal(str)
    export_requested = Signal()
    closed = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._axes = {
            "x": Quantity("x", tr("Side profile"), "", 0.0),
            "z": Quantity("z", tr("Horizontal section"), "", 0.0),
            "y": Quantity("y", tr("Frontal section"), "", 0.0),
        }
        column = QVBoxLayout()
        column.setContentsMargins(6, 2, 2, 4)
        column.setSpacing(SPACING)
        column.addLayout(self._head())
        self.plot = SectionPlot()
        self.plot.setAccessibleName(tr("Curves of the section, in {unit}").format(unit=length_unit()))
        set_tip(self.plot, tr("Wheel: zoom. Drag: move. Double-click: fit changed region."))
        column.addWidget(self.plot)
        column.addLayout(self._place_row())
        self.keys = CurveKeys()
        column.addWidget(self.keys)
        self.readout = label("", "secondary", tabular=True)
        self.readout.setWordWrap(True)
        column.addWidget(self.readout)
        self.row.addLayout(column)
        self._by_hand, self._cramped = get_setting("section_folded") == "yes", False
        self._fit(WIDE)
        self._show_fold()
        if parent is not None:
            parent.installEventFilter(self)

    @property
    def is_folded(self) -> bool:
        """Return whether only title and place are shown."""
        return self.plot.isHidden()

    def set_folded(self, folded: bool) -> None:
        """Hide or show the curves."""
        self._by_hand = folded
        self._show_fold()

    def set_room(self, high: int) -> None:
        """Hide the curves as long as there is no more room than so high for the visible part [px]."""
        shadow = self.MARGINS[1] + self.MARGINS[3]
        full = self.sizeHint().height() - shadow
        if self.is_folded:
            full += self.plot.height() + self.keys.height() + self.readout.heightForWidth(self.plot.width())
            full += 3 * SPACING
        if self._cramped != (full > high):
            self._cramped = full > high
            self._show_fold()

    def _show_fold(self) -> None:
        folded = self._by_hand or self._cramped
        for part in (self.plot, self.keys, self.readout):
            part.setVisible(not folded)
        self.fold.show_icon("caret-up" if folded else "caret-down")
        self.fold.setEnabled(not self._cramped)
        text = tr("Show curves") if folded else tr("Collapse curves")
        self.fold.setAccessibleName(tr("Not enough space for curves") if self._cramped else text)
        set_tip(self.fold, self.fold.accessibleName())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QResizeEvent) and watched is self.parent():
            self._fit(min(max(round(_SHARE * event.size().width()), NARROW), WIDE))
        return False

    def _fit(self, width: int) -> None:
        self.plot.setFixedSize(width, round(_FLAT * width))
        self.readout.setFixedWidth(width)
        self._axis.setVisible(width >= _ROOMY)

    def _place_row(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(6)
        self.slider = PlaneSlider()
        self.slider.setAccessibleName(tr("Position of the section plane"))
        set_tip(self.slider, tr("Move section plane; ← → {step}").format(step=length(arrow_step(), 0)))
        self.slider.setSingleStep(STEPS)
        self.slider.setPageStep(10 * STEPS)
        self.slider.valueChanged.connect(lambda value: self.moved.emit(value * _place()))
        self._axis = label("", "caption")
        self.place = ValueEdit("mm", tr("Position of the section plane"), widest="−888.8")
        self.place.entered.connect(self.moved)
        row.addWidget(self.slider, 1)
        row.addWidget(self._axis)
        row.addWidget(self.place)
        return row

    def _head(self) -> QHBoxLayout:
        head = QHBoxLayout()
        head.setSpacing(2)
        self.title = QuantityTitle(list(self._axes.values()))
        set_tip(self.title, tr("Choose the section plane or export the curves"))
        self.title.chosen.connect(self.axis_chosen)
        menu = self.title.menu
        menu.addSeparator()
        for side, words in (
            ("left", tr("Through the left bust point")),
            ("right", tr("Through the right bust point")),
        ):
            menu.addAction(words).triggered.connect(
                lambda _=False, side=side: self.through_requested.emit(side)
            )
        menu.addSeparator()
        self.export = menu.addAction(tr("Export curves as CSV…"))
        self.export.triggered.connect(self.export_requested)
        self.fold = ToolButton("caret-down", size=14, room=24)
        self.fold.clicked.connect(self._turn_fold)
        close = ToolButton("x", tr("Close section (P)"), size=14, room=24)
        close.clicked.connect(self.closed)
        head.addWidget(self.title)
        head.addStretch(1)
        head.addWidget(self.fold)
        head.addWidget(close)
        return head

    def _turn_fold(self) -> None:
        self.set_folded(not self._by_hand)
        set_setting("section_folded", "yes" if self._by_hand else "no")

    def show_plane(self, axis: str, at: float, low: float, high: float) -> None:
        """Show which plane it is, where [mm], and how far it can go; nothing is emitted."""
        self.title.show_quantity(self._axes[axis])
        self._axis.setText(f"{axis} =")
        self.place.show_value(at)
        speak_value(self.slider, f"{axis} = {length(at)}")
        self.slider.blockSignals(True)
        self.slider.setRange(round(low / _place()), round(high / _place()))
        self.slider.setValue(round(at / _place()))
        self.slider.blockSignals(False)

    def show_curves(self, drawn: SectionDrawing, readout: str, *, again: bool) -> None:
        """Draw the curves; ``again`` shows all that changed."""
        self.plot.show_curves(drawn, again=again)
        banded = ["band"] if drawn.bands else []
        self.keys.show_roles([*(role for role in CurveKeys.ROLES if drawn.curves.get(role)), *banded])
        self.readout.setText(readout)


def _place() -> float:
    """Return how far two places of the slider are apart [mm]."""
    return arrow_step() / STEPS


class PlaneSlider(QSlider):
    """A quiet slider: a groove and a round handle."""

    def __init__(self) -> None:
        super().__init__(Qt.Orientation.Horizontal)
        self.setFixedHeight(22)
        self.setMinimumWidth(60)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        option = QStyleOptionSlider()
        self.initStyleOption(option)
        style = self.style()
        handle = style.subControlRect(
            QStyle.ComplexControl.CC_Slider, option, QStyle.SubControl.SC_SliderHandle, self
        )
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(tokens.groove))
        painter.drawRoundedRect(QRectF(4, self.height() / 2 - 2, self.width() - 8, 4), 2, 2)
        if self.hasFocus():
            halo = QColor(tokens.accent)
            halo.setAlpha(60)
            painter.setBrush(halo)
            painter.drawEllipse(QRectF(handle).center(), 10, 10)
        painter.setPen(QPen(QColor(tokens.accent), 1.6))
        painter.setBrush(QColor(tokens.raised))
        painter.drawEllipse(QRectF(handle).center(), 6.5, 6.5)


class CurveKeys(QWidget):
    """What each kind of curve is."""

    ROLES = ("before", "after", "wished", "other")

    def __init__(self) -> None:
        super().__init__()
        self._roles: Sequence[str] = ()
        self._words = {
            "before": tr("Before"),
            "after": tr("After"),
            "wished": tr("Target"),
            "other": tr("other side, mirrored"),
            "band": tr("uncertainty"),
        }
        set_tip(
            self,
            tr("Shaded range: 95 % of cases at each point of the skin if errors are normally distributed."),
        )
        self.setFixedHeight(self.sizeHint().height())

    def sizeHint(self) -> QSize:
        return QSize(200, 18)

    def show_roles(self, roles: Sequence[str]) -> None:
        """Explain these."""
        self._roles = roles
        self.setAccessibleName(", ".join(self._words[role] for role in roles))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter, tokens = QPainter(self), tokens_of(self)
        painter.setFont(font("caption"))
        inks = {"before": tokens.ghost_curve, "after": tokens.accent, "other": tokens.warn_mark}
        inks["band"] = inks["wished"] = tokens.accent
        x, y = 2.0, self.height() / 2.0
        wide = [painter.fontMetrics().horizontalAdvance(self._words[role]) for role in self._roles]
        roomy = sum(wide) + 37.0 * len(wide) - 12.0 < self.width()
        long, gap = (18.0, 14.0) if roomy else (12.0, 7.0)
        for role, advance in zip(self._roles, wide, strict=True):
            pen = QPen(QColor(inks[role]), 2.0)
            if role in ("before", "wished"):
                pen.setDashPattern([3.0, 2.0])
            if role == "band":
                swatch = QPainterPath()
                swatch.addRect(QRectF(x, y - 4.0, long, 8.0))
                paint_band(painter, swatch, QColor(inks[role]), faint=False)
            else:
                painter.setPen(pen)
                painter.drawLine(QPointF(x, y), QPointF(x + long, y))
            painter.setPen(QColor(tokens.text_quiet))
            painter.drawText(QPointF(x + long + 5.0, y + 4.0), self._words[role])
            x += long + 5.0 + advance + gap
