"""The page that the window starts on: a scan to begin with on the left, what was open before on the right."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QObject, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QAction, QColor, QKeyEvent, QPainter, QPaintEvent, QPen, QResizeEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QLineEdit, QScrollArea, QVBoxLayout, QWidget

from app.gui.features.project.project_card import HEIGHT, WIDTH, ProjectCard, ProjectView
from app.gui.theme.icons import icon, paint_icon
from app.gui.theme.stylesheet import font, label, set_tag, tokens_of
from app.gui.widgets.basic import EmptyState, IconLabel, button, hairline, sentence
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr, tr_context
from app.presenters.samples import SAMPLES
from app.presenters.scan import KINDS


class DropZone(QFrame):
    """Says what can be dropped, with a button for those who would rather choose."""

    requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumHeight(212)
        column = QVBoxLayout(self)
        column.setContentsMargins(10, 24, 10, 24)
        column.setSpacing(6)
        column.addStretch(1)
        column.addWidget(IconLabel("drop-file", "text_quiet", 30), alignment=Qt.AlignmentFlag.AlignHCenter)
        column.addSpacing(6)
        for text, role in (
            (tr("Drop a scan or a project here"), "name"),
            (tr("{kinds}. The unit is detected and shown.").format(kinds=KINDS), "caption"),
        ):
            column.addWidget(_centred(text, role))
        column.addSpacing(10)
        self.choose = button(tr("Choose file…"), "primary")
        self.choose.clicked.connect(self.requested)
        column.addWidget(self.choose, alignment=Qt.AlignmentFlag.AlignHCenter)
        column.addStretch(1)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        pen = QPen(QColor(tokens_of(self).control), 1.4)
        pen.setDashPattern([4.0, 4.0])
        painter.setPen(pen)
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), 12, 12)


class DropVeil(QWidget):
    """Lies over the window while a file is dragged over it, and says what letting go will do."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._window = parent
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._said = ""
        self.hide()

    def show_for(self, name: str) -> None:
        """Cover the window and name the file."""
        self._said = tr("Release to open {name}").format(name=name)
        self.setAccessibleName(self._said)
        self.setGeometry(self._window.rect())
        self.raise_()
        self.show()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens = tokens_of(self)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        veil = QColor(tokens.panel)
        veil.setAlphaF(0.82)
        painter.fillRect(self.rect(), veil)
        pen = QPen(QColor(tokens.accent), 2)
        pen.setDashPattern([4.0, 3.0])
        painter.setPen(pen)
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(16, 16, -16, -16), 12, 12)
        middle = QRectF(self.rect()).center()
        paint_icon(painter, "drop-file", tokens.accent, QRectF(middle.x() - 22, middle.y() - 52, 44, 44))
        painter.setFont(font("page"))
        painter.setPen(QColor(tokens.text))
        words = QRectF(40, middle.y() + 4, self.width() - 80, 40)
        message = painter.fontMetrics().elidedText(
            self._said, Qt.TextElideMode.ElideMiddle, round(words.width())
        )
        painter.drawText(words, Qt.AlignmentFlag.AlignCenter, message)


def _centred(text: str, role: str) -> QLabel:
    result = sentence(text, role)
    result.setAlignment(Qt.AlignmentFlag.AlignHCenter)
    return result


_LEFT, _LEFT_IF_NARROW, _NARROW = 400, 340, 1150
_APART = 16
_MARGIN = 32
_SEARCH_FROM = 5  # fewer cards are seen at a glance


class StartPage(QWidget):
    """Asks for a file to open; ``closed`` when the open document is wanted back.

    ``project_chosen``, ``locate_requested`` and ``forget_requested`` carry the path of a card,
    ``sample_requested`` the name of a sample body.
    """

    open_requested = Signal()
    sample_requested = Signal(str)
    tour_requested = Signal()
    guide_requested = Signal()
    project_chosen = Signal(str)
    locate_requested = Signal(str)
    forget_requested = Signal(str)
    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        self.search = self._search_field()
        for part, stretch in ((self._begin(), 0), (hairline(vertical=True), 0), (self._recent(), 1)):
            row.addWidget(part, stretch)

    def set_projects(self, projects: Sequence[ProjectView]) -> None:
        """Show these files, the last one first."""
        self.shelf.set_projects(projects)
        self.search.clear()
        self.search.setVisible(len(projects) >= _SEARCH_FROM)
        self._nothing.setVisible(not projects)

    def set_document(self, name: str) -> None:
        """Show the way back to the open document, if there is one."""
        self.back.setText(tr("Back to {name}").format(name=name))
        self.back.setVisible(bool(name))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and not self.back.isHidden():
            self.closed.emit()
        else:
            super().keyPressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        # In the smallest window three cards fit beside each other.
        self._side.setFixedWidth(_LEFT if self.width() >= _NARROW else _LEFT_IF_NARROW)

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange:
            self._dress_search()

    def _begin(self) -> QWidget:
        """Return the left side."""
        side = self._side = QWidget()
        column = QVBoxLayout(side)
        column.setContentsMargins(_MARGIN, 28, _MARGIN, 24)
        column.setSpacing(8)
        heading = label(tr("New from scan"), "page")
        heading.setMinimumHeight(self.search.height())
        column.addWidget(heading)
        column.addSpacing(8)
        self.zone = DropZone()
        self.zone.requested.connect(self.open_requested)
        column.addWidget(self.zone)
        column.addSpacing(16)
        column.addWidget(label(tr("Or open a sample"), "secondary"))
        column.addLayout(self._samples())
        tour = button(tr("Start tour"))
        tour.clicked.connect(self.tour_requested)
        column.addWidget(tour)
        guide = button(tr("Quick start"), "quiet")
        set_tip(guide, tr("Open the user guide in the browser"))
        guide.clicked.connect(self.guide_requested)
        column.addWidget(guide)
        column.addStretch(1)
        self.back = button("", "secondary")
        set_tip(self.back, tr("Back to the current design (Esc)"))
        self.back.clicked.connect(self.closed)
        self.back.hide()
        column.addWidget(self.back)
        column.addSpacing(8)
        private = QHBoxLayout()
        private.setSpacing(10)
        private.addWidget(IconLabel("shield", "text_caption", 18), alignment=Qt.AlignmentFlag.AlignTop)
        private.addWidget(
            sentence(tr("Scans stay on this computer. Busk has no network code."), "caption"), 1
        )
        column.addLayout(private)
        return side

    def _samples(self) -> QHBoxLayout:
        samples = QHBoxLayout()
        samples.setSpacing(8)
        for name, title in SAMPLES.items():
            each = button(tr_context("sample", title))
            each.clicked.connect(lambda _=False, chosen=name: self.sample_requested.emit(chosen))
            samples.addWidget(each, 1)
        return samples

    def _recent(self) -> QWidget:
        """Return the right side."""
        side = QWidget()
        column = QVBoxLayout(side)
        column.setContentsMargins(0, 28, 0, 0)
        column.setSpacing(0)
        head = QHBoxLayout()
        head.setContentsMargins(_MARGIN, 0, _MARGIN, 0)
        head.addWidget(label(tr("Recent"), "page"))
        head.addStretch(1)
        head.addWidget(self.search)
        column.addLayout(head)
        column.addSpacing(16)
        self._nothing = EmptyState(
            "folder-open", tr("No recent files"), tr("Opened scans and projects are listed here with images.")
        )
        self._nothing.setFixedWidth(2 * WIDTH + _APART)
        empty = QHBoxLayout()
        empty.setContentsMargins(_MARGIN, 0, _MARGIN, 0)
        empty.addWidget(self._nothing)
        empty.addStretch(1)
        column.addLayout(empty)
        self.shelf = _Shelf(self)
        self.search.textChanged.connect(self.shelf.show_only)
        scroll = QScrollArea()
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        set_tag(self.shelf, "scrolled", "true")
        scroll.setWidget(self.shelf)
        self._scroll = scroll
        column.addWidget(scroll, 1)
        return side

    def reveal(self, card: QWidget) -> None:
        """Scroll to a card."""
        self._scroll.ensureWidgetVisible(card, 0, _APART)

    def _search_field(self) -> QLineEdit:
        search = QLineEdit()
        search.setPlaceholderText(tr("Search"))
        search.setAccessibleName(tr("Search recent files"))
        set_tip(search, tr("Show only files whose names contain these letters"))
        search.setClearButtonEnabled(True)
        search.setFixedSize(220, 30)
        self._glass = QAction(self)
        search.addAction(self._glass, QLineEdit.ActionPosition.LeadingPosition)
        self._dress_search()
        return search

    def _dress_search(self) -> None:
        self._glass.setIcon(icon("search", tokens_of(self).text_caption, 16))


class _Shelf(QWidget):
    """Cards in as many columns as there is room for."""

    def __init__(self, page: StartPage) -> None:
        super().__init__()
        self._page = page
        self.cards: list[ProjectCard] = []

    def set_projects(self, projects: Sequence[ProjectView]) -> None:
        """Show these files instead of those before."""
        for card in self.cards:
            card.hide()
            card.deleteLater()
        self.cards = [ProjectCard(each) for each in projects]
        for card in self.cards:
            card.setParent(self)
            card.opened.connect(self._page.project_chosen)
            card.located.connect(self._page.locate_requested)
            card.forgotten.connect(self._page.forget_requested)
            card.installEventFilter(self)
            card.show()
        self._place()

    def show_only(self, letters: str) -> None:
        """Show only files with these letters in their names."""
        for card in self.cards:
            card.setHidden(letters.strip().lower() not in card.view.name.lower())
        self._place()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.FocusIn and isinstance(watched, QWidget):
            self._page.reveal(watched)
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            return self._step(watched, event.key())
        return False

    def resizeEvent(self, event: QResizeEvent) -> None:
        self._place()

    def sizeHint(self) -> QSize:
        return QSize(WIDTH + 2 * _MARGIN, self.minimumHeight())

    def _columns(self) -> int:
        return max(1, (self.width() - 2 * _MARGIN + _APART) // (WIDTH + _APART))

    def _shown(self) -> list[ProjectCard]:
        return [card for card in self.cards if not card.isHidden()]

    def _place(self) -> None:
        columns, shown = self._columns(), self._shown()
        for place, card in enumerate(shown):
            row, column = divmod(place, columns)
            card.move(_MARGIN + column * (WIDTH + _APART), row * (HEIGHT + _APART))
        rows = -(-len(shown) // columns)
        self.setMinimumHeight(rows * (HEIGHT + _APART) + _APART if rows else 0)

    def _step(self, watched: QObject, key: int) -> bool:
        """Go to the card beside, above or below with the arrow keys."""
        steps = {
            Qt.Key.Key_Left: -1,
            Qt.Key.Key_Right: 1,
            Qt.Key.Key_Up: -self._columns(),
            Qt.Key.Key_Down: self._columns(),
        }
        shown = self._shown()
        if key not in steps or watched not in shown:
            return False
        place = shown.index(watched) + steps[Qt.Key(key)]
        if 0 <= place < len(shown):
            shown[place].setFocus(Qt.FocusReason.TabFocusReason)
        return True
