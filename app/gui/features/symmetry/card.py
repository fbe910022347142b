"""Left and right, beside the measures: how they differ before and after, where, and what makes them even."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, set_tag, tokens_of
from app.gui.widgets.basic import Disclosure, button, hairline, sentence
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.symmetry import SymmetryRowView, SymmetryView

_FADED = 0.4  # how strongly bars of a former shape are seen
_BAR = QSize(26, 20)
_HEAD = 4  # figures that are always seen, the most telling first


class AsymmetryBar(QWidget):
    """A bar about a centre line: to the side that is more, as it is seen from the front; before is a tick."""

    def __init__(self) -> None:
        super().__init__()
        self.shares: tuple[float | None, float | None] = (None, None)
        self._faint = False
        self.setFixedSize(_BAR)

    def show_shares(self, shares: tuple[float | None, float | None], faint: bool) -> None:
        """Show how far it is to the left (positive) or right, before and after."""
        self.shares, self._faint = shares, faint
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the bar of after, the centre line, and the tick of before."""
        tokens, painter, half = tokens_of(self), QPainter(self), self.width() / 2.0
        painter.setOpacity(_FADED if self._faint else 1.0)
        middle = self.height() / 2.0
        before, after = self.shares
        if (before, after) == (None, None):
            return  # it has no sides
        if after is not None:
            # The subject's left is on the right of who looks at her.
            long = max(-1.0, min(after, 1.0)) * (half - 1.0)
            bar = QRectF(min(half, half + long), middle - 3.0, abs(long), 6.0)
            painter.fillRect(bar, QColor(tokens.accent))
        painter.fillRect(QRectF(half - 0.5, middle - 7.0, 1.0, 14.0), QColor(tokens.control))
        if before is not None:
            at = half + max(-1.0, min(before, 1.0)) * (half - 1.0)
            painter.fillRect(QRectF(at - 0.75, middle - 5.0, 1.5, 10.0), QColor(tokens.text_caption))


class ElidedTitle(QLabel):
    """A name with its unit, of which the name alone ends in dots where there is no room for both."""

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint what there is room for."""
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        where = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        painter.drawText(self.rect(), where, self.shown())

    def shown(self) -> str:
        """Return what there is room for."""
        name, bracket, unit = self.text().rpartition(" [")
        metrics, rest = self.fontMetrics(), f"{bracket}{unit}"
        room = self.width() - metrics.horizontalAdvance(rest)
        return metrics.elidedText(name, Qt.TextElideMode.ElideRight, room) + rest


class _Row:
    """The parts of one figure, in a row of a grid."""

    def __init__(self, grid: QGridLayout, row: int) -> None:
        self.title = ElidedTitle()
        self.title.setTextFormat(Qt.TextFormat.PlainText)
        self.title.setFont(font("body"))
        self.title.setMinimumWidth(60)
        roles = "body", "name", "caption"
        self.before, self.after, self.off = (label("", role, tabular=True) for role in roles)
        for part in (self.before, self.off):
            set_tag(part, "tone", "quiet")
        self.bar = AsymmetryBar()
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        grid.addWidget(self.title, row, 0)
        for column, part in enumerate((self.before, self.after, self.off), start=1):
            part.setAlignment(right)
            grid.addWidget(part, row, column)
        grid.addWidget(self.bar, row, 4)
        self.parts: tuple[QLabel, ...] = (self.title, self.before, self.after, self.off)

    def show_view(self, view: SymmetryRowView, faint: bool, seen: bool) -> None:
        """Show a figure, ``faint`` if it is of a former shape."""
        quiet = {self.before, self.off, *([self.after] if view.within else [])}
        for part, text in zip(self.parts, (view.title, view.before, view.after, view.off), strict=True):
            part.setText(text)
            set_tag(part, "tone", "faint" if faint else "quiet" if part in quiet else "")
            set_tip(part, view.tip)
            part.setVisible(seen)
        self.bar.show_shares(view.shares, faint)
        self.bar.setVisible(seen)
        spoken = f"{view.title} {view.before} → {view.after} {view.off}".rstrip()
        self.title.setAccessibleName(spoken)

    def hide(self) -> None:
        """Show nothing here."""
        for part in (*self.parts, self.bar):
            part.hide()


class SymmetryCard(QWidget):
    """The figures of left and right; ``shown`` asks for the map on the body or takes it away, ``requested``
    for what makes it even.
    """

    shown = Signal(bool)
    requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._faint = self._mapped = False
        self.says = sentence("", "secondary")
        self.hint, self.notes = sentence("", "caption"), sentence("", "caption")
        self.fold = Disclosure(tr("More values and sources"))
        self.fold.toggled.connect(lambda _: self._show())
        self.look = button(tr("Show on body"))
        set_tip(self.look, tr("Show the Symmetry map on the body (C)"))
        self.look.clicked.connect(lambda: self.shown.emit(not self._mapped))
        self.make = button(tr("Balance sides…"))
        set_tip(self.make, tr("Compute line lengths that balance left and right"))
        self.make.clicked.connect(self.requested)
        self.summary: SymmetryView | None = None
        self._grid = QGridLayout()
        self._grid.setContentsMargins(0, 2, 0, 2)
        self._grid.setHorizontalSpacing(5)
        self._grid.setVerticalSpacing(2)
        self._grid.setColumnStretch(0, 1)
        self._rows: list[_Row] = []
        self._lay()
        self.hide()

    def _lay(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(4, 4, 4, 8)
        column.setSpacing(4)
        column.addWidget(label(tr("Symmetry"), "heading"))
        column.addWidget(self.says)
        for place, (title, where) in enumerate(self._heads(), start=1):
            title.setAlignment(where | Qt.AlignmentFlag.AlignVCenter)
            self._grid.addWidget(title, 0, place)
        column.addLayout(self._grid)
        column.addWidget(self.fold)
        column.addWidget(self.notes)
        row = QHBoxLayout()
        row.setSpacing(6)
        row.addWidget(self.look)
        row.addWidget(self.make)
        row.addStretch(1)
        column.addLayout(row)
        column.addWidget(self.hint)
        column.addWidget(hairline())

    def _heads(self) -> list[tuple[QLabel, Qt.AlignmentFlag]]:
        right, middle = Qt.AlignmentFlag.AlignRight, Qt.AlignmentFlag.AlignHCenter
        return [
            (label(tr("Before"), "caption"), right),
            (label(tr("After"), "caption"), right),
            (label("", "caption"), right),
            (label(tr("R | L"), "caption"), middle),
        ]

    def show_summary(self, summary: SymmetryView | None, faint: bool) -> None:
        """Show how left and right differ, ``faint`` if that was of a former shape; None hides the card."""
        self.summary, self._faint = summary, faint
        self.setVisible(summary is not None)
        if summary is not None:
            while len(self._rows) < len(summary.views):
                self._rows.append(_Row(self._grid, len(self._rows) + 1))
            self._show()

    def show_map(self, on: bool) -> None:
        """Show by the button whether the map is on the body."""
        self._mapped = on
        self.look.setText(tr("Hide map") if on else tr("Show on body"))

    def _show(self) -> None:
        summary, unfolded = self.summary, self.fold.isChecked()
        if summary is None:
            return
        self.says.setText(summary.says)
        set_tag(self.says, "tone", "faint" if self._faint else "")
        for place, row in enumerate(self._rows):
            if place < len(summary.views):
                row.show_view(summary.views[place], self._faint, unfolded or place < _HEAD)
            else:
                row.hide()
        self.notes.setText("\n".join(summary.notes))
        self.notes.setVisible(unfolded and bool(summary.notes))
        self.hint.setText(summary.hint)
        self.hint.setVisible(bool(summary.hint))
        self.make.setEnabled(summary.possible and not self._faint)
