"""Whether what was found can be a bust: refused where it cannot, warned of where it is only unusual."""

from __future__ import annotations

import numpy as np

from core.errors import LandmarkError
from core.finding.bust_point import FLAT, NIPPLE, missing_sides
from core.finding.chest import KINK, Anchor, Pole
from core.finding.under_breast import CREASE, NO_CREASE
from core.landmark import SIDES, Landmarks
from core.mesh import Mesh
from core.trunk import Survey, stable_level, trunk_levels


def refusal(why: str) -> LandmarkError:
    """Return the error that says ``why`` there is no bust."""
    return LandmarkError(
        f"No bust can be found: {why}.",
        "Open a scan of a whole upper body, or say which way is up and which is the front.",
    )


def check_anchor(anchor: Anchor) -> None:
    """Raise LandmarkError where the body does not come forward as over a bust."""
    least = 2.0 * KINK if anchor.lone else KINK
    if anchor.kink < least or anchor.middle_kink > 0.5 * anchor.kink:
        raise refusal("no fold lies under a left and a right breast")


def check(mesh: Mesh, trunk: Survey, poles: tuple[Pole, Pole], landmarks: Landmarks) -> tuple[str, ...]:
    """Return warnings, one sentence each. Raises LandmarkError where this cannot be a bust."""
    left, right = (landmarks.position(f"bust_point_{side}") for side in SIDES)
    under, bust = stable_level(mesh, landmarks.underbust_level), trunk_levels(mesh, landmarks.bust_level)[0]
    if under.tape == 0.0 or bust.tape == 0.0:
        raise refusal("the trunk is missing there")
    across, middle = left - right, 0.5 * (left + right)
    wide, deep, _ = np.ptp(under.points, axis=0)
    missing = missing_sides(poles)
    nipples = [landmarks.points[f"bust_point_{side}"].rule == NIPPLE for side in SIDES if side not in missing]
    rules = [landmarks.points[f"fold_{side}"].rule for side in SIDES]
    for wrong, why in (
        (
            under.longest_straight > 0.25 * under.tape,
            "the trunk is open, as if only a part of it was scanned",
        ),
        (not 550.0 < under.tape < 1600.0, f"the girth under it would be {under.tape:.0f} mm"),
        (len(missing) > 0 and not all(nipples), "only one side stands out of the chest"),
        (not 5.0 < bust.tape - under.tape < 500.0, "it would not be wider than the trunk under it"),
        (not 1.0 < wide / deep < 2.3, "the trunk is not as deep as a body"),
        (not 90.0 < across[0] < 400.0, f"its points would lie {across[0]:.0f} mm apart"),
        (abs(across[2]) > 60.0 and not missing, "its points would lie at very different heights"),
        (abs(middle[0] - trunk.middle) > 40.0 and not missing, "it would lie beside the middle of the body"),
        (max(pole.prominence for pole in poles) < FLAT, "nothing stands out of the chest"),
        (not any(pole.inside for pole in poles), "the chest comes to no point"),
        (
            not 0.0 < landmarks.bust_level - landmarks.underbust_level < 220.0,
            "no fold lies at a likely depth under it",
        ),
        (rules == [NO_CREASE, NO_CREASE], "there is no crease under it"),
    ):
        if wrong:
            raise refusal(why)
    return tuple(
        warning
        for side, rule in zip(SIDES, rules, strict=True)
        for warning in _warnings(side, rule, side in missing)
    )


def _warnings(side: str, rule: str, missing: bool) -> list[str]:
    if missing:
        return [f"On the {side} side no breast stands out of the chest: its points are uncertain."]
    if rule not in (CREASE, NO_CREASE):
        return [f"The scan has a hole where the fold of the {side} breast lies: its height is estimated."]
    return []
