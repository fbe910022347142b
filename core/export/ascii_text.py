"""Texts for formats that hold ASCII only."""

from __future__ import annotations

import unicodedata


def ascii_text(text: str) -> str:
    """Return a text in ASCII: accents left off, other letters as question marks, on one line."""
    plain = unicodedata.normalize("NFKD", " ".join(text.split()))
    letters = "".join(each for each in plain if not unicodedata.combining(each) and each.isprintable())
    return letters.encode("ascii", "replace").decode()
