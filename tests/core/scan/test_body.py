"""Scan files in, clean bodies out: what is sound stays, the rest is repaired and said, or refused."""

import tracemalloc
from pathlib import Path

import numpy as np
import pytest
import trimesh

from core.errors import ScanError
from core.geometry.mesh import Mesh
from core.messages import plain
from core.scan.body import read_scan
from core.scan.readers.registry import read_triangles
from core.scan.repair.repair import repair

SAMPLES = Path(__file__).parents[3] / "resources" / "samples"
PLY_HEADER = (
    "ply\nformat {kind} 1.0\nelement vertex {n}\nproperty float x\nproperty float y\nproperty float z\n"
    "element face {m}\nproperty list uchar int vertex_indices\nend_header\n"
)


def raw_sample(name):
    """Read a sample without the code under test: the header ends, then floats, then 13 bytes a face."""
    data = (SAMPLES / name).read_bytes()
    head, body = data.split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in head.splitlines() if line.startswith(b"element")]
    vertices = np.frombuffer(body, "<f4", 3 * counts[0]).reshape(-1, 3).astype(float)
    row = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
    faces = np.frombuffer(body, row, counts[1], offset=12 * counts[0])["corners"].astype(int)
    return vertices, faces


def ball():
    shape = trimesh.creation.icosphere(subdivisions=3, radius=2.0)
    return np.array(shape.vertices), np.array(shape.faces)


def corner_sets(faces):
    return {frozenset(face) for face in faces.tolist()}


@pytest.mark.parametrize(("name", "face_count"), [("mannequin.ply", 65_742), ("person.ply", 65_218)])
def test_a_clean_body_comes_through_bit_for_bit(name, face_count):
    vertices, faces = raw_sample(name)
    body = read_scan(SAMPLES / name)
    assert np.array_equal(body.mesh.vertices, vertices)
    assert np.array_equal(body.mesh.faces, faces)
    assert len(faces) == face_count
    assert body.repairs == ()
    assert body.name == name.removesuffix(".ply")
    assert np.array_equal(body.pose.file_to_mm, np.eye(4))
    assert body.mesh.enclosed_volume() > 0.0


def test_a_scan_in_metres_with_all_kinds_of_dirt_gives_the_clean_body(tmp_path):
    vertices, faces = raw_sample("person.ply")
    mm = vertices
    flipped = np.random.default_rng(3).random(len(faces)) < 0.25
    dirty = np.where(flipped[:, None], faces[:, ::-1], faces)
    speck = len(vertices) + np.array([[0, 1, 2]])
    vertices = np.concatenate([vertices, [[900, 0, 0], [905, 0, 0], [900, 5, 0], [0, 0, 0], [1, 2, np.nan]]])
    unplaced = [[0, 1, len(vertices) - 1]]
    dirty = np.concatenate([dirty, speck, dirty[:7], [[5, 5, 9]], unplaced])
    path = tmp_path / "dirty.ply"
    trimesh.Trimesh(vertices / 1000.0, dirty, process=False).export(path)
    body = read_scan(path)
    assert body.pose.unit == "m"
    assert tuple(map(str, body.repairs)) == (
        "Removed 1 vertex without a position.",
        "Removed 1 vertex not belonging to any face.",
        "Removed 8 faces with zero area or listed twice.",
        "Removed 1 small component separate from the body.",
        f"Reversed {flipped.sum():,} faces to face outward.",
    )
    assert np.abs(body.mesh.vertices - mm).max() < 1e-4  # the file holds single precision
    assert np.array_equal(np.sort(body.mesh.faces, axis=1), np.sort(faces, axis=1))
    assert body.mesh.enclosed_volume() == pytest.approx(Mesh(mm, faces).enclosed_volume(), rel=1e-6)


def test_triangle_soup_is_sewn_together_again(tmp_path):
    vertices, faces = raw_sample("mannequin.ply")
    path = tmp_path / "soup.stl"
    trimesh.Trimesh(vertices, faces, process=False).export(path)
    body = read_scan(path)
    assert tuple(map(str, body.repairs)) == (
        f"Merged {3 * len(faces) - len(vertices):,} vertices with others at the same position.",
    )
    assert len(body.mesh.vertices) == len(vertices)
    assert np.array_equal(body.mesh.vertices[body.mesh.faces], vertices[faces])


def test_what_is_told_overrules_the_shape(tmp_path):
    body = read_scan(SAMPLES / "mannequin.ply", up="-z", front="+y")
    as_file, _ = raw_sample("mannequin.ply")
    assert np.array_equal(body.mesh.vertices[:, 2], -as_file[:, 2])
    assert np.array_equal(body.mesh.vertices[:, 1], -as_file[:, 1])
    assert np.array_equal(body.mesh.vertices[:, 0], as_file[:, 0])


def test_turned_faces_look_outward_again_on_a_closed_and_on_an_open_skin():
    vertices, faces = ball()
    for skin in (faces, faces[vertices[faces].mean(axis=1)[:, 2] < 1.2]):
        flipped = np.random.default_rng(1).random(len(skin)) < 0.4
        for wound in (skin[:, ::-1], np.where(flipped[:, None], skin[:, ::-1], skin)):
            _, mended, sentences = repair(vertices, wound)
            changed = int((wound != skin).any(axis=1).sum())
            assert f"Reversed {changed:,} faces to face outward." in plain(sentences)
            normals, centres = Mesh(vertices[np.unique(skin)], mended), vertices[skin].mean(axis=1)
            assert (np.einsum("ij,ij->i", normals.area_vectors, centres) > 0.0).all()


def test_each_of_two_pieces_is_turned_by_itself():
    vertices, faces = ball()
    both = np.concatenate([vertices, vertices + np.array([5.0, 0.0, 0.0])])
    _, mended, sentences = repair(both, np.concatenate([faces, faces[:, ::-1] + len(vertices)]))
    assert tuple(map(str, sentences)) == (f"Reversed {len(faces):,} faces to face outward.",)
    assert np.array_equal(Mesh(both, mended).face_normals[: len(faces)], Mesh(vertices, faces).face_normals)


def test_a_strip_with_one_side_is_left_as_it_is():
    angle = np.arange(12) * np.pi / 6
    middle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    across = np.stack(
        [np.cos(angle / 2) * np.cos(angle), np.cos(angle / 2) * np.sin(angle), np.sin(angle / 2)], 1
    )
    vertices = np.concatenate([middle + 0.2 * across, middle - 0.2 * across])
    k = np.arange(11)
    faces = np.concatenate(
        [np.stack([k, k + 1, k + 12], 1), np.stack([k + 1, k + 13, k + 12], 1), [[11, 12, 23], [12, 0, 23]]]
    )
    _, mended, _ = repair(vertices, faces)
    assert np.array_equal(mended, faces) or np.array_equal(mended, faces[:, ::-1])


def test_a_fin_goes_and_a_flap_at_the_border_stays():
    vertices, faces = ball()
    faces = faces[vertices[faces].mean(axis=1)[:, 2] < 1.2]
    border = Mesh(vertices, faces).boundary_loops[0]
    inner = next(face for face in faces if vertices[face, 2].max() < 0.0)
    fin = [inner[0], inner[1], len(vertices)]
    flap = [border[1], border[0], len(vertices) + 1]
    vertices = np.concatenate([vertices, 1.2 * vertices[inner[:1]], 1.1 * vertices[border[:1]]])
    _, mended, sentences = repair(vertices, np.concatenate([faces, [fin, flap]]))
    assert "Removed 1 face from fin-shaped parts." in plain(sentences)
    assert len(mended) == len(faces) + 1


def test_vertices_too_far_for_arithmetic_are_dropped():
    vertices, faces = ball()
    far = np.concatenate([vertices, [[1e300, 0, 0], [-np.inf, 0, 0]]])
    spikes = [[0, 1, len(vertices)], [2, 3, len(vertices) + 1]]
    kept, mended, sentences = repair(far, np.concatenate([faces, spikes]))
    assert tuple(map(str, sentences)) == ("Removed 2 vertices without a position.",)
    assert np.array_equal(kept, vertices)
    assert np.array_equal(mended, faces)


def test_polygons_and_groups_of_an_obj_become_one_set_of_triangles(tmp_path):
    path = tmp_path / "two.obj"
    corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 5\n"
    path.write_text(f"{corners}o a\nusemtl p\nf 1 2 3 4\no b\nusemtl q\nf 1 2 5\n")
    vertices, faces = read_triangles(path.name, path.read_bytes())
    assert vertices.shape == (5, 3)
    assert corner_sets(faces) == {frozenset(s) for s in ((0, 1, 2), (0, 2, 3), (0, 1, 4))}


def test_quads_of_a_ply_become_triangles(tmp_path):
    path = tmp_path / "quads.ply"
    text = (
        PLY_HEADER.format(kind="ascii", n=5, m=2) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 5\n4 0 1 2 3\n3 0 1 4\n"
    )
    path.write_text(text)
    assert corner_sets(read_triangles(path.name, path.read_bytes())[1]) == {
        frozenset(s) for s in ((0, 1, 2), (0, 2, 3), (0, 1, 4))
    }


def test_a_count_that_the_file_cannot_hold_is_refused_without_reserving_memory(tmp_path):
    path = tmp_path / "claim.ply"
    path.write_bytes(
        PLY_HEADER.format(kind="binary_little_endian", n=4_000_000_000, m=1).encode() + b"0" * 30
    )
    data = path.read_bytes()
    assert len(data) < 230
    tracemalloc.start()
    with pytest.raises(ScanError, match="truncated: the header declares more"):
        read_triangles(path.name, data)
    assert tracemalloc.get_traced_memory()[1] < 1_000_000
    tracemalloc.stop()


TRIANGLE = "0 0 0\n1 0 0\n0 1 0\n"
ASCII_PLY = PLY_HEADER.format(kind="ascii", n=3, m=1)
BAD_FILES = [
    ("scan.doc", b"1 2 3", "not a supported scan file"),
    (
        "letter.txt",
        b"Dear Anna,\n\nhere is the scan of 12 May.\n",
        "is not a scan: the text contains no points",
    ),
    ("scan.ply", b"", "is empty"),
    ("scan.ply", b"hello", "not a PLY file"),
    ("scan.ply", b"ply\nformat ascii 1.0\nelement vertex", "not a PLY file, or its header is truncated"),
    ("scan.ply", (ASCII_PLY + TRIANGLE).encode(), "truncated: the header declares more"),
    ("scan.ply", (ASCII_PLY + TRIANGLE + "3 0 1 x\n").encode(), "damaged or truncated"),
    ("scan.ply", (ASCII_PLY + TRIANGLE + "3 0 1 7\n").encode(), "vertices that do not exist"),
    ("scan.ply", (ASCII_PLY.replace("vertex 3", "vertex -3") + TRIANGLE).encode(), "invalid header"),
    ("scan.ply", (ASCII_PLY.replace("float z", "number z") + TRIANGLE).encode(), "invalid header"),
    ("scan.ply", (PLY_HEADER.format(kind="ascii", n=3, m=0) + TRIANGLE).encode(), "too few points"),
    ("scan.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no valid triangles"),
    ("scan.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "do not exist|damaged"),
    ("scan.obj", b"v 0 0 0\nv 1 0 0\nf 1 1 2\n", "no valid triangles"),
    ("scan.stl", b"\x00" * 80 + b"\x09\x00\x00\x00" + b"\x00" * 60, "truncated, or it is not an STL file"),
    ("scan.stl", b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "truncated"),
]


@pytest.mark.parametrize(("name", "content", "words"), BAD_FILES)
def test_a_bad_file_is_refused_in_words_with_what_to_do(tmp_path, name, content, words):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(ScanError, match=words) as refusal:
        read_scan(path)
    assert refusal.value.hint


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    (tmp_path / "folder.ply").mkdir()
    for name, words in (("none.ply", "does not exist"), ("folder.ply", "cannot be read")):
        with pytest.raises(ScanError, match=words):
            read_scan(tmp_path / name)
