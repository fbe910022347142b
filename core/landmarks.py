"""The landmarks of the bust: bust points, under-bust folds, lowest points of the breasts, and two levels."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from core.body import Body
from core.bust_check import check, refusal
from core.bust_point import bust_points
from core.chest import find_anchor, find_poles
from core.landmark import SIDES, Landmark, Landmarks
from core.mesh import Mesh, Points
from core.placed import placed_marks
from core.roots import root_marks
from core.trunk import survey
from core.trunk_marks import trunk_marks
from core.under_breast import ABOVE, folds_and_lowest

NOTHING: Mapping[str, Points] = MappingProxyType({})


def find_landmarks(body: Body, placed: Mapping[str, Points] = NOTHING) -> Landmarks:
    """Return the bust landmarks of ``body``; ``placed`` points, by name, shape (3,) [mm], replace found ones.

    What depends on a placed point follows it. Raises LandmarkError if the body shows no bust, unless bust
    points and folds are all placed, or if a place or its name makes no sense. Source: ours.
    """
    calm = body.calm
    by_hand = placed_marks(calm, placed)
    warnings: tuple[str, ...] = ()
    if all(f"{name}_{side}" in by_hand for name in ("bust_point", "fold") for side in SIDES):
        found = _around(calm, by_hand)
    else:
        trunk = survey(calm)
        anchor = find_anchor(trunk)
        if anchor.kink < 8.0 or anchor.middle_kink > 0.5 * anchor.kink:
            raise refusal("no fold lies under a left and a right breast")
        poles = find_poles(trunk, anchor)
        busts = [by_hand.get(mark.name, mark) for mark in bust_points(calm, poles)]
        found = _levels(busts + folds_and_lowest(calm, busts, anchor.z, by_hand), by_hand)
        warnings = check(calm, trunk, poles, found)
    further = {mark.name: mark for mark in (*trunk_marks(calm, found), *root_marks(calm, found))}
    points = MappingProxyType({**found.points, **further, **by_hand})
    return Landmarks(points, found.bust_level, found.underbust_level, warnings)


def _around(mesh: Mesh, by_hand: Mapping[str, Landmark]) -> Landmarks:
    """Return the landmarks round bust points and folds that are all placed, whatever the body looks like."""
    busts = [by_hand[f"bust_point_{side}"] for side in SIDES]
    level = min(by_hand[f"fold_{side}"].position[2] for side in SIDES) - ABOVE
    return _levels(busts + folds_and_lowest(mesh, busts, level, by_hand), by_hand)


def _levels(marks: list[Landmark], by_hand: Mapping[str, Landmark]) -> Landmarks:
    found = {mark.name: by_hand.get(mark.name, mark) for mark in marks}
    bust = [found[f"bust_point_{side}"].position[2] for side in SIDES]
    under = [found[f"{name}_{side}"].position[2] for name in ("fold", "lowest") for side in SIDES]
    return Landmarks(MappingProxyType(found), float(sum(bust)) / 2.0, float(min(under)))
