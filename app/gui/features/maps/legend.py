"""Legend of a map: quantity, colours and a range that can be set, and its place in the view."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
# ruff: noqa: N802 - Qt names its events

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, QRect, QRectF, QTimer, Signal
from PySide6.QtWidgets import QApplication, QHBoxLayout, QMenu, QVBoxLayout, QWidget

from app.gui.features.maps.color_bar import LegendBar
from app.gui.plots.live_plot import QuantityTitle
from app.gui.theme.stylesheet import label
from app.gui.viewport.value_labels import ValueFlags
from app.gui.viewport.view_area import ViewArea
from app.gui.widgets.basic import FloatingPanel, ToolButton
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.i18n.lengths import shown_unit
from app.presenters.maps import MapKind
from app.presenters.plots import Quantity
from core.geometry.mesh import Floats

WIDTH = 152
"""Width of what is inside the panel, whatever map it is [px]."""

SIZES = "full", "small", "folded"
"""How much room it takes, the usual first."""


CORNERS = ("top-right", "bottom-right", "top-left", "bottom-left")
"""Where it can be, the usual place first."""

_REST = 200  # a view that has not moved for so long rests [ms]

_WORD = 20  # a label that is covered is as bad as so many places of a band

_AIR = 6  # least distance from what it must not cover [px]


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


class LegendPlacement(QObject):
    """Moves a legend once what is seen rests; it stays where it covers nothing, and else becomes smaller.

    It folds where even the smaller one would lie on another panel or reach out of the view.
    """

    def __init__(self, view: ViewArea, legend: Legend, flags: ValueFlags) -> None:
        super().__init__(legend)
        self._view, self._legend, self._flags = view, legend, flags
        self._clock = QTimer(self, interval=_REST, singleShot=True)
        self._clock.timeout.connect(self.choose)
        view.viewport.view_changed.connect(self.consider)
        view.compared.connect(self.consider)
        view.floating.rearranged.connect(self.consider)
        view.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Check the placement when the size of the view changes."""
        if event.type() == QEvent.Type.Resize:
            self.consider()
        return False

    def consider(self) -> None:
        """Check soon whether the legend covers something."""
        if not self._legend.isHidden():
            self._clock.start()

    def choose(self) -> None:
        """Keep a place that covers nothing, else choose the first such place, else that which covers least.

        Between places that all cover something it stays, unless another covers a quarter less.
        """
        if self._legend.isHidden():
            return
        if QApplication.mouseButtons().value:  # it must not go from under the pointer
            self._clock.start()
            return
        size, here = self._legend.size_taken(), self._view.floating.corner_of(self._legend)
        order = sorted(CORNERS, key=lambda corner: corner != here)
        places, words = self._places(), self._words()
        full, small, folded = ([(each, corner) for corner in order] for each in SIZES)
        first = [full[0], (size, here)] if size != SIZES[-1] else []
        costs: dict[tuple[str, str], tuple[int, int]] = {}
        for spot in dict.fromkeys((*first, *full, *small)):
            costs[spot] = self._cost(*spot, places, words)
            if costs[spot] == (0, 0):
                return
        free = [spot for spot in small if not costs[spot][0]]
        if not free:
            free, costs = folded, {spot: self._cost(*spot, places, words) for spot in folded}
        best, stays = min(free, key=costs.__getitem__), free[0]
        (clashes, covered), (fewest, least) = costs[stays], costs[best]
        self._go(*(best if clashes > fewest or 0.75 * covered > least else stays))

    def _go(self, size: str, corner: str) -> None:
        self._legend.set_size(size)
        self._view.floating.move(self._legend, corner)

    def _cost(self, size: str, corner: str, places: Floats, words: list[QRectF]) -> tuple[int, int]:
        """Return how many panels the legend lies on there, and how much else it covers; it stays there."""
        self._go(size, corner)
        room = self._view.floating.seen(self._legend)
        return self._view.floating.clashes(self._legend), _covered(room, places, words)

    def _places(self) -> Floats:
        """Return places along all bands that are seen, shape (k, 2) [px of the view]."""
        found = [np.empty((0, 2))]
        for body in self._view.beside.bodies:
            viewport = body.viewport
            bands, origin = viewport.scene.bands, viewport.mapTo(self._view, QRect().topLeft())
            for name in set(bands.names) - body.hidden_lines if viewport.isVisible() else ():
                spine, _ = bands.spine(name)
                spots = viewport.view.to_picture(spine, viewport.width(), viewport.height())
                found.append(spots[:, :2] + (origin.x(), origin.y()))
        return np.concatenate(found)

    def _words(self) -> list[QRectF]:
        """Return where something is written over the view."""
        main = self._view.viewport.mapTo(self._view, QRect().topLeft())
        found = [each.translated(QPointF(main)) for each in self._flags.words()]
        for body in self._view.beside.bodies:
            origin = body.viewport.mapTo(self._view, QRect().topLeft())
            found += [each.translated(QPointF(origin)) for each in body.viewport.overlay.words()]
        return found + [QRectF(title.geometry()) for title in self._view.panes.titles]


def _covered(room: QRect, places: Floats, words: list[QRectF]) -> int:
    """Return how much a panel in this room would cover."""
    wide = room.adjusted(-_AIR, -_AIR, _AIR, _AIR)
    low, high = (wide.left(), wide.top()), (wide.right(), wide.bottom())
    inside = ((places >= low) & (places <= high)).all(axis=1).sum()
    return int(inside) + _WORD * sum(QRectF(wide).intersects(each) for each in words)
