"""Validation of a detected bust: errors where impossible, warnings where unusual."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from core.errors import LandmarkError
from core.geometry.mesh import Floats, Mesh
from core.landmarks.anchor import KINK, Anchor
from core.landmarks.bust_point import FLAT, NIPPLE
from core.landmarks.chest import Pole
from core.landmarks.lower_breast import HIDDEN, NO_CREASE, UNSEEN
from core.landmarks.torso.cross_sections import TorsoSections, stable_level, trunk_levels
from core.landmarks.types import SIDES, Landmarks
from core.messages import Length, Message, SideName

SLIMMEST, WIDEST = 550.0, 1600.0
"""Under-bust girths of adults [mm]: the sizes of bands that are sold, some 600 to 1500, and a little more."""

FLATTEST_BUST, FULLEST_BUST = 5.0, 500.0
"""A bust is by so much wider round than the trunk under it [mm]: wide bounds of our own, from no table."""

FULL = 30.0
"""Breasts that both stand out by more than this [mm], and as far forward of what is under them, are breasts:
though a belly under them be as wide and they hide their creases."""

ROUNDEST, FLATTEST = 1.0, 2.3
"""A trunk is so many times as wide as deep; chairs, bottles and things on a table are not."""

APART = 55.0, 400.0
"""Bust points lie so far apart [mm]: less is one bump, more the knees or the arms of something."""

UNEVEN = 60.0
"""The heights of two bust points differ by less than this [mm]: one breast may hang, or the scan lean."""

ASIDE = 40.0
"""So near to the middle of the trunk lies the middle between the bust points [mm]."""

DEEPEST = 220.0
"""The under-bust level lies by less than this below that of the bust [mm]."""

ONE_BUMP, RIDGE = 0.6, 9.0
"""What comes forward in the middle by more than this part of the sides, and lies by more than this before or
behind them there [mm], is one bump or has a cleft: a bra spans from breast to breast."""

SPANNED = 50.0
"""Under the cloth that spans from breast to breast the middle comes forward by less than this [mm]."""

OPEN = 0.25
"""One straight line is no longer than this part of an outline: else a side of the trunk is missing."""


def refusal(why: Message, placed: bool = False) -> LandmarkError:
    """Return the error that says ``why`` there is no bust, or none with the points that were ``placed``."""
    if placed:
        return LandmarkError(
            Message("No bust detected with the manually placed points: {why}.", why=why),
            Message(
                "Place bust points on the breasts and inframammary folds below them, or remove "
                "the manual points."
            ),
        )
    return LandmarkError(
        Message("No bust detected: {why}.", why=why),
        Message(
            "Open a scan of a complete upper body, set its up and front axes, or place both bust "
            "points and both inframammary folds manually."
        ),
    )


def check_anchor(anchor: Anchor) -> None:
    """Raise LandmarkError where the body does not come forward as over a bust."""
    least = 2.0 * KINK if anchor.lone else KINK
    spanned = abs(anchor.ridge) <= RIDGE and anchor.middle_kink < SPANNED
    one_bump = anchor.middle_kink > ONE_BUMP * anchor.kink and not spanned
    if anchor.kink < least or one_bump:
        raise refusal(Message("left and right inframammary folds not detected"))


def check_placed(landmarks: Landmarks) -> None:
    """Raise LandmarkError where points that were placed by hand contradict each other."""
    points = landmarks.points
    for kind in ("bust_point", "fold"):
        left, right = (points[f"{kind}_{side}"] for side in SIDES)
        if (left.by_hand or right.by_hand) and left.position[0] <= right.position[0]:
            raise refusal(Message("left and right are swapped"), _placed(landmarks))
    if _placed(landmarks) and landmarks.bust_level <= landmarks.underbust_level:
        raise refusal(Message("the inframammary folds are above the bust points"), _placed(landmarks))


def _placed(landmarks: Landmarks) -> bool:
    return any(mark.by_hand for mark in landmarks.points.values())


def check(
    mesh: Mesh,
    trunk: TorsoSections,
    anchor: Anchor,
    poles: tuple[Pole, Pole],
    missing: Sequence[str],
    landmarks: Landmarks,
) -> tuple[Message, ...]:
    """Return warnings, one sentence each; on sides ``missing`` there is no breast.

    Raises LandmarkError where this cannot be a bust.
    """
    check_placed(landmarks)
    full = min(anchor.kink, *(pole.prominence for pole in poles)) > FULL
    for wrong, why in _rules(mesh, trunk, poles, missing, landmarks, full):
        if wrong:
            raise refusal(why, _placed(landmarks))
    rules = [landmarks.points[f"fold_{side}"].rule for side in SIDES]
    return tuple(
        warning
        for side, rule in zip(SIDES, rules, strict=True)
        for warning in _warnings(side, rule, side in missing)
    )


def _rules(
    mesh: Mesh,
    trunk: TorsoSections,
    poles: tuple[Pole, Pole],
    missing: Sequence[str],
    landmarks: Landmarks,
    full: bool,
) -> Iterator[tuple[bool, Message]]:
    """Give what a bust must not be, whether it is so, and why it is refused then; the first is told."""
    under, bust = stable_level(mesh, landmarks.underbust_level), trunk_levels(mesh, landmarks.bust_level)[0]
    yield under.tape == 0.0 or bust.tape == 0.0, Message("the trunk is missing at the expected height")
    left, right = (landmarks.position(f"bust_point_{side}") for side in SIDES)
    across, middle = left - right, 0.5 * (left + right)
    wide, deep, _ = np.ptp(under.points, axis=0)
    busts = [landmarks.points[f"bust_point_{side}"] for side in SIDES if side not in missing]
    clear = all(mark.rule == NIPPLE or mark.by_hand for mark in busts)
    more, depth = bust.tape - under.tape, landmarks.bust_level - landmarks.underbust_level
    yield (
        under.longest_straight > OPEN * under.tape,
        Message("the trunk is open, possibly an incomplete scan"),
    )
    yield (
        not SLIMMEST < under.tape < WIDEST,
        Message("the under-bust girth would be {girth}", girth=Length(under.tape)),
    )
    yield len(missing) > 0 and not clear, Message("only one side of the chest protrudes")
    slight = more <= FLATTEST_BUST and not full
    yield slight or more >= FULLEST_BUST, Message("the bust would not be wider than the trunk below it")
    yield not ROUNDEST < wide / deep < FLATTEST, Message("the trunk depth is implausible for a body")
    yield from _rules_of_places(across, middle, trunk.middle, len(missing) > 0)
    yield max(pole.prominence for pole in poles) < FLAT, Message("the chest has no protrusion")
    yield not 0.0 < depth < DEEPEST, Message("no inframammary fold at a plausible height below the breast")
    rules = {landmarks.points[f"fold_{side}"].rule for side in SIDES}
    yield rules == {NO_CREASE} and not (full and clear), Message("no crease below the breast")


def _rules_of_places(
    across: Floats, middle: Floats, trunk_middle: float, is_one_sided: bool
) -> Iterator[tuple[bool, Message]]:
    """Give where bust points must not be, from the vector between them and their middle [mm]."""
    yield (
        not APART[0] < across[0] < APART[1],
        Message("the bust points would be {distance} apart", distance=Length(across[0])),
    )
    yield (
        abs(across[2]) > UNEVEN and not is_one_sided,
        Message("the bust points would be at very different heights"),
    )
    yield (
        abs(middle[0] - trunk_middle) > ASIDE and not is_one_sided,
        Message("the bust would be off the centre of the body"),
    )


def _warnings(side: str, rule: Message, missing: bool) -> list[Message]:
    if missing:
        return [
            Message(
                "No breast protrusion on the {side} side: landmarks there are uncertain.",
                side=SideName(side),
            )
        ]
    if rule in HIDDEN:
        return [
            Message(
                "The scan has a hole at the inframammary fold of the {side} breast: the height of the fold "
                "is estimated.",
                side=SideName(side),
            )
        ]
    if rule == UNSEEN:
        return [
            Message(
                "No inframammary fold detected under the {side} breast: the height of the fold is estimated.",
                side=SideName(side),
            )
        ]
    return []


def placed_warnings(landmarks: Landmarks) -> tuple[Message, ...]:
    """Return one sentence for each side on which the fold lies above the bust point by hand."""
    pairs = {side: [landmarks.points[f"{name}_{side}"] for name in ("bust_point", "fold")] for side in SIDES}
    return tuple(
        Message(
            "The manually placed inframammary fold of the {side} breast is above its bust point. Check both.",
            side=SideName(side),
        )
        for side, (bust, fold) in pairs.items()
        if (bust.by_hand or fold.by_hand) and fold.position[2] > bust.position[2]
    )
