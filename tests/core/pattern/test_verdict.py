"""The verdict on pieces and seams: what is refused, with the reason, and what is only told."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import pytest

from core.document.garment_pattern import GarmentPattern
from core.pattern.cloth_library import cloth_of_stretch, with_cloth
from core.pattern.garment import MISFIT, SEWN, Pattern, worn_skin
from core.pattern.seam_matching import SeamFit
from core.pipeline.build import Stages

Built = Callable[[str], Stages]


def cup_seam(pattern: Pattern) -> SeamFit:
    return next(fit for fit in pattern.matched.fits if fit.seam.name == "cup seam left")


def with_ratio(pattern: Pattern, ratio: float) -> Pattern:
    """The pattern as it is, but with a left cup seam whose sides should differ."""
    kept = cup_seam(pattern).seam
    seams = tuple(replace(each, ratio=ratio) if each is kept else each for each in pattern.matched.seams)
    return replace(pattern, matched=replace(pattern.matched, seams=seams))


def test_the_skin_at_rest_has_no_noise_of_the_scanner(built: Built) -> None:
    body = built("mannequin").body
    assert worn_skin(built("mannequin"), body.mesh.vertices) == pytest.approx(body.smoothed.vertices)
    assert worn_skin(built("mannequin"), body.mesh.vertices + 2.0) == pytest.approx(
        body.smoothed.vertices + 2.0
    )


def test_all_of_a_bra_on_a_firm_bust_fits(bra: Pattern) -> None:
    assert bra.fits_cloths
    assert [bra.problem(flat) for flat in bra.flats] == [None] * 11


def test_strain_beyond_its_cloth_names_both_figures(bra: Pattern) -> None:
    stiff = replace(cloth_of_stretch("stiff", (0.04, 0.04)), title="Stiff lining", limit=0.02)
    lower = next(flat for flat in bra.flats if flat.panel.name == "lower cup left")
    found = replace(bra, cloths={**bra.cloths, lower.panel.cloth: stiff})
    within = 100.0 * bra.strains["lower cup left"].within
    text = str(found.problem(lower))
    assert {f"{within:.1f} %", "2 %"} <= set(re.findall(r"[\d.]+ %", text))
    assert "Stiff lining" in text
    assert not found.fits_cloths


def test_a_seam_that_still_differs_is_refused_on_both_of_its_pieces(bra: Pattern) -> None:
    length = cup_seam(bra).together[0]
    assert with_ratio(bra, 1.0 + 0.9 * SEWN / length).fits_cloths
    found = with_ratio(bra, 1.0 + 1.2 * SEWN / length)
    said = "The sides of the cup seam left differ by 0.06 mm."
    assert str(found.seam_problem(cup_seam(found).seam)) == said
    refused = {flat.panel.name: str(found.problem(flat)) for flat in found.flats if not found.fits(flat)}
    assert refused == {"upper cup left": said, "lower cup left": said}


def test_a_seam_that_is_gathered_on_purpose_is_no_misfit(bra: Pattern) -> None:
    fit = cup_seam(bra)
    gathered = replace(fit, seam=replace(fit.seam, ratio=1.2), alone=(120.0, 100.0))
    assert bra.seam_note(gathered) is None
    assert bra.seam_note(replace(gathered, alone=(100.0, 100.0))) is not None


def test_a_misfit_before_matching_names_the_longer_piece(bra: Pattern) -> None:
    fit = replace(cup_seam(bra), alone=(150.0, 158.0))
    assert str(bra.seam_note(fit)) == (
        "The lower cup left is 8.0 mm longer than the upper cup left before matching: ease it in, "
        "or add a seam."
    )
    longer = replace(fit, alone=(158.0, 150.0))
    assert str(bra.seam_note(longer)).startswith("The upper cup left is 8.0 mm longer than the lower cup")
    assert bra.seam_note(replace(fit, alone=(100.0, 100.0 * (1.0 - 0.9 * MISFIT)))) is None


def test_a_cloth_without_stretch_bags_where_it_is_pressed_and_one_with_ease_does_not(bra: Pattern) -> None:
    said = {flat.panel.name: bra.note(flat) for flat in bra.flats}
    assert str(said["lower cup left"]).startswith("Bags across on ")
    assert said["wing left"] is None, "15 % of ease"
    wing = next(flat for flat in bra.flats if flat.panel.name == "wing left")
    assert bra.worn_stretch(wing) == pytest.approx((0.15, 0.0), abs=0.002)
    tight = replace(wing, ease=(-0.05, 0.0))
    flats = tuple(tight if each is wing else each for each in bra.flats)
    loose = replace(bra, matched=replace(bra.matched, flats=flats, seams=()))
    assert str(loose.note(tight)).startswith("Bags across on 100 %")


def test_a_seam_keeps_its_own_allowance(bra: Pattern) -> None:
    block = bra.garment.block
    seams = tuple(replace(s, allowance=11.0) if s.name == "cup seam" else s for s in block.seams)
    own = replace(bra, garment=replace(bra.garment, block=replace(block, seams=seams)))
    widths = {(p.name, s.name): s.allowance for p in own.pieces(6.0) for s in p.sides}
    assert {key: width for key, width in widths.items() if width != 6.0} == {
        ("upper cup", "cup seam"): 11.0,
        ("lower cup", "cup seam"): 11.0,
    }


def test_a_cloth_of_ones_own_serves_the_pieces_that_are_named(bra: Pattern) -> None:
    mine = cloth_of_stretch("my net", (0.4, 0.3))
    plan = with_cloth(GarmentPattern(bra.garment.block), "wing", mine)
    assert {panel.name: panel.cloth for panel in plan.block.panels}["wing"] == "my net"
    assert [panel.cloth for panel in plan.block.panels].count("my net") == 1
    assert plan.cloths == (mine,)
    assert with_cloth(plan, "wing", mine) == plan
    assert {panel.cloth for panel in with_cloth(plan, "all", mine).block.panels} == {"my net"}
