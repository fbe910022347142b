"""Blocks: garments as seams and panels whose places are told by landmarks, so that they fit any body."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

from core.document.cloth import LONGEST_NAME as LONGEST_CLOTH
from core.document.document_limits import check_counts
from core.document.printable_name import LONGEST_NAME as LONGEST_LINE
from core.document.printable_name import is_blank, is_printable, repeated
from core.errors import PatternError
from core.landmarks.types import SIDES
from core.messages import Message

WAY, RING, ROOT = KINDS = ("way", "ring", "root")
"""How a seam runs: from place to place over the skin, at a level, or along the root of a breast."""

REFERENCES = ("under", "bust", "waist", "belly", "hip", "crotch", "low")
"""What levels are told from: the under-bust, the bust points, those of the lower trunk, the scan's edge."""

LONGEST_NAME, LONGEST_PLACE = 60, 80
"""Letters of the name of a seam, panel or level, and of a place."""

MOST_SEAMS, MOST_PANELS, MOST_PLACES = 120, 80, 40
"""Seams and panels of a block, places of a seam: more than any garment has."""

LARGEST_ALLOWANCE = 40.0
"""The widest seam allowance [mm]."""

MOST_TURN = 180.0
"""A grain line is turned by less, either way [degrees]."""

_SPANS = {RING: 1.0, ROOT: 360.0}


@dataclass(frozen=True)
class Level:
    """A height: ``above`` one of REFERENCES [mm]."""

    name: str
    reference: str
    above: float = 0.0


@dataclass(frozen=True)
class Seam:
    """A seam or edge of a block, ``each`` on both sides of the body or once.

    ``kind`` is one of KINDS. A way goes through ``places`` (see ``core.pattern.places``), on the right side
    through those of ``right`` if there are any; a ring lies at ``level`` from one share of the half round to
    another, ``span``, 0 being the front centre and 1 the back centre; a root goes from one clock position to
    another [degrees], ``below`` the bust point or above it. A ``slit`` is cut into a panel and divides none:
    a dart. Panels beside an ``edge`` are not sewn together, as where a band is hooked. ``allowance`` is that
    of both sides [mm], None for that of the pattern. An edge carries the elastic of ``line``, the name of a
    line of the design without its side. ``notches`` are shares of the length of each stretch that is sewn
    [1], None for the usual ones; see ``core.pattern.notches``.
    """

    name: str
    kind: str
    each: bool = False
    places: tuple[str, ...] = ()
    right: tuple[str, ...] = ()
    level: str = ""
    span: tuple[float, float] = (0.0, 1.0)
    below: bool = False
    slit: bool = False
    edge: bool = False
    allowance: float | None = None
    line: str = ""
    notches: tuple[float, ...] | None = None

    def named(self) -> tuple[tuple[str, str], ...]:
        """Return name and side of each curve that it is: "" for one over the middle."""
        return tuple((f"{self.name} {side}", side) for side in SIDES) if self.each else ((self.name, ""),)

    def places_of(self, side: str) -> tuple[str, ...]:
        """Return the places that it goes through on a side."""
        return self.right if side == "right" and self.right else self.places


@dataclass(frozen=True)
class PanelPlan:
    """A panel of a block: the skin round the place ``seed`` up to the seams, and the name of its ``cloth``.

    Its grain line runs up on the body, turned by ``turn`` [degrees]: counter-clockwise seen from outside, on
    the right side of the body clockwise.
    """

    name: str
    seed: str
    cloth: str
    each: bool = False
    turn: float = 0.0


@dataclass(frozen=True)
class Block:
    """A garment: its ``levels``, ``seams`` in the order in which they are drawn, and ``panels``.

    Raises PatternError, which says what is wrong in it.
    """

    name: str
    title: str
    levels: tuple[Level, ...]
    seams: tuple[Seam, ...]
    panels: tuple[PanelPlan, ...]

    def __post_init__(self) -> None:
        check_counts(
            (
                (len(self.levels), MOST_SEAMS, Message("levels")),
                (len(self.seams), MOST_SEAMS, Message("seams")),
                (len(self.panels), MOST_PANELS, Message("panels")),
                *(
                    (len(seam.places) + len(seam.right), MOST_PLACES, Message("places of a seam"))
                    for seam in self.seams
                ),
                *(
                    (len(seam.notches or ()), MOST_PLACES, Message("notches of a seam"))
                    for seam in self.seams
                ),
            )
        )
        for names in (
            [self.name, self.title],
            *([each.name for each in own] for own in (self.levels, self.seams, self.panels)),
        ):
            self._check_names(names)
        for own in (self.levels, self.seams, self.panels):
            if twice := repeated(each.name for each in own):
                raise self._refusal(f"the name '{twice}' is used twice")
            if sided := next((each.name for each in own if without_side(each.name)[1]), ""):
                raise self._refusal(f"the name '{sided}' ends in a side of the body")
        for level in self.levels:
            if level.reference not in REFERENCES:
                raise self._refusal(f"the level {level.name} is told from '{level.reference}'")
        for seam in self.seams:
            self._check_seam(seam)
        for panel in self.panels:
            self._check_panel(panel)
        if not self.panels:
            raise self._refusal("it has no panel")

    def _check_names(self, names: Iterable[str]) -> None:
        for name in names:
            if not _is_word(name, LONGEST_NAME):
                raise self._refusal("a name is missing, too long or unprintable")

    def _check_seam(self, seam: Seam) -> None:
        if seam.kind not in KINDS:
            raise self._refusal(f"the seam {seam.name} is of the kind '{seam.kind}'")
        if seam.kind == RING and seam.level not in {level.name for level in self.levels}:
            raise self._refusal(f"the seam {seam.name} is at the level '{seam.level}'")
        if seam.kind == WAY and len(seam.places) < 2:
            raise self._refusal(f"the seam {seam.name} has fewer than two places")
        if seam.right and len(seam.right) < 2:
            raise self._refusal(f"the seam {seam.name} has fewer than two places on the right")
        if seam.allowance is not None and not 0.0 <= seam.allowance <= LARGEST_ALLOWANCE:
            raise self._refusal(f"the allowance of the seam {seam.name} is {seam.allowance:g} mm")
        if not all(0.0 < each < 1.0 for each in seam.notches or ()):
            raise self._refusal(f"a notch of the seam {seam.name} is not between its ends")
        if not all(_is_word(each, LONGEST_PLACE) for each in (*seam.places, *seam.right)):
            raise self._refusal(f"a place of the seam {seam.name} is missing, too long or unprintable")
        if not is_printable(seam.line, LONGEST_LINE):
            raise self._refusal(f"the line of the seam {seam.name} is too long or unprintable")
        self._check_span(seam)

    def _check_span(self, seam: Seam) -> None:
        first, last = seam.span
        most = _SPANS.get(seam.kind, math.inf)
        if not all(math.isfinite(each) and 0.0 <= each <= most for each in seam.span):
            raise self._refusal(f"the span of the seam {seam.name} is not from 0 to {most:g}")
        if seam.kind == RING and first >= last:
            raise self._refusal(f"the span of the seam {seam.name} ends before it starts")
        if seam.kind == ROOT and not seam.each:
            raise self._refusal(f"the seam {seam.name} follows a breast, but is not on each side")

    def _check_panel(self, panel: PanelPlan) -> None:
        if not _is_word(panel.seed, LONGEST_PLACE):
            raise self._refusal(f"the seed of the panel {panel.name} is missing, too long or unprintable")
        if not _is_word(panel.cloth, LONGEST_CLOTH):
            raise self._refusal(f"the cloth of the panel {panel.name} is missing, too long or unprintable")
        if not abs(panel.turn) <= MOST_TURN:
            raise self._refusal(
                f"the grain line of the panel {panel.name} is turned by {panel.turn:g} degrees"
            )

    def _refusal(self, why: str) -> PatternError:
        name = self.name if is_printable(self.name, LONGEST_NAME) else ""
        return PatternError(
            Message("The block {name} cannot be used: {why}.", name=name, why=why),
            Message("Correct the file or choose another block."),
        )

    @property
    def needs_lower_trunk(self) -> bool:
        """Return whether any of its places is told from the lower trunk."""
        words = [
            *(place for seam in self.seams for place in (*seam.places, *seam.right)),
            *(each.seed for each in self.panels),
        ]
        references = {level.reference for level in self.levels}
        return bool(references & {"waist", "belly", "hip", "crotch"}) or any(
            "below" in word for word in words
        )

    @property
    def needs_bust(self) -> bool:
        """Return whether any of its places is told from a breast or the control mesh of the bust."""
        words = [place for seam in self.seams for place in (*seam.places, *seam.right)]
        own = [word for word in words if "below" not in word]
        return any(seam.kind == ROOT for seam in self.seams) or any(
            "root" in word or "apex" in word for word in own
        )

    @property
    def panel_names(self) -> tuple[str, ...]:
        """Return the names of its panels with their sides."""
        return tuple(
            f"{panel.name} {side}".rstrip()
            for panel in self.panels
            for side in (SIDES if panel.each else ("",))
        )

    def with_seam(self, seam: Seam) -> Block:
        """Return the block with another seam of the same name."""
        return replace(self, seams=tuple(seam if each.name == seam.name else each for each in self.seams))

    def with_own_sides(self, name: str, apart: bool) -> Block:
        """Return the block in which each side of a seam has places of its own, or the left one's for both.

        Raises KeyError for an unknown name.
        """
        seam = self.seam(name)
        return self.with_seam(replace(seam, right=seam.places if apart else ()))

    def seam(self, name: str) -> Seam:
        """Return a seam by the name of its curve, with or without a side. Raises KeyError."""
        for seam in self.seams:
            if name == seam.name or name in {own for own, _ in seam.named()}:
                return seam
        raise KeyError(name)


def _is_word(text: str, longest: int) -> bool:
    return not is_blank(text) and is_printable(text, longest)


def without_side(name: str) -> tuple[str, str]:
    """Return the name of a piece or seam without its side, and the side, "" for one over the middle."""
    side = next((each for each in SIDES if name.endswith(f" {each}")), "")
    return name.removesuffix(f" {side}"), side
