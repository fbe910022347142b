"""The legend of a map: what is shown, its colours and its range, which can be set by hand."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, Signal
from PySide6.QtWidgets import QHBoxLayout, QMenu, QVBoxLayout, QWidget

from app.gui.features.maps.color_bar import LegendBar
from app.gui.plots.live_plot import QuantityTitle
from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import FloatingPanel, ToolButton
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.i18n.lengths import shown_unit
from app.presenters.maps import MapKind
from app.presenters.plots import Quantity

WIDTH = 152
"""Width of what is inside the panel, whatever map it is [px]."""

SIZES = "full", "small", "folded"
"""How much room it takes, the usual first."""


class Legend(FloatingPanel):
    """Title, bar and numbers.

    ``chosen`` carries another map, or an empty name to close; ``range_set`` low and high by hand;
    ``range_freed`` asks for the automatic one; ``flags_cleared`` for the values on the body to go.
    """

    chosen = Signal(str)
    range_set = Signal(float, float)
    range_freed = Signal()
    flags_cleared = Signal()
    theme_changed = Signal()

    def __init__(self, kinds: Sequence[MapKind], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._kinds = {kind.name: kind for kind in kinds}
        self._kind = kinds[0]
        self._size = SIZES[0]
        column = QVBoxLayout()
        column.setContentsMargins(6, 2, 2, 2)
        column.setSpacing(4)
        head = QHBoxLayout()
        head.setSpacing(4)
        self.title = QuantityTitle(
            [Quantity(kind.name, kind.title, shown_unit(kind.unit), 0.0) for kind in kinds]
        )
        self.title.chosen.connect(self.chosen)
        self._add_to(self.title.menu)
        close = ToolButton("x", tr("Close map (C)"), size=14, room=24)
        close.clicked.connect(lambda: self.chosen.emit(""))
        head.addWidget(self.title)
        head.addStretch(1)
        head.addWidget(close)
        column.addLayout(head)
        self.bar = LegendBar()
        self.bar.dragged.connect(self._set_end)
        self.bar.freed.connect(self.range_freed)
        self.high, self.low = self.bar.high, self.bar.low
        self.high.entered.connect(lambda value: self._set_end(True, value))
        self.low.entered.connect(lambda value: self._set_end(False, value))
        column.addWidget(self.bar)
        self.note = label("", "caption")
        self.note.setWordWrap(True)
        self.note.setContentsMargins(0, 4, 0, 0)  # else it nearly touches the number at the lower end
        column.addWidget(self.note)
        self.row.addLayout(column)
        self.note.setFixedWidth(WIDTH)
        self.bar.setFixedWidth(WIDTH)

    def show_map(self, name: str) -> None:
        """Show another map's title and words; nothing is emitted."""
        self._kind = kind = self._kinds[name]
        self.title.show_quantity(Quantity(kind.name, kind.title, shown_unit(kind.unit), 0.0))
        self.show_note(kind.note)
        self.bar.set_numbers(kind.unit, kind.digits, kind.both_ways, kind.marks)

    def show_note(self, note: str) -> None:
        """Show a description of the values below the bar."""
        self.note.setText(note)
        self.bar.say(note)
        # What the sign means can be guessed from no colour.
        shown = self._size == "full" or (self._size == "small" and self._kind.both_ways)
        self.note.setVisible(shown)
        set_tip(self.title, "\n".join(filter(None, (self._kind.tip, "" if shown else note))))

    def size_taken(self) -> str:
        """Return which of ``SIZES`` it has."""
        return self._size

    def set_size(self, size: str) -> None:
        """Set one of ``SIZES``: small is shorter, folded is only a title with a tooltip."""
        self.bar.set_small(size != "full")
        self.bar.setVisible(size != "folded")
        self._size = size
        self.show_note(self.note.text())
        inner = self.layout()
        assert inner is not None
        inner.activate()  # so that its size is that of now, and not of before, to who asks at once

    def show_range(self, low: float, high: float, stops: Sequence[str], by_hand: bool) -> None:
        """Show the ends of the range and the colours from low to high."""
        self.bar.set_range(low, high, stops, by_hand)
        self.automatic.setEnabled(by_hand)

    def show_value(self, value: float | None) -> None:
        """Mark a value on the bar: that of the last flag on the body."""
        self.bar.set_value(value)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self.theme_changed.emit()

    def _add_to(self, menu: QMenu) -> None:
        menu.addSeparator()
        self.automatic = menu.addAction(tr("Automatic range"))
        self.automatic.triggered.connect(self.range_freed)
        menu.addAction(tr("Clear values on body")).triggered.connect(self.flags_cleared)

    def _set_end(self, is_high: bool, value: float) -> None:
        low, high = self.bar.range_
        if self._kind.both_ways:
            low, high = -abs(value), abs(value)
        elif is_high:
            high = value
        else:
            low = value
        if high - low > 0.0:
            self.range_set.emit(low, high)
        else:
            self.bar.show_ends()
