"""Dialog with a heading, its content and buttons, and message boxes made of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtGui import QFontDatabase, QShowEvent
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QHBoxLayout,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import button, hairline, sentence
from app.gui.widgets.focus_chain import next_stop, stops
from app.i18n.catalog import tr

LOSING = ("delete", "discard", "replace")
"""Answers that nothing brings back: Enter does not give them."""

_WIDTH = 460


class Dialog(QDialog):
    """A dialog that goes when it is closed; ``body`` takes what it shows, ``foot`` its buttons.

    A height of 0 in its size means as high as it needs.
    """

    def __init__(self, parent: QWidget | None, title: str, size: tuple[int, int] | None = None) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(title)
        self.body, self.foot = QVBoxLayout(), QHBoxLayout()
        self.body.setContentsMargins(20, 18, 20, 16)
        self.body.setSpacing(10)
        self.foot.setContentsMargins(20, 11, 20, 12)
        self.foot.setSpacing(8)
        self.foot.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addLayout(self.body, 1)
        column.addWidget(hairline())
        column.addLayout(self.foot)
        heading = label(title, "page")
        heading.setWordWrap(True)
        self.body.addWidget(heading)
        self._size = size
        self._before: QWidget | None = None
        if size is not None:
            self.setMinimumWidth(size[0])
            self.resize(*size)

    def add_button(self, text: str, do: Callable[[], object], kind: str = "secondary") -> QPushButton:
        """Place one more button at the right of the foot; the primary one answers the Enter key."""
        result = button(text, kind)
        result.setAutoDefault(False)
        result.setDefault(kind == "primary")
        result.clicked.connect(lambda _=False: do())
        self.foot.addWidget(result)
        return result

    def fit(self) -> None:
        """Take the height that all the text needs at this width."""
        column = self.layout()
        assert column is not None
        column.activate()
        self.resize(self.width(), column.totalHeightForWidth(self.width()))

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802
        """Set the needed height, where none was set."""
        if self._size is not None and not self._size[1]:
            self.fit()
        if self._before is None and not event.spontaneous():
            self._before = QApplication.focusWidget()
            if self._before is not None:
                self._before.destroyed.connect(self._forget)
        super().showEvent(event)

    def done(self, result: int) -> None:
        """Close, and restore the keyboard focus."""
        super().done(result)
        before = self._before
        if before is not None and before.isVisible():
            before.window().activateWindow()
            before.setFocus(Qt.FocusReason.OtherFocusReason)

    def _forget(self) -> None:
        self._before = None

    def focusNextPrevChild(self, next: bool) -> bool:  # noqa: N802
        """Move the keyboard focus in reading order, as in the window."""
        return next_stop(stops(self), next)

    def add_close(self) -> QPushButton:
        """Place the button that closes the sheet at the foot."""
        return self.add_button(tr("Close"), self.accept, "primary")


def text_viewer(text: str, name: str, *, code: bool = False) -> QPlainTextEdit:
    """Return text to read and to copy, for ears called ``name``; ``code`` keeps its columns."""
    result = QPlainTextEdit(text)
    result.setReadOnly(True)
    result.setAccessibleName(name)
    result.setTabChangesFocus(True)
    result.setTextInteractionFlags(
        Qt.TextInteractionFlag.TextSelectableByMouse | Qt.TextInteractionFlag.TextSelectableByKeyboard
    )
    if code:
        type_ = QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont)
        type_.setPixelSize(12)
        result.setFont(type_)
    return result


def ask(parent: QWidget | None, question: str, message: str, answers: Sequence[tuple[str, str]]) -> str:
    """Return the name of the answer that is chosen, or an empty text.

    ``answers`` are names with the words on their buttons: first the one that Enter gives, then others, from
    right to left. Esc, and the button *Cancel*, give none, and so does Enter where the first is ``LOSING``.
    """
    sheet, chosen = Dialog(parent, question, (_WIDTH, 0)), [""]
    sheet.setWindowTitle("Busk")

    def choose(name: str) -> None:
        chosen[0] = name
        sheet.accept()

    if message:
        sheet.body.addWidget(sentence(message, "body"))
    (main, words), *others = answers
    for name, other in reversed(others):
        sheet.add_button(other, partial(choose, name))
    cancel = sheet.add_button(tr("Cancel"), sheet.reject)
    usual = sheet.add_button(words, partial(choose, main), "primary")
    if main in LOSING:
        usual = cancel
    usual.setDefault(True)
    usual.setFocus()
    sheet.exec()
    return chosen[0]


def ask_name(parent: QWidget | None, title: str, what: str, name: str, longest: int) -> str:
    """Return a name that is typed for something, at most so long, or an empty text."""
    sheet, typed = Dialog(parent, title, (_WIDTH, 0)), [""]
    field = QLineEdit(name)
    field.setMaxLength(longest)
    field.setAccessibleName(what)
    field.setMinimumHeight(30)
    field.selectAll()

    def keep() -> None:
        typed[0] = field.text().strip()
        sheet.accept()

    sheet.body.addWidget(label(what, "secondary"))
    sheet.body.addWidget(field)
    sheet.add_button(tr("Cancel"), sheet.reject)
    save = sheet.add_button(tr("Save"), keep, "primary")
    field.textChanged.connect(lambda text: save.setEnabled(bool(text.strip())))
    field.setFocus()
    sheet.exec()
    return typed[0]
