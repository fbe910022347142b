"""What is asked before something could be lost for good."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget

from app.gui.widgets.message_box import ask
from app.i18n.catalog import tr


def ask_overwrite(parent: QWidget, name: str, protected: bool = False) -> str:
    """Return what to do with a project that was changed by others: "overwrite", "elsewhere" or "stay".

    ``protected``: it was not, but its file is write-protected.
    """
    question = tr("{name} was changed outside this window.").format(name=name)
    if protected:
        question = tr("{name} is write-protected.").format(name=name)
    said = tr("Saving replaces that version. Busk tries to keep it under File, Open a backup.")
    answers = [("elsewhere", tr("Save as…")), ("overwrite", tr("Replace"))]
    return ask(parent, question, said, answers) or "stay"


def may_discard(parent: QWidget, name: str) -> bool:
    """Ask whether what was kept of a document after a crash may go for good."""
    question = tr("Discard the changes that were kept of {name}?").format(name=name)
    said = tr("They cannot be had back.")
    return ask(parent, question, said, [("discard", tr("Discard"))]) == "discard"
