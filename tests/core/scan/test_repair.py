"""Hand-made defects on sound skins: what was sound comes back, the rest is gone, and the count is said."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import trimesh
from shapes import SAMPLES

from core.geometry.mesh import Mesh
from core.messages import plain
from core.scan.readers.registry import read_triangles
from core.scan.repair.repair import repair

RNG = np.random.default_rng


@cache
def person():
    name = "person.ply"
    return read_triangles(name, (SAMPLES / name).read_bytes())


@cache
def ball(radius=100.0):
    shape = trimesh.creation.icosphere(subdivisions=4, radius=radius)
    return np.array(shape.vertices), np.array(shape.faces)


def beside(one, *others):
    """Put skins into one file."""
    vertices, faces = one
    for more, triangles in others:
        faces = np.concatenate([faces, np.asarray(triangles) + len(vertices)])
        vertices = np.concatenate([vertices, more])
    return vertices, faces


def shape(made, place=(0.0, 0.0, 0.0), noise=0.0, edge=None):
    """A shape of the library at a place, with scanner noise."""
    made = made if edge is None else made.subdivide_to_size(edge)
    vertices = np.array(made.vertices) + place
    return vertices + RNG(0).normal(0.0, noise, vertices.shape), np.array(made.faces)


def same_skin(mended, sound):
    """Whether two skins have the same triangles at the same places, whatever the order of vertices."""

    def corners(vertices, faces):
        places = np.round(vertices[faces], 5)
        turned = np.argmin(places @ [1.0, 1e-3, 1e-6], axis=1)
        rows = np.arange(len(faces))[:, None]
        places = places[rows, (turned[:, None] + [0, 1, 2]) % 3].reshape(len(faces), 9)
        return places[np.lexsort(places.T)]

    return len(mended[1]) == len(sound[1]) and np.array_equal(corners(*mended[:2]), corners(*sound))


STANDS = {
    "a floor of two triangles": shape(trimesh.creation.box((3e3, 3e3, 1e-9)), (0, 0, -50)),
    "a noisy floor larger than the body": shape(
        trimesh.creation.box((2e3, 2e3, 0.1)), (0, 0, -60), 1.5, 60.0
    ),
    "a wall": shape(trimesh.creation.box((1500, 12, 1800)), (0, 320, 300), 1.0, 40.0),
    "a turntable": shape(trimesh.creation.cylinder(350, 40), (0, 0, -40), 1.0, 30.0),
    "a box under the body": shape(trimesh.creation.box((400, 300, 500)), (0, -80, -280), 1.0, 30.0),
    "a pole": shape(trimesh.creation.cylinder(20, 1200), (420, 0, 300), 0.0, 20.0),
}


@pytest.mark.parametrize("stand", STANDS, ids=str)
def test_what_the_body_stands_on_or_by_goes_and_the_body_stays(stand):
    *mended, sentences = repair(*beside(person(), STANDS[stand]))
    assert same_skin(mended, person())
    assert "Removed 1 piece shaped like a floor, a wall or a stand." in plain(sentences)


def test_a_closed_dress_form_is_no_furniture():
    form = read_triangles("mannequin.ply", (SAMPLES / "mannequin.ply").read_bytes())
    pole = shape(trimesh.creation.cylinder(18.0, 900.0), (0.0, -95.0, -440.0), edge=30.0)
    *mended, _ = repair(*beside(form, pole))
    assert same_skin(mended, form)


def test_a_file_of_furniture_alone_is_left_as_it_is():
    box = shape(trimesh.creation.box((400, 400, 400)), edge=40.0)
    *mended, _ = repair(*beside(box, STANDS["a wall"]))
    assert len(mended[1]) > len(box[1])


@pytest.mark.parametrize("depth", [0.4, 2.0, 9.0])
def test_a_lining_goes_and_the_outer_skin_stays(depth):
    vertices, faces = person()
    lining = vertices - depth * Mesh(vertices, faces).vertex_normals, faces[:, ::-1]
    *mended, sentences = repair(*beside((vertices, faces), lining))
    assert "Removed 1 piece inside the body or duplicating its surface." in plain(sentences)
    assert len(mended[1]) == pytest.approx(len(faces), abs=3)
    low, high = mended[0].min(axis=0), mended[0].max(axis=0)
    assert np.allclose([low, high], [vertices.min(axis=0), vertices.max(axis=0)], atol=0.5)


def test_a_body_in_patches_stays_whole():
    vertices, faces = person()
    middle = vertices[faces].mean(axis=1) - vertices.mean(axis=0)
    patch = (middle > 0.0) @ [1, 2, 4]
    parts = [(vertices + 0.4 * RNG(k).normal(size=3), faces[patch == k]) for k in range(8)]
    soup = beside(*parts)
    *mended, sentences = repair(*soup)
    area = Mesh(*mended).face_areas.sum()
    assert area == pytest.approx(Mesh(vertices, faces).face_areas.sum(), rel=2e-3)
    assert not [each for each in sentences if "Reversed" in str(each) or "shaped like" in str(each)]


def test_specks_go_and_a_part_near_the_body_stays():
    tiny = [shape(trimesh.creation.icosphere(1, 3.0), (300.0 + 20 * k, 0, 0)) for k in range(7)]
    far = shape(trimesh.creation.icosphere(3, 35.0), (900, 0, 0))
    part = shape(trimesh.creation.icosphere(3, 35.0), (0, -140, 590))
    *mended, sentences = repair(*beside(person(), *tiny, far, part))
    assert same_skin(mended, beside(person(), part))
    assert tuple(map(str, sentences)) == ("Removed 8 small components separate from the body.",)


@pytest.mark.parametrize("whole", [0.0, 0.5])
def test_a_skin_in_shreds_keeps_them(whole):
    vertices, faces = ball()
    kept = vertices[faces].mean(axis=1)[:, 2] > 100.0 - 200.0 * whole
    corners = vertices[faces[~kept]].reshape(-1, 3)
    shreds = corners + 0.3 * RNG(0).normal(size=corners.shape), np.arange(len(corners)).reshape(-1, 3)
    mended = repair(*beside((vertices, faces[kept]), shreds))
    assert len(mended[1]) > 0.98 * len(faces)


def fin_on(vertices, faces):
    """A strip of two triangles that stands on an inner edge."""
    a, b, _ = faces[1000]
    tops = 1.2 * vertices[[a, b]]
    n = len(vertices)
    return np.concatenate([vertices, tops]), np.concatenate([faces, [[a, b, n + 1], [a, n + 1, n]]])


def wall_in(vertices, faces):
    """A disc of triangles inside the ball, that hangs on an edge loop of its skin."""
    above = vertices[faces].mean(axis=1)[:, 2] > 20.0
    loop = Mesh(vertices, faces[above]).boundary_loops[0]
    fan = [[a, b, len(vertices)] for a, b in zip(loop, np.roll(loop, -1), strict=True)]
    return np.concatenate([vertices, vertices[loop].mean(axis=0)[None]]), np.concatenate([faces, fan])


def back_to_back(vertices, faces):
    """Faces listed again the other way round, and a flap of two faces glued to each other."""
    twice, fin = faces[100:120, ::-1], [faces[500][0], faces[500][1], len(vertices)]
    both = np.array([fin, fin[::-1]])
    return np.concatenate([vertices, 1.1 * vertices[faces[500][:1]]]), np.concatenate([faces, twice, both])


def tee_on(vertices, faces):
    """A flap in the shape of a T: a stem on the skin, a bar across its top."""
    a, b, _ = faces[700]
    n = len(vertices)
    stem = 1.2 * vertices[[a, b]]
    upward = np.array([0.0, 0.0, 8.0])
    bar = np.concatenate([stem + upward, stem - upward])
    more = [[a, b, n + 1], [a, n + 1, n]]
    more += [[n, n + 1, n + 2], [n + 1, n + 3, n + 2], [n, n + 1, n + 4], [n + 1, n + 5, n + 4]]
    return np.concatenate([vertices, stem, bar]), np.concatenate([faces, more])


@pytest.mark.parametrize("defect", [fin_on, wall_in, back_to_back, tee_on])
def test_fins_of_all_kinds_go(defect):
    *mended, _ = repair(*defect(*ball()))
    assert same_skin(mended, ball())


def test_two_bodies_of_skin_that_touch_in_a_vertex_are_parted():
    vertices, faces = ball()
    top, bottom = np.argmax(vertices[:, 2]), np.argmin(vertices[:, 2])
    other = vertices + np.array([0.0, 0.0, vertices[top, 2] - vertices[bottom, 2]])
    both = beside((vertices, faces), (other, faces))
    assert len(both[0]) == len(np.unique(both[0], axis=0)) + 1
    *mended, sentences = repair(*both)
    assert "Separated two touching layers of the surface at 1 vertex." in plain(sentences)
    assert same_skin(mended, both)


def test_a_skin_pinched_to_a_point_is_parted_there():
    vertices, faces = ball()
    place = vertices[np.argmax(vertices[:, 2])]
    one, other = np.argsort(np.linalg.norm(vertices - place, axis=1))[[0, 25]]
    pinched = np.where(faces == other, one, faces)
    kept, mended, sentences = repair(vertices, pinched)
    assert "Separated two touching layers of the surface at 1 vertex." in plain(sentences)
    assert len(kept) == len(vertices)
    assert len(mended) == len(faces)


def test_a_spike_and_a_vertex_far_away_go():
    vertices, faces = ball()
    vertices = vertices.copy()
    vertices[7] *= 3.0
    vertices[90] = [4e5, 0.0, 0.0]
    kept, mended, sentences = repair(vertices, faces)
    assert str(sentences[0]) == "Removed 1 vertex far from all others."
    assert "Removed 1 vertex from spike-shaped parts." in plain(sentences)
    assert len(faces) - 12 <= len(mended) <= len(faces) - 10
    assert np.linalg.norm(kept, axis=1).max() < 100.01


@pytest.mark.parametrize("shift", [0.0, 1e6])
def test_far_from_the_origin_soup_is_sewn_as_near_it(shift):
    vertices, faces = person()
    away = (vertices + shift).astype(np.float32).astype(float)
    soup, corners = away[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)
    kept, mended, _ = repair(soup, corners)
    assert len(kept) == pytest.approx(len(vertices), abs=5)
    assert len(mended) == pytest.approx(len(faces), abs=10)


def dirty():
    """A body with a floor, flipped faces, fins, specks and doubled vertices."""
    vertices, faces = fin_on(*person())
    flipped = RNG(2).random(len(faces)) < 0.3
    faces = np.where(flipped[:, None], faces[:, ::-1], faces)
    speck = shape(trimesh.creation.icosphere(1, 3.0), (300, 0, 0))
    return beside((vertices, faces), speck, STANDS["a turntable"])


def test_repair_finds_nothing_more_the_second_time():
    once = repair(*dirty())
    assert len(once[2]) >= 4
    kept, mended, sentences = repair(*once[:2])
    assert sentences == ()
    assert np.array_equal(kept, once[0])
    assert np.array_equal(mended, once[1])


@pytest.mark.parametrize("scale", [0.001, 1.0 / 25.4, 1.0])
def test_a_turned_body_in_another_unit_is_repaired_in_the_same_way(scale):
    vertices, faces = dirty()
    turn = np.linalg.qr(RNG(5).normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)
    kept, mended, sentences = repair(vertices, faces)
    turned, again, said = repair(scale * (vertices @ turn.T) + scale * np.array([300.0, -50.0, 900.0]), faces)
    assert said == sentences
    assert np.array_equal(again, mended)
    assert np.allclose((turned / scale - [300.0, -50.0, 900.0]) @ turn, kept, atol=1e-6)
