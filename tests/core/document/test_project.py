"""The project file: whole or not at all, wherever it lies, whatever is done to it."""

import errno
import json
import os
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest
from small_project import DESIGN, PICTURE, SCAN

from core.document.design import ScanSource
from core.document.document import Document
from core.document.storage.project_file import (
    ScanFile,
    is_project,
    open_project,
    read_scan_file,
    save_project,
)
from core.errors import ProjectError, ScanError


def left_over(folder):
    return sorted(path.name for path in folder.iterdir())


def test_what_is_saved_is_opened_again(project):
    design = open_project(project).design
    assert replace(design, scan=DESIGN.scan) == DESIGN
    assert design.scan.unit == "cm"
    assert design.scan.path == str(project)
    scan = read_scan_file(design.scan)
    assert (scan.name, scan.data) == (SCAN.name, SCAN.data)


def test_saving_returns_what_opening_returns(tmp_path):
    path = tmp_path / "anna.busk"
    assert save_project(path, Document.single(DESIGN), SCAN, None) == open_project(path)


def test_variants_are_kept_on_one_body(tmp_path):
    path = tmp_path / "anna.busk"
    short = Document.single(DESIGN).with_shown("B").with_design(DESIGN.with_line("mid-bust", 0.8))
    assert save_project(path, short, SCAN, None) == open_project(path)
    again = open_project(path)
    assert (again.shown, again.variants["A"].lines) == ("B", DESIGN.lines)
    assert again.variants["A"].scan == again.design.scan
    told = again.with_design(replace(again.design, scan=replace(again.design.scan, unit="mm")))
    assert [each.scan.unit for each in told.variants.values()] == ["mm", "mm"]
    with zipfile.ZipFile(path) as archive:
        assert json.loads(archive.read("design.json"))["format"] == 2, "an older program must not drop them"


@pytest.mark.parametrize(
    "variants", ["[]", "{", '{"shown": "Z", "others": {}}', '{"shown": "A", "others": {"A": {}}}']
)
def test_broken_variants_are_told(project, variants):
    with zipfile.ZipFile(project, "a") as archive:
        archive.writestr("variants.json", variants)
    with pytest.raises(ProjectError, match="variants"):
        open_project(project)


def test_other_programs_can_look_inside(project):
    with zipfile.ZipFile(project) as archive:
        assert archive.namelist() == ["design.json", "scan/body.ply", "preview.png"]
        assert archive.testzip() is None
        assert archive.read("preview.png") == PICTURE
        assert json.loads(archive.read("design.json"))["scan"]["path"] == ""


def test_a_moved_project_still_opens(project, tmp_path):
    other = tmp_path / "elsewhere"
    other.mkdir()
    moved = project.rename(other / "renamed.busk")
    design = open_project(moved).design
    assert read_scan_file(design.scan).data == SCAN.data


def test_a_project_opens_by_a_relative_path(project, monkeypatch):
    monkeypatch.chdir(project.parent)
    design = open_project("anna.busk").design
    monkeypatch.chdir("/")
    assert read_scan_file(design.scan).data == SCAN.data


def test_a_project_is_saved_over_itself(project):
    design = open_project(project).design
    scan = read_scan_file(design.scan)
    for ratio in (0.95, 0.9):
        design = save_project(
            project, Document.single(design.with_line("mid-bust", ratio)), scan, None
        ).design
    again = open_project(project).design
    assert again == design
    assert again.ratio("mid-bust") == 0.9
    assert read_scan_file(again.scan).data == SCAN.data
    assert left_over(project.parent) == ["anna.busk"]


def fail_to_replace(source, target):
    raise OSError(errno.EACCES, "Permission denied")


def fail_to_sync(handle):
    raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize(("step", "failure"), [("replace", fail_to_replace), ("fsync", fail_to_sync)])
def test_a_failure_at_the_end_leaves_the_old_file_whole(project, monkeypatch, step, failure):
    before = project.read_bytes()
    monkeypatch.setattr(os, step, failure)
    with pytest.raises(ProjectError, match="cannot be written"):
        save_project(project, Document.single(DESIGN.with_line("mid-bust", 0.8)), SCAN, PICTURE)
    assert project.read_bytes() == before
    assert left_over(project.parent) == ["anna.busk"]


@pytest.mark.parametrize("member", ["design.json", "scan/body.ply", "preview.png"])
def test_a_disk_that_fills_up_leaves_the_old_file_whole(project, monkeypatch, member):
    before = project.read_bytes()
    write = zipfile.ZipFile.writestr

    def full(archive, name, data):
        if name == member:
            raise OSError(errno.ENOSPC, "No space left on device")
        write(archive, name, data)

    monkeypatch.setattr(zipfile.ZipFile, "writestr", full)
    with pytest.raises(ProjectError, match=r"No space left.*free up disk space"):
        save_project(project, Document.single(DESIGN), SCAN, PICTURE)
    assert project.read_bytes() == before
    assert left_over(project.parent) == ["anna.busk"]


def test_an_interruption_leaves_the_old_file_whole(project, monkeypatch):
    before = project.read_bytes()

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        save_project(project, Document.single(DESIGN.with_line("mid-bust", 0.8)), SCAN, None)
    assert project.read_bytes() == before
    assert left_over(project.parent) == ["anna.busk"]


@pytest.mark.parametrize("place", ["missing/anna.busk", "file/anna.busk", "folder"])
def test_a_place_that_cannot_be_written_to_is_named(tmp_path, place):
    (tmp_path / "file").write_text("a file, no folder")
    (tmp_path / "folder").mkdir()
    with pytest.raises(ProjectError, match=r"cannot be written.*Choose another folder"):
        save_project(tmp_path / place, Document.single(DESIGN), SCAN, None)
    assert left_over(tmp_path) == ["file", "folder"]


@pytest.mark.parametrize("name", ["体.ply", "K\udcf6rper.ply", "a:b|c?.ply", "x" * 200 + ".ply", "..."])
def test_scans_with_odd_names_are_saved_and_come_back(tmp_path, name):
    path = tmp_path / "anna.busk"
    save_project(path, Document.single(DESIGN), ScanFile(name, b"ply"), None)
    design = open_project(path).design
    scan = read_scan_file(design.scan)
    assert scan.data == b"ply"
    assert Path(scan.name).suffix == Path(name).suffix


def test_a_plain_scan_is_read_where_it_lies(tmp_path):
    path = tmp_path / "body.ply"
    path.write_bytes(b"ply")
    scan = read_scan_file(ScanSource(str(path)))
    assert (scan.name, scan.data) == ("body.ply", b"ply")


def test_missing_files_are_named(tmp_path):
    with pytest.raises(ScanError, match=r"body\.ply does not exist"):
        read_scan_file(ScanSource(str(tmp_path / "body.ply")))
    with pytest.raises(ProjectError, match=r"Project .*anna\.busk does not exist"):
        open_project(tmp_path / "anna.busk")
    with pytest.raises(ScanError, match="cannot be read"):
        read_scan_file(ScanSource(str(tmp_path)))
    with pytest.raises(ProjectError, match="cannot be read"):
        open_project(tmp_path)


def test_projects_are_known_by_their_ending():
    assert is_project("anna.busk")
    assert is_project(Path("ANNA.BUSK"))
    assert not is_project("anna.ply")
    assert not is_project("busk")
