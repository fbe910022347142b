"""How a command ends: what is printed, what is to be looked at, and its exit code."""

from __future__ import annotations

import sys
from collections.abc import Iterable

from core.document.printable_name import shown_line

SETTLED, NOT_SETTLED = 0, 3


def told(text: str, settled: bool, warnings: Iterable[str]) -> int:
    """Print a text unless it went to a file, then the ``warnings`` that are no line of it.

    Returns how the command ends.
    """
    if text:
        print(text, flush=True)
    printed = {line.strip() for line in text.splitlines()}
    warn(each for each in warnings if each not in printed)
    return SETTLED if settled else NOT_SETTLED


def warn(sentences: Iterable[str]) -> None:
    """Print what is to be looked at."""
    for sentence in sentences:
        print(f"busk: {shown_line(sentence)}", file=sys.stderr)
