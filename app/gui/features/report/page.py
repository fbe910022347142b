"""The sheet on the screen: its pages as they come out of the printer, and what can be done with them."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPixmap, QResizeEvent, QShowEvent, QWheelEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLineEdit, QScrollArea, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, tokens_of
from app.gui.widgets.basic import Segment, button, hairline, sentence
from app.gui.widgets.navigation_row import BackButton
from app.i18n.catalog import LANGUAGES, tr
from app.report.pages import Pages
from app.report.painter import A4, UNITS
from core.document.custom_measures import LONGEST_CUSTOMER

WIDE, GAP = 316, 24
"""Width of the column beside the pages, and what is between them [px]."""

_LIMITS = 360.0, 2400.0  # of the width of a page [px]
_WIDEST = 980.0  # of a page that fills the room [px]
_STEP = 1.1  # of a notch of the wheel


class ReportPage(QWidget):
    """Shows the pages of a sheet; what is wished is told by signals.

    ``customer_changed`` carries whose it is, ``language_chosen`` a code; ``requested`` "pdf", "print",
    "json" or "csv"; ``closed`` when the work is to come back.
    """

    customer_changed = Signal(str)
    language_chosen = Signal(str)
    requested = Signal(str)
    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.paper = _PageArea()
        self.customer = QLineEdit()
        self.customer.setFont(font("body"))
        self.customer.setFixedHeight(30)
        self.customer.setMaxLength(LONGEST_CUSTOMER)
        self.customer.setPlaceholderText(tr("Name or number"))
        self.customer.editingFinished.connect(self.tell_name)
        self.languages = Segment(list(LANGUAGES.items()), wide=True)
        self.languages.chosen.connect(self.language_chosen)
        self.zoom = Segment([("page", tr("Whole page")), ("width", tr("Full width"))], wide=True)
        self.zoom.chosen.connect(self.paper.fit)
        self.zoom.set_choice("width")
        self.back = BackButton(tr("Close report"))
        self.back.clicked.connect(self.closed)
        self.does = {
            "print": button(tr("Print…")),
            "csv": button(tr("Values (CSV)…")),
            "json": button(tr("Data (JSON)…")),
            "pdf": button(tr("Save as PDF…"), "primary"),
        }
        for name, press in self.does.items():
            press.clicked.connect(lambda _=False, name=name: self._want(name))
        self.facts, self.state = label("", "secondary"), sentence("", "secondary")
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.paper, 1)
        row.addWidget(hairline(vertical=True))
        row.addWidget(self._column())
        self.show_pages(None)

    def show_pages(self, pages: Pages | None, words: str = "", *, stale: bool = False) -> None:
        """Show the pages of a sheet, or none yet; ``words`` say what is under way, if anything is.

        A ``stale`` sheet is that of a former body: it is faint, and cannot be given away.
        """
        ready = pages is not None and not stale
        for press in self.does.values():
            press.setEnabled(ready)
        count = pages.count if pages is not None else 0
        facts = tr("A4, one page") if count == 1 else tr("A4, {count} pages").format(count=count)
        self.facts.setText(facts if count else "A4")
        self.state.setText(words)
        self.state.setVisible(bool(words))
        self.paper.show_pages(pages, words, stale=stale)

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if not event.spontaneous():
            self.paper.verticalScrollBar().setValue(0)  # a doubt stands at the head

    def show_choices(self, customer: str, language: str) -> None:
        """Show whose the sheet is, unless that is being typed, and which language it speaks."""
        typing = self.customer.hasFocus() and self.customer.isModified()
        if not typing and self.customer.text() != customer:
            self.customer.setText(customer)
        self.languages.set_choice(language)

    def tell_name(self) -> None:
        """Emit the customer's name, if it was edited since the last time."""
        if self.customer.isModified():
            self.customer.setModified(False)
            name = " ".join(self.customer.text().split())
            self.customer_changed.emit("".join(each for each in name if each.isprintable()))

    def _want(self, what: str) -> None:
        self.tell_name()  # a press of a button leaves the keyboard in the field: its name is not told yet
        self.requested.emit(what)

    def _column(self) -> QWidget:
        column = QWidget()
        column.setFixedWidth(WIDE)
        lay = QVBoxLayout(column)
        lay.setContentsMargins(16, 14, 16, 14)
        lay.setSpacing(4)
        lay.addWidget(self.back, alignment=Qt.AlignmentFlag.AlignLeft)
        lay.addSpacing(8)
        lay.addWidget(label(tr("Fitting report"), "page"))
        lay.addWidget(self.facts)
        for title, part in (
            (tr("Customer (optional)"), self.customer),
            (tr("Report language"), self.languages),
            (tr("Page zoom"), self.zoom),
        ):
            lay.addSpacing(12)
            lay.addWidget(label(title, "caption"))
            part.setAccessibleName(title)
            lay.addWidget(part)
        lay.addSpacing(12)
        lay.addWidget(self.state)
        lay.addStretch(1)
        for first, second in (("csv", "json"), ("print", "pdf")):
            foot = QHBoxLayout()
            foot.setSpacing(8)
            for name in (first, second):
                foot.addWidget(self.does[name], 1)
            lay.addSpacing(4)
            lay.addLayout(foot)
        return column


class _PageArea(QScrollArea):
    """The pages below each other on the ground of the window; Ctrl and the wheel make them larger."""

    def __init__(self) -> None:
        super().__init__()
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setWidgetResizable(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAccessibleName(tr("Report pages"))
        self._ground = _Background()
        self.setWidget(self._ground)
        self._lay = QVBoxLayout(self._ground)
        self._lay.setContentsMargins(GAP, GAP, GAP, GAP)
        self._lay.setSpacing(GAP)
        self.empty = sentence("", "body")
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._lay.addWidget(self.empty)
        self.leaves: list[ReportSheet] = []
        self._by, self._width = "width", 0.0
        self.viewport().installEventFilter(self)

    def show_pages(self, pages: Pages | None, words: str, *, stale: bool) -> None:
        """Show these pages, or words where there are none."""
        count = pages.count if pages is not None else 0
        while len(self.leaves) > count:
            leaf = self.leaves.pop()
            self._lay.removeWidget(leaf)
            leaf.deleteLater()
        while len(self.leaves) < count:
            leaf = ReportSheet(len(self.leaves))
            self.leaves.append(leaf)
            self._lay.addWidget(leaf, alignment=Qt.AlignmentFlag.AlignHCenter)
        for leaf in self.leaves:
            leaf.show_page(pages, stale=stale)
        self.empty.setText(words)
        self.empty.setVisible(not count)
        self._lay_out()

    def fit(self, by: str) -> None:
        """Show whole pages, or pages as wide as there is room."""
        self._by = by
        self._lay_out()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._lay_out()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Zoom by Ctrl and the wheel, which else scrolls."""
        if isinstance(event, QWheelEvent) and event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            low, high = _LIMITS
            self._width = min(max(self._width * _STEP ** (event.angleDelta().y() / 120.0), low), high)
            self._by = ""
            self._lay_out()
            return True
        return super().eventFilter(watched, event)

    def _lay_out(self) -> None:
        room = self.viewport().size()
        if self._by == "page":
            self._width = (room.height() - 2 * GAP) * A4[0] / A4[1]
        elif self._by == "width":
            self._width = min(room.width() - 2 * GAP - 16.0, _WIDEST)
        width = round(min(max(self._width, _LIMITS[0]), _LIMITS[1]))
        for leaf in self.leaves:
            leaf.setFixedSize(width, round(width * A4[1] / A4[0]))


class _Background(QWidget):
    """What pages lie on."""

    def paintEvent(self, event: QPaintEvent) -> None:
        QPainter(self).fillRect(event.rect(), QColor(tokens_of(self).app))


class ReportSheet(QWidget):
    """One page, white in every theme; it is painted once, and kept until page or size change."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self._number, self._stale = number, False
        self._pages: Pages | None = None
        self._kept = QPixmap()
        self.setAccessibleName(tr("Page {number}").format(number=number + 1))

    def show_page(self, pages: Pages | None, *, stale: bool) -> None:
        """Show a page of these, faint if it is ``stale``."""
        if pages is not self._pages:
            self._kept = QPixmap()
        self._pages, self._stale = pages, stale
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        ratio, painter = self.devicePixelRatioF(), QPainter(self)
        size = self.size() * ratio
        if self._kept.size() != size:
            self._kept = self._painted(size.width(), size.height())
        painter.fillRect(self.rect(), QColor("white"))
        painter.setOpacity(0.35 if self._stale else 1.0)
        painter.drawPixmap(self.rect(), self._kept)
        painter.setOpacity(1.0)
        painter.setPen(QColor(tokens_of(self).outline))
        painter.drawRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5))

    def _painted(self, width: int, height: int) -> QPixmap:
        result = QPixmap(width, height)
        result.fill(QColor("white"))
        if self._pages is not None:
            painter = QPainter(result)
            scale = width / A4[0] / UNITS
            painter.scale(scale, scale)
            self._pages.paint(painter, self._number)
            painter.end()
        return result
