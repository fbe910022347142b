"""Parts of a self-test: each is tried and told in one line, and one that fails hides none of the others."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from core.errors import UserError

T = TypeVar("T")

Say = Callable[[str], object]
"""Hears a piece of a line; the line ends with its newline."""

_WIDE = 18


class PartError(Exception):
    """What a part has found to be wrong, in a sentence."""


def check(holds: bool, sentence: str) -> None:
    """Raise PartError unless it ``holds``."""
    if not holds:
        raise PartError(sentence)


@dataclass(frozen=True)
class Part(Generic[T]):
    """One thing that is tried: ``work`` returns what it has seen, in a few words, or raises.

    It is not tried after one of the parts that it ``needs`` has failed.
    """

    name: str
    work: Callable[[T], str]
    needs: tuple[str, ...] = ()


def try_parts(parts: Iterable[Part[T]], bench: T, say: Say) -> list[str]:
    """Try parts one after the other, and return the names of those that are not well."""
    lost: list[str] = []
    for part in parts:
        missing = [name for name in part.needs if name in lost]
        # The name comes first: if the program ends in the middle of a part, it is the last that is read.
        say(f"  {part.name:{_WIDE}} ")
        begun = time.perf_counter()
        try:
            told = f"skipped: requires {', '.join(missing)}" if missing else f"ok      {part.work(bench)}"
        except Exception as fault:
            told, missing = f"FAILED  {_in_words(fault)}", [part.name]
        if missing:
            lost.append(part.name)
        say(f"{told}  ({time.perf_counter() - begun:.2f} s)\n")
    return lost


def _in_words(fault: Exception) -> str:
    """Return in one line what went wrong; of a fault that nobody thought of also where."""
    if isinstance(fault, PartError | UserError):
        return " ".join(str(fault).split())
    frame = traceback.extract_tb(fault.__traceback__)[-1]
    said = " ".join(str(fault).split())
    return f"{type(fault).__name__}: {said} ({Path(frame.filename).name}, line {frame.lineno})"
