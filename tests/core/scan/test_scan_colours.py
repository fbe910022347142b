"""Colours of scans: read from every format that has them, laid on the body, no reason to refuse it."""

import io
import json
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from coloured_scans import (
    BLUE,
    COLOURED,
    MTL,
    RED,
    SAMPLE,
    coloured_ply,
    painted_sample,
    picture,
    textured_gltf,
    textured_obj,
)
from PIL import Image
from scan_files import HOUSES

from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.project_file import ScanFile, open_project, save_project
from core.errors import ScanError
from core.pipeline.build import read_body
from core.scan.body import body_of, read_scan
from core.scan.edited_body import apply_edits
from core.scan.readers.colors import UNREADABLE, texture
from core.scan.readers.raw_scan import RawScan
from core.scan.readers.registry import read_raw, scan_bytes
from core.scan.source import ScanEdits


def check(scan: RawScan, off: int = 1) -> None:
    """Each vertex has the colour of its side, whatever order the file has them in."""
    assert scan.colours is not None
    assert scan.notes == ()
    right = np.where(np.abs(scan.vertices[:, 1:2]) < 1.0, RED, BLUE)
    assert (scan.colours[:, 3] == 255).all()
    assert np.abs(scan.colours[:, :3].astype(int) - right).max() <= off


@pytest.mark.parametrize("name", COLOURED)
def test_colours_are_read_at_the_vertices(name: str) -> None:
    check(read_raw(name, COLOURED[name]))


def test_colours_in_whole_numbers_of_four_bytes_are_bytes() -> None:
    check(read_raw("wide.ply", coloured_ply().replace(b"property uchar", b"property int")))


def test_vertices_without_a_colour_beside_others_with_one_have_none() -> None:
    assert read_raw("groups.obj", HOUSES["groups.obj"]).colours[:, 3].tolist() == [255] * 5 + [0] * 5
    assert read_raw("odd.ply", coloured_ply().replace(b"green", b"grain")).colours is None


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_a_texture_beside_an_obj_file_goes_with_it(tmp_path, kind: str) -> None:
    (tmp_path / "house.obj").write_bytes(textured_obj())
    (tmp_path / "house.mtl").write_bytes(MTL)
    (tmp_path / "skin.png").write_bytes(picture(kind))
    data = scan_bytes(tmp_path / "house.obj")
    check(read_raw("elsewhere.obj", data), off=3)
    assert data.startswith(textured_obj())  # the shape stays to the letter
    plain = read_raw("house.obj", textured_obj())
    assert np.array_equal(read_raw("house.obj", data).faces, plain.faces)
    assert plain.colours is None


def test_a_texture_beside_a_gltf_file_goes_with_it(tmp_path) -> None:
    document = json.loads(textured_gltf(uri="the%20skin.png"))
    (tmp_path / "house.gltf").write_text(json.dumps(document))
    (tmp_path / "the skin.png").write_bytes(picture())
    check(read_raw("elsewhere.gltf", scan_bytes(tmp_path / "house.gltf")))


@pytest.mark.parametrize(
    "image", [None, b"", b"\x89PNG\r\n\x1a\nbroken", picture()[:60], b"not an image" * 99]
)
def test_a_broken_texture_costs_the_colours_alone(tmp_path, image: bytes | None) -> None:
    (tmp_path / "house.obj").write_bytes(textured_obj())
    (tmp_path / "house.mtl").write_bytes(MTL)
    if image is not None:
        (tmp_path / "skin.png").write_bytes(image)
    scans = [read_raw("house.obj", scan_bytes(tmp_path / "house.obj"))]
    scans += [read_raw("a.gltf", textured_gltf(image))] if image is not None else []
    for scan in scans:
        assert scan.colours is None
        assert scan.notes == (UNREADABLE,)
        assert len(scan.vertices) >= 10


def test_names_that_lead_out_of_the_folder_are_not_followed(tmp_path) -> None:
    inside = tmp_path / "scan"
    inside.mkdir()
    (tmp_path / "skin.png").write_bytes(picture())
    (inside / "house.obj").write_bytes(textured_obj())
    for name in (b"../skin.png", str(tmp_path / "skin.png").encode()):
        (inside / "house.mtl").write_bytes(b"newmtl skin\nmap_Kd " + name)
        assert read_raw("house.obj", scan_bytes(inside / "house.obj")).notes == (UNREADABLE,)
    (inside / "house.mtl").unlink()
    (inside / "house.mtl").symlink_to(tmp_path / "house.mtl")
    (tmp_path / "house.mtl").write_bytes(MTL)
    assert scan_bytes(inside / "house.obj") == textured_obj()


def test_an_image_of_far_more_pixels_than_bytes_is_no_texture() -> None:
    with pytest.raises(ValueError, match="cannot be read"):
        texture(picture(), 4 * 16 * 8 - 1)
    assert texture(picture(), 4 * 16 * 8).shape == (8, 16, 3)
    packed = io.BytesIO()
    Image.new("1", (6000, 6000)).save(packed, "PNG")  # 5 kB
    assert read_raw("a.gltf", textured_gltf(packed.getvalue())).notes == (UNREADABLE,)


def test_a_progressive_image_is_held_whole_and_so_has_a_limit() -> None:
    packed = io.BytesIO()
    Image.new("RGB", (64, 64), RED).save(packed, "JPEG", progressive=True)
    data = bytearray(packed.getvalue())
    sides = data.index(b"\xff\xc2") + 5
    data[sides : sides + 4] = struct.pack(">HH", 13_000, 13_000)  # more than what Pillow warns of
    with pytest.raises(ValueError, match="cannot be read") as caught:
        texture(bytes(data), 1 << 40)
    assert "memory" in str(caught.value.__cause__)


def test_an_odd_comment_is_no_reason_to_refuse_an_obj_file() -> None:
    scan = read_raw("house.obj", b"#MRGB abc\n" + textured_obj())
    assert (len(scan.vertices), scan.notes) == (10, (UNREADABLE,))


def test_a_scan_that_is_too_fine_is_refused_before_its_texture_is_sampled(tmp_path, monkeypatch) -> None:
    (tmp_path / "house.mtl").write_bytes(MTL)
    (tmp_path / "skin.png").write_bytes(picture())
    (tmp_path / "house.obj").write_bytes(textured_obj())
    monkeypatch.setattr("core.scan.readers.raw_scan.MOST_TRIANGLES", 12)
    monkeypatch.setattr("core.scan.readers.obj.blocks", pytest.fail)
    with pytest.raises(ScanError, match="too large"):
        read_raw("house.obj", scan_bytes(tmp_path / "house.obj"))


def test_a_file_that_a_gltf_file_names_often_is_joined_once(tmp_path) -> None:
    document = json.loads(textured_gltf(uri="skin.png"))
    document["images"] *= 50
    (tmp_path / "house.gltf").write_text(json.dumps(document))
    (tmp_path / "skin.png").write_bytes(picture() + bytes(100_000))
    data = scan_bytes(tmp_path / "house.gltf")
    assert len(data) < 200_000
    check(read_raw("elsewhere.gltf", data))


@pytest.fixture(scope="module")
def painted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("painted") / "painted.ply"
    path.write_bytes(painted_sample())
    return path


def test_colours_follow_cleaning_cropping_mirroring_and_filling(painted) -> None:
    body = read_scan(painted)
    assert body.colours is not None
    left = body.mesh.vertices[:, 0] > 1.0
    assert (body.colours[left, :3] == RED).all()
    assert (body.colours[body.mesh.vertices[:, 0] < -1.0, :3] == BLUE).all()
    low, high = body.heights
    cropped = apply_edits(body, ScanEdits(low=60.0, high=high - low - 40.0))
    assert len(cropped.mesh.vertices) < len(body.mesh.vertices)
    assert (cropped.colours[cropped.mesh.vertices[:, 0] > 5.0, :3] == RED).all()
    mirrored = apply_edits(body, ScanEdits(kept="left"))
    away = np.abs(mirrored.mesh.vertices[:, 0]) > 10.0
    assert (mirrored.colours[away, :3] == RED).all()  # both halves are those of the left side
    centre = body.mesh.vertices[np.argmin(body.mesh.vertices[:, 1])]
    keep = np.linalg.norm(body.mesh.vertices - centre, axis=1)[body.mesh.faces].min(axis=1) > 20.0
    holed = replace(body, mesh=type(body.mesh)(body.mesh.vertices, body.mesh.faces[keep]))
    filled = apply_edits(holed, ScanEdits(fill_all=True))
    assert len(filled.estimated)
    assert not filled.colours[filled.estimated, 3].any()  # an estimate has no colour
    assert len(filled.colours) == len(filled.mesh.vertices)


def test_colours_are_saved_with_the_project(painted, tmp_path) -> None:
    scan = ScanFile(painted.name, scan_bytes(painted))
    document = Document.single(Design(ScanSource(str(painted))))
    saved = save_project(tmp_path / "a.busk", document, scan, None)
    painted_body = read_body(open_project(tmp_path / "a.busk").design.scan)[1]
    assert saved.design.scan.member
    assert np.array_equal(painted_body.colours, read_scan(painted).colours)


def test_a_scan_of_one_colour_shows_none(painted) -> None:
    scan = read_raw(SAMPLE.name, SAMPLE.read_bytes())
    lines = [f"v {x} {y} {z} 0.7 0.7 0.7" for x, y, z in scan.vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (scan.faces + 1).tolist()]
    assert body_of("grey.obj", "\n".join(lines).encode()).colours is None
