"""Advice on a pattern, as it is printed: darts, and ways out for a piece over its limit."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from app.cli.pattern_advice import dart_lines, fix_lines
from core.errors import PatternError
from core.pattern.block_library import find_block
from core.pattern.cloth_library import built_in
from core.pattern.garment import Pattern, cut_garment
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pipeline.build import Stages


@pytest.fixture(scope="module")
def stages(coarsely_built: Callable[[str], Stages]) -> Stages:
    return coarsely_built("mannequin")


def pattern(stages: Stages, name: str) -> Pattern:
    garment = cut_garment(SeamDrawing(BodyPlaces.of(stages)), find_block(name))
    return garment.flat(stages.body.smoothed.vertices, {cloth.name: cloth for cloth in built_in()})


def test_each_dart_is_a_row(stages: Stages) -> None:
    head, titles, *rows = dart_lines(pattern(stages, "one-part-cup"), stages, "cup left")
    assert head.startswith("Darts of the piece cup left: 1")
    assert titles.split() == ["from", "at", "%", "clock", "work", "left", "%", "strain", "%"]
    assert len(rows) > 15
    assert {row.split()[0] for row in rows} == {"wire", "neckline", "armhole"}


def test_a_piece_that_is_not_there_is_refused_with_those_that_are(stages: Stages) -> None:
    with pytest.raises(PatternError) as refused:
        list(dart_lines(pattern(stages, "one-part-cup"), stages, "cup"))
    assert "cup left, cup right" in str(refused.value.hint)


def test_pieces_that_fit_need_no_way_out(stages: Stages) -> None:
    found = pattern(stages, "long-line-band")
    assert found.fits_cloths
    assert not list(fix_lines(found, stages, stages.body.smoothed.vertices))
