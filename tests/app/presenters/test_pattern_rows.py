"""Rows of pieces and seams: their figures are those of the pattern, their titles in the language in use."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from app.i18n.catalog import using_language
from app.presenters.messages import render
from app.presenters.pattern import block_title, piece_rows, seam_rows
from core.document.garment_pattern import GarmentPattern
from core.messages import Message, PieceName
from core.pattern.annotation import piece_words
from core.pattern.block_library import find_block
from core.pattern.garment import Pattern, pattern_of
from core.pipeline.build import Stages


@pytest.fixture(scope="module")
def cup(built: Callable[[str], Stages]) -> Pattern:
    stages = built("mannequin")
    return pattern_of(stages, stages.body.mesh.vertices, GarmentPattern(find_block("two-part-cup")))


def test_pieces_have_their_figures_and_the_reason_why_they_do_not_fit(cup: Pattern) -> None:
    rows = {row.name: row for row in piece_rows(cup)}
    assert len(rows) == 9
    upper, lower = rows["upper cup left"], rows["lower cup left"]
    assert (upper.title, upper.cloth, upper.limit_percent) == ("Upper cup, left", "Cup tricot, stable", 8.0)
    flat = next(each for each in cup.flats if each.panel.name == "upper cup left")
    assert upper.area_cm2 == pytest.approx(0.01 * flat.areas.sum())
    assert (upper.fits, upper.reason) == (True, "")
    assert not lower.fits
    assert (upper.is_overstrained, lower.is_overstrained) == (False, True)
    assert lower.reason == (
        f"Strain of {lower.strain_percent:.1f} % on 95 % of the area exceeds 8 %, "
        "the limit of Cup tricot, stable."
    )
    assert all(row.fits == (row.strain_percent <= row.limit_percent) for row in rows.values())


def test_seams_have_the_lengths_of_both_sides_before_and_after(cup: Pattern) -> None:
    seam = next(row for row in seam_rows(cup) if row.name == "cup seam left")
    assert seam.title == "Cup seam, left"
    assert seam.pieces == ("upper cup left", "lower cup left")
    assert seam.lengths_mm[0] == pytest.approx(seam.lengths_mm[1], abs=0.05)
    longer = seam.alone_mm[1] - seam.alone_mm[0]
    assert longer > 5.0
    assert f"{longer:.1f} mm longer than the upper cup left" in seam.note
    assert seam.on_body_mm == pytest.approx(seam.lengths_mm[0], rel=0.1)


def test_titles_are_japanese_in_rows_and_on_paper(cup: Pattern) -> None:
    with using_language("ja"):
        notes = [row.note for row in seam_rows(cup) if row.name == "cup seam left"]
        assert notes[0].startswith("縫い目を合わせる前は下カップ（左）が上カップ（左）より")
        assert next(row.title for row in piece_rows(cup) if row.name == "lower cup left") == "下カップ（左）"
        titles = {row.name: row.title for row in seam_rows(cup)}
        assert titles["cup seam left"] == "カップ縫い目（左）"
        assert block_title(cup.garment.block).startswith("二枚はぎカップ")
        words = {piece_words(piece, render)[0].partition("（")[0] for piece in cup.pieces()}
        assert words == {"上カップ", "下カップ", "前中心布", "土台", "脇布"}
        assert render(Message("The {piece}", piece=PieceName("my own left"))) == "The my own left"
