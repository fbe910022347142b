"""How short a line can be made: where strain, fold and inversion of the control mesh begin (ours).

The exact answer follows the line's length down from rest, each balance from the ones before it, and what
begins between two of them is closed in on.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from core.comparison import shape_of
from core.design import Design
from core.design_lines import WornLine
from core.exact import solve_exact
from core.lines import RATIO_LIMITS, Line
from core.mesh import Floats
from core.model import ConstrainedModel
from core.pipeline import Stages, build, targets_of
from core.progress import Progress, quiet
from core.solving.condition import CALM_RANGE, FOLD_LIMIT, STRAIN_RANGE, Condition
from core.solving.elastic_lines import ElasticLines, fit_elastics
from core.solving.newton import Balance, energy_steps
from core.solving.newtons import newtons_per_unit
from core.solving.potential import Potential
from core.solving.sliding import sliding_steps

SIGNS = ("strained", "overstrained", "folded", "inverted")
"""What can begin, as ``Condition`` names it: from amber to nonsense."""

_LEAST = RATIO_LIMITS[0]

PRECISION = 0.0005
"""Ratios of natural length to which a beginning is closed in on [1]."""

_STRIDE = 0.05
_NEAR_ENOUGH = 1e-5  # largest unbalanced force over the mean stiffness [mm]: far less than PRECISION moves
_ROUNDS = 12  # six are the rule, till the end of an elastic's curve is met
_FEW_STEPS = 10  # three are the rule; where it takes more a shorter stride does better


@dataclass(frozen=True)
class Length:
    """A length of a line: natural length as set over that at rest [1], and the length it reaches [mm]."""

    ratio: float
    reached: float


@dataclass(frozen=True, eq=False)
class Limits:
    """How short a line can be made while all others stay as they are set.

    ``present`` is the line as it is set, None if it is off; ``beyond`` names those of SIGNS that this setting
    already shows. ``begins`` tells for each of SIGNS the longest length that shows it, None where none does
    down to RATIO_LIMITS; a beginning at the rest length is the other lines' doing. ``last`` is the shortest
    length with a balance, None if there is one down to where all SIGNS show. ``found`` is False if there is
    none anywhere: the other lines ask for what cannot be. ``stretched`` is where the elastic it is made of is
    stretched to the end of its curve, None for a line without one, or down to RATIO_LIMITS.
    """

    line: Line
    present: Length | None
    beyond: tuple[str, ...]
    begins: Mapping[str, Length | None]
    last: Length | None
    found: bool = True
    stretched: Length | None = None


def shortest(
    model: ConstrainedModel,
    ratios: tuple[float, ...],
    name: str,
    partners: Collection[str] = (),
    progress: Progress = quiet,
) -> Limits:
    """Return how short the worn line ``name`` can be made, with ``ratios`` as set, one per line.

    ``partners`` are lines that share its length. ``progress`` hears each balance; raises Cancelled.
    """
    lines = [line.name for line in model.lines]
    index = lines.index(name)
    walk = _Walk(model, ratios, index, [lines.index(each) for each in partners], progress)
    line, present = model.lines[index], walk.solved(ratios[index])
    beyond = tuple(sign for sign in SIGNS if present is not None and present.shows(sign))
    if not line.constrains:
        return Limits(line, None if present is None else present.length, beyond, dict.fromkeys(SIGNS), None)
    stops, last = walk.down()
    begins = {sign: walk.beginning(stops, sign) for sign in SIGNS}
    length = None if present is None else present.length
    return Limits(line, length, beyond, begins, last, found=bool(stops))


def limits_of(stages: Stages, name: str, progress: Progress = quiet) -> Limits:
    """Return the limits of a line, worn or not, the others being as they are set.

    A linked partner goes with it. Raises Cancelled.
    """
    both, worn = stages.design.linked(name), name in stages.design.worn()
    tried = build(_wearing(stages.design, both), stages)
    ratios, partners = targets_of(tried.design, tried).ratios, set(both) - {name}
    limits = shortest(tried.model, ratios, name, partners, progress)
    if limits.line.constrains:
        limits = replace(limits, stretched=_end_of_curve(tried, limits.line, both, progress))
    return limits if worn else replace(limits, present=None, beyond=())


def all_limits(stages: Stages) -> Iterator[Limits]:
    """Yield the limits of each line that moves anything, worn or not; see ``limits_of``."""
    return (limits_of(stages, line.name) for line in stages.model.lines if line.constrains)


def _end_of_curve(stages: Stages, line: Line, pair: tuple[str, ...], progress: Progress) -> Length | None:
    """Return the length at which the elastic of ``line``, or its partner's, is stretched as far as is known.

    That is looked for with lines whose force and length are on their curves, as what is shorter is refused.
    """
    design = stages.design
    made = design.worn_elastics()
    reach = {name: made[name].reach for name in pair if name in made}
    if not reach or design.line_hold == "held":
        return None
    newtons = newtons_per_unit(stages.model, design.tissue_stiffness)
    ratio = 1.0 / (1.0 + min(reach.values()))  # as if the line did not move the body
    for _ in range(_ROUNDS):
        progress("finding limits", 0.0)
        set_ = {each.name: design.ratio(each.name) for each in stages.model.lines}
        ratios = set_ | dict.fromkeys(pair, ratio)
        wish = ElasticLines(stages.model, ratios, made, newtons, design.own_stiffness())
        fitted = fit_elastics(wish, partial(solve_exact, ratios=tuple(ratios.values())))
        beyond = max((1.0 + fitted.elongations[name]) / (1.0 + reach[name]) for name in reach)
        if abs(beyond - 1.0) * ratio < 0.2 * PRECISION:
            break
        ratio *= beyond
    reached = (1.0 + fitted.elongations.get(line.name, 0.0)) * ratio * line.rest_length
    return Length(ratio, reached) if fitted.agreed and ratio > _LEAST else None


def _wearing(design: Design, names: Collection[str]) -> Design:
    """Return the design with these lines worn, whether they are locked or not."""
    off = set(names) - design.worn()
    return replace(design, lines=(*design.lines, *(WornLine(name, 1.0) for name in sorted(off))))


@dataclass(frozen=True, eq=False)
class _Stop:
    """A balance on the way down."""

    length: Length
    balance: Balance
    condition: Condition

    def shows(self, sign: str) -> bool:
        """Return whether ``sign`` is to be seen."""
        return bool(getattr(self.condition, sign))

    def margin(self, sign: str) -> float:
        """Return how far the shape is from showing ``sign``; 0 or less if it does [1]."""
        seen = self.condition
        if sign in ("folded", "inverted"):
            return seen.turned - (FOLD_LIMIT if sign == "folded" else 0.0)
        low, high = CALM_RANGE if sign == "strained" else STRAIN_RANGE
        return min(seen.shortest - low, high - seen.longest)


class _Walk:
    """The way of one line from its rest length down to the shortest that can be asked for."""

    def __init__(
        self,
        model: ConstrainedModel,
        ratios: tuple[float, ...],
        index: int,
        partners: Collection[int],
        progress: Progress,
    ) -> None:
        self._model, self._ratios, self._index = model, ratios, index
        self._together = {index, *partners}
        self._progress = progress
        self._shape = shape_of(model)
        self._snapped = False

    def solved(self, ratio: float) -> _Stop | None:
        """Return the balance that rest leads to with the line at ``ratio``, or None if there is none."""
        balance = solve_exact(self._model, self._with(ratio))
        return self._stop(ratio, balance) if balance.found else None

    def _near(self, ratio: float, start: Balance) -> _Stop | None:
        """Return the balance of the line at ``ratio`` if a few steps lead there from ``start``."""
        sliding = self._model.mechanics.line_contact == "sliding"
        iterates = (sliding_steps if sliding else energy_steps)(
            Potential(self._model, self._with(ratio)), start, _FEW_STEPS
        )
        balance = next((step for step in iterates if step.residual < _NEAR_ENOUGH), None)
        return None if balance is None else self._stop(ratio, balance)

    def _with(self, ratio: float) -> tuple[float, ...]:
        self._progress("finding limits", 0.0)
        return tuple(ratio if at in self._together else set_ for at, set_ in enumerate(self._ratios))

    def _stop(self, ratio: float, balance: Balance) -> _Stop:
        points = self._model.tensegric.expand(balance.state.moved)
        length = Length(ratio, self._model.lines[self._index].length(points))
        return _Stop(length, balance, self._shape.condition(points))

    def down(self) -> tuple[list[_Stop], Length | None]:
        """Return the stops from rest until all SIGNS show, and the last length if no balance lies below."""
        here = self.solved(1.0) or self.solved(self._ratios[self._index])
        if here is None:
            return [], None
        stops, stride = [here], _STRIDE
        while not (here.shows("overstrained") and here.shows("inverted")) and here.length.ratio > _LEAST:
            ratio = max(here.length.ratio - stride, _LEAST)
            there = self._near(ratio, _ahead(stops[-2:], ratio))
            if there is not None:
                here, stride = there, min(1.5 * stride, _STRIDE)
                stops.append(here)
            elif stride > PRECISION:
                stride /= 2.0
            elif (there := self._jumped(here.length.ratio)) is not None:
                here, stride = there, _STRIDE
                stops.append(here)
            else:
                return stops, here.length
        return stops, None

    def _jumped(self, above: float) -> _Stop | None:
        """Return a balance far from the last one: where lines are springs the shape may snap there, once."""
        if self._snapped or self._model.mechanics.line_hold == "held":
            return None
        self._snapped = True
        ratios = (above - strides * _STRIDE for strides in (0.1, 1.0, 2.0, 4.0))
        tries = (self.solved(ratio) for ratio in ratios if ratio >= _LEAST)
        return next((there for there in tries if there is not None), None)

    def beginning(self, stops: list[_Stop], sign: str) -> Length | None:
        """Return the longest length that shows ``sign``; adds to ``stops`` those made to close in on it."""
        below = next((at for at, stop in enumerate(stops) if stop.shows(sign)), None)
        if below is None:
            return None
        tries = 0
        while below > 0 and stops[below - 1].length.ratio - stops[below].length.ratio > PRECISION:
            tries += 1
            between = self._between(stops[below - 1], stops[below], sign, halve=tries % 3 == 0)
            if between is None:
                break
            stops.insert(below, between)
            below += not between.shows(sign)
        return stops[below].length

    def _between(self, above: _Stop, below: _Stop, sign: str, halve: bool) -> _Stop | None:
        """Return a stop where ``sign`` seems to begin, a little beyond on the side where more is unknown."""
        high, low = above.length.ratio, below.length.ratio
        share = above.margin(sign) / (above.margin(sign) - below.margin(sign))
        nudge = 0.4 * PRECISION / (high - low)
        share = 0.5 if halve else min(max(share + (nudge if share < 0.5 else -nudge), nudge), 1.0 - nudge)
        ratio = high + share * (low - high)
        starts = (_mixed(above.balance, below.balance, share), above.balance, below.balance)
        return next((stop for start in starts if (stop := self._near(ratio, start))), None)


def _ahead(stops: list[_Stop], ratio: float) -> Balance:
    """Return where the way through the last ``stops``, one or two, leads at ``ratio``."""
    one, here = stops[0], stops[-1]
    if one is here:
        return here.balance
    share = (one.length.ratio - ratio) / (one.length.ratio - here.length.ratio)
    return _mixed(one.balance, here.balance, share)


def _mixed(one: Balance, other: Balance, share: float) -> Balance:
    """Return the place between two balances, ``share`` of the way to the other."""

    def mix(a: Floats, b: Floats) -> Floats:
        return np.asarray(a + share * (b - a))

    state = replace(one.state, moved=mix(one.state.moved, other.state.moved))
    return replace(one, state=state, multipliers=mix(one.multipliers, other.multipliers))
