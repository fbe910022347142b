"""The pieces of a pattern laid flat: strain in colours, seams that are pointed at, chosen and walked."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from PySide6.QtCore import QEvent, QPoint, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
    QPolygonF,
    QResizeEvent,
    QWheelEvent,
)
from PySide6.QtWidgets import QWidget

from app.gui.plots.painting import curve_path
from app.gui.theme.stylesheet import font, tokens_of
from app.gui.widgets.basic import announce
from app.gui.widgets.tooltip import watch_tip
from app.i18n.catalog import number, tr
from app.presenters.pattern_layout import PieceShape, arranged, joined_at
from app.rendering.palette import MAP_LESS, MAP_MORE
from app.rendering.vertex_colors import Ramp
from core.geometry.mesh import Floats, Points
from core.geometry.plane_sections import arc_length, interpolate

BLANK = {False: "#FFFFFF", True: "#5A5753"}
"""Colour of cloth without strain in the light and in the dark theme."""

STEPS = 20
"""Colours in which strain is drawn: one fill each."""

_EDGE = 18.0  # round the pieces [px]
_NEAR = 7.0  # how near to a seam the pointer means it [px]
_FARTHEST = (0.4, 12.0)  # of the scale in which all is seen [1]
_SMALL = 96.0  # a piece that is narrower has its strain alone written on it [px]
_FAINT = 0.35  # how opaque pieces of a former shape are [1]


def strain_ramp(limit: float, dark: bool) -> Ramp:
    """Return the colours of strain: compressed to stretched, up to the ``limit`` of a cloth [1]."""
    return Ramp((*MAP_LESS, BLANK[dark], *MAP_MORE), -limit, limit, BLANK[dark])


class PiecesView(QWidget):
    """Shows the pieces; ``piece_chosen`` and ``seam_chosen`` name what is clicked, ``seam_hovered`` the seam
    under the pointer (off all seams: an empty name).

    The wheel zooms, a drag moves, a double click shows all again.
    """

    piece_chosen = Signal(str)
    seam_chosen = Signal(str)
    seam_hovered = Signal(str)
    theme_changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(tr("Pattern pieces"))
        self.setMinimumWidth(220)
        watch_tip(self)
        self._shapes: tuple[PieceShape, ...] = ()
        self._all: tuple[PieceShape, ...] = ()
        self._joined = False
        self._titles: Mapping[str, str] = {}
        self._values: Mapping[str, str] = {}
        self._moves = np.zeros((0, 2))
        self._names: tuple[str, ...] = ()
        self._cloth: QPixmap | None = None
        self._cloth_centre = np.zeros(2)  # that it was painted about
        self._faint = False
        self._words = ""
        self.piece = self.seam = self.hovered = ""
        self._knob: float | None = None
        self._scale, self._centre = 1.0, np.zeros(2)
        self._by_hand = False
        self._pressed: QPointF | None = None
        self._dragged = False

    def sizeHint(self) -> QSize:
        return QSize(420, 400)

    # -- what is shown

    def show_pieces(
        self, shapes: Sequence[PieceShape], titles: Mapping[str, str], values: Mapping[str, str]
    ) -> None:
        """Show pieces, with their titles and the value written on each; they stay where they are if they can.

        A piece is moved only when there are others, or the room is another.
        """
        names = tuple(shape.name for shape in shapes)
        fresh = names != self._names
        self._all, self._titles, self._values, self._names = tuple(shapes), titles, values, names
        self._choose_shapes()
        if fresh:
            self._by_hand = False
            self._arrange()
        elif len(self._moves) != len(self._shapes):
            self._arrange()
        elif not self._by_hand:
            self._fit()
        self._redraw()

    def show_words(self, words: str) -> None:
        """Say why there are no pieces, in the middle."""
        self._words = words
        self.update()

    def set_faint(self, faint: bool) -> None:
        """Draw the pieces faintly: they are of a former shape."""
        if faint != self._faint:
            self._faint = faint
            self.update()

    def select(self, piece: str, seam: str) -> None:
        """Mark a piece and a seam; an empty name marks none."""
        other = seam != self.seam
        self.piece, self.seam = piece, seam
        if self._joined and other:
            self._show_joined()
        self.update()

    def join(self, on: bool) -> None:
        """Lay the two pieces of the selected seam edge to edge at the knob, or show all pieces."""
        self._joined = on
        self._show_joined()

    def _show_joined(self) -> None:
        self._choose_shapes()
        self._by_hand = False
        self._arrange()
        self._redraw()

    def _choose_shapes(self) -> None:
        """Show all pieces, or those that are laid edge to edge."""
        joined = joined_at(self._all, self.seam, self._knob or 0.0) if self._joined else ()
        self._shapes = joined or self._all

    def hover(self, seam: str) -> None:
        """Mark the seam under the pointer, here or on the body."""
        if seam != self.hovered:
            self.hovered = seam
            self.update()

    def walk(self, share: float | None) -> None:
        """Show a knob at a share of the length of the selected seam on all its pieces, or none."""
        self._knob = share
        if self._joined:
            self._choose_shapes()
            self._redraw()
        self.update()

    # -- where things are

    def _arrange(self) -> None:
        if self._shapes is self._all:
            self._moves = arranged(self._shapes, max(self.width(), 1) / max(self.height(), 1))
        else:
            self._moves = np.zeros((len(self._shapes), 2))
        self._fit()

    def _fit(self) -> None:
        """Show all pieces."""
        if not self._shapes:
            return
        whole = np.concatenate([s.points + m for s, m in zip(self._shapes, self._moves, strict=True)])
        low, high = whole.min(axis=0), whole.max(axis=0)
        room = np.maximum(np.array([self.width(), self.height()]) - 2.0 * _EDGE, 10.0)
        self._scale = float((room / np.maximum(high - low, 1.0)).min())
        self._centre = 0.5 * (low + high)

    def _spots(self, points: Points) -> Floats:
        """Return places of the layout on the widget, (k, 2) [px]."""
        middle = np.array([self.width(), self.height()]) / 2.0
        return np.asarray(middle + self._scale * (points - self._centre) * [1.0, -1.0])

    def piece_at(self, spot: QPointF) -> str:
        """Return the piece at a place of the widget, or an empty text."""
        for shape, move in zip(self._shapes, self._moves, strict=True):
            outline = np.concatenate([points[:-1] for _, points, _ in shape.sides])
            if _polygon(self._spots(shape.points[outline] + move)).containsPoint(
                spot, Qt.FillRule.OddEvenFill
            ):
                return shape.name
        return ""

    def seam_at(self, spot: QPointF) -> str:
        """Return the seam within reach of a place of the widget, or an empty text."""
        best, found = _NEAR, ""
        place = np.array([spot.x(), spot.y()])
        for shape, move in zip(self._shapes, self._moves, strict=True):
            for name, points, _ in shape.sides:
                away = _distance(self._spots(shape.points[points] + move), place)
                if away < best:
                    best, found = away, name
        return found

    def triangle_at(self, spot: QPointF) -> tuple[PieceShape, int] | None:
        """Return the piece and its triangle at a place of the widget, None off the pieces."""
        name = self.piece_at(spot)
        for shape, move in zip(self._shapes, self._moves, strict=True):
            if shape.name == name:
                middles = self._spots(shape.points[shape.faces].mean(axis=1) + move)
                return shape, int(np.hypot(*(middles - [spot.x(), spot.y()]).T).argmin())
        return None

    # -- the hand

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._pressed, self._dragged = event.position(), False

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._pressed is None:
            seam = self.seam_at(event.position())
            if seam != self.hovered:
                self.hover(seam)
                self.seam_hovered.emit(seam)
            return
        step = event.position() - self._pressed
        if self._dragged or step.manhattanLength() > 4.0:
            self._dragged, self._by_hand, self._pressed = True, True, event.position()
            self._centre = self._centre - np.array([step.x(), -step.y()]) / self._scale
            self.update()  # the cloth is moved as a picture meanwhile

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._pressed is not None and not self._dragged:
            seam = self.seam_at(event.position())
            if seam:
                self.seam_chosen.emit(seam)
            else:
                self.piece_chosen.emit(self.piece_at(event.position()))
        elif self._pressed is not None:
            self._redraw()
        self._pressed = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self._by_hand = False
        self._arrange()
        self._redraw()

    def leaveEvent(self, event: QEvent) -> None:
        if self.hovered:
            self.hover("")
            self.seam_hovered.emit("")

    def wheelEvent(self, event: QWheelEvent) -> None:
        self._zoom(1.2 ** (event.angleDelta().y() / 120.0), event.position())

    def _zoom(self, factor: float, spot: QPointF) -> None:
        here = np.array([spot.x(), spot.y()]) - np.array([self.width(), self.height()]) / 2.0
        former, self._by_hand = self._scale, True
        self._scale = float(np.clip(former * factor, *(_FARTHEST[0] * 0.2, _FARTHEST[1])))
        self._centre = self._centre + here * [1.0, -1.0] * (1.0 / former - 1.0 / self._scale)
        self._redraw()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Go from piece to piece by arrow keys."""
        step = {Qt.Key.Key_Right: 1, Qt.Key.Key_Down: 1, Qt.Key.Key_Left: -1, Qt.Key.Key_Up: -1}
        turn = step.get(Qt.Key(event.key()))
        if turn is None or not self._names:
            event.ignore()
            return
        at = self._names.index(self.piece) if self.piece in self._names else -max(turn, 0)
        name = self._names[(at + turn) % len(self._names)]
        self.piece_chosen.emit(name)
        announce(self, f"{self._titles.get(name, name)} {self._values.get(name, '')}")

    def tip_at(self, place: QPoint) -> str:
        """Return how far the cloth is stretched at a place of the widget, or nothing off the pieces."""
        found = self.triangle_at(QPointF(place))
        if found is None:
            return ""
        shape, at = found
        strain, (across, down) = float(shape.strain[at]), shape.worn[at].tolist()
        way = tr("stretched by {percent} %") if strain >= 0.0 else tr("compressed by {percent} %")
        words = way.format(percent=number(abs(100.0 * strain), 1))
        worn = tr("worn with ease: {across} % across, {down} % down").format(
            across=number(100.0 * across, 1), down=number(100.0 * down, 1)
        )
        return f"{self._titles.get(shape.name, shape.name)}: {words}\n{worn}"

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if not self._by_hand:
            self._arrange()
        self._redraw()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._redraw()
            self.theme_changed.emit()

    # -- painting

    def _redraw(self) -> None:
        self._cloth = None
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.fillRect(self.rect(), QColor(tokens.app))
        if self._words:
            self._paint_words(painter)
        if not self._shapes:
            return
        painter.setOpacity(_FAINT if self._faint else 1.0)
        if self._cloth is None:
            self._cloth, self._cloth_centre = self._paint_cloth(), self._centre
        x, y = self._scale * (self._cloth_centre - self._centre)
        painter.drawPixmap(QPointF(x, -y), self._cloth)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for shape, move in zip(self._shapes, self._moves, strict=True):
            self._paint_sides(painter, shape, move)
        self._paint_titles(painter)

    def _paint_words(self, painter: QPainter) -> None:
        painter.setFont(font("body"))
        painter.setPen(QColor(tokens_of(self).text_quiet))
        room = QRectF(self.rect()).adjusted(24, 24, -24, -24)
        painter.drawText(room, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, self._words)

    def _paint_cloth(self) -> QPixmap:
        """Return all pieces in the colours of their strain, with a path for each colour."""
        ratio, dark = self.devicePixelRatioF(), tokens_of(self).dark
        picture = QPixmap(self.size() * ratio)
        picture.setDevicePixelRatio(ratio)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        share = np.concatenate([s.strain / s.limit for s in self._shapes])
        step = np.round(np.clip(0.5 + 0.5 * share, 0.0, 1.0) * STEPS).astype(np.int64)
        corners = np.concatenate(
            [self._spots(s.points + m)[s.faces] for s, m in zip(self._shapes, self._moves, strict=True)]
        )
        colours = strain_ramp(1.0, dark)(np.linspace(-1.0, 1.0, STEPS + 1))
        for shade in np.unique(step):
            own = corners[step == shade]
            closed = np.concatenate([own, own[:, :1], np.full((len(own), 1, 2), np.nan)], axis=1)
            path = curve_path(closed.reshape(-1, 2))
            ink = QColor(*np.round(colours[shade]).astype(int).tolist())
            painter.setPen(QPen(ink, 0.8))  # closes the hair between two triangles
            painter.setBrush(ink)
            painter.drawPath(path)
        painter.end()
        return picture

    def _paint_sides(self, painter: QPainter, shape: PieceShape, move: Floats) -> None:
        tokens = tokens_of(self)
        outline = np.concatenate([points[:-1] for _, points, _ in shape.sides])
        edge = tokens.accent if shape.name == self.piece else tokens.bad if not shape.fits else tokens.text
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(edge), 2.0 if shape.name == self.piece else 1.2))
        painter.drawPolygon(_polygon(self._spots(shape.points[outline] + move)))
        self._paint_notches(painter, shape, move)
        for name, points, forward in shape.sides:
            if name not in (self.seam, self.hovered) or not name:
                continue
            spots = self._spots(shape.points[points] + move)
            pen = QPen(QColor(tokens.accent), 4.0 if name == self.seam else 3.0)
            pen.setCapStyle(Qt.PenCapStyle.RoundCap)
            painter.setPen(pen)
            painter.drawPolyline(_polygon(spots))
            if name == self.seam and self._knob is not None:
                self._paint_knob(painter, _walked(shape.points[points], self._knob, forward) + move)

    def _paint_notches(self, painter: QPainter, shape: PieceShape, move: Floats) -> None:
        painter.setPen(QPen(QColor(tokens_of(self).text), 1.2))
        for mark in shape.notches:
            painter.drawPolyline(_polygon(self._spots(mark + move)))

    def _paint_knob(self, painter: QPainter, place: Floats) -> None:
        tokens, (x, y) = tokens_of(self), self._spots(place[None])[0]
        painter.setPen(QPen(QColor(tokens.accent), 2.5))
        painter.setBrush(QColor(tokens.raised))
        painter.drawEllipse(QPointF(x, y), 6.5, 6.5)

    def _paint_titles(self, painter: QPainter) -> None:
        for shape, move in zip(self._shapes, self._moves, strict=True):
            x, y = self._spots((shape.label_place + move)[None])[0]
            self._paint_title(painter, QPointF(x, y), shape)

    def _paint_title(self, painter: QPainter, middle: QPointF, shape: PieceShape) -> None:
        """Write title and strain on a ground of their own: cloth may have any colour."""
        tokens, room = tokens_of(self), self._scale * shape.size[0] + 30.0
        lines = []
        texts = self._titles.get(shape.name, shape.name), self._values.get(shape.name, "")
        small = bool(self._scale * shape.size[0] < _SMALL) and shape.name != self.piece
        for text, role in tuple(zip(texts, ("title", "caption"), strict=True))[small:]:
            painter.setFont(font(role, tabular=True))
            metrics = painter.fontMetrics()
            shown = metrics.elidedText(text, Qt.TextElideMode.ElideRight, round(room))
            lines.append((shown, painter.font(), metrics.horizontalAdvance(shown)))
        wide = max(width for _, _, width in lines) + 14.0
        high = 4.0 + 15.0 * len(lines)
        ground = QRectF(middle.x() - wide / 2.0, middle.y() - high / 2.0, wide, high)
        colour = QColor(tokens.panel)
        colour.setAlpha(200)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawRoundedRect(ground, 7.0, 7.0)
        for at, (shown, type_, _) in enumerate(lines):
            painter.setFont(type_)
            value = at == len(lines) - 1
            painter.setPen(QColor(tokens.warn if value and not shape.fits else tokens.text))
            where = QRectF(ground.left(), ground.top() + 1.0 + 15.0 * at, wide, 16.0)
            painter.drawText(where, Qt.AlignmentFlag.AlignCenter, shown)


def _walked(points: Floats, share: float, forward: bool) -> Floats:
    """Return the place at a share of the length of a side from its beginning or its end, (2,) [mm]."""
    along = arc_length(points)
    at = share if forward else 1.0 - share
    return np.asarray(interpolate(np.array([at * along[-1]]), along, points)[0])


def _polygon(spots: Floats) -> QPolygonF:
    return QPolygonF([QPointF(x, y) for x, y in spots.tolist()])


def _distance(curve: Floats, place: Floats) -> float:
    """Return how far a place is from a polyline (k, 2) [px]."""
    start, step = curve[:-1], np.diff(curve, axis=0)
    long = np.maximum((step**2).sum(axis=1), 1e-12)
    at = np.clip(((place - start) * step).sum(axis=1) / long, 0.0, 1.0)
    return float(np.hypot(*(start + at[:, None] * step - place).T).min())
