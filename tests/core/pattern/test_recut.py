"""A garment cut again is the garment cut afresh, and panels that no changed seam touches are kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core.document.block import Block, Level
from core.errors import PatternError
from core.pattern.block_library import find_block
from core.pattern.garment import CutGarment, cut_garment
from core.pattern.places import BodyPlaces
from core.pattern.recut import recut
from core.pattern.seam_curves import SeamDrawing
from core.pipeline.build import Stages

Built = Callable[[str], Stages]
BLOCK = "two-part-cup"


@cache
def drawing(stages: Stages) -> SeamDrawing:
    return SeamDrawing(BodyPlaces.of(stages))


@cache
def first(stages: Stages, bridged: bool = False) -> CutGarment:
    return cut_garment(drawing(stages), find_block(BLOCK), bridged)


def changed(seam: str, former: str, place: str) -> Block:
    """The block with another place of a seam."""
    block = find_block(BLOCK)

    def own(words: tuple[str, ...]) -> tuple[str, ...]:
        assert former in words
        return tuple(place if word == former else word for word in words)

    seams = (replace(each, places=own(each.places)) if each.name == seam else each for each in block.seams)
    return replace(block, seams=tuple(seams))


def plan(name: str) -> str:
    return name.removesuffix(" left").removesuffix(" right")


def kept(one: CutGarment, other: CutGarment) -> set[str]:
    return {a.name for a, b in zip(one.panels, other.panels, strict=True) if a is b}


MOVES = [
    ("side seam", "ring band 0.50", "ring band 0.52", {"upper cup", "lower cup", "bridge"}),
    ("bridge seam", "root 205", "root 215", {"upper cup", "wing"}),
    ("cup seam", "root 72", "root 80", {"bridge", "wing"}),
]


@pytest.mark.parametrize(("seam", "former", "place", "same"), MOVES)
def test_a_garment_cut_again_is_the_one_cut_afresh(
    built: Built, seam: str, former: str, place: str, same: set[str]
) -> None:
    stages, block = built("mannequin"), changed(seam, former, place)
    found = recut(first(stages), drawing(stages), block)
    fresh = cut_garment(SeamDrawing(drawing(stages).places), block, is_bridged=False)
    assert {plan(name) for name in kept(first(stages), found)} == same
    vertices = stages.body.smoothed.vertices
    for one, other in zip(found.panels, fresh.panels, strict=True):
        assert (one.name, one.cloth) == (other.name, other.cloth)
        assert [(s.name, s.partner) for s in one.sides] == [(s.name, s.partner) for s in other.sides]
        for mine, theirs in zip(one.sides, other.sides, strict=True):
            places = one.places(vertices)[mine.points], other.places(vertices)[theirs.points]
            np.testing.assert_allclose(*places, atol=1e-6)
        assert one.covers == pytest.approx(other.covers, rel=1e-9)


def test_kept_panels_keep_the_points_of_their_seams(built: Built) -> None:
    stages = built("mannequin")
    block = changed("cup seam", "root 72", "root 84")  # the lower cup is larger: its points are elsewhere
    found = recut(first(stages), drawing(stages), block)
    panels = {panel.name: panel for panel in found.panels}
    vertices = stages.body.smoothed.vertices
    sewn = 0
    for panel in found.panels:
        for number, side in enumerate(panel.sides):
            if side.partner is None:
                continue
            other = panels[side.partner[0]]
            back = other.sides[side.partner[1]]
            assert back.partner == (panel.name, number)
            mine = panel.places(vertices)[side.points]
            np.testing.assert_allclose(mine, other.places(vertices)[back.points][::-1], atol=1e-6)
            sewn += 1
    assert sewn == sum(side.partner is not None for panel in first(stages).panels for side in panel.sides)


def test_a_seam_whose_ends_stay_touches_the_panels_beside_it_alone(built: Built) -> None:
    stages, block = built("mannequin"), changed("cup seam", "apex", "root 180*0.15")
    before = first(stages, bridged=True)
    found = recut(before, drawing(stages), block)
    assert {plan(name) for name in kept(before, found)} >= {"bridge", "wing"}
    assert not kept(before, found) & {"lower cup left", "upper cup left"}
    fresh = cut_garment(SeamDrawing(drawing(stages).places), block)
    vertices = stages.body.smoothed.vertices
    for one, other in zip(found.panels, fresh.panels, strict=True):
        for mine, theirs in zip(one.sides, other.sides, strict=True):
            places = (each.places(vertices)[side.points] for each, side in ((one, mine), (other, theirs)))
            ends = [np.diff(each, axis=0) for each in places]
            long, short = (float(np.linalg.norm(each, axis=1).sum()) for each in ends)
            assert long == pytest.approx(short, abs=1.0), "but for cloth over hollows, which was taut apart"


def test_what_is_not_cut_keeps_all_panels_or_none(built: Built) -> None:
    stages = built("mannequin")
    block, before = find_block(BLOCK), first(stages)
    seams = tuple(replace(each, allowance=9.0) for each in block.seams)
    wider = recut(before, drawing(stages), replace(block, seams=seams))
    assert wider.panels == before.panels
    assert {curve.seam.allowance for curve in wider.curves} == {9.0}
    panels = tuple(replace(each, turn=45.0 * (each.name == "bridge")) for each in block.panels)
    turned = recut(before, drawing(stages), replace(block, panels=panels))
    assert {panel.name for panel in turned.panels} - kept(before, turned) == {"bridge"}
    lower = tuple(Level(each.name, each.reference, each.above - 4.0) for each in block.levels)
    assert not kept(before, recut(before, drawing(stages), replace(block, levels=lower)))


def test_a_seam_that_no_longer_closes_is_refused_as_in_the_whole_garment(built: Built) -> None:
    stages, block = built("mannequin"), changed("side seam", "ring band 0.50", "ring under 0.50+15")
    with pytest.raises(PatternError) as whole:
        cut_garment(drawing(stages), block)
    with pytest.raises(PatternError) as again:
        recut(first(stages), drawing(stages), block)
    assert str(again.value) == str(whole.value)
