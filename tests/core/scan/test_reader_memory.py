"""Reading takes memory for what a file holds: 64 MB and twenty times its bytes, whatever it claims."""

import json
import random
import struct
import tracemalloc
import zlib
from contextlib import suppress

import numpy as np
import pytest

from core.errors import ScanError
from core.geometry.mesh import rows_of
from core.scan.body import body_of
from core.scan.readers.ply import read_ply
from core.scan.readers.registry import read_raw

FREE, TIMES, SIZE = 64 << 20, 20, 12_000_000
CORNERS = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
PLACES = np.eye(4, 3, dtype="<f4").tobytes()


def ply(head: str, body: bytes, form: str = "binary_little_endian") -> bytes:
    return f"ply\nformat {form} 1.0\n{head}end_header\n".encode() + body


def many_properties() -> bytes:
    names = "".join(f"property char {name}\n" for name in ["x", "y", "z", *(f"p{k}" for k in range(997))])
    return ply(f"element vertex {SIZE // 1000}\n{names}", bytes(SIZE))


def one_polygon() -> bytes:
    face = "element face 1\nproperty list int int vertex_indices\n"
    return ply(CORNERS + face, PLACES + struct.pack("<i", SIZE // 4) + bytes(SIZE))


def triangles_and_quads() -> bytes:
    face = f"element face {2 * (SIZE // 90)}\nproperty list uchar uchar vertex_indices\n"
    return ply(CORNERS + face, PLACES + bytes([3, 0, 1, 2, 4, 0, 1, 2, 3]) * (SIZE // 90))


def polygons_in_text() -> bytes:
    return b"v 0 0 0\n" * 3 + (b"f" + b" 1" * 400_000 + b"\n") * (SIZE // 800_000)


def a_mesh_placed_often() -> bytes:
    count, often = 3000, 9000
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 3 * count}],
        "bufferViews": [{"buffer": 0, "byteLength": 3 * count}],
        "accessors": [{"bufferView": 0, "componentType": 5121, "count": count, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}] * often,
        "scenes": [{"nodes": list(range(often))}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + 3 * count)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", 3 * count, b"BIN\0")
    return head + chunks + bytes(3 * count)


def vtp(array: str, count: int, settings: str = "", tail: bytes = b"") -> bytes:
    piece = f'<Piece NumberOfPoints="{count}" NumberOfPolys="0"><Points><DataArray {array}</Points></Piece>'
    return f'<VTKFile type="PolyData"{settings}><PolyData>{piece}</PolyData>'.encode() + tail + b"</VTKFile>"


def text_of_a_vtp() -> bytes:
    return vtp('type="Float32" format="ascii">' + "0 " * (SIZE // 2) + "</DataArray>", SIZE // 6)


def packed_points() -> bytes:
    block, count = zlib.compress(bytes(1 << 15)), 3000
    sizes = struct.pack(f"<III{count}I", count, 1 << 15, 0, *[len(block)] * count)
    appended = b'<AppendedData encoding="raw">_' + sizes + block * count + b"</AppendedData>"
    return vtp(
        'type="Int8" format="appended" offset="0"/>', 1, ' compressor="vtkZLibDataCompressor"', appended
    )


HEAVY = {
    "properties.ply": many_properties,
    "polygon.ply": one_polygon,
    "mixed.ply": triangles_and_quads,
    "polygons.obj": polygons_in_text,
    "placed.glb": a_mesh_placed_often,
    "text.vtp": text_of_a_vtp,
    "packed.vtp": packed_points,
    "points.off": lambda: b"OFF\n%d 0 0\n" % (SIZE // 6) + b"0 0 0\n" * (SIZE // 6),
    "points.xyz": lambda: b"0 0 0\n" * (SIZE // 6),
    "tag.vtp": lambda: b'<VTKFile a="' + b"x" * 3 * SIZE + b'"></VTKFile>',
}


@pytest.mark.parametrize("name", HEAVY)
def test_reading_takes_no_more_memory_than_the_file_is_worth(name):
    data = HEAVY[name]()
    tracemalloc.start()
    with suppress(ScanError):
        read_raw(name, data)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < FREE + TIMES * len(data)


REPEATED = {
    "placed.glb": (a_mesh_placed_often, "contains too much data that does not belong"),
    "packed.vtp": (packed_points, "decompresses to more than 50 times its size"),
    "line.obj": (lambda: b"v " + b"0 " * 600_000, "a line of text longer than 1 MB"),
}


@pytest.mark.parametrize("name", REPEATED)
def test_what_describes_far_more_than_it_holds_is_refused(name):
    make, words = REPEATED[name]
    with pytest.raises(ScanError, match=words):
        read_raw(name, make())


def test_more_lists_than_polygons_can_need_are_refused():
    names = "".join(f"property list uchar uchar p{k}\n" for k in range(9))
    odd = f"element odd 2400000\n{names}element face 0\nproperty list uchar int vertex_indices\n"
    with pytest.raises(ScanError, match="contains too much data"):
        read_raw("odd.ply", ply(CORNERS + odd, PLACES + bytes([0] * 8 + [1]) + bytes(2_400_000 * 9)))


def test_what_stands_behind_all_that_is_needed_is_passed_over():
    odd = "element odd 4900000\nproperty list uchar uchar near\n"
    data = ply(CORNERS + odd, PLACES + bytes([1, 0]) + bytes(4_900_000))
    calls = []
    assert len(read_ply("a.ply", data, lambda *told: calls.append(told)).vertices) == 4
    assert calls == []


def test_missing_memory_is_called_that(monkeypatch):
    def full(*_):
        raise MemoryError

    monkeypatch.setitem(read_raw.__globals__["_READERS"], "obj", full)
    for read in (read_raw, body_of):
        with pytest.raises(ScanError, match="Not enough memory to open"):
            read("a.obj", b"v 1 2 3\n")


def test_lists_of_any_lengths_are_picked_item_by_item(monkeypatch):
    monkeypatch.setattr("core.scan.readers.ply.BLOCK", 7)
    monkeypatch.setattr("core.scan.readers.raw_scan.BLOCK", 5)
    chance = random.Random(4)
    polygons = [
        [chance.randrange(40) for _ in range(chance.choice((0, 1, 3, 3, 4, 9, 30)))] for _ in range(60)
    ]
    wanted = [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]
    head = "element vertex 40\nproperty short x\nproperty short y\nproperty short z\n"
    head += "element face 60\nproperty uchar red\nproperty list uchar {kind} vertex_indices\n"
    for form, sign in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
        rows = [struct.pack(f"{sign}BB{len(p)}H", 7, len(p), *p) for p in polygons]
        scan = read_raw("a.ply", ply(head.format(kind="ushort"), bytes(240) + b"".join(rows), form))
        assert scan.faces.tolist() == [list(face) for face in wanted]
    text = "0 0 0\n" * 40 + "".join(f"7 {len(p)} {' '.join(map(str, p))}\n" for p in polygons)
    assert np.array_equal(
        read_raw("a.ply", ply(head.format(kind="int"), text.encode(), "ascii")).faces, scan.faces
    )


def test_items_know_their_rows():
    counts = np.array([0, 3, 0, 0, 2, 1, 0, 5, 0])
    rows = np.repeat(np.arange(9), counts)
    for start in range(11):
        for stop in range(start + 1, 12):
            assert rows_of(np.cumsum(counts), start, stop).tolist() == rows[start:stop].tolist()


def test_numbers_of_an_array_may_stand_in_one_line_of_any_length():
    count = 200_000
    text = " ".join(f"{k % 1000} {k % 7} 0.5" for k in range(count))
    scan = read_raw("a.vtp", vtp(f'type="Float64" format="ascii">\n{text}</DataArray>', count))
    assert scan.vertices[-1].tolist() == [(count - 1) % 1000, (count - 1) % 7, 0.5]
