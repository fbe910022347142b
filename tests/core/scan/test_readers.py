"""Every format gives the same house, and what no scan is ends in one sentence, soon, in little memory."""

import codecs
import gzip
import os
import random
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from damaged_files import damaged_file
from scan_files import CLOUDS, CORNERS, HOUSES, TRIANGLES, VOLUME, gltf, off, ply, vtp

from core.errors import ScanError
from core.geometry.mesh import Mesh
from core.progress import Cancelled
from core.scan.readers.raw_scan import RawScan
from core.scan.readers.registry import LARGEST_FILE, read_raw, read_triangles, scan_bytes


@pytest.mark.parametrize("name", HOUSES)
def test_every_format_gives_the_house(name):
    vertices, faces = read_triangles(name, HOUSES[name])
    assert vertices.dtype == np.float64
    assert faces.shape == (len(TRIANGLES), 3)
    house = Mesh(vertices, faces)
    assert house.enclosed_volume((1.0, 1.0, 1.0)) == pytest.approx(VOLUME, abs=1e-5)
    found = {tuple(corner) for corner in np.round(vertices, 5).tolist()}
    assert found == {tuple(map(float, corner)) for corner in CORNERS}
    cut = {frozenset(tuple(p) for p in t) for t in np.round(vertices[faces], 5).tolist()}
    if "vtp" not in name:  # its strip runs along the other diagonal
        assert cut == {frozenset(tuple(map(float, CORNERS[k])) for k in t) for t in TRIANGLES}


@pytest.mark.parametrize("name", CLOUDS)
def test_points_without_faces_are_a_cloud(name):
    scan = read_raw(name, CLOUDS[name])
    assert np.array_equal(scan.vertices, np.array(CORNERS, dtype=float))
    assert len(scan.faces) == 0
    with_normals = b"0.8" in CLOUDS[name]
    assert (scan.normals is not None) == with_normals
    if with_normals:
        assert np.allclose(scan.normals, [0.0, 0.6, 0.8])


def claims() -> dict[str, bytes]:
    """Small files that promise much more than they hold."""
    little = ply("binary_little_endian")
    glb = gltf(binary=True)
    far = b'"count": 10'
    return {
        "vertices.ply": little.replace(b"vertex 10", b"vertex 4000000000"),
        "list.ply": little.replace(b"list uchar int", b"list uint int"),
        "nothing.ply": little.replace(b"element face", b"element nothing 4000000000\nelement face"),
        "text.ply": ply().replace(b"vertex 10", b"vertex 4000000000"),
        "count.stl": b"\0" * 80 + b"\xff" * 4 + b"\0" * 50,
        "chunk.glb": glb[:12] + b"\xff\xff\xff\x7f" + glb[16:],
        "accessor.gltf": gltf(binary=False).replace(far, b'"count": 4000000000'),
        "steps.gltf": gltf(binary=False).replace(far, b'"byteOffset": 9000000000, "count": 4'),
        "points.vtp": vtp().replace(b'NumberOfPoints="10"', b'NumberOfPoints="4000000000"'),
        "block.vtp": vtp("appended").replace(b"_x\0\0\0", b"_\xff\xff\xff\xff"),
        "blocks.vtp": vtp("appended", packed=True).replace(b"_\2\0", b"_\xff\xff"),
        "ends.vtp": vtp().replace(b"5 10 14 18 22 26", b"5 10 14 18 22 2000000026"),
        "counts.off": off().replace(b"10 8 0", b"4000000000 8 0"),
    }


@pytest.mark.parametrize("name", claims())
def test_a_claim_that_the_file_cannot_hold_reserves_no_memory(name):
    data = claims()[name]
    assert data not in HOUSES.values()
    tracemalloc.start()
    with pytest.raises(ScanError):
        read_raw(name, data)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 3_000_000


NODES = b'{"asset": {"version": "2.0"}, "nodes": [{"children": [0, 0]}], "scenes": [{"nodes": [0]}]}'
LAUGHS = b'<?xml version="1.0"?><!DOCTYPE a [<!ENTITY a "ha">]><VTKFile type="PolyData">&a;</VTKFile>'
PIECES = gzip.compress(b"1 2 3\n", 1, mtime=0)
HOSTILE = [
    ("a.vtp", LAUGHS, "not a scan|damaged"),
    ("a.vtp", b"<VTKFile>" + b"<a>" * 300_000, "damaged"),
    ("a.vtp", b"<!---->" * 60 + b"x", "not a scan|damaged|no VTP"),
    ("a.vtp", b"<VTKFile type='PolyData'></VTKFile>", "not a VTP surface file"),
    (
        "a.vtp",
        vtp().replace(b"<VTKFile ", b'<VTKFile compressor="vtkLZ4DataCompressor" '),
        "unsupported compression",
    ),
    ("a.gltf", b"[" * 400_000, "damaged"),
    ("a.gltf", b"[" + b"1," * 3_000_000 + b"1]", "too much data that does not belong"),
    ("a.gltf", NODES, "too much data that does not belong"),
    ("a.gltf", gltf(binary=False, buffer={"uri": "other.bin", "byteLength": 9}), "in another file"),
    ("a.gltf", gltf(binary=False, buffer={"uri": "https://host/a.bin"}), "in another file"),
    (
        "a.gltf",
        gltf(binary=False, extensionsRequired=["KHR_draco_mesh_compression"]),
        "unsupported compression",
    ),
    ("a.obj", b"v 1 2 3\nf 1 1 9\n", "do not exist"),
    ("a.obj", b"v 1 2 3\nf -1 -1 -9\n", "do not exist"),
    ("a.obj", b"v 1 2 3\nf 0 1 1\n", "damaged"),
    ("a.obj", b"v 1 2 3\nf 1 1 99999999999999999999\n", "damaged"),
    ("a.obj", b"v 1 2\n", "damaged"),
    ("a.obj", b"v 1 2 3 " * 2_000_000, "damaged"),
    ("a.off", b"4OFF\n1 0 0\n", "unsupported OFF variant"),
    ("a.off", b"OFF BINARY\n\0\0\0\1", "unsupported OFF variant"),
    ("a.xyz", b"some words\nabout nothing\n", "is not a scan: the text contains no points"),
    ("a.csv", b"1,5,2,5,3,5\n" * 3, "commas may be separators or decimal marks"),
    ("a.csv", b"1.200,5;2.500,0;3,5\n", "commas may be separators or decimal marks"),
    ("a.xyz", b"1 2 3\n1 2\n", "damaged"),
    ("a.xyz", b"1 2 3\n" * 20_000_000, "too large"),
    ("a.obj", b"v 1 2 3\n" * 10_000_002, "too large"),
    ("a.stl", b"solid\nfacet\n" + b"\n" * 40_000_000 + b"endsolid", "too much data that does not belong"),
    ("a.xyz.gz", PIECES * 10_001, "damaged"),
    ("a.xyz.gz", PIECES + b"rubbish", "damaged"),
    ("a.ply.gz", HOUSES["packed.ply.gz"][:-20], "damaged"),
    ("a.ply.gz", gzip.compress(b""), "is empty"),
]


@pytest.mark.parametrize(("name", "data", "words"), HOSTILE, ids=range(len(HOSTILE)))
def test_a_hostile_file_is_refused_in_one_sentence(name, data, words):
    with pytest.raises(ScanError, match=words) as refusal:
        read_raw(name, data)
    assert refusal.value.hint


LISTS = {
    "semicolons": b"1;2;3\n1,5;-2,5;3,5\n",
    "blanks": b"1 2 3\n1,5 -2,5 3,5\n",
    "tabs": b"1\t2\t3\n1,5\t-2,5\t3,5\n",
    "spaced": b"1, 2, 3\n1.5, -2.5, 3.5\n",
    "colours": b"1 2 3 255,0,0\n1.5 -2.5 3.5 255,0,0\n",
    "six": b"1,2,3,255,-0,0\n1.5,-2.5,3.5,255,0,0\n",
    "closed": b"1 2 3\n1.5 -2.5 3.5\nend of file\n\n",
    "marked": codecs.BOM_UTF8 + b"1 2 3\n1.5 -2.5 3.5\n",
    "vertices": codecs.BOM_UTF8 + b"v 1 2 3\nv 1,5 -2,5 3,5\n",
}


@pytest.mark.parametrize("name", LISTS)
def test_a_list_is_read_whatever_stands_between_and_behind_its_numbers(name):
    for ending in ("csv", "xyz", "ply", "obj"):
        scan = read_raw(f"a.{ending}", LISTS[name])
        assert np.array_equal(scan.vertices, [[1, 2, 3], [1.5, -2.5, 3.5]])


@pytest.mark.parametrize(
    "name", ["text.ply", "groups.obj", "text.stl", "binary.stl", "plain.off", "text.gltf"]
)
def test_the_content_tells_the_format_and_no_wrong_name(name):
    right = read_raw(name, HOUSES[name])
    for ending in ("ply", "obj", "stl", "off", "gltf", "xyz", "vtp", "dat"):
        for mark in (b"", b"" if name == "binary.stl" else codecs.BOM_UTF8):
            scan = read_raw(f"a.{ending}", mark + HOUSES[name])
            assert np.array_equal(scan.vertices, right.vertices)
            assert np.array_equal(scan.faces, right.faces)


def test_a_file_packed_in_pieces_is_read_whole():
    half = len(HOUSES["groups.obj"]) // 2
    pieces = [gzip.compress(HOUSES["groups.obj"][a:b]) for a, b in ((0, half), (half, None))]
    found = read_raw("a.obj.gz", b"".join(pieces) + bytes(512))
    assert np.array_equal(found.vertices, read_raw("a.obj", HOUSES["groups.obj"]).vertices)


def test_corners_of_single_triangles_are_no_more_points_than_shared_ones(monkeypatch):
    monkeypatch.setattr("core.scan.readers.raw_scan.MOST_POINTS", 20)
    for name in ("binary.stl", "text.stl"):
        assert len(read_raw(name, HOUSES[name]).vertices) == 3 * len(TRIANGLES) > 20


@pytest.mark.parametrize("name", sorted(HOUSES))
def test_a_file_cut_anywhere_is_refused_or_read_in_part(name):
    data = HOUSES[name]
    for end in range(0, len(data), 1 + len(data) // 80):
        try:
            vertices, faces = read_triangles(name, data[:end])
        except ScanError:
            continue
        assert faces.size == 0 or faces.max() < len(vertices)


def test_whatever_is_damaged_only_a_refusal_comes_out():
    outcomes = set()
    for run in range(600):
        name, data = damaged_file(random.Random(run), HOUSES | CLOUDS)
        try:
            outcomes.add(type(read_raw(name, data)))
        except ScanError as refusal:
            outcomes.add(type(refusal.__cause__))
    assert outcomes >= {RawScan, ValueError, type(None)}
    assert MemoryError not in outcomes


def test_places_that_are_no_numbers_are_read_as_such():
    scan = read_raw("a.obj", b"v nan 1 2\nv -inf 1e999 -nan(ind)\nv 1.#QNAN 0 1\nv 1 2 3\nf 1 2 4\n")
    assert np.isnan(scan.vertices[:3]).sum() == 3
    assert np.array_equal(scan.vertices[3], [1.0, 2.0, 3.0])


def test_places_far_from_the_origin_keep_all_digits_of_the_file():
    far = np.array(CORNERS) + 1e6 + 1 / 16  # a sixteenth: single precision still tells it there
    text = "".join(f"v {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in far.tolist())
    assert np.array_equal(read_raw("a.obj", text.encode()).vertices, far)
    binary = ply("binary_little_endian")
    start = binary.index(b"end_header\n") + 11
    moved = binary[:start] + far.astype("<f4").tobytes() + binary[start + 120 :]
    assert np.array_equal(read_raw("a.ply", moved).vertices, far)


def test_too_much_is_refused_with_a_number(monkeypatch):
    monkeypatch.setattr("core.scan.readers.raw_scan.MOST_TRIANGLES", 10)
    for name in ("little.ply", "groups.obj", "binary.stl", "plain.off", "binary.glb"):
        with pytest.raises(ScanError, match="too large") as refusal:
            read_raw(name, HOUSES[name])
        assert "at most 10,000,000 points and 10 triangles" in str(refusal.value.hint)


def test_a_packed_bomb_is_left_alone(monkeypatch):
    with pytest.raises(ScanError, match="decompresses to more than 50 times its size"):
        read_raw("a.obj.gz", gzip.compress(bytes(100_000_000), 1))
    monkeypatch.setattr("core.scan.readers.registry.LARGEST_FILE", 1_000_000)
    with pytest.raises(ScanError, match="too large after decompression"):
        read_raw("a.obj.gz", gzip.compress(bytes(2_000_000), 0))


def test_what_is_no_file_is_not_even_opened(tmp_path):
    os.mkfifo(tmp_path / "pipe.ply")
    with open(tmp_path / "large.ply", "wb") as large:
        large.truncate(LARGEST_FILE + 1)
    for path, words in (
        (tmp_path / "pipe.ply", "not a file"),
        (Path("/dev/zero"), "not a file"),
        (tmp_path, "cannot be read"),
        (tmp_path / "large.ply", "too large"),
        (Path("a\0b.ply"), "cannot be read"),
        (tmp_path / ("x" * 300), "cannot be read"),
    ):
        with pytest.raises(ScanError, match=words):
            scan_bytes(path)


@pytest.mark.parametrize("name", HOUSES)
def test_reading_stops_when_nobody_wants_it(name):
    def stop(what: str, share: float) -> None:
        assert what == "reading"
        assert 0.0 <= share <= 1.0
        raise Cancelled

    with pytest.raises(Cancelled):
        read_raw(name, HOUSES[name], stop)
