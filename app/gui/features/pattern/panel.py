"""Panel of the pattern: its block, its verdict, its pieces, and what is selected of them."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QSizePolicy, QStackedWidget, QVBoxLayout, QWidget

from app.gui.features.pattern.cards import PieceCard, SeamCard
from app.gui.features.pattern.piece_list import ROW, PieceList
from app.gui.theme.stylesheet import font, label, set_tag
from app.gui.widgets.basic import ScrollColumn, button, hairline, sentence
from app.gui.widgets.menu import Menu, pull_down
from app.gui.widgets.navigation_row import NavigationRow
from app.gui.widgets.option_field import AmountEdit, OptionCombo
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.model_options import length_amount
from app.presenters.pattern import PieceRow
from core.document.block import LARGEST_ALLOWANCE
from core.document.garment_pattern import GarmentPattern

LIST_ROWS = 4
"""Pieces of the list that a card leaves in sight."""

_HEAD = 104  # height of block, verdict and note over the list [px]


class _PieceColumn(ScrollColumn):
    """Block, verdict, list and settings; the selected piece stays in sight while a card takes its room."""

    def __init__(self, pieces: PieceList) -> None:
        super().__init__(tr("Pattern pieces"), (12, 12, 12, 12), 8)
        self._pieces = pieces
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Ignored)

    def keep(self, rows: int) -> None:
        """Stay so high that of so many ``rows`` of the list ``LIST_ROWS`` are in sight."""
        self.setMinimumHeight(_HEAD + min(rows, LIST_ROWS) * ROW)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self.show_selected()

    def show_selected(self) -> None:
        """Scroll to the selected piece."""
        for each in self._pieces.buttons:
            if each.isChecked():
                self.ensureWidgetVisible(each, 0, 4)


class _CardColumn(ScrollColumn):
    """The card of what is selected, as high as it is; it scrolls where the list would get too small."""

    def __init__(self, cards: Sequence[QWidget]) -> None:
        self._at_end = False
        super().__init__(tr("Selection"), (12, 0, 12, 10), 0)
        for card in cards:
            self.column.addWidget(card)
        self.column.addStretch(1)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        bar = self.verticalScrollBar()
        bar.rangeChanged.connect(self._scroll_to_end)
        bar.actionTriggered.connect(lambda _: self.show_end(False))

    def sizeHint(self) -> QSize:
        return QSize(super().sizeHint().width(), self.column.totalHeightForWidth(self.viewport().width()))

    def minimumSizeHint(self) -> QSize:
        return QSize(super().minimumSizeHint().width(), 0)

    def show_end(self, on: bool = True) -> None:
        """Scroll to what has been added at the end of a card, once it has its place; or do no longer."""
        self._at_end = on

    def _scroll_to_end(self, _: int, most: int) -> None:
        if self._at_end:
            self.verticalScrollBar().setValue(most)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.LayoutRequest:
            self.updateGeometry()
        return super().eventFilter(watched, event)


class PatternPanel(QStackedWidget):
    """Offers blocks where there is none; else shows the pieces.

    ``block_chosen`` carries the name of a block that comes with Busk.
    """

    block_chosen = Signal(str)
    block_file_requested = Signal()
    save_block_requested = Signal()
    removed = Signal()
    piece_chosen = Signal(str)
    allowance_changed = Signal(float)
    bridged_changed = Signal(bool)
    draw_requested = Signal()
    export_requested = Signal()
    lines_requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.block_doors: dict[str, NavigationRow] = {}
        self.list, self.piece_card, self.seam_card = PieceList(), PieceCard(), SeamCard()
        self.verdict, self.note = sentence("", "body"), sentence("", "secondary")
        self.addWidget(self._make_choice())
        self.addWidget(self._make_pieces())
        self.list.chosen.connect(self.piece_chosen)

    # -- where there is no pattern

    def _make_choice(self) -> QWidget:
        page = ScrollColumn(tr("Garment blocks"), (0, 12, 0, 12), 0)
        head = QVBoxLayout()
        head.setContentsMargins(18, 0, 18, 10)
        head.setSpacing(6)
        head.addWidget(label(tr("Pattern pieces"), "heading"))
        words = tr(
            "Choose a garment block. Busk places its seams on the body by landmarks and flattens its pieces."
        )
        head.addWidget(sentence(words))
        page.column.addLayout(head)
        self._doors = QVBoxLayout()
        self._doors.setSpacing(0)
        page.column.addLayout(self._doors)
        self.open_block = NavigationRow(tr("Open block…"), tr("Open a block file"))
        self.open_block.clicked.connect(self.block_file_requested)
        page.column.addWidget(self.open_block)
        page.column.addStretch(1)
        return page

    def set_blocks(self, blocks: Sequence[tuple[str, str, str]]) -> None:
        """Set the blocks that are offered: name, title, and a line about each."""
        menu = self._menu
        for name, title, words in blocks:
            door = self.block_doors[name] = NavigationRow(title, words)
            door.clicked.connect(lambda _=False, name=name: self.block_chosen.emit(name))
            self._doors.addWidget(door)
            menu.addAction(title).triggered.connect(lambda _=False, name=name: self.block_chosen.emit(name))
        menu.addSeparator()
        menu.addAction(tr("Open block…")).triggered.connect(self.block_file_requested)
        menu.addAction(tr("Save block as…")).triggered.connect(self.save_block_requested)
        menu.addSeparator()
        menu.addAction(tr("Remove pattern")).triggered.connect(self.removed)

    # -- the pieces

    def _make_pieces(self) -> QWidget:
        holder = QWidget()
        whole = QVBoxLayout(holder)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(0)
        page = self._column = _PieceColumn(self.list)
        column = page.column
        column.addLayout(self._make_head())
        for each in (self.verdict, self.note):
            each.setContentsMargins(6, 0, 6, 0)
            column.addWidget(each)
        self.compute = button(tr("Compute pieces"))
        self.compute.hide()
        column.addWidget(self.compute, alignment=Qt.AlignmentFlag.AlignLeft)
        column.addWidget(self.list)
        column.addWidget(hairline())
        column.addLayout(self._make_settings())
        column.addStretch(1)
        whole.addWidget(page, 1)
        self._cards = _CardColumn((self.piece_card, self.seam_card))
        self.piece_card.extended.connect(self._cards.show_end)
        whole.addWidget(self._cards)
        whole.addWidget(self._make_foot())
        return holder

    def _make_head(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setContentsMargins(6, 0, 6, 0)
        self.block = OptionCombo()
        self.block.setMinimumHeight(30)
        self.block.setAccessibleName(tr("Garment block"))
        set_tip(self.block, tr("Choose another block, open one or save this one"))
        self._menu = Menu(self)
        self.block.clicked.connect(lambda: pull_down(self._menu, self.block))
        row.addWidget(self.block, 1)
        return row

    def _make_settings(self) -> QVBoxLayout:
        column, row = QVBoxLayout(), QHBoxLayout()
        column.setContentsMargins(6, 0, 6, 0)
        column.setSpacing(6)
        tip = tr("Set the allowance of all seams and edges without their own")
        amount = length_amount("allowance", tr("Seam allowance"), tip, (0.0, LARGEST_ALLOWANCE))
        self.allowance = AmountEdit(amount)
        self.allowance.setAccessibleName(amount.title)
        self.allowance.entered.connect(self.allowance_changed.emit)
        title = label(amount.title, "secondary")
        for each in (title, self.allowance):
            set_tip(each, tip)
        row.addWidget(title)
        row.addStretch(1)
        row.addWidget(self.allowance)
        column.addLayout(row)
        self.bridged = QCheckBox(tr("Bridge hollows"))
        self.bridged.setFont(font("secondary"))
        set_tip(
            self.bridged,
            tr("Span cleavage, overhang and cleft instead of following the skin"),
        )
        self.bridged.clicked.connect(self.bridged_changed)
        self.draw = button(tr("Draw seam or dart"))
        set_tip(self.draw, tr("Divide pieces by a seam, or add a dart, drawn on the body"))
        self.draw.clicked.connect(self.draw_requested)
        column.addWidget(self.bridged)
        column.addWidget(self.draw, alignment=Qt.AlignmentFlag.AlignLeft)
        return column

    def _make_foot(self) -> QWidget:
        foot = QWidget()
        column = QVBoxLayout(foot)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.lines_door = NavigationRow(tr("Line lengths"), tr("Set line lengths and update the pieces"))
        self.lines_door.clicked.connect(self.lines_requested)
        column.addWidget(self.lines_door)
        column.addWidget(hairline())
        row = QHBoxLayout()
        row.setContentsMargins(18, 10, 18, 12)
        self.export = button(tr("Export pieces…"), "primary")
        self.export.clicked.connect(self.export_requested)
        row.addWidget(self.export, 1)
        column.addLayout(row)
        return foot

    def show_plan(self, plan: GarmentPattern | None, title: str) -> None:
        """Show the settings of a pattern, or the choice of blocks; nothing is emitted."""
        self.setCurrentIndex(0 if plan is None else 1)
        if plan is None:
            return
        self.block.setText(title)
        self.allowance.show_value(plan.allowance)
        self.bridged.setChecked(plan.bridged)

    def show_pieces(self, rows: Sequence[PieceRow], faint: bool, selected: str) -> None:
        """Show the pieces, ``faint`` where they are of a former shape."""
        self.list.show_rows(rows, faint, selected)
        self._column.keep(len(rows))
        for each in (self.list, self.piece_card, self.seam_card):
            each.setEnabled(True)

    def select_piece(self, name: str) -> None:
        """Show which piece is selected, or none."""
        if name != self.list.selected:
            self._cards.show_end(False)
        self.list.select(name)
        self._column.show_selected()

    def show_verdict(self, words: str, tone: str, note: str = "") -> None:
        """Show whether the pieces can be cut and sewn, in a tone of the style sheet."""
        self.verdict.setText(words)
        set_tag(self.verdict, "tone", tone)
        self.note.setText(note)
        self.note.setVisible(bool(note))
