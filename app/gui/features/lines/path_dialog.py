"""The dialog in which a line is drawn: from control point to control point on a map of the control mesh."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Collection
from itertools import pairwise

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QLineEdit,
    QVBoxLayout,
    QWidget,
)

from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import Segment, sentence
from app.i18n.catalog import tr
from app.presenters.lines import OWN_COLOURS
from app.presenters.messages import render
from core.control_mesh.embedding import Cell
from core.control_mesh.template import Template
from core.document.line_notation import format_point, parse_line, path_cells
from core.document.lines import CustomLine
from core.errors import UserError
from core.messages import Message

_STEP, _EDGE, _REACH = 34, 30, 15


class PointMap(QWidget):
    """The control points of a template as the body is seen from the front; a click goes on to a point."""

    pressed = Signal(int)

    def __init__(self, template: Template) -> None:
        super().__init__()
        self._template = template
        self._path: tuple[Cell, ...] = ()
        self.setFixedSize(self.sizeHint())
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def sizeHint(self) -> QSize:
        return QSize(
            2 * _EDGE + 2 * self._template.half * _STEP, 2 * _EDGE + (len(self._template.rows) - 1) * _STEP
        )

    def show_path(self, path: tuple[Cell, ...]) -> None:
        """Draw a line through these places."""
        self._path = path
        self.update()

    def place(self, point: int) -> QPointF:
        """Return where a control point is drawn."""
        return self._at(int(self._template.row[point]), int(self._template.column[point]))

    def _at(self, row: float, column: float) -> QPointF:
        return QPointF(
            _EDGE + (column + self._template.half) * _STEP,
            _EDGE + (len(self._template.rows) - 1 - row) * _STEP,
        )

    def mousePressEvent(self, event: QMouseEvent) -> None:
        away = {
            point: (self.place(point) - event.position()).manhattanLength()
            for point in range(len(self._template.row))
        }
        nearest = min(away, key=away.__getitem__)
        if away[nearest] < _REACH:
            self.pressed.emit(nearest)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(tokens.line), 1))
        for a, b, c in self._template.faces.tolist():
            for one, other in ((a, b), (b, c), (c, a)):
                painter.drawLine(self.place(one), self.place(other))
        painter.setPen(QPen(QColor(OWN_COLOURS[0]), 4))
        for one, other in pairwise(self._path):
            painter.drawLine(self._at(*one), self._at(*other))
        self._paint_points(painter)
        painter.setFont(font("axis"))
        painter.setPen(QColor(tokens.text_caption))
        for column in range(-self._template.half, self._template.half + 1):
            at = self.place(self._template.point(0, column))
            painter.drawText(QRectF(at.x() - 17, at.y() + 9, 34, 16), _MIDDLE, f"c{column}".replace("-", "−"))
        for row in range(len(self._template.rows)):
            at = self.place(self._template.point(row, -self._template.half))
            painter.drawText(QRectF(at.x() - 30, at.y() - 8, 20, 16), _MIDDLE, f"r{row}")

    def _paint_points(self, painter: QPainter) -> None:
        tokens, template = tokens_of(self), self._template
        bust = template.row_of("bust point")
        tips = {template.point(bust, sign * template.bust_column) for sign in (-1, 1)}
        for point in range(len(template.row)):
            free = bool(template.free[point])
            painter.setPen(QPen(QColor(tokens.text_quiet), 1.2))
            painter.setBrush(QColor(tokens.text_quiet if free else tokens.panel))
            painter.drawEllipse(self.place(point), 3.2 if free else 2.4, 3.2 if free else 2.4)
            if point in tips:
                painter.setPen(QPen(QColor(tokens.accent), 1.5))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawEllipse(self.place(point), 7.0, 7.0)


class LineDialog(QDialog):
    """Asks for name and control points of a line; ``line`` is what was drawn, once it is one."""

    def __init__(self, parent: QWidget, template: Template, names: Collection[str]) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Line through control points"))
        self.line: CustomLine | None = None
        self._template, self._names = template, names
        self.map = PointMap(template)
        self.name, self.points = QLineEdit(self._free_name()), QLineEdit()
        self.points.setPlaceholderText("r2c3, r3c3, r4c2")
        self.ends = Segment((("open", tr("Open ends")), ("closed", tr("Closed"))), small=True)
        self.ends.set_choice("open")
        self._said = sentence("", "caption")
        self._buttons = QDialogButtonBox()
        add = self._buttons.addButton(tr("Add"), QDialogButtonBox.ButtonRole.AcceptRole)
        cancel = self._buttons.addButton(tr("Cancel"), QDialogButtonBox.ButtonRole.RejectRole)
        add.clicked.connect(self.accept)
        cancel.clicked.connect(self.reject)
        self._add = add
        self._lay_out()
        self.map.pressed.connect(self._go_on)
        self.ends.chosen.connect(self._read)
        for field in (self.name, self.points):
            field.setMinimumHeight(28)
            field.textEdited.connect(self._read)
        self._read()

    def _free_name(self) -> str:
        titles = (tr("line {number}").format(number=number) for number in range(1, 1000))
        return next(title for title in titles if title not in self._names)

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 18, 20, 16)
        column.setSpacing(10)
        what = tr("Click control points in order. Click the last point again to remove it.")
        how = tr("Front view. Filled points can move; rings mark the bust points.")
        column.addWidget(sentence(f"{what} {how}"))
        column.addWidget(self.map, alignment=Qt.AlignmentFlag.AlignHCenter)
        form = QFormLayout()
        form.addRow(tr("Name"), self.name)
        form.addRow(tr("Points"), self.points)
        form.addRow("", self.ends)
        column.addLayout(form)
        column.addWidget(self._said)
        column.addWidget(self._buttons)

    def _go_on(self, point: int) -> None:
        """Take a point as the next, or back if it is the last."""
        words = [word.strip() for word in self.points.text().split(",") if word.strip()]
        place = format_point(point, self._template)
        words = words[:-1] if words and words[-1] == place else [*words, place]
        self.points.setText(", ".join(words))
        self._read()

    def _read(self) -> None:
        """Understand what is written, and show it on the map."""
        text = self.points.text().strip().strip(",")
        line: CustomLine | None = None
        message: Message | str = ""
        try:
            closed = ",closed" if self.ends.button("closed").isChecked() else ""
            line = parse_line(f"{self.name.text()}={text}{closed}", self._template)
            if line.name in self._names:
                line, message = None, tr("A line of that name already exists.")
        except UserError as error:
            message = error.message if text.count(",") + text.count(":") else ""
        self.line = line
        self._said.setText(render(message))
        self._add.setEnabled(line is not None)
        self.map.show_path(path_cells(line, self._template) if line else self._so_far(text))

    def _so_far(self, text: str) -> tuple[Cell, ...]:
        try:
            return path_cells(parse_line(f"x={text}", self._template), self._template)
        except UserError:
            return ()


def ask_own_line(parent: QWidget, template: Template, names: Collection[str]) -> CustomLine | None:
    """Return the line that the user draws, or None. ``names`` are taken."""
    dialog = LineDialog(parent, template, names)
    drawn = dialog.exec() == QDialog.DialogCode.Accepted
    line = dialog.line if drawn else None
    dialog.deleteLater()
    return line


_MIDDLE = Qt.AlignmentFlag.AlignCenter
