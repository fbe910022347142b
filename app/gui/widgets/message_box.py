"""Short questions as sheets of the house: each answer is a button in its own words."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtWidgets import QLineEdit, QWidget

from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import sentence
from app.gui.widgets.dialog import Dialog
from app.i18n.catalog import tr

LOSING = ("delete", "discard", "replace")
"""Answers that nothing brings back: Enter does not give them."""

_WIDTH = 460


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
