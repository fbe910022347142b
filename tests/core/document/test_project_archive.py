"""A project's archive takes memory for what is in it, whatever it says of itself."""

import struct
import tracemalloc
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest
from small_project import DESIGN

from core.document.design import ScanSource
from core.document.serialization import to_json
from core.document.storage.archive import HEADROOM
from core.document.storage.project_file import open_project, picture_bytes, read_scan_file
from core.errors import ProjectError

MEMBER = "scan/body.ply"
INSIDE = to_json(replace(DESIGN, scan=ScanSource("", member=MEMBER)))


def crafted(path: Path, packed: int, **members: bytes) -> Path:
    with zipfile.ZipFile(path, "w", packed) as archive:
        for name, data in {"design.json": INSIDE.encode(), MEMBER: b"ply", **members}.items():
            archive.writestr(name, data)
    return path


def refused(read, *values: object) -> tuple[str, int]:  # type: ignore[no-untyped-def]
    """Return the sentence with which something is refused, and how many bytes it took until then."""
    tracemalloc.start()
    try:
        with pytest.raises(ProjectError) as problem:
            read(*values)
        return str(problem.value), tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("packed", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_what_cannot_be_unpacked_piece_by_piece_is_not_unpacked(tmp_path: Path, packed: int) -> None:
    path = crafted(tmp_path / "anna.busk", packed)
    sentence, _ = refused(open_project, path)
    assert "design.json of this project uses an unsupported compression" in sentence


@pytest.mark.parametrize("lie", [False, True])
def test_a_scan_that_unpacks_to_far_more_than_its_file_is_refused(tmp_path: Path, lie: bool) -> None:
    path = crafted(tmp_path / "anna.busk", zipfile.ZIP_DEFLATED, **{MEMBER: bytes(200_000_000)})
    if lie:  # that it holds 500 bytes
        whole = path.read_bytes()
        path.write_bytes(whole.replace(struct.pack("<L", 200_000_000), struct.pack("<L", 500)))
    design = open_project(path).design
    sentence, most = refused(read_scan_file, design.scan)
    assert "larger than" in sentence or "is an incomplete" in sentence
    assert most < 2.2 * HEADROOM  # a buffer that grows is there twice for a moment


def test_packed_projects_are_read(tmp_path: Path) -> None:
    scan = b"ply\n" + b"1.0 2.0 3.0\n" * 1000
    path = crafted(tmp_path / "anna.busk", zipfile.ZIP_DEFLATED, **{MEMBER: scan, "preview.png": b"picture"})
    assert read_scan_file(open_project(path).design.scan).data == scan
    assert picture_bytes(path) == b"picture"


def test_a_table_of_contents_without_end_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "anna.busk"
    with zipfile.ZipFile(path, "w") as archive:
        for k in range(40_000):
            archive.writestr(f"{k}", b"")
    sentence, most = refused(open_project, path)
    assert "an incomplete Busk project" in sentence
    assert most < 10_000_000


def test_a_picture_of_another_program_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "anna.busk").write_bytes(b"no archive")
    assert picture_bytes(tmp_path / "anna.busk") is None
    assert picture_bytes(crafted(tmp_path / "bare.busk", zipfile.ZIP_STORED)) is None
