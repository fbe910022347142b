"""Nine panels of a bra on the sample bodies: no fold, no overlap, nothing lost, and seams that fit."""

import numpy as np
import pytest
from curved_patches import EVEN, PlainCloth
from pattern_curves import bra
from scipy.spatial import cKDTree

from core.geometry.mesh import Mesh, area_vectors, boundary_loops
from core.pattern.flattening import flatten_all, strain_summary
from core.pattern.panel import PanelSeed, cut_panels
from core.pattern.seam_matching import match, seams_of
from core.pattern.surface_cut import cut_surface
from core.pattern.surface_trace import SurfaceCurve

CLOTHS = {"cup": EVEN, "sheer": PlainCloth((10.0, 10.0, 3.5)), "power net": PlainCloth(ease=(0.15, 0.0))}


@pytest.fixture(scope="module", params=["person", "mannequin", "trunk"])
def garment(request, finely_built):
    stages = finely_built(request.param)
    curves, seeds = bra(stages.body.mesh, stages.landmarks)
    return stages.body.mesh, curves, seeds


@pytest.fixture(scope="module")
def panels(garment):
    mesh, curves, seeds = garment
    return cut_panels(cut_surface(mesh, curves), seeds)


def cloths_of(panels):
    return [CLOTHS[panel.cloth] for panel in panels]


def test_panels_cover_the_skin_within_their_outlines(garment):
    mesh, curves, seeds = garment
    fine = cut_panels(cut_surface(mesh, curves), seeds, 2.0)  # wide steps cut across the crease of the fold
    total, covered = 0.0, 0.0
    for panel in fine:
        places = panel.places(mesh.vertices)
        total += float(np.linalg.norm(area_vectors(places, panel.faces), axis=1).sum())
        covered += panel.covers
        np.testing.assert_allclose(panel.mix.sum(axis=1), 1.0, atol=1e-12)
        assert len(boundary_loops(panel.faces)) == 1
    assert total == pytest.approx(covered, rel=1e-3)


def test_pieces_have_no_fold_and_no_overlap(garment, panels):
    mesh, _, _ = garment
    places = [panel.places(mesh.vertices) for panel in panels]
    for piece in flatten_all(panels, places, cloths_of(panels)):
        assert not piece.is_folded
        assert not piece.overlaps
        assert piece.panel.grain @ piece.points[:, 1] > 0.0


def test_seams_fit_after_matching_and_cost_strain(garment, panels):
    mesh, _, _ = garment
    places = [panel.places(mesh.vertices) for panel in panels]
    seams = seams_of(panels)
    assert len(seams) == 14  # five of each cup, and bridge and side seam of each side
    matched = match(panels, places, cloths_of(panels), seams)
    for fit in matched.fits:
        assert fit.together[0] == pytest.approx(fit.together[1], abs=0.05)
        assert fit.off < 0.1
    cup = next(fit for fit in matched.fits if fit.seam.name == "cup seam left")
    assert abs(cup.misfit) > 0.01  # alone it could not be sewn
    costs = [
        strain_summary(after).mean - strain_summary(before).mean
        for before, after in zip(matched.alone, matched.flats, strict=True)
    ]
    assert sum(costs) > 0.0


def test_pieces_follow_a_body_that_moves(garment, panels):
    mesh, _, _ = garment
    seams, cloths = seams_of(panels), cloths_of(panels)
    former = match(panels, [panel.places(mesh.vertices) for panel in panels], cloths, seams)
    moved = mesh.vertices + 3.0 * np.sin(mesh.vertices[:, [2, 0, 1]] / 40.0)
    places = [panel.places(moved) for panel in panels]
    warm, cold = match(panels, places, cloths, seams, former), match(panels, places, cloths, seams)
    for one, two in zip(warm.flats, cold.flats, strict=True):
        assert np.abs(one.points - two.points).max() < 0.2


def test_a_turned_shifted_or_mirrored_body_gives_the_same_pieces(garment, panels):
    mesh, curves, seeds = garment
    cloths = cloths_of(panels)
    pieces = flatten_all(panels, [panel.places(mesh.vertices) for panel in panels], cloths)
    angle = np.radians(37.0)
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]]
    )
    for matrix, side in ((turn, 1.0), (np.diag([-1.0, 1.0, 1.0]), -1.0)):

        def carried(points, matrix=matrix):
            return points @ matrix.T + [40.0, -7.0, 120.0]

        body = Mesh(carried(mesh.vertices), mesh.faces if side > 0.0 else mesh.faces[:, ::-1])
        moved = [SurfaceCurve(each.name, carried(each.points), each.slit, each.is_edge) for each in curves]
        marks = [PanelSeed(each.name, carried(each.place), each.cloth) for each in seeds]
        others = cut_panels(cut_surface(body, tuple(moved)), tuple(marks))
        twins = flatten_all(others, [panel.places(body.vertices) for panel in others], cloths)
        for piece, twin in zip(pieces, twins, strict=True):
            assert len(piece.points) == len(twin.points)
            assert cKDTree(piece.points).query(twin.points * [side, 1.0])[0].max() < 1e-6
