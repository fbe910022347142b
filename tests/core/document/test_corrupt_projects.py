"""Projects that were cut, scrambled or made by a bad hand: a sentence and nothing worse."""

import os
import zipfile
from contextlib import suppress
from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from small_project import DESIGN, PICTURE, SCAN

from core.document.design import ScanSource
from core.document.document import Document
from core.document.serialization import to_json
from core.document.storage.project_file import open_project, read_scan_file, save_project
from core.errors import ProjectError, UserError


def test_every_truncation_is_refused_in_a_sentence(project):
    whole = project.read_bytes()
    for length in range(0, len(whole), 7):
        project.write_bytes(whole[:length])
        with pytest.raises(ProjectError) as refused:
            read_scan_file(open_project(project).design.scan)
        assert refused.value.hint


@settings(deadline=None, max_examples=200, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(changes=st.lists(st.tuples(st.integers(0, 10**6), st.integers(0, 255)), min_size=1, max_size=4))
def test_no_flipped_byte_does_worse_than_a_refusal(tmp_path, changes):
    path = tmp_path / "anna.busk"
    save_project(path, Document.single(DESIGN), SCAN, PICTURE)
    broken = bytearray(path.read_bytes())
    for place, value in changes:
        broken[place % len(broken)] = value
    path.write_bytes(bytes(broken))
    # Any other error than a refusal fails this test, and so does a scan that is not the one that was saved.
    with suppress(UserError):
        assert read_scan_file(open_project(path).design.scan).data == SCAN.data


def test_no_flipped_bit_in_the_table_of_contents_does_worse_than_a_refusal(project):
    """There stand the bits for encryption and for kinds of compression that nobody can unpack."""
    whole = project.read_bytes()
    refused = set()
    for place in range(whole.index(b"PK\x01\x02"), len(whole)):
        for bit in (0, 5, 6):
            project.write_bytes(whole[:place] + bytes([whole[place] ^ 1 << bit]) + whole[place + 1 :])
            try:
                read_scan_file(open_project(project).design.scan)
            except ProjectError as problem:
                refused.add(type(problem.__cause__))
    assert {RuntimeError, NotImplementedError, zipfile.BadZipFile} <= refused


def crafted(path, design_text, **members):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("design.json", design_text)
        for name, data in members.items():
            archive.writestr(name, data)
    return path


def test_an_empty_file_and_other_archives_are_no_projects(tmp_path):
    path = tmp_path / "anna.busk"
    for content in (b"", b"PK", b"ply\n", os.urandom(1000)):
        path.write_bytes(content)
        with pytest.raises(ProjectError, match="an incomplete Busk project"):
            open_project(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("letter.txt", "dear")
    with pytest.raises(ProjectError, match="not a Busk project"):
        open_project(path)


def test_a_project_without_its_scan_is_refused(tmp_path):
    inside = replace(DESIGN, scan=ScanSource("", member="scan/body.ply"))
    with pytest.raises(ProjectError, match="contains no scan"):
        open_project(crafted(tmp_path / "anna.busk", to_json(inside)))


def test_a_project_without_a_design_inside_is_refused(tmp_path):
    with pytest.raises(ProjectError, match="cannot be read"):
        open_project(crafted(tmp_path / "anna.busk", "[[]]"))


@pytest.mark.parametrize(
    "member", ["../../evil.ply", "scan/..", "/", "..", "/etc/passwd.ply", "a" * 300 + ".ply", "scan/a:b?.ply"]
)
def test_a_scan_with_a_hostile_name_gets_a_harmless_one(tmp_path, member):
    design = open_project(
        crafted(
            tmp_path / "anna.busk",
            to_json(replace(DESIGN, scan=ScanSource("", member=member))),
            **{member: b"ply"},
        )
    ).design
    scan = read_scan_file(design.scan)
    assert scan.data == b"ply"
    save_project(tmp_path / "again.busk", Document.single(design), scan, None)
    with zipfile.ZipFile(tmp_path / "again.busk") as archive:
        _, kept = archive.namelist()
    assert kept.startswith("scan/")
    assert len(kept.split("/")) == 2
    assert ".." not in kept
    assert sorted(path.name for path in tmp_path.iterdir()) == ["again.busk", "anna.busk"]
