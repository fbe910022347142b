"""How a command ends: what is printed, what is to be looked at, and its exit code."""

from __future__ import annotations

import sys
from collections.abc import Iterable

SETTLED, NOT_SETTLED = 0, 3


def told(text: str, settled: bool, warnings: Iterable[str]) -> int:
    """Print a text unless it went to a file, and return how the command ends."""
    if text:
        print(text, flush=True)
    warn(warnings)
    return SETTLED if settled else NOT_SETTLED


def warn(sentences: Iterable[str]) -> None:
    """Print what is to be looked at."""
    for sentence in sentences:
        print(f"busk: {sentence}", file=sys.stderr)
