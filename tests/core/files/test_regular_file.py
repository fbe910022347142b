"""What is no file is refused at once, by whatever reads files: a pipe never ends, nor does a device."""

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from app.research.ground_truth import read_truths
from core.analysis.inverse_design.profile_curve import read_profile
from core.document.design import ScanSource
from core.document.storage.project_file import open_project, picture_bytes, read_scan_file
from core.document.storage.recovery import load_unsaved
from core.errors import UserError
from core.files.regular_file import read_regular
from core.garment.elastic_library import read_elastic
from core.garment.presets import read_preset
from core.measurements.size_table import read_table

READERS: dict[str, tuple[str, Callable[[Path], object]]] = {
    "project": ("anna.busk", open_project),
    "scan": ("anna.ply", lambda path: read_scan_file(ScanSource(str(path)))),
    "scan in a project": ("anna.busk", lambda path: read_scan_file(ScanSource(str(path), "scan/anna.ply"))),
    "preset": ("anna.json", read_preset),
    "sizes": ("anna.json", read_table),
    "elastic": ("anna.csv", read_elastic),
    "profile": ("anna.csv", lambda path: read_profile(str(path))),
    "truth": ("truth.json", lambda path: read_truths(path.parent)),
    "recovery": ("document.json", lambda path: load_unsaved(path.parent)),
}


@pytest.mark.skipif(sys.platform == "win32", reason="pipes and devices of POSIX")
@pytest.mark.parametrize("what", READERS)
def test_what_is_no_file_is_refused_at_once(tmp_path: Path, what: str) -> None:
    name, read = READERS[what]
    for make in (os.mkfifo, lambda path: path.symlink_to("/dev/zero"), Path.mkdir):
        place = tmp_path / name
        make(place)
        with pytest.raises(UserError, match="is damaged" if what == "recovery" else "cannot be read"):
            read(place)
        place.rmdir() if place.is_dir() else place.unlink()


@pytest.mark.skipif(sys.platform == "win32", reason="pipes of POSIX")
def test_a_picture_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "anna.busk")
    assert picture_bytes(tmp_path / "anna.busk") is None


def test_no_more_is_read_than_was_agreed(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_bytes(bytes(100))
    assert read_regular(path, 100) == bytes(100)
    with pytest.raises(OSError, match="too large"):
        read_regular(path, 99)
