"""A bust pressed flat by a bra: where the crease under it is, and what is not taken for it."""

from __future__ import annotations

import numpy as np
import pytest

from core.geometry.mesh import Mesh
from core.landmarks.anchor import find_anchor
from core.landmarks.torso.cross_sections import scan_torso
from tests.core.landmarks.test_landmarks import SIDES, landmarks_of

FOLD = -40.0
"""Where the crease under the bust is [mm]; the bust itself is foremost at z = 0."""


def trunk(out: float, belly: float = 0.0, head: float = 0.0) -> Mesh:
    """Return a trunk with a bust ``out`` [mm] that cloth bridges, wider at the arm-pits than below them.

    A ``belly`` comes forward below the fold [mm]; on a slim neck there is a ``head`` of this half width [mm].
    """
    z, turn = np.meshgrid(
        np.arange(-240.0, 200.0 + 200.0 * (head > 0.0), 5.0),
        np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False),
        indexing="ij",
    )
    wide = 140.0 + 28.0 * np.clip((z + 10.0) / 60.0, 0.0, 1.0)
    deep = 110.0 - 0.4 * np.maximum(z, 0.0)
    x, y = wide * np.sin(turn), -deep * np.cos(turn)
    across = np.clip((125.0 - np.abs(x)) / 40.0, 0.0, 1.0) * (y < 0.0)
    tall = np.where(z > 0.0, np.exp(-((z / 55.0) ** 2)), np.clip((z - FOLD) / 30.0, 0.0, 1.0))
    y -= across * (out * tall * (0.7 + 0.3 * np.abs(np.sin(3.0 * turn))))
    y -= across * belly * np.exp(-(((z - FOLD + 110.0) / 40.0) ** 2))
    if head > 0.0:
        above = np.clip((z - 190.0) / 10.0, 0.0, 1.0) - np.clip((z - 250.0) / 10.0, 0.0, 1.0)
        skull = np.clip((z - 250.0) / 10.0, 0.0, 1.0)
        x = x * (1.0 - above - skull) + np.sin(turn) * (50.0 * above + head * skull)
        chin = 1.0 + 0.5 * np.clip((z - 290.0) / 40.0, 0.0, 1.0)
        y = y * (1.0 - above - skull) - np.cos(turn) * (50.0 * above + head * chin * skull)
    rows, columns = z.shape
    at = (np.arange(rows - 1)[:, None] * columns + np.arange(columns)).ravel()
    right = at - at % columns + (at + 1) % columns
    faces = [np.stack([at, right, at + columns], 1), np.stack([right, right + columns, at + columns], 1)]
    return Mesh(np.stack([x, y, z], axis=2).reshape(-1, 3), np.concatenate(faces))


@pytest.mark.parametrize("out", [14.0, 22.0, 40.0])
def test_the_crease_under_a_pressed_bust_is_below_it_and_not_beside_the_arm_pits(out):
    anchor = find_anchor(scan_torso(trunk(out)))
    assert FOLD - 35.0 < anchor.z < FOLD + 5.0


def test_a_belly_under_a_pressed_bust_is_no_bust():
    landmarks = landmarks_of(trunk(22.0, belly=60.0))
    for side in SIDES:
        assert landmarks.position(f"fold_{side}")[2] == pytest.approx(FOLD, abs=5.0)


def test_a_head_as_wide_as_the_trunk_is_none_of_it():
    full = scan_torso(trunk(22.0, head=130.0))
    _, usable = full.trunk()
    assert usable[full.z < 100.0].any()
    assert not usable[full.z > 200.0].any()
    landmarks = landmarks_of(trunk(22.0, head=130.0))
    assert landmarks.bust_level == pytest.approx(0.0, abs=10.0)
