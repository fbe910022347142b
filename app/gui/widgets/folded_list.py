"""A list of sentences that stands folded under its heading."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QVBoxLayout

from app.gui.widgets.basic import Disclosure, sentence


def folded_list(column: QVBoxLayout, title: str, sentences: Sequence[str]) -> Disclosure:
    """Add ``sentences`` to a column, folded under a ``title``; returns what unfolds them."""
    fold, words = Disclosure(title), sentence("\n".join(f"• {each}" for each in sentences), "caption")
    words.setContentsMargins(28, 0, 0, 4)
    words.hide()
    fold.toggled.connect(words.setVisible)
    column.addWidget(fold)
    column.addWidget(words)
    return fold
