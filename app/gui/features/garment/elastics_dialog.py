"""The elastics there are: a table, the curve of the marked one, one's own brought in and taken away."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QHeaderView,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from app.gui.theme.stylesheet import font, label, set_tag, tokens_of
from app.gui.widgets.basic import sentence
from app.gui.widgets.dialog import Dialog
from app.gui.widgets.notification_bar import NotificationBar
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import number, tr
from app.i18n.lengths import length_unit
from app.presenters.elastics import TOLD_AT, ElasticView

_NAME = Qt.ItemDataRole.UserRole


class ElasticsDialog(Dialog):
    """All elastics; ``export_requested`` names the marked one, ``delete_requested`` one of one's own."""

    import_requested = Signal()
    export_requested = Signal(str)
    template_requested = Signal()
    delete_requested = Signal(str)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, tr("Elastics"), (780, 600))
        self.notices = NotificationBar()
        self.views: dict[str, ElasticView] = {}
        self.table, self.curve = _Table(), ElasticCurve()
        self.title, self.source = label("", "name"), sentence("", "caption")
        self.mark = label("", "caption")
        text = tr("Forces in N for the full width. Built-in curves are estimates; test your own material.")
        self.body.addWidget(sentence(text))
        self.body.insertWidget(0, self.notices)
        self.body.addWidget(self.table, 1)
        self.body.addLayout(self._make_detail())
        self.table.currentItemChanged.connect(self._show_one)
        self._make_foot()

    def set_elastics(self, views: Sequence[ElasticView], marked: str = "") -> None:
        """Show these; the one called ``marked`` is marked, or that of before, or the first."""
        marked = marked or self.marked
        self.views = {view.name: view for view in views}
        self.table.show_elastics(views)
        self.table.mark(marked)

    @property
    def marked(self) -> str:
        """Return the name of the elastic that is marked, or nothing."""
        item = self.table.currentItem()
        return str(item.data(0, _NAME)) if item is not None else ""

    def _make_detail(self) -> QHBoxLayout:
        row, words = QHBoxLayout(), QVBoxLayout()
        row.setSpacing(18)
        words.setSpacing(3)
        for each in (self.title, self.mark, self.source):
            words.addWidget(each)
        words.addStretch(1)
        row.addWidget(self.curve)
        row.addLayout(words, 1)
        return row

    def _make_foot(self) -> None:
        brought = self.add_button(tr("Import CSV…"), self.import_requested.emit)
        set_tip(brought, tr("Import elongation and force from a table with units"))
        handed_on = self.add_button(
            tr("Export CSV…"), lambda: self.export_requested.emit(self.marked), "quiet"
        )
        set_tip(handed_on, tr("Export the selected elastic as a table"))
        template = self.add_button(tr("Export empty table…"), self.template_requested.emit, "quiet")
        set_tip(template, tr("Export an empty table (CSV) for your measurements"))
        self.delete = self.add_button(tr("Delete…"), lambda: self.delete_requested.emit(self.marked), "quiet")
        set_tip(self.delete, tr("Delete a custom elastic; projects that use it keep a copy"))
        for place, each in enumerate((brought, handed_on, template, self.delete)):
            self.foot.removeWidget(each)
            self.foot.insertWidget(place, each)
        self.add_close()

    def _show_one(self) -> None:
        view = self.views.get(self.marked)
        self.delete.setEnabled(view is not None and view.own)
        if view is None:
            return
        self.title.setText(view.title)
        told = tr("Measured") if view.source else tr("Source of the measurement unknown")
        self.mark.setText(tr("Estimate, not measured") if view.estimate else told)
        set_tag(self.mark, "tone", "ok" if view.source and not view.estimate else "warn")
        self.source.setText(view.source)
        self.curve.show_elastic(view)


class ElasticTable(QTreeWidget):
    """Elastics, a row each under ``heads``; the column ``wide`` takes the room that is left."""

    def __init__(self, heads: Sequence[str], wide: int) -> None:
        super().__init__()
        self.setHeaderLabels(heads)
        self.setRootIsDecorated(False)
        self.setUniformRowHeights(True)
        self.setAccessibleName(tr("Elastics"))
        self.setFont(font("body", tabular=True))
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        header = self.header()
        header.setStretchLastSection(False)
        header.setSectionsMovable(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header.setSectionResizeMode(wide, QHeaderView.ResizeMode.Stretch)
        header.setFont(font("caption"))


class _Table(ElasticTable):
    """The elastics with their forces."""

    def __init__(self) -> None:
        at = [f"{number(100.0 * each, 0)} %" for each in TOLD_AT]
        lengths = (tr("width {unit}"), tr("allowance {unit}"))
        wide, allowance = (each.format(unit=length_unit()) for each in lengths)
        super().__init__([tr("Elastic"), wide, *at, allowance, tr("source")], 0)
        for column in range(1, self.columnCount() - 1):
            self.headerItem().setTextAlignment(column, _RIGHT)

    def show_elastics(self, views: Sequence[ElasticView]) -> None:
        """Show these rows."""
        self.clear()
        for view in views:
            forces = (force or "\N{EN DASH}" for force in view.forces)
            item = QTreeWidgetItem([view.title, view.width, *forces, view.allowance, view.where])
            item.setData(0, _NAME, view.name)
            for column in range(1, self.columnCount() - 1):
                item.setTextAlignment(column, _RIGHT)
            if view.own:
                item.setFont(0, font("name"))
            self.addTopLevelItem(item)

    def mark(self, name: str) -> None:
        """Mark the row of an elastic, or the first."""
        items = [self.topLevelItem(row) for row in range(self.topLevelItemCount())]
        found = [item for item in items if item is not None and item.data(0, _NAME) == name]
        for item in [*found, *items][:1]:
            if item is not None:
                self.setCurrentItem(item)


class ElasticCurve(QWidget):
    """Force over elongation of one elastic: dots where it was measured, dashes where it is an estimate."""

    LEFT, BOTTOM, ROOM = 34, 20, 8

    def __init__(self) -> None:
        super().__init__()
        self._view: ElasticView | None = None
        self.setFixedSize(QSize(300, 150))

    def show_elastic(self, view: ElasticView) -> None:
        """Show the curve of an elastic."""
        self._view = view
        words = tr("Curve of {elastic}: up to {force} N at {percent} % elongation")
        end, strength = view.curve[-1]
        force, percent = number(strength, 1), number(100.0 * end, 0)
        self.setAccessibleName(words.format(elastic=view.title, force=force, percent=percent))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint axes and curve."""
        if self._view is None:
            return
        tokens, painter = tokens_of(self), QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        field = QRectF(self.rect()).adjusted(self.LEFT, self.ROOM, -self.ROOM, -self.BOTTOM)
        longest, strongest = self._view.curve[-1]
        step = _step(strongest)
        top = step * -(-strongest // step)
        self._paint_axes(painter, field, longest, top, step)
        curve = QPolygonF(
            [
                QPointF(field.left() + e / longest * field.width(), field.bottom() - n / top * field.height())
                for e, n in self._view.curve
            ]
        )
        pen = QPen(QColor(tokens.accent), 2.0)
        if self._view.estimate:
            pen.setDashPattern([4, 3])
        painter.setPen(pen)
        painter.drawPolyline(curve)
        if not self._view.estimate:
            painter.setPen(QPen(QColor(tokens.panel), 1.5))
            painter.setBrush(QColor(tokens.accent))
            for dot in curve.toList()[1:]:
                painter.drawEllipse(dot, 4, 4)

    def _paint_axes(self, painter: QPainter, field: QRectF, longest: float, top: float, step: float) -> None:
        tokens = tokens_of(self)
        painter.setFont(font("axis", tabular=True))
        for tick in range(round(top / step) + 1):
            level = field.bottom() - tick * step / top * field.height()
            painter.setPen(QColor(tokens.line))
            painter.drawLine(QPointF(field.left(), level), QPointF(field.right(), level))
            painter.setPen(QColor(tokens.text_caption))
            words = f"{tick * step:g}" + (" N" if tick * step == top else "")
            painter.drawText(QRectF(0, level - 8, self.LEFT - 6, 16), _RIGHT, words)
        for share in (0.0, 0.5, 1.0):
            place = field.left() + share * field.width()
            words = f"{number(100.0 * share * longest, 0)} %"
            room = QRectF(place - 30, field.bottom() + 3, 60, 16)
            room.moveRight(min(room.right(), self.width()))
            painter.drawText(room, _RIGHT if share == 1.0 else Qt.AlignmentFlag.AlignCenter, words)


_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


def _step(strongest: float) -> float:
    """Return a round distance of two to five ticks up to a force."""
    steps = (unit * power for power in (0.1, 1.0, 10.0, 100.0, 1000.0) for unit in (1.0, 2.0, 5.0))
    return next(step for step in steps if strongest <= 5.0 * step)
