"""What the list shows of a line: plain values."""

from __future__ import annotations

from dataclasses import dataclass

from core.analysis.length_limits.zones import Leeway


@dataclass(frozen=True)
class SideView:
    """One line of a linked pair: its side in words, its length at rest and the one reached [mm]."""

    title: str
    rest_mm: float
    reached_mm: float | None


@dataclass(frozen=True)
class LineView:
    """What a row shows of a line; lengths [mm], ``ratio`` = set over rest length [1].

    ``rest_mm`` is the rest length of the free front part, ``whole_mm`` that of the whole closed band.
    ``reached_mm`` is None before a run. A line that is not ``constrained`` is only measured; an ``own`` one
    can be removed and led elsewhere. ``partner`` names its line of the other side, if there is one; the row
    of a linked pair has both ``sides``, and means of their lengths. ``own_title`` is empty for the usual one.
    One that is ``tried`` has a length that is only shown, and was not taken.
    One that ``splits`` goes across both sides and can be split into a left and a right line.
    One that was ``parted`` is off, and its two halves are worn in its place.
    ``apart`` is the side, "left" or "right", of a line that is set apart from its partner; ``pair_title``
    what both are called together.
    ``elastic`` is what it is made of, if anything: its length is then that of the elastic unstretched.
    ``pressed`` is what the line presses with and what that means, in the ``tone`` of its light; empty
    while it is not known.
    ``leeway`` is how far it can go, None while that is not known; ``stale`` that of the design before.
    ``strap`` is where it goes on over the shoulder, as words; its lengths are then those of all of it.
    ``over_shoulder``: whether it does, None for a line that cannot.
    ``width_mm`` is that of its band; ``stiffness`` [1] its own, or None for the ``usual_stiffness``.
    """

    name: str
    title: str
    color: str
    ratio: float
    rest_mm: float
    reached_mm: float | None
    constrained: bool
    visible: bool
    whole_mm: float
    own: bool = False
    partner: str = ""
    sides: tuple[SideView, ...] = ()
    locked: bool = False
    own_title: str = ""
    width_mm: float = 12.0
    stiffness: float | None = None
    usual_stiffness: float = 16.0
    leeway: Leeway | None = None
    stale: bool = False
    apart: str = ""
    pair_title: str = ""
    elastic: str = ""
    pressed: str = ""
    tone: str = ""
    splits: bool = False
    tried: bool = False
    parted: bool = False
    strap: str = ""
    over_shoulder: bool | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The lines that this row stands for."""
        return (self.name, self.partner) if self.sides else (self.name,)

    @property
    def settable(self) -> bool:
        """Whether its length can be set."""
        return self.constrained and not self.locked
