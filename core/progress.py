"""Progress of long work: what is being done, how much of it is done, and a way to stop it."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[str, float], None]
"""Told what is at work and which share of it is done (0..1); raises Cancelled to stop the work there."""


class Cancelled(Exception):  # noqa: N818 - no error: it was wished
    """The work was stopped because nobody wants its result any more."""


def quiet(what: str, share: float) -> None:
    """Hear progress and do nothing about it."""
