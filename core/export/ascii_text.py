"""Texts for formats that hold ASCII only."""

from __future__ import annotations

import unicodedata

_MARKS = str.maketrans("·–—×−", "---x-")


def ascii_text(text: str) -> str:
    """Return a text in ASCII: accents left off, other letters as question marks, on one line."""
    plain = unicodedata.normalize("NFKD", " ".join(text.translate(_MARKS).split()))
    letters = "".join(each for each in plain if not unicodedata.combining(each) and each.isprintable())
    return letters.encode("ascii", "replace").decode()
