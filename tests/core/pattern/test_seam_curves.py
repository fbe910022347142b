"""Blocks on bodies: the polar map of a breast, places told by landmarks, seams on the skin."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from importlib import resources

import numpy as np
import pytest
import trimesh
from whole_trunk import trunk_stages

from core.errors import PatternError
from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Mesh
from core.landmarks.types import Landmark, Landmarks
from core.messages import EMPTY
from core.pattern.block_library import block_of, built_in_blocks, find_block
from core.pattern.breast_map import breast_map
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import STEP, SeamCurve, SeamDrawing
from core.pipeline.build import Stages

Built = Callable[[str], Stages]
RADIUS = 70.0
BUST_BLOCKS = [block.name for block in built_in_blocks() if not block.needs_lower_trunk]


def ball() -> tuple[Mesh, Landmarks]:
    """A ball as a left breast, facing forward (-y), its root at 60 degrees outside, inside and below."""
    shape = trimesh.creation.icosphere(subdivisions=5, radius=RADIUS)
    skin = Mesh(np.asarray(shape.vertices), np.asarray(shape.faces))
    across, ahead = RADIUS * np.sin(np.radians(60.0)), -RADIUS * np.cos(np.radians(60.0))
    places = {
        "bust_point_left": (0.0, -RADIUS, 0.0),
        "root_outer_left": (across, ahead, 0.0),
        "root_inner_left": (-across, ahead, 0.0),
        "fold_left": (0.0, ahead, -across),
    }
    points = {name: Landmark(name, np.array(place), 1.0, EMPTY) for name, place in places.items()}
    return skin, Landmarks(points, 0.0, -RADIUS)


def test_distances_of_a_ball_are_arcs_and_clock_positions_angles() -> None:
    breast = breast_map(*ball(), "left")
    arc = RADIUS * np.radians(60.0)
    np.testing.assert_allclose(breast.root_distance(np.array([90.0, 180.0, 270.0])), arc, atol=1.5)
    assert breast.root_distance(0.0) == pytest.approx(1.08 * arc, abs=1.5)
    clocks, far = np.array([0.0, 33.0, 90.0, 147.5, 200.0, 301.0]), np.full(6, 50.0)
    found = breast.places(clocks, far)
    angle, clock = 50.0 / RADIUS, np.radians(clocks)
    known = RADIUS * np.stack(
        [np.sin(angle) * np.sin(clock), np.full(6, -np.cos(angle)), np.sin(angle) * np.cos(clock)], axis=1
    )
    np.testing.assert_allclose(found, known, atol=0.3)


def test_a_breast_that_a_hole_reaches_is_refused() -> None:
    skin, landmarks = ball()
    torn = Mesh(skin.vertices, skin.faces[skin.vertices[skin.faces].mean(axis=1)[:, 0] < -10.0])
    with pytest.raises(PatternError, match="incomplete"):
        breast_map(torn, landmarks, "left")


@cache
def drawing(stages: Stages) -> SeamDrawing:
    return SeamDrawing(BodyPlaces.of(stages))


@cache
def curves(stages: Stages, block: str) -> dict[str, SeamCurve]:
    return {curve.name: curve for curve in drawing(stages).curves(find_block(block))}


@pytest.mark.parametrize("sample", ["person", "mannequin"])
@pytest.mark.parametrize("block", BUST_BLOCKS)
def test_all_blocks_lie_on_the_skin_of_the_samples(built: Built, sample: str, block: str) -> None:
    stages = built(sample)
    for curve in curves(stages, block).values():
        _, on_skin = nearest_faces(stages.body.smoothed, curve.points)
        assert np.abs(on_skin - curve.points).max() < 1e-6, curve.name
        steps = np.linalg.norm(np.diff(curve.points, axis=0), axis=1)
        assert 0.2 < steps.min() <= steps.max() < 9.0, f"{curve.name} is even"


LOWER_BLOCKS = [block.name for block in built_in_blocks() if block.needs_lower_trunk]


@pytest.mark.parametrize("block", LOWER_BLOCKS)
def test_blocks_of_waist_and_hips_lie_on_the_whole_trunk(built: Built, block: str) -> None:
    found = curves(trunk_stages(), block)
    for curve in found.values():
        _, on_skin = nearest_faces(trunk_stages().body.smoothed, curve.points)
        assert np.abs(on_skin - curve.points).max() < 1e-6, curve.name
    for side in ("left", "right"):
        leg, gusset = found[f"leg edge {side}"].points, found[f"gusset edge {side}"].points
        assert np.linalg.norm(leg[-1] - gusset[0]) < 0.1
        assert np.linalg.norm(leg[0] - gusset[-1]) < 0.1, "closed round the leg"
        assert 20.0 < abs(gusset[:, 0]).max() < 70.0
    with pytest.raises(PatternError, match="waist, hips and seat"):
        curves(built("person"), block)


def test_seams_meet_where_they_share_a_place(built: Built) -> None:
    found = curves(built("person"), "two-part-cup")
    for side in ("left", "right"):
        wire, neckline, armhole, cup = (
            found[f"{name} {side}"].points for name in ("wire", "neckline", "armhole", "cup seam")
        )
        assert np.linalg.norm(wire[0] - neckline[0]) < 1.0
        assert np.linalg.norm(wire[-1] - armhole[-1]) < 1.0
        assert np.linalg.norm(neckline[-1] - armhole[0]) < 0.1
        apex = drawing(built("person")).places.breasts[side].apex
        assert np.linalg.norm(cup - apex, axis=1).min() < STEP, "rounded there, not led elsewhere"
        assert wire[:, 2].min() < apex[2] - 20.0, "it goes below"


def test_levels_and_shares_are_those_of_the_body(built: Built) -> None:
    stages = built("mannequin")
    places = drawing(stages).places
    band = curves(stages, "two-part-cup")["band edge left"].points
    np.testing.assert_allclose(band[:, 2], stages.landmarks.underbust_level - 18.0, atol=1.0)
    assert band[:, 0].min() > places.middle - 6.0
    ring = places.ring(stages.landmarks.underbust_level, "left")
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ring, axis=0), axis=1))])
    half = places.place("ring under 0.5", "left", {}, {})
    at = np.linalg.norm(ring - half, axis=1).argmin()
    assert along[at] == pytest.approx(0.5 * along[-1], abs=8.0)
    above = places.place("front under+22", "", {}, {})
    assert above[2] == pytest.approx(stages.landmarks.underbust_level + 22.0)


def test_left_and_right_of_a_symmetric_body_mirror_each_other(built: Built) -> None:
    stages = built("mannequin")
    middle, found = drawing(stages).places.middle, curves(stages, "two-part-cup")
    for name in ("wire", "neckline", "wing top"):
        left, right = (found[f"{name} {side}"].points for side in ("left", "right"))
        image = left * [-1.0, 1.0, 1.0] + [2.0 * middle, 0.0, 0.0]
        away = np.linalg.norm(image[:, None] - right, axis=2).min(axis=1)
        assert np.median(away) < 3.0, name


def test_what_a_body_or_a_block_cannot_give_is_refused_with_the_reason(built: Built) -> None:
    places = drawing(built("person")).places
    for word in (
        "root",
        "somewhere 3",
        "point hip",
        "root 400",
        "root 180*99",
        "root 0+9999",
        "ring under 99",
    ):
        with pytest.raises(PatternError, match="not a place"):
            places.place(word, "left", {}, {})
    for word in ("apex", "root 180", "ring under 0.5"):
        with pytest.raises(PatternError, match="side"):
            places.place(word, "", {}, {})
    with pytest.raises(PatternError, match="'hip'"):
        places.place("front hip", "left", {}, {})
    with pytest.raises(PatternError, match="not drawn yet"):
        places.place("apex > neckline", "left", {}, {})
    with pytest.raises(PatternError, match="There is no block"):
        find_block("three")
    lower = drawing(trunk_stages()).places
    assert lower.place("front hip", "", {}, {})[2] == lower.lower.points["hip"].position[2]
    assert lower.place("point buttock", "left", {}, {})[0] > 20.0


def test_a_broken_block_says_what_is_wrong() -> None:
    text = (resources.files("resources") / "blocks" / "two-part-cup.json").read_text(encoding="utf-8")

    def broken(change: Callable[[dict], object]) -> str:
        data = json.loads(text)
        change(data)
        return json.dumps(data)

    for wrong, why in (
        ("{", "property name"),
        (broken(lambda d: d.pop("seams")), "seams"),
        (broken(lambda d: d["seams"].append(d["seams"][0])), "used twice"),
        (broken(lambda d: d["levels"][0].update(reference="nowhere")), "nowhere"),
        (broken(lambda d: d["seams"][5].update(level="hem")), "hem"),
        (broken(lambda d: d.update(panels=[])), "no panel"),
        (broken(lambda d: d["seams"][1].update(places=["apex"])), "fewer than two"),
    ):
        with pytest.raises(PatternError, match=why):
            block_of("mine", wrong)
