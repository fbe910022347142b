"""Progress of long work: what is being done, how much of it is done, and a way to stop it."""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import TypeVar

Result = TypeVar("Result")

Pieces = Generator[float, None, Result]
"""Work that stops after each small piece, with the share done (0..1): for who cannot wait for all of it."""

Progress = Callable[[str, float], None]
"""Told what is at work and which share of it is done (0..1); raises Cancelled to stop the work there."""


class Cancelled(Exception):  # noqa: N818 - no error: it was wished
    """The work was stopped because nobody wants its result any more."""


def quiet(what: str, share: float) -> None:
    """Ignore progress."""


def in_one_go(pieces: Pieces[Result], progress: Progress = quiet, what: str = "") -> Result:
    """Run all pieces of a task called ``what``, and return its result. Raises Cancelled."""
    try:
        while True:
            progress(what, next(pieces))
    except StopIteration as ended:
        result: Result = ended.value
        return result
    finally:
        pieces.close()


def part_of(pieces: Pieces[Result], begin: float, share: float) -> Pieces[Result]:
    """Return the same pieces as a ``share`` of larger work, of which so much is done at the ``begin``."""
    try:
        while True:
            yield begin + share * next(pieces)
    except StopIteration as ended:
        result: Result = ended.value
        return result
