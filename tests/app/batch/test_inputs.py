"""Scans of a run: files, folders, patterns and lists, whatever is in them."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

import pytest

from app.batch.inputs import file_digest, list_scans, printable_path
from core.errors import UserError


def touch(path: Path) -> str:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(b"x")
    return str(path)


def test_folders_are_listed_in_order_with_all_below_them(tmp_path: Path) -> None:
    names = ["b.ply", "a.OBJ", "deep/er/c.stl.gz", "deep/名前.glb"]
    expected = [touch(tmp_path / name) for name in names]
    for other in ("notes.txt", "table.csv", "picture.png", "archive.gz"):
        touch(tmp_path / other)
    listed = list_scans([str(tmp_path), str(tmp_path / "b.ply")])
    assert sorted(listed) == sorted(expected)
    assert listed[:2] == [expected[1], expected[0]]


@pytest.mark.skipif(os.name == "nt", reason="links need rights there")
def test_links_in_circles_end(tmp_path: Path) -> None:
    scan = touch(tmp_path / "in" / "a.ply")
    (tmp_path / "in" / "loop").symlink_to(tmp_path, target_is_directory=True)
    (tmp_path / "in" / "self").symlink_to(tmp_path / "in" / "self")
    assert list_scans([str(tmp_path)]) == [scan]


def test_patterns_and_missing_files(tmp_path: Path) -> None:
    scans = [touch(tmp_path / name) for name in ("a1.ply", "a2.ply")]
    touch(tmp_path / "b.ply")
    assert list_scans([str(tmp_path / "a*.ply")]) == scans
    assert list_scans([str(tmp_path / "none.ply")]) == [str(tmp_path / "none.ply")]
    with pytest.raises(UserError, match="No scans found"):
        list_scans([str(tmp_path / "none*.ply")])


@pytest.mark.parametrize(
    "text",
    [
        "\ufeffname,Scan\nAnna,s/a.ply\n,\nBea,s/b.ply\n",
        'name;"Scan"\nAnna;s/a.ply\n;\n"B, Bea";s/b.ply\n',
        "s/a.ply,1\ns/b.ply,2",
    ],
)
def test_lists_name_scans_relative_to_them(tmp_path: Path, text: str) -> None:
    (tmp_path / "list.csv").write_text(text, "utf-8")
    assert list_scans([str(tmp_path / "list.csv")]) == [str(tmp_path / "s" / f"{name}.ply") for name in "ab"]


def test_a_list_that_cannot_be_read_is_refused(tmp_path: Path) -> None:
    (tmp_path / "list.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UserError, match=r"list\.csv cannot be read"):
        list_scans([str(tmp_path / "list.csv")])


def test_reshaped_bodies_of_runs_are_no_input_unless_their_folder_is_named(tmp_path: Path) -> None:
    scan, out, former = touch(tmp_path / "a.ply"), tmp_path / "out", tmp_path / "former"
    beside = touch(former / "b.ply")
    for name in ("design.json", "results.parquet"):
        touch(former / name)
    body = touch(former / "bodies" / "b-1.ply")
    touch(out / "bodies" / "a-1.ply")
    assert list_scans([str(tmp_path)], out) == [scan, beside]
    assert list_scans([str(tmp_path / "**" / "*.ply")], out) == [scan, beside]
    everything = list_scans([str(tmp_path / "**")], out)
    assert {each for each in everything if each.endswith(".ply")} == {scan, beside}
    assert list_scans([str(former / "bodies")], out) == [body]


def test_scans_may_be_in_the_output_folder(tmp_path: Path) -> None:
    scan = touch(tmp_path / "a.ply")
    touch(tmp_path / "bodies" / "a-1.ply")
    assert list_scans([str(tmp_path)], tmp_path) == [scan]


def test_a_scan_named_in_two_ways_is_listed_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    touch(tmp_path / "a.ply")
    monkeypatch.chdir(tmp_path)
    assert list_scans(["a.ply", "./a.ply", str(tmp_path / "a.ply"), "."]) == ["a.ply"]


def test_digests_of_files_and_of_what_is_none(tmp_path: Path) -> None:
    assert file_digest(Path(touch(tmp_path / "a.ply"))) == hashlib.sha256(b"x").hexdigest()
    assert file_digest(tmp_path) == file_digest(tmp_path / "none") == ""


@pytest.mark.skipif(os.name == "nt", reason="names are texts there")
def test_names_that_are_no_text_are_escaped() -> None:
    assert printable_path(os.fsdecode(b"\xff\xe5\x90\x8d.ply")) == "\\xff名.ply"
    assert printable_path("half \ud800 letter") == "half \\ud800 letter"
