"""Export of the pieces: kind of file and paper at the left, the pages as they will be at the right."""

# ruff: noqa: D102, N802 - Qt names its events and says what they are
from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QRadioButton, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, set_tag, tokens_of
from app.gui.widgets.basic import Segment, ToolButton, sentence
from app.gui.widgets.dialog import Dialog
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.i18n.lengths import length, length_number
from app.presenters.pattern_files import kind_titles, paper_titles
from app.report.painter import UNITS
from app.report.pdf_file import PaintedPages

SIZE = (940, 680)
"""Width and height of the dialog [px]."""

_GAP = 10.0  # round a page [px]


class PatternExportDialog(Dialog):
    """Offers kinds of files and paper with a preview; ``changed`` when the pages are others."""

    changed = Signal()
    save_requested = Signal()
    print_requested = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, tr("Export pieces"), SIZE)
        self.kind, self.paper = "pdf", "a4"
        self.preview = PagePreview()
        self.facts = label("", "secondary")
        self.doubt = sentence("", "secondary")
        set_tag(self.doubt, "tone", "warn")
        row = QHBoxLayout()
        row.setSpacing(20)
        row.addLayout(self._make_choices())
        row.addLayout(self._make_preview(), 1)
        self.body.addLayout(row, 1)
        self.add_button(tr("Close"), self.reject)
        self.print = self.add_button(tr("Print…"), self.print_requested.emit)
        self.save = self.add_button(tr("Save…"), self.save_requested.emit, "primary")

    def _make_choices(self) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setSpacing(4)
        self.kinds: dict[str, QRadioButton] = {}
        for kind, (title, tip) in kind_titles().items():
            choice = self.kinds[kind] = QRadioButton(title)
            choice.setFont(font("body"))
            choice.setAccessibleDescription(tip)
            set_tip(choice, tip)
            choice.setChecked(kind == self.kind)
            choice.clicked.connect(lambda _=False, kind=kind: self._choose(kind))
            column.addWidget(choice)
        column.addSpacing(12)
        self.paper_label = label(tr("Paper size"), "caption")
        self.papers = Segment(tuple(paper_titles().items()), small=True)
        self.papers.set_choice(self.paper)
        self.papers.chosen.connect(self._choose_paper)
        self.strips = QCheckBox(tr("Include straps and bands"))
        self.strips.setFont(font("body"))
        set_tip(self.strips, tr("Add strips of the active lines, except elastics of edges"))
        self.strips.clicked.connect(self.changed)
        for each in (self.paper_label, self.papers):
            column.addWidget(each)
        column.addSpacing(8)
        column.addWidget(self.strips)
        column.addSpacing(12)
        column.addWidget(self.doubt)
        column.addStretch(1)
        return column

    def _make_preview(self) -> QVBoxLayout:
        column, row = QVBoxLayout(), QHBoxLayout()
        column.addWidget(self.preview, 1)
        back = ToolButton("caret-left", tr("Previous page"), size=14, room=28)
        ahead = ToolButton("caret-right", tr("Next page"), size=14, room=28)
        back.clicked.connect(lambda: self.preview.turn(-1))
        ahead.clicked.connect(lambda: self.preview.turn(1))
        self.preview.turned.connect(self._show_page)
        self._turners = back, ahead
        row.addWidget(back)
        row.addStretch(1)
        row.addWidget(self.facts)
        row.addStretch(1)
        row.addWidget(ahead)
        column.addLayout(row)
        return column

    def show_pages(self, pages: PaintedPages | None, words: str = "") -> None:
        """Show the pages that would be printed, or ``words`` why there are none."""
        self.preview.show_pages(pages, words)
        self._show_page()
        self._enable_buttons()

    def _enable_buttons(self) -> None:
        self.save.setEnabled(self.preview.count > 0)
        self.print.setEnabled(self.kind == "pdf" and self.preview.count > 0)

    def show_doubt(self, words: str) -> None:
        """Say what to mind before cutting."""
        self.doubt.setText(words)
        self.doubt.setVisible(bool(words))

    def _choose(self, kind: str) -> None:
        self.kind = kind
        for part in (self.paper_label, self.papers):
            part.setEnabled(kind == "pdf")
        self._enable_buttons()

    def _choose_paper(self, paper: str) -> None:
        self.paper = paper
        self.papers.set_choice(paper)
        self.changed.emit()

    def _show_page(self) -> None:
        count = self.preview.count
        text = tr("Page {page} of {count}, {width} × {height}")
        width, height = self.preview.size_mm
        told = text.format(
            page=self.preview.page + 1, count=count, width=length_number(width, 0), height=length(height, 0)
        )
        self.facts.setText(told if count else "")
        for each in self._turners:
            each.setEnabled(count > 1)


class PagePreview(QWidget):
    """One page on the ground of the window, as large as there is room; ``turned`` to another one."""

    turned = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.page = 0
        self._pages: PaintedPages | None = None
        self._words = ""
        self.setMinimumSize(420, 380)
        self.setAccessibleName(tr("Preview of the pages"))

    def sizeHint(self) -> QSize:
        return QSize(560, 520)

    @property
    def count(self) -> int:
        """Return the number of pages."""
        return 0 if self._pages is None else self._pages.count

    @property
    def size_mm(self) -> tuple[float, float]:
        """Return width and height of the pages [mm]."""
        return (0.0, 0.0) if self._pages is None else self._pages.size

    def show_pages(self, pages: PaintedPages | None, words: str) -> None:
        """Show other pages, the first of them if there are fewer now."""
        self._pages, self._words = pages, words
        self.page = min(self.page, max(self.count - 1, 0))
        self.update()

    def turn(self, step: int) -> None:
        """Show another page."""
        if self.count:
            self.page = (self.page + step) % self.count
            self.update()
            self.turned.emit()

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, painter = tokens_of(self), QPainter(self)
        painter.fillRect(self.rect(), QColor(tokens.app))
        if self._pages is None:
            painter.setFont(font("body"))
            painter.setPen(QColor(tokens.text_quiet))
            room = QRectF(self.rect()).adjusted(20, 20, -20, -20)
            painter.drawText(room, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, self._words)
            return
        width, height = self._pages.size
        scale = min((self.width() - 2 * _GAP) / width, (self.height() - 2 * _GAP) / height)
        page = QRectF(0.0, 0.0, scale * width, scale * height)
        page.moveCenter(QRectF(self.rect()).center())
        painter.fillRect(page, QColor("white"))
        painter.setPen(QColor(tokens.outline))
        painter.drawRect(page)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setClipRect(page)
        painter.translate(page.topLeft())
        painter.scale(scale / UNITS, scale / UNITS)
        self._pages.paint(painter, self.page)
