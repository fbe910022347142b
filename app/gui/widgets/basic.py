"""Basic widgets: buttons, labels, rows, folded lists, and their names for screen readers."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

from collections.abc import Iterable, Sequence

from PySide6.QtCore import QEvent, QPoint, QPointF, QRectF, QSize, Qt, Signal, SignalInstance
from PySide6.QtGui import (
    QAccessible,
    QAccessibleAnnouncementEvent,
    QAction,
    QColor,
    QFont,
    QKeyEvent,
    QKeySequence,
    QPainter,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import (
    QAbstractButton,
    QButtonGroup,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.gui.theme.icons import icon, pixmap
from app.gui.theme.shadow import MARGINS, RADIUS, floating_ground
from app.gui.theme.stylesheet import Sentence, font, label, set_tag, tokens_of
from app.gui.widgets.tooltip import set_tip, watch_tip


def announce(widget: QWidget, words: str) -> None:
    """Announce a text to screen readers: the response to an action at ``widget``."""
    if QAccessible.isActive():
        QAccessible.updateAccessibility(QAccessibleAnnouncementEvent(widget, words))


def speak_value(widget: QWidget, words: str) -> None:
    """Let a slider be heard as people write its value: its own number counts steps.

    The words are spoken at once while the keyboard is there.
    """
    if words != widget.accessibleDescription():
        widget.setAccessibleDescription(words)
        if widget.hasFocus():
            announce(widget, words)


def button(text: str, kind: str = "secondary") -> QPushButton:
    """Return a push button: ``primary``, ``secondary`` or ``quiet``."""
    result = QPushButton(text)
    result.setFont(font("button"))
    result.setProperty("kind", kind)
    result.setCursor(Qt.CursorShape.PointingHandCursor)
    result.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # a button that has the keyboard was reached by it
    return result


def sentence(text: str = "", role: str = "secondary") -> QLabel:
    """Return text that wraps and takes the height it needs."""
    result = label(text, role, kind=Sentence)
    result.setWordWrap(True)
    result.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
    return result


class ScrollColumn(QScrollArea):
    """A column of widgets that scrolls; ``keys=False`` leaves arrows and focus to what is in it."""

    def __init__(
        self,
        name: str,
        margins: tuple[int, int, int, int],
        spacing: int = -1,
        *,
        keys: bool = True,
        sideways: bool = False,
    ) -> None:
        super().__init__()
        inside = QWidget()
        inside.setProperty("scrolled", "true")
        self.column = QVBoxLayout(inside)
        self.column.setContentsMargins(*margins)
        self.column.setSpacing(spacing)  # -1: as the style has it
        self._keys = keys
        if not keys:
            self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        if not sideways:
            self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setAccessibleName(name)
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidget(inside)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if self._keys:
            super().keyPressEvent(event)
        else:
            event.ignore()


class ElidedLabel(QLabel):
    """Text on one line that ends in dots where there is no room for all of it."""

    def __init__(self) -> None:
        super().__init__()
        self.setTextFormat(Qt.TextFormat.PlainText)  # a name may look like HTML

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        shown = painter.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, self.width())
        painter.drawText(self.rect(), Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, shown)


def hairline(vertical: bool = False) -> QFrame:
    """Return a line of one pixel."""
    result = QFrame()
    result.setProperty("rule", "true")
    if vertical:
        result.setFixedWidth(1)
    else:
        result.setFixedHeight(1)
    return result


def paint_card(painter: QPainter, item: QAbstractButton, checked: str, radius: int) -> None:
    """Paint the ground of an item of a list: ``checked`` names its token, hovered and focused follow."""
    tokens = tokens_of(item)
    painter.setPen(QPen(QColor(tokens.accent), 2) if item.hasFocus() else Qt.PenStyle.NoPen)
    if item.isChecked() or item.underMouse() or item.hasFocus():
        painter.setBrush(QColor(getattr(tokens, checked) if item.isChecked() else tokens.hover))
        painter.drawRoundedRect(QRectF(item.rect()).adjusted(1, 1, -1, -1), radius, radius)


class IconLabel(QLabel):
    """An icon that follows the theme; ``token`` names its colour."""

    def __init__(self, name: str, token: str = "text_quiet", size: int = 18) -> None:
        super().__init__()
        self._drawing = (name, token, size)
        self.setFixedSize(size, size)

    def show_icon(self, name: str, token: str) -> None:
        """Show another drawing in another colour."""
        if (name, token) != self._drawing[:2]:
            self._drawing = (name, token, self._drawing[2])
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        name, token, size = self._drawing
        picture = pixmap(name, getattr(tokens_of(self), token), size, self.devicePixelRatioF())
        QPainter(self).drawPixmap(0, 0, picture)


class ToolButton(QToolButton):
    """A button that is only an icon; it follows the theme and, if given, an action."""

    def __init__(
        self, drawing: str, tip: str = "", *, size: int = 18, room: int = 30, action: QAction | None = None
    ) -> None:
        super().__init__()
        self._drawing, self._size = drawing, size
        self.setIconSize(QSize(size, size))
        self.setFixedSize(room, room)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        if action is not None:
            action.setIconVisibleInMenu(False)
            self.setDefaultAction(action)
        watch_tip(self)
        if tip:
            set_tip(self, tip)
            self.setAccessibleName(tip)
        self._repaint_icon()

    def tip(self) -> str:
        """Return what this is, with the key that does the same."""
        action, message = self.defaultAction(), self.toolTip()
        key = "" if action is None else action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
        return f"{message}  {key}" if key and not message.endswith((key, f"({key})")) else message

    def tip_at(self, place: QPoint) -> str:
        return self.tip() if self.toolTip() else ""

    def show_icon(self, drawing: str) -> None:
        """Show another drawing."""
        if drawing != self._drawing:
            self._drawing = drawing
            self._repaint_icon()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._repaint_icon()

    def _repaint_icon(self) -> None:
        tokens, shows = tokens_of(self), self.defaultAction() or self
        drawn = icon(self._drawing, tokens.text_quiet, self._size, on_color=tokens.accent)
        if shows.icon().cacheKey() != drawn.cacheKey():
            shows.setIcon(drawn)


class Segment(QFrame):
    """A few choices of which one is on."""

    chosen = Signal(str)

    def __init__(
        self, choices: Sequence[tuple[str, str]], small: bool = False, *, wide: bool = False
    ) -> None:
        super().__init__()
        self.setProperty("kind", "segment")
        fixed = QSizePolicy.Policy.Fixed
        self.setSizePolicy(QSizePolicy.Policy.Expanding if wide else fixed, fixed)
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(2, 2, 2, 2)
        self._row.setSpacing(0)
        self._small, self._wide = small, wide
        self._group = QButtonGroup(self)
        self._buttons: dict[str, QPushButton] = {}
        for name, title in choices:
            self.add(name, title)

    def add(self, name: str, title: str) -> None:
        """Take in one more choice."""
        small, each = self._small, button(title, "segment")
        each.setCheckable(True)
        each.setAutoExclusive(True)  # heard as one of several choices; the group sees to the rest
        each.setFont(font("title" if small else "name"))
        room = each.fontMetrics().horizontalAdvance(title) + (6 if self._wide else 20 if small else 24)
        each.setFixedHeight(24)
        each.setMinimumWidth(room)
        if self._wide:
            each.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        else:
            each.setFixedWidth(room)
        each.toggled.connect(lambda on: each.setFont(_segment_font(on, small)))
        each.setFont(_segment_font(False, small))
        each.clicked.connect(lambda: self.chosen.emit(name))
        self._group.addButton(each)
        self._row.addWidget(each)
        self._buttons[name] = each

    def set_choice(self, name: str) -> None:
        """Show ``name`` as the choice that is on, or that it is none of these; nothing is emitted."""
        self._group.setExclusive(False)
        for each, item in self._buttons.items():
            item.setChecked(each == name)
        self._group.setExclusive(True)

    def button(self, name: str) -> QPushButton:
        """Return the button of one choice, for tooltip, shortcut or state."""
        return self._buttons[name]


def _segment_font(on: bool, small: bool) -> QFont:
    if small:
        return font("title" if on else "secondary")
    return font("name" if on else "body")


class Disclosure(QAbstractButton):
    """A heading that opens and closes what stands under it; ``toggled`` says which."""

    def __init__(self, title: str) -> None:
        super().__init__()
        self.setText(title)
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(32)

    def sizeHint(self) -> QSize:
        return QSize(self.fontMetrics().horizontalAdvance(self.text()) + 40, 32)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        if self.hasFocus():
            painter.setPen(QPen(QColor(tokens.accent), 2))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 6, 6)
        drawing = "caret-down" if self.isChecked() else "caret-right"
        caret = pixmap(drawing, tokens.text_quiet, 12, self.devicePixelRatioF())
        painter.drawPixmap(QPointF(8, self.height() / 2 - 6), caret)
        painter.setFont(font("secondary"))
        painter.setPen(QColor(tokens.text_quiet))
        words = QRectF(self.rect()).adjusted(28, 0, 0, 0)
        painter.drawText(words, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, self.text())


class FloatingPanel(QWidget):
    """A translucent rounded panel with a soft shadow, to lie on the view."""

    MARGINS, RADIUS = MARGINS, RADIUS

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        left, top, right, bottom = self.MARGINS
        self.row = QHBoxLayout(self)
        self.row.setContentsMargins(left + 6, top + 6, right + 6, bottom + 6)
        self.row.setSpacing(2)

    def paintEvent(self, event: QPaintEvent) -> None:
        ratio, dark = self.devicePixelRatioF(), tokens_of(self).dark
        QPainter(self).drawPixmap(0, 0, floating_ground(self.width(), self.height(), ratio, dark))


class OverlayCard(FloatingPanel):
    """A card over the whole window, which waits for an answer; ``given_up`` by Esc from wherever."""

    given_up = Signal()

    def paintEvent(self, event: QPaintEvent) -> None:
        super().paintEvent(event)
        # Other than a panel of tools it lies on words and tools, which must not shine through.
        tokens, painter = tokens_of(self), QPainter(self)
        left, top, right, bottom = self.MARGINS
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QColor(tokens.outline))
        painter.setBrush(QColor(tokens.raised))
        card = QRectF(self.rect()).adjusted(left + 0.5, top + 0.5, -right - 0.5, -bottom - 0.5)
        painter.drawRoundedRect(card, self.RADIUS, self.RADIUS)


class EmptyState(QFrame):
    """What is missing and what to do, where nothing can be shown yet; ``requested`` at its button."""

    requested = Signal()

    def __init__(self, drawing: str, missing: str, hint: str, ask: str = "") -> None:
        super().__init__()
        set_tag(self, "kind", "card")
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 16, 16, 16)
        column.setSpacing(6)
        column.addWidget(IconLabel(drawing, "text_quiet", 26))
        column.addSpacing(4)
        self._missing, self._hint = sentence(missing, "name"), sentence(hint)
        column.addWidget(self._missing)
        column.addWidget(self._hint)
        if ask:
            press = button(ask)
            press.clicked.connect(self.requested)
            column.addSpacing(6)
            column.addWidget(press, alignment=Qt.AlignmentFlag.AlignLeft)

    def show_words(self, missing: str, hint: str) -> None:
        """Set the text."""
        self._missing.setText(missing)
        self._hint.setText(hint)


def folded_list(column: QVBoxLayout, title: str, sentences: Sequence[str]) -> Disclosure:
    """Add ``sentences`` to a column, folded under a ``title``; returns what unfolds them."""
    fold, words = Disclosure(title), sentence("\n".join(f"• {each}" for each in sentences), "caption")
    words.setContentsMargins(28, 0, 0, 4)
    words.hide()
    fold.toggled.connect(words.setVisible)
    column.addWidget(fold)
    column.addWidget(words)
    return fold


def button_row(choices: Iterable[tuple[str, str, SignalInstance]], top: int = 0) -> QWidget:
    """Return buttons from the left: text, tip and what is emitted; ``top`` is the room over them [px]."""
    holder = QWidget()
    row = QHBoxLayout(holder)
    row.setContentsMargins(0, top, 0, 0)
    row.setSpacing(6)
    for text, tip, signal in choices:
        press = button(text)
        set_tip(press, tip)
        press.clicked.connect(signal)
        row.addWidget(press)
    row.addStretch(1)
    return holder
