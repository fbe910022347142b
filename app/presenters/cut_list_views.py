"""What the garment's tab shows: plain values, figures as they are read."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PressureView:
    """What a line presses with: ``kpa`` as it is read, ``light`` "green", "amber" or "red", empty for none.

    ``word`` says in short what the light means, ``tip`` where it comes from. ``stale`` figures are those of
    a former shape.
    """

    kpa: str
    light: str
    word: str
    tip: str
    stale: bool = False


@dataclass(frozen=True)
class CutView:
    """One piece to cut: of which ``line``, of what, how long [mm], how far stretched [%], its tension [N].

    ``elastic`` is what it is called here, empty for none. What is not known is an empty text; ``notes`` are
    sentences that say why, or what to look at. ``stretch_percent`` is a number where the designer sets it.
    The lengths of one that is ``front_only`` are no whole piece; one that is ``far`` is stretched further
    than usual.
    """

    line: str
    title: str
    color: str
    width_mm: float
    elastic: str
    cut: str = ""
    stretch: str = ""
    tension: str = ""
    notes: tuple[str, ...] = ()
    stretch_percent: float | None = None
    front_only: bool = False
    far: bool = False


@dataclass(frozen=True)
class GarmentView:
    """All pieces, and what holds for all of them; ``tissue`` [N/m] is what the newtons rest on.

    ``worn`` tells whether any line is: bands on points that do not move can be cut all the same. ``bare``
    that no line is made of an elastic yet.
    """

    rows: tuple[CutView, ...]
    notes: tuple[str, ...] = ()
    tissue: float = 0.0
    worn: bool = False
    bare: bool = False
