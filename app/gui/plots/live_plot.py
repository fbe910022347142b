"""A live curve over the turns of a run, under a title at which another quantity can be chosen."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QActionGroup, QColor, QFontMetrics, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QHBoxLayout, QSizePolicy, QVBoxLayout, QWidget

from app.gui.plots.canvas import PlotCanvas, Turns
from app.gui.plots.painting import is_dense
from app.gui.theme.icons import pixmap
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.menu import Menu
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.plots import Curve, Event, Plotted, Quantity


class LivePlot(QWidget):
    """A titled plot: the main curve strong, others faint, the exact answer dashed, a tolerance as a band.

    ``pointed`` carries the turn under the pointer, or None; ``zoomed`` the turns wanted in view, or None for
    all; ``quantity_chosen`` the name of another quantity.
    """

    pointed = Signal(object)
    zoomed = Signal(object)
    menu_requested = Signal(object)
    quantity_chosen = Signal(str)

    def __init__(self, quantities: Sequence[Quantity]) -> None:
        super().__init__()
        self._quantities = {each.name: each for each in quantities}
        self.quantity = quantities[0]
        self._range = (0.0, 1.0)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Expanding)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.head = QHBoxLayout()
        self.head.setContentsMargins(0, 0, 0, 0)
        self.title = QuantityTitle(quantities)
        self.title.chosen.connect(self.set_quantity)
        self.title.chosen.connect(self.quantity_chosen)
        self.head.addWidget(self.title)
        self.head.addStretch(1)
        column.addLayout(self.head)
        self.canvas = PlotCanvas()
        for heard, told in (
            (self.canvas.pointed, self.pointed),
            (self.canvas.zoomed, self.zoomed),
            (self.canvas.menu_requested, self.menu_requested),
        ):
            heard.connect(told)
        column.addWidget(self.canvas, 1)
        self.set_quantity(self.quantity.name)

    def set_quantity(self, name: str) -> None:
        """Plot another quantity from now on; an unknown one changes nothing."""
        self.quantity = self._quantities.get(name, self.quantity)
        self.title.show_quantity(self.quantity)
        self.canvas.unit = self.quantity.unit
        self.canvas.setAccessibleName(f"{self.quantity.title} {self.quantity.unit}")

    def set_curves(
        self,
        curves: Sequence[Curve],
        exact: float | None = None,
        *,
        exact_is_main: bool = False,
        tolerance: float = 0.0,
        events: Sequence[Event] = (),
        refit: bool = True,
    ) -> None:
        """Draw these runs and the exact answer; without ``refit`` the range only grows, as during a drag."""
        plotted = Plotted(tuple(curves), exact, exact_is_main, tolerance, tuple(events))
        first, last = plotted.turns()
        if self.canvas.zoom and not (first <= self.canvas.zoom[0] and self.canvas.zoom[1] <= last):
            self.canvas.set_turns(None)
        self._fit(plotted, refit)
        self.canvas.set_plotted(plotted, self._range, smooth=refit)

    def show_turns(self, turns: Turns | None) -> None:
        """Show these turns, or all; the range of values follows."""
        self.canvas.set_turns(turns)
        self._fit(self.canvas.plotted, True)
        self.canvas.set_plotted(self.canvas.plotted, self._range, self.canvas.smooth)

    def value_range(self) -> tuple[float, float]:
        """Return the lowest and the highest value that has room."""
        return self._range

    def drawn_as_envelope(self, curve: Curve) -> bool:
        """Return whether a curve flips so densely that its envelope is drawn."""
        return is_dense(curve, self.canvas.scale())

    def point_at(self, turn: float | None) -> None:
        """Read the curves at the nearest turn, or stop to."""
        self.canvas.point_at(turn)

    def _fit(self, plotted: Plotted, refit: bool) -> None:
        """Set the range of values: all that is in view, at least the smallest span worth seeing."""
        low, high = plotted.values(*(self.canvas.zoom or plotted.turns()))
        if not refit:
            low, high = min(low, self._range[0]), max(high, self._range[1])
        slack = max(self.quantity.least_span - (high - low), 0.0) / 2
        self._range = (low - slack, high + slack)


class QuantityTitle(QAbstractButton):
    """Title and unit of a plot; where there is more than one quantity, pressing it shows the others."""

    chosen = Signal(str)

    def __init__(self, quantities: Sequence[Quantity]) -> None:
        super().__init__()
        self._shown, self._pulls = quantities[0], len(quantities) > 1
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus if self._pulls else Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        if self._pulls:
            self.setCursor(Qt.CursorShape.PointingHandCursor)
            set_tip(self, tr("Choose plotted values"))
        self.menu = Menu(self)
        group = QActionGroup(self)
        self._entries = {}
        for each in quantities:
            entry = self.menu.addAction(f"{each.title}  {each.unit}")
            entry.setCheckable(True)
            entry.triggered.connect(lambda _=False, name=each.name: self.chosen.emit(name))
            group.addAction(entry)
            self._entries[each.name] = entry
        self.clicked.connect(self._pull)

    def show_quantity(self, quantity: Quantity) -> None:
        """Show which quantity is plotted; nothing is emitted."""
        self._shown = quantity
        self._entries[quantity.name].setChecked(True)
        self.setAccessibleName(f"{quantity.title} {quantity.unit}")
        self.setFixedSize(self.sizeHint())
        self.update()

    def sizeHint(self) -> QSize:
        title = QFontMetrics(font("title")).horizontalAdvance(self._shown.title)
        unit = QFontMetrics(font("caption")).horizontalAdvance(self._shown.unit)
        return QSize(title + unit + (30 if self._pulls else 12), 20)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self._pulls and (self.underMouse() or self.hasFocus()):
            painter.setPen(QPen(QColor(tokens.accent), 2) if self.hasFocus() else Qt.PenStyle.NoPen)
            painter.setBrush(QColor(tokens.pressed))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 5, 5)
        x, upright = 3.0, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        for text, role, ink in (
            (self._shown.title, "title", tokens.text),
            (self._shown.unit, "caption", tokens.text_caption),
        ):
            painter.setFont(font(role))
            painter.setPen(QColor(ink))
            painter.drawText(QRectF(x, 0, self.width(), self.height()), upright, text)
            x += painter.fontMetrics().horizontalAdvance(text) + 6
        if self._pulls:
            caret = pixmap("caret-down", tokens.text_caption, 10, self.devicePixelRatioF())
            painter.drawPixmap(QPointF(x, self.height() / 2 - 5), caret)

    def _pull(self) -> None:
        if self._pulls:
            self.menu.exec(self.mapToGlobal(self.rect().bottomLeft()))
