"""Editor of a custom measurement: kind, landmarks and present value."""

# ruff: noqa: N802 - Qt names its events and says what they are
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QAbstractButton, QFormLayout, QHBoxLayout, QLineEdit, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import font, label, set_tag
from app.gui.widgets.basic import Segment, ToolButton, button, hairline, sentence
from app.gui.widgets.option_field import LandmarkCombo
from app.gui.widgets.tooltip import set_tip
from app.gui.widgets.value_edit import ValueEdit
from app.i18n.catalog import tr
from app.presenters.measurements import Draft
from core.document.custom_measures import FURTHEST, LONGEST_NAME


class MeasurementEditor(QWidget):
    """A form for one measure; ``changed`` whenever its ``draft`` is another one.

    ``accepted`` and ``closed`` when it is to be kept, or not; ``removed`` when the one that is changed is to
    go.
    """

    changed = Signal()
    accepted = Signal()
    closed = Signal()
    removed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.draft = Draft()
        self._title, self._hint = label("", "heading"), sentence()
        self.name = QLineEdit()
        self.name.setMaxLength(LONGEST_NAME)
        self.name.setMinimumHeight(28)
        self.name.setAccessibleName(tr("Measurement name"))
        set_tip(self.name, tr("Name in the table and in files"))
        self.name.textEdited.connect(lambda text: self._set(name=text.strip()))
        kinds = (("straight", tr("Straight")), ("skin", tr("On the skin")), ("girth", tr("Girth")))
        self.kind = Segment(kinds, small=True, wide=True)
        set_tip(self.kind, tr("Straight line, length on the skin, or horizontal girth"))
        self.kind.chosen.connect(lambda kind: self._set(kind=kind))
        self.start, self.end = LandmarkCombo(tr("From")), LandmarkCombo(tr("To"))
        self.at = LandmarkCombo(tr("Height of"), tr("custom height"))
        self.start.chosen.connect(lambda mark: self._set(ends=(mark, self._other(mark, 1))))
        self.end.chosen.connect(lambda mark: self._set(ends=(self._other(mark, 0), mark)))
        self.at.chosen.connect(lambda mark: self._set(at=mark, level=0.0))
        self.level = ValueEdit("mm", tr("Offset"), widest="−2,999.9")
        self.level.entered.connect(self._set_level)
        self.value, self.said = label("", "hero", tabular=True), sentence("", "secondary")
        self.doubt = sentence("", "secondary")
        set_tag(self.doubt, "tone", "warn")
        column = QVBoxLayout(self)
        column.setContentsMargins(14, 8, 14, 12)
        column.setSpacing(10)
        for part in (self._make_head(), self.name, self.kind, self._hint, self._make_places(), hairline()):
            column.addWidget(part)
        column.addWidget(self.value)
        column.addWidget(self.said)
        column.addWidget(self.doubt)
        column.addStretch(1)
        column.addWidget(self._make_foot())

    def begin(self, draft: Draft, marks: Mapping[str, str], former: str = "") -> None:
        """Start with a draft; ``marks`` are the landmarks to choose from, ``former`` what is changed."""
        for field in (self.start, self.end, self.at):
            field.set_marks(marks)
        self._title.setText(tr("Edit measurement") if former else tr("Custom measurement"))
        self.keep.setText(tr("Save") if former else tr("Add"))
        self.delete.setVisible(bool(former))
        self.name.setText(draft.name)
        self.show_draft(draft)

    def show_draft(self, draft: Draft) -> None:
        """Show another draft, and tell."""
        self.draft = draft
        girth = draft.kind == "girth"
        self.kind.set_choice(draft.kind)
        for row, shown in ((0, not girth), (1, not girth), (2, girth), (3, girth)):
            self._places.setRowVisible(row, shown)
        self.start.show_mark(draft.ends[0])
        self.end.show_mark(draft.ends[1])
        self.at.show_mark(draft.at)
        self.level.set_unit("mm", 0 if draft.level.is_integer() else 1, bool(draft.at))
        self.level.show_value(draft.level)
        ends = tr("Click two landmarks on the body, or choose them below.")
        level = tr("Click a landmark or any point on the skin: the girth is horizontal at this height.")
        self._hint.setText(level if girth else ends)
        self.changed.emit()

    def set_height(self, mm: float) -> None:
        """Let a girth lie so high above the lowest point of the scan."""
        self._set(at="", level=float(mm))

    def show_value(self, value: str, message: str, doubt: str, suggested: str) -> None:
        """Show what it measures, what is said of it and what is doubtful; without a value it is not kept.

        ``suggested`` is the name that it gets if none is typed.
        """
        for part, words in ((self.value, value), (self.said, message), (self.doubt, doubt)):
            part.setText(words)
            part.setVisible(bool(words))
        self.name.setPlaceholderText(suggested or tr("Name"))
        self.keep.setEnabled(bool(value))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Keep it by Enter, unless that presses a button; leave it by Esc."""
        enter = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if enter and self.keep.isEnabled() and not isinstance(self.focusWidget(), QAbstractButton):
            self.accepted.emit()
        elif event.key() == Qt.Key.Key_Escape:
            self.closed.emit()
        else:
            super().keyPressEvent(event)

    def event(self, event: QEvent) -> bool:
        """Take Esc before it ends work in hand: what it measures is worked out all the time."""
        wanted = isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape
        if not wanted or event.type() != QEvent.Type.ShortcutOverride:
            return super().event(event)
        event.accept()
        return True

    def _set(self, **changes: object) -> None:
        self.show_draft(replace(self.draft, **changes))  # type: ignore[arg-type]

    def _set_level(self, mm: float) -> None:
        self._set(level=min(max(mm, 1.0 - FURTHEST), FURTHEST - 1.0))

    def _other(self, mark: str, place: int) -> str:
        """Return the other end; one landmark cannot be both."""
        other = self.draft.ends[place]
        return "" if other == mark else other

    def _make_head(self) -> QWidget:
        head = QWidget()
        row = QHBoxLayout(head)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self._title, 1)
        close = ToolButton("x", tr("Cancel without changes (Esc)"), size=14, room=26)
        close.clicked.connect(self.closed)
        row.addWidget(close)
        return head

    def _make_places(self) -> QWidget:
        holder = QWidget()
        self._places = QFormLayout(holder)
        self._places.setContentsMargins(0, 0, 0, 0)
        self._places.setVerticalSpacing(6)
        self._places.setLabelAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self._places.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        for field in (self.start, self.end, self.at, self.level):
            words = label(field.accessibleName(), "secondary")
            words.setMinimumHeight(28)
            self._places.addRow(words, field)
        self.level.setFont(font("body", tabular=True))
        return holder

    def _make_foot(self) -> QWidget:
        foot = QWidget()
        row = QHBoxLayout(foot)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(8)
        self.delete, cancel = button(tr("Delete"), "quiet"), button(tr("Cancel"), "quiet")
        self.keep = button(tr("Add"), "primary")
        self.delete.clicked.connect(self.removed)
        cancel.clicked.connect(self.closed)
        self.keep.clicked.connect(self.accepted)
        row.addWidget(self.delete)
        row.addStretch(1)
        row.addWidget(cancel)
        row.addWidget(self.keep)
        return foot
