"""Ways out for a piece over its limit: each leaves what it is said to leave, and nothing worse is offered."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from core.pattern.block_library import block_of, block_text, find_block
from core.pattern.cloth_library import built_in
from core.pattern.garment import Pattern, cut_garment
from core.pattern.piece_fixes import CLOTH, DART, SEAM, PieceFix, piece_fixes
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pipeline.build import Stages

CLOTHS = {cloth.name: cloth for cloth in built_in()}
PIECE = "cup left"


@pytest.fixture(scope="module")
def tried(coarsely_built: Callable[[str], Stages]) -> tuple[Stages, Pattern, tuple[PieceFix, ...]]:
    stages = coarsely_built("mannequin")
    drawing = SeamDrawing(BodyPlaces.of(stages))
    vertices = stages.body.smoothed.vertices
    found = cut_garment(drawing, find_block("one-part-cup")).flat(vertices, CLOTHS)
    return stages, found, piece_fixes(found, PIECE, drawing, vertices)


def test_a_dart_another_cloth_and_a_seam_are_offered(tried: tuple) -> None:
    _, before, offers = tried
    assert not before.fits_cloths
    assert {offer.kind for offer in offers} == {DART, CLOTH, SEAM}
    for offer in offers:
        assert offer.fits == (offer.left <= offer.limit)
        assert offer.left < before.strains[PIECE].within or offer.fits
        assert f"{100.0 * offer.left:.1f} % of {100.0 * offer.limit:g} %" in str(offer.message)
    fits = [offer.fits for offer in offers]
    assert fits == sorted(fits, reverse=True)
    assert fits[0]
    limits = [offer.limit for offer in offers if offer.kind == CLOTH]
    assert limits == sorted(limits)


@pytest.mark.parametrize("kind", [DART, CLOTH, SEAM])
def test_a_changed_block_leaves_what_is_said_also_from_its_file(tried: tuple, kind: str) -> None:
    stages, before, offers = tried
    offer = next(each for each in offers if each.kind == kind)
    block = block_of(offer.block.name, block_text(offer.block))
    garment = cut_garment(SeamDrawing(BodyPlaces.of(stages)), block)
    after = garment.flat(stages.body.smoothed.vertices, CLOTHS)
    worst = max(after.strains[flat.panel.name].within for flat in after.flats)
    assert worst == pytest.approx(offer.left, abs=1e-6)
    added = len(after.flats) - len(before.flats)
    assert added == (2 if kind == SEAM else 0)
