"""Places that are dragged: the new word is of the same kind and means the place that was dragged to."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from whole_trunk import trunk_stages

from core.document.block import RING, ROOT, Level
from core.errors import PatternError
from core.geometry.closest_point import nearest_faces
from core.geometry.mesh import Points
from core.pattern.block_library import built_in_blocks, find_block
from core.pattern.place_words import moved_level, moved_span, moved_word, seam_handles, word_at
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pipeline.build import Stages

Built = Callable[[str], Stages]
LEVELS = {"band": "under", "top": "bust"}


@cache
def places(stages: Stages) -> BodyPlaces:
    return BodyPlaces.of(stages)


def heights(own: BodyPlaces) -> dict[str, float]:
    return {name: own.height(reference) - 10.0 for name, reference in LEVELS.items()}


def dragged(own: BodyPlaces, word: str, side: str, way: tuple[float, float, float]) -> tuple[str, float]:
    """The new word, and how far its place is from where the old one was dragged to [mm]."""
    levels = heights(own)
    start = own.place(word, side, levels, {})
    target = nearest_faces(own.skin, (start + np.array(way))[None], own.skin.centroid_tree)[1][0]
    new = moved_word(own, word, side, levels, target)
    return new, float(np.linalg.norm(own.place(new, side, levels, {}) - target))


BUST_WORDS = [
    "apex",
    "root 205",
    "root 72",
    "root 180*0.55",
    "root 10+12",
    "ring band 0.35",
    "ring top 0.8+8",
]
ways = st.tuples(*(st.floats(-12.0, 12.0) for _ in range(3)))


@settings(deadline=None, max_examples=25, derandomize=True)
@given(word=st.sampled_from(BUST_WORDS), side=st.sampled_from(["left", "right"]), way=ways)
def test_a_word_of_the_bust_follows_its_place(
    built: Built, word: str, side: str, way: tuple[float, float, float]
) -> None:
    own = places(built("person"))
    new, away = dragged(own, word, side, way)
    if new != word:
        assert new.partition(" ")[0] == ("root" if word == "apex" else word.partition(" ")[0])
        assert ("*" in new) == ("*" in word or word == "apex")
    assert away < 4.5, new  # OFF, and half of a degree or a step


@settings(deadline=None, max_examples=15, derandomize=True)
@given(
    word=st.sampled_from(["below r5c6", "below r2.8c8", "below r7.6c4", "point buttock"]),
    side=st.sampled_from(["left", "right"]),
    way=ways,
)
def test_a_word_of_the_lower_trunk_follows_its_place(
    word: str, side: str, way: tuple[float, float, float]
) -> None:
    new, away = dragged(places(trunk_stages()), word, side, way)
    assert new == word or "c" in new
    assert away < 6.0, new  # half a tenth of a cell in both directions, where the skin is curved


def test_directions_are_those_of_the_word(built: Built) -> None:
    own = places(built("mannequin"))
    levels, breast = heights(own), own.breasts["left"]
    assert moved_word(
        own, "root 205", "left", levels, breast.places(220.0, breast.root_distance(220.0))[0]
    ) == ("root 220")
    further = breast.places(220.0, breast.root_distance(220.0) + 9.0)[0]
    assert moved_word(own, "root 205", "left", levels, further) == "root 220+9"
    half = breast.places(96.0, 0.4 * breast.root_distance(96.0))[0]
    assert moved_word(own, "root 90*0.55 > neckline", "left", levels, half) == "root 96*0.40 > neckline"
    assert moved_word(own, "apex", "left", levels, half) == "root 96*0.40"
    aside = own.at_share(levels["band"], 0.62, "right")
    assert moved_word(own, "ring band 0.5 right", "left", levels, aside) == "ring band 0.62 right"
    risen = own.at_share(levels["band"] + 15.0, 0.25, "left")
    assert moved_word(own, "ring band 0.2", "left", levels, risen) == "ring band 0.25+15"
    front = own.place("front top+22", "", levels, {})
    assert moved_word(own, "front top", "", levels, front) == "front top+22"
    assert moved_word(own, "front top+5", "", levels, front + np.array([30.0, 0.0, -22.0])) == "front top"
    corner = own.place("r2.3c1.6", "right", levels, {})
    assert moved_word(own, "r2c3", "right", levels, corner) == "r2.3c1.6"


@pytest.mark.parametrize("block", ["two-part-cup", "triangle-bralette", "brief"])
def test_a_place_that_is_not_moved_keeps_its_word(built: Built, block: str) -> None:
    plan = next(each for each in built_in_blocks() if each.name == block)
    own = places(trunk_stages() if plan.needs_lower_trunk else built("person"))
    drawing = SeamDrawing(own)
    levels, drawn = drawing.levels(plan), {each.name: each.points for each in drawing.curves(plan)}
    for seam in plan.seams:
        for _, side in seam.named():
            for at, place in seam_handles(drawing, seam, side, levels, drawn):
                if seam.places and ">" not in seam.places_of(side)[at]:
                    word = seam.places_of(side)[at]
                    assert moved_word(own, word, side, levels, place) == word


def test_ends_of_roots_and_rings_are_dragged(built: Built) -> None:
    own = places(built("person"))
    drawing, block = SeamDrawing(own), find_block("two-part-cup")
    levels, drawn = drawing.levels(block), {each.name: each.points for each in drawing.curves(block)}
    for seam in block.seams:
        if seam.kind in (RING, ROOT):
            handles = seam_handles(drawing, seam, "left", levels, drawn)
            assert [at for at, _ in handles] == [0, 1]
            for at, place in handles:
                span = moved_span(own, seam, at, "left", levels, place)
                np.testing.assert_allclose(span, seam.span, atol=1.0 if seam.kind == ROOT else 0.005)
    wire, breast = block.seam("wire"), own.breasts["right"]
    target: Points = breast.places(60.0, breast.root_distance(60.0))[0]
    assert moved_span(own, wire, 1, "right", levels, target) == (308.0, 60.0)
    with pytest.raises(PatternError, match="through places"):
        moved_span(own, block.seam("cup seam"), 0, "left", levels, target)
    level = Level("band", "under", -18.0)
    height = own.height("under") - 25.2
    assert moved_level(own, level, np.array([0.0, 0.0, height])) == -25.0


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_new_place_is_told_by_the_breast_or_a_mesh_and_by_its_side(built: Built, side: str) -> None:
    own = places(built("mannequin"))
    on_breast = own.place("root 205*0.40", side, {}, {})
    assert word_at(own, side, on_breast) == "root 205*0.40"
    assert word_at(own, "", on_breast) == f"root 205*0.40 {side}"
    for level in ("under", "bust"):
        for share in np.arange(0.0, 1.01, 0.1):
            target = own.place(f"ring {level} {share:.1f}-12", side, {}, {})
            word = word_at(own, side, target)
            assert np.linalg.norm(own.place(word, side, {}, {}) - target) < 3.1, word
            assert not (share > 0.6 and word.startswith("root")), "the back is no part of a breast"
