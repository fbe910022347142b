"""Export dialog: content on the left, options and preview on the right."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Mapping, Sequence

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QAbstractButton,
    QButtonGroup,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from app.gui.theme.icons import paint_icon
from app.gui.theme.stylesheet import font, label, set_tag, tokens_of
from app.gui.widgets.basic import IconLabel, hairline, paint_card, sentence
from app.gui.widgets.dialog import Dialog
from app.gui.widgets.option_field import Field, field_of
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import tr
from app.presenters.export import Export
from app.presenters.model_options import Choice

SIZE = (800, 620)
"""Width and height of the sheet: room for what has most choices [px]."""


class ExportDialog(Dialog):
    """All that can be exported.

    ``chosen`` carries the word of something else to export, ``changed`` key and value of a choice for it;
    ``save_requested`` wants a file.
    """

    chosen = Signal(str)
    changed = Signal(str, str)
    save_requested = Signal()

    def __init__(self, parent: QWidget, exports: Sequence[Export]) -> None:
        super().__init__(parent, tr("Export"), SIZE)
        self.items: dict[str, _Item] = {}
        self.fields: dict[str, Field] = {}
        self._choices = QWidget()
        self._right = QVBoxLayout()
        self._right.setContentsMargins(20, 0, 0, 0)
        self._right.setSpacing(12)
        self._right.addWidget(self._choices, 1)
        self._right.addWidget(self._make_card())
        row = QHBoxLayout()
        row.setSpacing(0)
        row.addLayout(self._make_list(exports))
        row.addWidget(hairline(vertical=True))
        row.addLayout(self._right, 1)
        self.body.addLayout(row, 1)
        self.add_button(tr("Close"), self.reject)
        self.save = self.add_button(tr("Save…"), self.save_requested.emit, "primary")

    def show_export(self, export: Export, settings: Sequence[Choice], values: Mapping[str, str]) -> None:
        """Show something to export with its choices; the keyboard stays at the choice where it was."""
        at = next((key for key, field in self.fields.items() if field.isAncestorOf(self.focusWidget())), "")
        self.items[export.what].setChecked(True)
        old, self.fields, self._choices = self._choices, {}, QWidget()
        column = QVBoxLayout(self._choices)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(4)
        column.addWidget(label(export.title, "heading"))
        column.addWidget(sentence(export.tip))
        column.addSpacing(8)
        column.addLayout(self._make_grid(settings, values))
        column.addStretch(1)
        self._right.replaceWidget(old, self._choices)
        old.hide()
        old.deleteLater()
        if at in self.fields:
            self.fields[at].setFocus(Qt.FocusReason.OtherFocusReason)

    def show_contents(self, name: str, contents: str, doubt: str = "", possible: bool = True) -> None:
        """Show which file would be written, what is in it as far as that is known, and what to mind."""
        self._name.setText(name)
        for told, text in ((self._contents, contents), (self._doubt, doubt)):
            told.setText(text)
            told.setVisible(bool(text))
        self._mark.show_icon(*(("warning", "warn") if doubt else ("export", "text_quiet")))
        self._card.setAccessibleName(" ".join(filter(None, (name, contents, doubt))))
        self.save.setEnabled(possible)

    def _choose(self, what: str) -> None:
        self.items[what].setFocus(Qt.FocusReason.OtherFocusReason)
        self.chosen.emit(what)

    def _make_list(self, exports: Sequence[Export]) -> QVBoxLayout:
        column, group = QVBoxLayout(), QButtonGroup(self)
        column.setContentsMargins(0, 0, 12, 0)
        column.setSpacing(2)
        for export in exports:
            item = self.items[export.what] = _Item(export)
            item.clicked.connect(lambda _=False, what=export.what: self._choose(what))
            group.addButton(item)
            column.addWidget(item)
        column.addStretch(1)
        return column

    def _make_grid(self, settings: Sequence[Choice], values: Mapping[str, str]) -> QGridLayout:
        grid = QGridLayout()
        grid.setColumnStretch(0, 1)
        grid.setHorizontalSpacing(16)
        grid.setVerticalSpacing(0)
        for setting in settings:
            row, field = grid.rowCount(), field_of(setting)
            name, tip = label(setting.title, "body"), sentence(setting.tip, "caption")
            tip.setContentsMargins(0, 1, 0, 13)
            field.describe(setting.title, setting.tip)
            field.show_value(values[setting.key])
            field.chosen.connect(lambda value, key=setting.key: self.changed.emit(key, str(value)))
            grid.addWidget(name, row, 0, Qt.AlignmentFlag.AlignBottom)
            grid.addWidget(tip, row + 1, 0)
            right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
            grid.addWidget(field, row, 1, 2, 1, right)
            self.fields[setting.key] = field
        return grid

    def _make_card(self) -> QFrame:
        card = self._card = QFrame()
        set_tag(card, "kind", "card")
        row, column = QHBoxLayout(card), QVBoxLayout()
        row.setContentsMargins(14, 12, 14, 12)
        row.setSpacing(12)
        self._mark = IconLabel("export", "text_quiet", 20)
        self._name, self._contents = sentence("", "name"), sentence("", "secondary")
        self._doubt = sentence("", "secondary")
        set_tag(self._doubt, "tone", "warn")
        column.setSpacing(3)
        for told in (self._name, self._contents, self._doubt):
            column.addWidget(told)
        row.addWidget(self._mark, alignment=Qt.AlignmentFlag.AlignTop)
        row.addLayout(column, 1)
        return card


class _Item(QAbstractButton):
    """One thing that can be exported: its drawing and its name."""

    def __init__(self, export: Export) -> None:
        super().__init__()
        self._drawing = export.drawing
        self.setText(export.title)
        set_tip(self, export.tip)
        self.setAccessibleName(export.title)
        self.setAccessibleDescription(export.tip)
        self.setCheckable(True)
        self.setAutoExclusive(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)

    def sizeHint(self) -> QSize:
        return QSize(196, 38)

    def paintEvent(self, event: QPaintEvent) -> None:
        tokens, on = tokens_of(self), self.isChecked()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        paint_card(painter, self, "pressed", 8)
        ink = tokens.text if on else tokens.text_quiet
        paint_icon(painter, self._drawing, ink, QRectF(12, self.height() / 2 - 10, 20, 20))
        painter.setFont(font("name" if on else "body"))
        painter.setPen(QColor(ink))
        words = QRectF(self.rect()).adjusted(42, 0, -8, 0)
        painter.drawText(words, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, self.text())
