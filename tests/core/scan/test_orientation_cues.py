"""What tells up and front is read where it is, and nothing that only looks like it."""

import numpy as np

from core.scan.orientation.orientation_cues import CUES, Fold, Side, TorsoFeatures
from core.scan.orientation.silhouette import Silhouette

FLAT = [0.0] * 20


def cue(words: str, front: list[float], back: list[float], fold: Fold) -> float:
    """Return what a cue gives for lobes at both sides, from the hips up [mm]."""
    sides = [Side(np.zeros(len(lobes)), np.array(lobes)) for lobes in (front, back)]
    (found,) = (each for each in CUES if str(each.words) == words)
    return found.evaluate(TorsoFeatures(None, fold, *sides))


def test_breasts_that_hang_to_the_waist_are_no_buttocks():
    hanging = [5.0] * 2 + [45.0] * 10 + [5.0] * 8
    assert cue("the cleft of the buttocks", hanging, FLAT, Fold()) == 0.0
    assert cue("the cleft of the buttocks", FLAT, hanging, Fold()) == 0.0


def test_the_cleft_of_the_buttocks_is_behind():
    cleft = [9.0] * 4 + [-2.0] * 16
    assert cue("the cleft of the buttocks", FLAT, cleft, Fold()) > 0.5
    assert cue("the cleft of the buttocks", cleft, FLAT, Fold()) < -0.5


def test_the_cleft_of_the_buttocks_is_read_above_the_legs():
    front, back = [np.nan] * 3 + [-4.0] * 17, [np.nan] * 3 + [2.0] * 17
    assert cue("the cleft of the buttocks", front, back, Fold()) > 0.5


def test_what_stands_out_further_than_any_breast_is_no_better_bust():
    bust, chin = (
        cue("the bust with the inframammary folds", FLAT, FLAT, Fold(strength, 18.0, 0.8))
        for strength in (70.0, 120.0)
    )
    assert chin < bust - 1.0


def test_arms_that_are_one_with_the_trunk_at_most_levels_are_none_of_its_width():
    count, free = 40, 12
    z, beside = np.arange(count) * 10.0, np.arange(count) < free
    merged = np.where(beside, 125.0, 210.0)
    nothing, yes = np.empty((count, 0)), np.ones(count, dtype=bool)
    for way in (1, -1):
        depth = np.full(count, 95.0)
        trunk = Silhouette(
            *(10.0, z, merged[::way], -depth, depth, beside[::way], ~yes),
            *(nothing, nothing, yes, yes),
        )
        assert trunk.half_width == 125.0
        assert (trunk.proper == beside[::way]).all()
