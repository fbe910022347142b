"""Seams edited by hand: points added and removed, seams and darts drawn and removed."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from core.document.block import Block
from core.errors import PatternError
from core.geometry.mesh import Points
from core.pattern.block_library import block_of, block_text, find_block
from core.pattern.garment import CutGarment, cut_garment
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pattern.seam_edits import with_drawn_seam, with_point, without_point, without_seam
from core.pipeline.build import Stages

Built = Callable[[str], Stages]


@cache
def drawing(stages: Stages) -> SeamDrawing:
    return SeamDrawing(BodyPlaces.of(stages))


@cache
def garment(stages: Stages, block: str) -> CutGarment:
    return cut_garment(drawing(stages), find_block(block))


def curve(made: SeamDrawing, block: Block, name: str) -> Points:
    return next(each.points for each in made.curves(block) if each.name == name)


def places(stages: Stages, *words: str, side: str = "left") -> Points:
    made = drawing(stages)
    levels = made.levels(find_block("two-part-cup"))
    return np.array([made.places.place(word, side, levels, {}) for word in words])


def names(block: Block) -> set[str]:
    return {plan.name for plan in block.panels}


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_point_is_added_where_it_is_and_removed_again(built: Built, side: str) -> None:
    made, block, name = drawing(built("mannequin")), find_block("two-part-cup"), f"cup seam {side}"
    before = curve(made, block, name)
    place = before[len(before) * 3 // 4]
    more = with_point(made, block, name, made.curves(block), place)
    assert len(more.seam(name).places) == 4
    after = curve(made, more, name)
    assert np.linalg.norm(after - place, axis=1).min() < 2.5
    away = np.linalg.norm(after[:, None] - before, axis=2).min(axis=1)
    assert away.max() < 3.0, "the seam stays where it was"
    assert without_point(more, name, 2) == block
    halved = with_point(made, block, name, made.curves(block))
    assert len(halved.seam(name).places) == 4, "in the middle of its longest stretch"
    with pytest.raises(PatternError, match="ends of a seam"):
        without_point(more, name, 3)


def test_roots_have_no_points_to_add(built: Built) -> None:
    made, block = drawing(built("mannequin")), find_block("two-part-cup")
    with pytest.raises(PatternError, match="drawn through points"):
        with_point(made, block, "wire left", made.curves(block), np.zeros(3))


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_seam_from_seam_to_seam_divides_the_piece_on_both_sides(built: Built, side: str) -> None:
    stages = built("mannequin")
    own = garment(stages, "two-part-cup")
    drawn = places(stages, "root 180", "root 180*0.5", "apex", side=side)
    block = with_drawn_seam(drawing(stages), own, drawn)
    assert names(block) - names(own.block) == {"inner lower cup", "outer lower cup"}
    assert names(own.block) - names(block) == {"lower cup"}
    assert [word.partition(">")[2].strip() for word in block.seams[-1].places] == ["wire", "", "cup seam"]
    cut = cut_garment(drawing(stages), block)
    former = {panel.name: panel.covers for panel in own.panels}
    now = {panel.name: panel.covers for panel in cut.panels}
    for each in ("left", "right"):
        parts = now[f"inner lower cup {each}"] + now[f"outer lower cup {each}"]
        assert parts == pytest.approx(former[f"lower cup {each}"], rel=2e-3)
    assert block_of("own", block_text(block)).panels == block.panels, "it can be saved"
    assert names(without_seam(cut, f"{block.seams[-1].name} left")) == names(own.block)


def test_a_line_that_ends_within_a_piece_is_a_dart(built: Built) -> None:
    stages = built("mannequin")
    own = garment(stages, "one-part-cup")
    drawn = places(stages, "apex", "root 200*0.5", "root 200")
    block = with_drawn_seam(drawing(stages), own, drawn)
    dart = block.seams[-1]
    assert (dart.name, dart.slit, dart.each) == ("cup dart", True, True)
    assert dart.places[0].endswith("> wire"), "it starts on the seam, however it was drawn"
    assert names(block) == names(own.block)
    cut = cut_garment(drawing(stages), block)
    assert {side.name for panel in cut.panels for side in panel.sides} >= {"cup dart left", "cup dart right"}
    assert without_seam(cut, "cup dart left") == own.block


def test_a_seam_over_the_middle_is_drawn_once(built: Built) -> None:
    stages = built("mannequin")
    made, own = drawing(stages), garment(stages, "two-part-cup")
    top, bottom = (curve(made, own.block, name) for name in ("bridge seam left", "bridge seam right"))
    drawn = np.array([top[len(top) // 2], bottom[len(bottom) // 2]])
    block = with_drawn_seam(made, own, drawn)
    assert not block.seams[-1].each
    assert names(block) - names(own.block) == {"upper bridge", "lower bridge"}
    assert len(cut_garment(made, block).panels) == len(own.panels) + 1


def test_lines_that_divide_nothing_are_refused(built: Built) -> None:
    stages = built("mannequin")
    made, own = drawing(stages), garment(stages, "two-part-cup")
    with pytest.raises(PatternError, match="does not start on a seam"):
        with_drawn_seam(made, own, places(stages, "root 150*0.5", "root 210*0.5"))
    along = curve(made, own.block, "wire left")
    with pytest.raises(PatternError, match="does not divide"):
        with_drawn_seam(made, own, along[[5, 15, 25]])


@pytest.mark.parametrize(
    ("seam", "why"),
    [
        ("wing top left", "ends on this seam"),
        ("wire left", "exactly two pieces"),
        ("centre back", "exactly two pieces"),
    ],
)
def test_a_seam_that_others_need_is_kept(built: Built, seam: str, why: str) -> None:
    with pytest.raises(PatternError, match=why):
        without_seam(garment(built("mannequin"), "two-part-cup"), seam)


def test_pieces_become_one_where_their_seam_is_removed(built: Built) -> None:
    stages = built("mannequin")
    own = garment(stages, "two-part-cup")
    block = without_seam(own, "side seam right")
    assert names(block) == names(own.block) - {"wing"}
    assert len(cut_garment(drawing(stages), block).panels) == len(own.panels) - 2
