"""Curves become edges of the skin: nothing of it is lost, and they may cross, end on each other and pinch."""

from itertools import pairwise

import numpy as np
import pytest
from curved_patches import ball, circle, meridian, on_ball, sheet

from core.errors import PatternError
from core.geometry.mesh import Mesh, half_edges
from core.pattern.surface_cut import cut_surface
from core.pattern.surface_trace import SNAP, SurfaceCurve

CROSSING = (
    circle(60.0),
    meridian("across", 20.0, -75.0, 70.0),
    meridian("end", 110.0, 1.0, 58.0),
    meridian("third", 200.0, -30.0, 40.0),
)


def as_mesh(cut):
    return Mesh(cut.vertices, cut.faces)


@pytest.mark.parametrize("subdivisions", [2, 3, 4, 5])
def test_a_cut_skin_is_the_same_surface_whatever_the_size_of_its_triangles(subdivisions):
    skin = ball(70.0, subdivisions)
    cut = cut_surface(skin, CROSSING)
    mesh = as_mesh(cut)
    assert mesh.face_areas.sum() == pytest.approx(skin.face_areas.sum(), rel=1e-12)
    assert mesh.enclosed_volume() == pytest.approx(skin.enclosed_volume(), rel=1e-12)
    sides = half_edges(mesh.faces)
    assert len(np.unique(sides, axis=0)) == len(sides)
    assert not mesh.boundary_loops
    outward = np.einsum("ij,ij->i", mesh.face_normals, skin.face_normals[cut.origin])
    assert outward.min() > 1.0 - 1e-6


def test_curves_are_edges_in_order():
    cut = cut_surface(ball(), CROSSING)
    known = set(map(tuple, as_mesh(cut).edges.tolist()))
    for chain in cut.chains:
        assert all(tuple(sorted(pair)) in known for pair in pairwise(chain.tolist()))
    assert {tuple(edge) for edge in cut.edges.tolist()} <= known


@pytest.mark.parametrize("part", [None, 0.5])
def test_neighbours_are_those_of_a_mesh_of_its_own(part):
    skin = ball()
    within = None if part is None else np.arange(len(skin.faces)) < part * len(skin.faces)
    cut = cut_surface(skin, CROSSING, within)
    np.testing.assert_array_equal(cut.face_neighbours, as_mesh(cut).face_neighbours)


def test_vertices_keep_their_shares_of_the_skin():
    skin = ball()
    cut = cut_surface(skin, CROSSING)
    np.testing.assert_allclose(cut.mix.sum(axis=1), 1.0, atol=1e-12)
    assert cut.mix.data.min() > 0.0
    np.testing.assert_array_equal(cut.mix @ skin.vertices, cut.vertices)
    np.testing.assert_array_equal(cut.vertices[: len(skin.vertices)], skin.vertices)


def test_curves_stay_where_they_were_drawn():
    cut = cut_surface(ball(), CROSSING)
    rim = cut.vertices[cut.chains[0]]
    away = np.degrees(np.arccos(np.clip(-rim[:, 1] / np.linalg.norm(rim, axis=1), -1.0, 1.0))) - 60.0
    assert np.radians(np.abs(away)).max() * 70.0 < 0.2  # a vertex of the skin is taken where one is that near


def test_crossing_curves_meet_in_one_vertex():
    cut = cut_surface(ball(), CROSSING)
    degree = np.bincount(cut.edges.ravel())
    rim, across = (set(cut.chains[number].tolist()) for number in (0, 1))
    assert len(rim & across) == 2
    assert all(degree[vertex] == 4 for vertex in rim & across)


@pytest.mark.parametrize("short", [-3.0, 0.0, 3.0])
def test_an_end_near_a_curve_is_put_on_it(short):
    end = np.degrees(short / 70.0)
    cut = cut_surface(ball(), (circle(60.0), meridian("end", 110.0, 20.0, 60.0 - end)))
    assert cut.chains[1][-1] in cut.chains[0]
    assert np.bincount(cut.edges.ravel())[cut.chains[1][-1]] == 3
    target = on_ball(110.0, 60.0)
    assert np.linalg.norm(cut.vertices[cut.chains[1][-1]] - target) < 0.3


def test_an_end_farther_away_stays_free():
    cut = cut_surface(
        ball(), (circle(60.0), meridian("end", 110.0, 20.0, 60.0 - np.degrees(1.5 * SNAP / 70.0)))
    )
    assert cut.chains[1][-1] not in cut.chains[0]
    assert np.bincount(cut.edges.ravel())[cut.chains[1][-1]] == 1


def test_ends_that_meet_are_one_vertex():
    curves = tuple(meridian(str(clock), clock, 0.0, 40.0) for clock in (0.0, 100.0, 220.0))
    cut = cut_surface(ball(), curves)
    assert len({int(chain[0]) for chain in cut.chains}) == 1


def test_curves_that_coincide_are_cut_once():
    one = meridian("one", 40.0, 10.0, 50.0)
    cut = cut_surface(ball(), (one, SurfaceCurve("two", one.points)))
    np.testing.assert_array_equal(cut.chains[0], cut.chains[1])
    assert set(cut.curve.tolist()) == {0}


def test_a_curve_from_vertex_to_vertex_of_the_skin_adds_little():
    skin = ball(70.0, 3)
    loop = skin.faces[0]
    places = skin.vertices[[loop[0], loop[1]]]
    share = np.linspace(0.0, 1.0, 5)[:, None]
    cut = cut_surface(skin, (SurfaceCurve("side", places[0] + share * (places[1] - places[0])),))
    assert as_mesh(cut).face_areas.sum() == pytest.approx(skin.face_areas.sum(), rel=1e-12)


def test_a_curve_over_a_gap_is_refused_by_name():
    skin = ball()
    front = Mesh(skin.vertices, skin.faces[np.abs(skin.vertices[skin.faces].mean(axis=1)[:, 0]) > 6.0])
    with pytest.raises(PatternError) as refused:
        cut_surface(front, (SurfaceCurve("bridge", on_ball(90.0, np.linspace(-40.0, 40.0, 30))),))
    assert refused.value.message.parameters["name"] == "bridge"


def cleft(u, v):
    """A cleft 30 mm deep along v, whose walls overlap by up to 2 mm below its upper third."""
    depth = np.maximum(30.0 - np.abs(u), 0.0)
    overlap = np.where(depth > 8.0, -np.sin(np.pi * (depth - 8.0) / 22.0), 0.25 * (8.0 - depth))
    return np.sign(u) * np.where(np.abs(u) < 30.0, overlap, np.abs(u) - 28.0), depth, v


def test_a_curve_in_a_cleft_stays_on_its_wall_where_the_walls_overlap():
    skin = sheet(cleft, 120.0, 120.0)
    v = np.linspace(-40.0, 40.0, 28)
    points = np.stack(cleft(np.full(28, 12.0), v), axis=1)
    points[12:15, 0] *= -1.0  # nearer to the wall on the other side
    cut = cut_surface(skin, (SurfaceCurve("centre", points),))
    path = cut.vertices[cut.chains[0]]
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).sum() < 85.0
    assert np.sign(path[:, 0]).min() == np.sign(points[0, 0])
