"""Pieces sewn together again: a developable garment comes back exactly, a bra nearly."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from curved_patches import EVEN, cylinder, loop, sheet

from core.document.block import Block, PanelPlan
from core.pattern.block_library import find_block
from core.pattern.cloth_library import built_in
from core.pattern.garment import CutGarment, Pattern, cut_garment
from core.pattern.panel import PanelSeed, cut_panels
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pattern.seam_matching import match, seams_of
from core.pattern.sewn_again import sewn_again
from core.pattern.surface_cut import cut_surface
from core.pattern.surface_trace import SurfaceCurve
from core.pipeline.build import Stages


def on_cylinder() -> Pattern:
    """Two panels side by side on a cylinder."""
    skin = sheet(cylinder, 160.0, 120.0)
    edge = loop("edge", cylinder, [(-50.0, -40.0), (50.0, -40.0), (50.0, 40.0), (-50.0, 40.0)])
    v = np.linspace(-40.0, 40.0, 80)
    middle = SurfaceCurve("seam", np.stack(cylinder(0.1 * v, v), axis=1))
    places = [np.array([float(x) for x in cylinder(np.array(u), np.array(0.0))]) for u in (-30.0, 30.0)]
    seeds = tuple(PanelSeed(name, place, "even") for name, place in zip(("one", "two"), places, strict=True))
    panels = cut_panels(cut_surface(skin, (*edge, middle)), seeds, 5.0)
    block = Block("two", "Two", (), (), (PanelPlan("one", "apex", "even"),))
    on_body = tuple(panel.places(skin.vertices) for panel in panels)
    matched = match(panels, on_body, [EVEN, EVEN], seams_of(panels))
    return Pattern(CutGarment(block, (), panels), matched, on_body, {})


def test_a_developable_garment_comes_back_as_it_was() -> None:
    pattern = on_cylinder()
    again = sewn_again(pattern)
    assert again.worst < 0.05
    (seam,) = pattern.matched.seams
    counts = [len(flat.worn) for flat in pattern.flats]
    assert len(again.places) == sum(counts) - len(seam.points[0]), "sewn points are one"


def test_a_sewn_bra_is_near_the_body_and_as_large_as_its_pieces(
    coarsely_built: Callable[[str], Stages],
) -> None:
    stages = coarsely_built("mannequin")
    garment = cut_garment(SeamDrawing(BodyPlaces.of(stages)), find_block("three-part-cup"))
    cloths = {cloth.name: cloth for cloth in built_in()}
    again = sewn_again(garment.flat(stages.body.smoothed.vertices, cloths))
    assert again.rms < 2.0
    assert again.worst < 8.0
    assert again.rms > 0.1, "pieces of cloth with strain are not the body itself"
    start = np.linalg.norm(again.worn.mean(axis=0) - again.places.mean(axis=0))
    assert start < 0.5
    assert again.points.max() + 1 == len(again.places)


def test_the_nearest_turn_of_a_stretched_triangle_is_without_its_stretch() -> None:
    from core.pattern.sewn_again import _turns  # noqa: PLC0415

    rng = np.random.default_rng(4)
    frame = np.linalg.qr(rng.normal(size=(3, 3)))[0][:, :2]
    stretch = np.array([[1.2, 0.1], [0.1, 0.8]])
    assert _turns((frame @ stretch)[None])[0] == pytest.approx(frame, abs=1e-12)
