"""Holes and seams of a skin in mm: small ones are closed along the curvature, large ones named and left."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree
from shapes import SAMPLES

from core.geometry.mesh import Mesh
from core.geometry.triangulate import triangulate
from core.progress import Cancelled
from core.scan.body import read_scan
from core.scan.repair.editable_mesh import EditableMesh
from core.scan.repair.holes import fill_holes, fill_small_holes, find_holes, hole_sentences
from core.scan.repair.repair import repair

CENTRES = {"back": (0.0, 30.0, 260.0), "belly": (10.0, -170.0, 60.0), "side": (140.0, -80.0, 180.0)}


@pytest.fixture(scope="module")
def person():
    return read_scan(SAMPLES / "person.ply").mesh


def pierced(mesh, *holes):
    """Take the triangles round some places away: (place, radius) each, the place on the skin."""
    middle, keep = mesh.vertices[mesh.faces].mean(axis=1), np.ones(len(mesh.faces), dtype=bool)
    tree = cKDTree(middle)
    for place, radius in holes:
        keep[tree.query_ball_point(middle[tree.query(place)[1]], radius)] = False
    skin = EditableMesh(mesh.vertices, mesh.faces[keep]).compact()
    return Mesh(skin.vertices, skin.faces)


def is_sound(mesh):
    sides = EditableMesh(mesh.vertices, mesh.faces).sides
    return sides.count.max() == 2 and not sides.neighbours[2].any()


def test_holes_in_a_ball_are_closed_onto_the_ball():
    ball = trimesh.creation.icosphere(subdivisions=5, radius=80.0)
    sound = Mesh(ball.vertices, ball.faces)
    places = [80.0 * np.array(p) / np.linalg.norm(p) for p in ((1, 0, 0), (0, -1, 1), (0, 1, 1), (-1, 1, -1))]
    holed = pierced(sound, *zip(places, (4.0, 8.0, 11.0, 13.0), strict=True))
    closed, sewn, count = fill_small_holes(holed)
    assert (sewn, count) == (0, 4)
    assert closed.boundary_loops == ()
    assert is_sound(closed)
    new = np.linalg.norm(closed.vertices[len(holed.vertices) :], axis=1)
    assert len(new) > 20
    assert np.abs(new - 80.0).max() < 0.1  # a flat lid over the largest would lie 1 mm deep
    assert closed.enclosed_volume() == pytest.approx(sound.enclosed_volume(), rel=2e-4)


@pytest.mark.parametrize("noise", [0.0, 0.8])
def test_hundreds_of_small_holes_in_a_body_are_closed_and_counted(person, noise):
    rng = np.random.default_rng(4)
    rough = person.moved(person.vertices + rng.normal(0.0, noise, person.vertices.shape))
    places = person.vertices[rng.choice(len(person.vertices), 200, replace=False)]
    holed = pierced(rough, *((place, 5.0) for place in places))
    vertices, faces, _ = repair(holed.vertices, holed.faces)
    closed, sentences = fill_holes(Mesh(vertices, faces))
    assert is_sound(closed)
    assert any(
        str(each).startswith("Filled 1") and str(each).endswith("holes up to 30 mm across.")
        for each in sentences
    )
    assert sum(len(hole.border) for hole in find_holes(closed) if not hole.opening) < 150
    assert closed.face_areas.sum() == pytest.approx(rough.face_areas.sum(), rel=0.01)
    moved = cKDTree(closed.vertices).query(vertices)[0]
    assert moved.max() <= 1.0  # a crack is sewn half way
    assert (moved > 0.0).mean() < 0.002


def test_a_skin_of_thousands_of_holes_is_closed_and_can_be_stopped(person):
    keep = np.random.default_rng(0).random(len(person.faces)) > 0.1
    vertices, faces, _ = repair(person.vertices, person.faces[keep])
    torn, heard = Mesh(vertices, faces), []
    closed, _, count = fill_small_holes(torn, lambda what, share: heard.append((what, share)))
    assert count > 3000
    assert closed.face_areas.sum() == pytest.approx(person.face_areas.sum(), rel=0.01)
    assert EditableMesh(closed.vertices, closed.faces).sides.count.max() == 2
    assert len(heard) > count - 10
    assert heard == sorted(heard)

    def stop(what, share):
        if share > 0.5:
            raise Cancelled

    with pytest.raises(Cancelled):
        fill_small_holes(torn, stop)


def test_a_clean_body_is_not_touched_and_its_cuts_are_no_holes(person):
    assert fill_small_holes(person)[0] is person
    holes = find_holes(person)
    assert [hole.opening for hole in holes] == [True] * 4  # hips, neck, two arms
    assert hole_sentences(person, holes) == ()


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ((60.0, -200.0, 60.0), "lower front"),
        ((0.0, 100.0, 430.0), "upper back"),
        ((180.0, -80.0, 240.0), "middle left side"),
        ((-180.0, -80.0, 240.0), "middle right side"),
    ],
)
def test_a_large_hole_stays_open_and_is_named(person, place, words):
    closed, sentences = fill_holes(pierced(person, (np.array(place), 35.0)))
    assert len(closed.boundary_loops) == 5
    assert tuple(map(str, sentences)) == (f"Unfilled hole of 7 × 7 cm: {words}.",)
    hole = next(hole for hole in find_holes(closed) if not hole.opening)
    assert np.linalg.norm(hole.centre - person.vertices, axis=1).min() < 15.0
    assert 60.0 < hole.width <= hole.length < 85.0


@pytest.mark.parametrize("low", [100.0, 150.0, 190.0])
def test_a_ring_torn_off_the_trunk_is_no_opening(person, low):
    x, y, z = person.vertices[person.faces].mean(axis=1).T
    patch = (np.abs(x) < 20.0) & (y < np.median(y))
    skin = EditableMesh(person.vertices, person.faces[(np.abs(z - low) > 6.0) | patch]).compact()
    torn = Mesh(skin.vertices, skin.faces)
    assert [hole.opening for hole in find_holes(torn)].count(True) == 4
    assert any("Unfilled hole" in str(sentence) for sentence in fill_holes(torn)[1])


def test_what_was_mended_is_whole_the_second_time(person):
    holed = pierced(person, *((np.array(place), 10.0) for place in CENTRES.values()))
    closed, _, count = fill_small_holes(holed)
    assert count == 3
    assert fill_small_holes(closed) == (closed, 0, 0)


def test_a_moved_body_is_mended_in_the_same_way(person):
    holed = pierced(person, *((np.array(place), 10.0) for place in CENTRES.values()))
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    one, other = fill_small_holes(holed)[0], fill_small_holes(holed.moved(holed.vertices @ turn.T + 5e5))[0]
    assert other.enclosed_volume() != one.enclosed_volume()
    assert len(other.faces) == pytest.approx(len(one.faces), abs=30)  # the places strewn depend on the axes
    assert other.face_areas.sum() == pytest.approx(one.face_areas.sum(), rel=1e-5)


def test_patches_with_gaps_are_sewn(person):
    middle = person.vertices[person.faces].mean(axis=1) - person.vertices.mean(axis=0)
    patch = (middle > 0.0) @ [1, 2, 4]
    rng, parts, count = np.random.default_rng(2), [], 0
    for number in range(8):
        part = EditableMesh(person.vertices, person.faces[patch == number]).compact()
        parts.append((part.vertices + rng.uniform(-0.5, 0.5, 3), part.faces + count))
        count += len(part.vertices)
    gaping = Mesh(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))
    assert len(gaping.boundary_loops) >= 8
    sewn, sentences = fill_holes(Mesh(*repair(gaping.vertices, gaping.faces)[:2]))
    assert is_sound(sewn)
    assert len(EditableMesh(sewn.vertices, sewn.faces).piece_areas) == 1
    assert sum(len(loop) for loop in sewn.boundary_loops) < 1.1 * sum(map(len, person.boundary_loops))
    assert str(sentences[0]).startswith("Joined ")


@pytest.mark.parametrize(
    "outline",
    [
        [(0, 0), (4, 0), (4, 4), (0, 4)],
        [(0, 0), (8, 0), (8, 1), (1, 1), (1, 8), (0, 8)],
        [(0, 0), (6, 6), (6, 0), (0, 6)],
        [(0, 0), (5, 0), (10, 0), (15, 0), (10, 0.01), (5, 0.01)],
    ],
    ids=["square", "hook", "crossed", "slit"],
)
def test_any_outline_is_cut_into_triangles_with_its_own_sides(outline):
    outline = np.array(outline, dtype=float)
    faces, inside = triangulate(outline)
    loops = Mesh(np.zeros((len(outline) + len(inside), 3)), faces).boundary_loops
    assert [sorted(loop) for loop in loops] == [list(range(len(outline)))]
