"""Seams moved by their points: ways, roots, rings and levels, on both sides or on one."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from core.document.block import Block
from core.geometry.mesh import Points
from core.pattern.block_library import find_block
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pattern.seam_moves import LEVEL, handles_of, moved_block
from core.pipeline.build import Stages

Built = Callable[[str], Stages]
BLOCK = find_block("two-part-cup")


@cache
def drawing(stages: Stages) -> SeamDrawing:
    return SeamDrawing(BodyPlaces.of(stages))


def handles(made: SeamDrawing, block: Block, curve: str) -> dict[int, Points]:
    return dict(handles_of(made, block, curve, made.curves(block)))


def moved(
    stages: Stages, curve: str, handle: int, off: tuple[float, float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Where a handle was wished, and where it is then [mm]."""
    made = drawing(stages)
    place = handles(made, BLOCK, curve)[handle] + np.array(off)
    after = handles(made, moved_block(made, BLOCK, curve, handle, place), curve)[handle]
    return [place, after]


@pytest.mark.parametrize(
    ("curve", "handle", "off"),
    [
        ("cup seam left", 1, (4.0, 0.0, -8.0)),
        ("cup seam right", 2, (0.0, 0.0, 8.0)),
        ("wire left", 1, (0.0, 0.0, 9.0)),
        ("wing top left", 1, (0.0, 10.0, 5.0)),
        ("band edge left", LEVEL, (0.0, 0.0, -7.0)),
    ],
)
def test_a_handle_goes_where_it_is_dragged(
    built: Built, curve: str, handle: int, off: tuple[float, float, float]
) -> None:
    wished, found = moved(built("mannequin"), curve, handle, off)
    assert np.linalg.norm(found - wished) < np.linalg.norm(off), "nearer than it was"
    assert abs(found[2] - wished[2]) < 3.5


def test_an_end_of_a_ring_stops_short_of_the_other_one(built: Built) -> None:
    made = drawing(built("mannequin"))
    band = next(each for each in made.curves(BLOCK) if each.name == "band edge left")
    moved = moved_block(made, BLOCK, "band edge left", 0, band.points[-1]).seam("band edge")
    assert moved.span[0] < moved.span[1] == BLOCK.seam("band edge").span[1]


def test_both_sides_are_moved_unless_each_has_its_own(built: Built) -> None:
    made = drawing(built("mannequin"))
    place = handles(made, BLOCK, "cup seam right")[1] + [0.0, 0.0, -8.0]
    both = moved_block(made, BLOCK, "cup seam right", 1, place).seam("cup seam")
    assert both.right == ()
    assert both.places[1].startswith("root 1")
    apart = BLOCK.with_own_sides("cup seam", apart=True)
    one = moved_block(made, apart, "cup seam right", 1, place).seam("cup seam")
    assert one.places == BLOCK.seam("cup seam").places, "the left side stays"
    assert one.right[1] == both.places[1]
    assert apart.with_own_sides("cup seam", apart=False) == BLOCK
    curves = {
        each.name: each.points for each in made.curves(moved_block(made, apart, "cup seam right", 1, place))
    }
    left, right = (curves[f"cup seam {side}"][:, 2].min() for side in ("left", "right"))
    assert right < left - 4.0
