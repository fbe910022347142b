"""Leeway: how far a line can go, as zones of its length that a slider can show (ours).

Green settles without trouble. Amber strains, would vibrate with the conventional force, or with any where
lines act one turn late, or presses beyond the comfort limit. Red overstrains, folds, goes beyond the curve
of an elastic or has no balance. Where a line is longer than what it lies on it would have to push, which no
band can: it is slack there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import groupby, pairwise

from core.analysis.length_limits.limits import Limits, limits_of
from core.analysis.length_limits.line_search import RED as RED_SIGNS
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.pipeline.build import Stages
from core.progress import Progress, quiet

GREEN, SLACK, AMBER, RED = TONES = ("green", "slack", "amber", "red")
"""How a length can stand, from the best to the worst."""

TONE_OF = {
    "slack": SLACK,
    "strained": AMBER,
    "vibrating": AMBER,
    "restless": AMBER,
    "pressing": AMBER,
    **dict.fromkeys((*RED_SIGNS, "unreachable"), RED),
}
"""The tone of each reason, by name; "unreachable" is a length at which no balance is found."""


@dataclass(frozen=True)
class Reason:
    """Why some lengths are not green: ``why`` is one of TONE_OF, and holds from ``short`` to ``long`` [1].

    ``others``: it holds at the rest length too, where this line does nothing; so the other lines cause it.
    """

    why: str
    short: float
    long: float
    others: bool = False

    @property
    def tone(self) -> str:
        """Return one of TONES."""
        return TONE_OF[self.why]

    def contains(self, ratio: float) -> bool:
        """Return whether the reason applies to a length [1]."""
        return self.short <= ratio <= self.long

    @property
    def is_independent(self) -> bool:
        """Return whether it holds whatever this line does."""
        return self.short <= RATIO_LIMITS[0] and self.long >= RATIO_LIMITS[1]


@dataclass(frozen=True)
class Zone:
    """Lengths from ``short`` to ``long`` [1] that stand alike: their ``tone``, and all reasons there."""

    tone: str
    short: float
    long: float
    reasons: tuple[Reason, ...] = ()


@dataclass(frozen=True)
class LengthLimits:
    """How far the line ``name`` can go: ``zones`` of all its lengths, ascending, one beside the other.

    ``pressure_known`` tells whether pressures were looked at: they are only where what the line is made of
    tells the newtons.
    """

    name: str
    zones: tuple[Zone, ...]
    pressure_known: bool = False

    def at(self, ratio: float) -> Zone:
        """Return the zone of a length [1]; where two meet, the better one."""
        here = [zone for zone in self.zones if zone.short <= ratio <= zone.long]
        ends = self.zones[0] if ratio < self.zones[0].short else self.zones[-1]
        return min(here, key=lambda zone: TONES.index(zone.tone), default=ends)

    @property
    def red_below(self) -> float | None:
        """Return the length below which it is red, None if it never is there [1]."""
        first = self.zones[0]
        return first.long if first.tone == RED else None


def length_limits_of(
    stages: Stages, name: str, progress: Progress = quiet, *, through: bool = False
) -> LengthLimits | None:
    """Return the leeway of a line that moves anything, worn or not, the others being as they are set.

    Of a band over both regions it is what both allow. ``through``: look on where it is red, and tell what
    else is wrong there. None where the other lines leave no balance at any length. Raises Cancelled.
    """
    found = None
    for each in stages.design.band_of(name):
        limits = limits_of(stages, each, progress, through=through)
        if not limits.line.constrains and each != name:
            continue
        zones = to_length_limits(limits)
        if zones is None:
            return None
        found = zones if found is None else _both(name, found, zones)
    return found


def _both(name: str, one: LengthLimits, other: LengthLimits) -> LengthLimits:
    """Return what two parts of a band allow: at each length the worse, with the reasons of both.

    Of one reason that both give, the part is told where it holds for more lengths.
    """
    zones = [zone for limits in (one, other) for zone in limits.zones]
    widest: dict[tuple[str, bool], Reason] = {}
    for reason in (reason for zone in zones for reason in zone.reasons):
        key = reason.why, reason.short <= RATIO_LIMITS[0]
        known = widest.setdefault(key, reason)
        if reason.long - reason.short > known.long - known.short:
            widest[key] = reason
    ends = sorted({end for zone in zones for end in (zone.short, zone.long)})
    pieces = [_worse(one, other, widest.values(), short, long) for short, long in pairwise(ends)]
    joined = (_joined(list(alike)) for _, alike in groupby(pieces, lambda zone: zone.tone))
    return LengthLimits(name, tuple(joined), one.pressure_known and other.pressure_known)


def _worse(
    one: LengthLimits, other: LengthLimits, reasons: Iterable[Reason], short: float, long: float
) -> Zone:
    """Return the zone of lengths that both parts of a band have alike."""
    middle = 0.5 * (short + long)
    tone = max(one.at(middle).tone, other.at(middle).tone, key=TONES.index)
    return Zone(tone, short, long, tuple(each for each in reasons if each.contains(middle)))


def to_length_limits(limits: Limits) -> LengthLimits | None:
    """Return limits as zones; None where no length has a balance, or nothing can move.

    Where a way from rest comes into the red all that follows is red: it is of no use to anybody.
    """
    if limits.rest is None:
        return None
    rest, reasons = limits.rest.ratio, tuple(_reasons(limits))
    ends = sorted({*RATIO_LIMITS, *(end for reason in reasons for end in (reason.short, reason.long))})
    pieces = [_zone(short, long, reasons) for short, long in pairwise(ends)]
    shorter = [piece for piece in reversed(pieces) if piece.short < rest]
    longer = [piece for piece in pieces if piece.short >= rest]
    ways = [*reversed(_red_on(shorter)), *_red_on(longer)]
    zones = (_joined(list(alike)) for _, alike in groupby(ways, lambda zone: zone.tone))
    return LengthLimits(limits.line.name, tuple(zones), limits.pressure_known)


def _reasons(limits: Limits) -> Iterator[Reason]:
    """Yield every reason; what shows where the way ended goes on to the end of all lengths."""
    assert limits.rest is not None
    assert limits.evaluated is not None
    low, high = RATIO_LIMITS
    first, last = limits.evaluated.short.ratio, limits.evaluated.long.ratio
    for why, spans in limits.shows.items():
        for span in spans if why in TONE_OF else ():
            short = low if span.short.ratio <= first else span.short.ratio
            long = high if span.long.ratio >= last else span.long.ratio
            yield Reason(why, short, long, others=short <= limits.rest.ratio <= long)
    if limits.last is not None:
        yield Reason("unreachable", low, limits.last.ratio)
    if limits.longest is not None:
        yield Reason("unreachable", limits.longest.ratio, high)


def _zone(short: float, long: float, reasons: tuple[Reason, ...]) -> Zone:
    here = tuple(reason for reason in reasons if reason.contains(0.5 * (short + long)))
    if "restless" in (reason.why for reason in here):
        here = tuple(reason for reason in here if reason.why != "vibrating")  # with any control
    if SLACK in (reason.tone for reason in here):
        # What a line does that pushes is no garment's doing; what the others do is.
        here = tuple(reason for reason in here if reason.others or reason.tone == SLACK)
    return Zone(max((reason.tone for reason in here), key=TONES.index, default=GREEN), short, long, here)


def _red_on(way: list[Zone]) -> list[Zone]:
    """Return the zones of a way from rest with all of them red from where it comes into the red."""
    calm = next((at for at, zone in enumerate(way) if zone.tone != RED), len(way))
    entry = next((at for at in range(calm, len(way)) if way[at].tone == RED), len(way))
    return [*way[:entry], *(_red_after(way[entry], zone) for zone in way[entry:])]


def _red_after(entry: Zone, zone: Zone) -> Zone:
    """Return a zone as red for what is red at the ``entry``, and for what is besides."""
    more = (reason for reason in zone.reasons if reason.tone == RED)
    return replace(zone, tone=RED, reasons=tuple(dict.fromkeys((*entry.reasons, *more))))


def _joined(zones: list[Zone]) -> Zone:
    """Return neighbours of one tone as one zone, with the reasons of its tone first, the widest first."""
    reasons = dict.fromkeys(reason for zone in zones for reason in zone.reasons)
    order = sorted(reasons, key=lambda reason: (-TONES.index(reason.tone), reason.short - reason.long))
    return Zone(zones[0].tone, zones[0].short, zones[-1].long, tuple(order))
