"""What is not saved outlives a crash, and what is overwritten can be had back."""

import os
import time
from dataclasses import replace
from pathlib import Path

import pytest
from small_project import DESIGN, PICTURE, SCAN, write_project

import core.document.storage.backups
import core.document.storage.recovery
from core.document.document import Document
from core.document.storage.project_file import ScanFile, read_scan_file, save_project, with_scan
from core.document.storage.recovery import Recovery, find_unsaved, load_unsaved
from core.errors import ProjectError

SHORT = Document.single(DESIGN).with_shown("B").with_design(DESIGN.with_line("mid-bust", 0.8))


@pytest.fixture(autouse=True)
def own_base(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(core.document.storage.recovery, "recovery_folder", lambda: tmp_path / "recovery")
    monkeypatch.setattr(core.document.storage.backups, "backups_folder", lambda: tmp_path / "backups")
    return tmp_path


def crashed(**changes) -> Recovery:
    recovery = Recovery.new()
    recovery.save(**{"document": SHORT, "scan": SCAN, "name": "anna", "project": None} | changes)
    recovery.leave()
    return recovery


def test_what_was_kept_is_found_whole() -> None:
    crashed(project=Path("/projects/anna.busk"), picture=PICTURE)
    (kept, recovery), *others = find_unsaved()[0]
    assert not others
    assert (kept.name, kept.project, kept.picture) == ("anna", Path("/projects/anna.busk"), PICTURE)
    assert abs(kept.time - time.time()) < 60
    assert with_scan(kept.document, "", "") == with_scan(SHORT, "", "")
    scan = read_scan_file(kept.document.design.scan)
    assert (scan.name, scan.data) == (SCAN.name, SCAN.data)
    recovery.remove()
    assert not recovery.folder.exists()


def test_a_running_window_keeps_what_is_its_own() -> None:
    recovery = Recovery.new()
    recovery.save(SHORT, SCAN, "anna", None)
    assert find_unsaved() == ([], [])
    recovery.leave()
    assert len(find_unsaved()[0]) == 1


def test_the_newest_comes_first_and_nothing_to_lose_is_nothing_to_offer() -> None:
    for name in ("old", "new"):
        crashed(name=name)
    saved = crashed()
    saved.clear()
    found, _ = find_unsaved()
    assert [kept.name for kept, _ in found] == ["new", "old"]
    assert not saved.folder.exists()


def test_the_scan_is_written_when_it_changes_only_and_the_old_one_stays_until_then(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    recovery = Recovery.new()
    recovery.save(SHORT, SCAN, "anna", None)
    (first,) = recovery.folder.glob("scan*/*")
    written = first.stat().st_mtime_ns, first.stat().st_ino
    recovery.save(Document.single(DESIGN), SCAN, "anna", None)
    assert (first.stat().st_mtime_ns, first.stat().st_ino) == written
    monkeypatch.setattr(core.document.storage.recovery, "to_texts", lambda _: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        recovery.save(SHORT, ScanFile("body.ply", b"another"), "anna", None)
    assert read_scan_file(load_unsaved(recovery.folder).document.design.scan).data == SCAN.data
    monkeypatch.undo()
    recovery.save(SHORT, ScanFile("body.ply", b"another"), "anna", None)
    assert [path.read_bytes() for path in recovery.folder.glob("scan*/*")] == [b"another"]


def test_a_restored_document_goes_on_in_its_own_folder() -> None:
    crashed()
    (kept, recovery), *_ = find_unsaved()[0]
    changed = kept.document.with_design(kept.document.design.with_line("full-bust", 0.9))
    scan = read_scan_file(kept.document.design.scan)
    recovery.save(changed, scan, "anna", None)
    assert len(list(recovery.folder.glob("scan*"))) == 1
    recovery.clear()
    assert read_scan_file(changed.design.scan).data == SCAN.data, "the window still works on this scan"


@pytest.mark.parametrize("text", [b"", b"{", b"\xff\xfe", b"[]", b'{"texts": {}}'])
def test_what_is_broken_is_put_aside_and_said_once(text: bytes) -> None:
    (crashed().folder / "document.json").write_bytes(text)
    short = crashed().folder
    next(short.glob("scan*/*")).write_bytes(b"half")
    crashed(name="whole")
    found, broken = find_unsaved()
    assert [kept.name for kept, _ in found] == ["whole"]
    assert len(broken) == 2
    assert all((folder / "document.json").exists() for folder in broken), "nothing is deleted"
    assert find_unsaved()[1] == []


def test_a_full_disk_is_told_and_the_last_state_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    recovery = Recovery.new()
    recovery.save(SHORT, SCAN, "anna", None)
    monkeypatch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(ProjectError, match=r"Changes cannot be autosaved in .*: No space"):
        recovery.save(Document.single(DESIGN), SCAN, "anna", None)
    assert load_unsaved(recovery.folder).document.shown == "B"


def test_what_a_killed_program_left_beside_a_project_goes_with_the_next_save(tmp_path: Path) -> None:
    path = write_project(tmp_path)
    left, fresh = tmp_path / ".anna.busk.1.part", tmp_path / ".anna.busk.2.part"
    for each in (left, fresh):
        each.write_bytes(b"half")
    os.utime(left, (0, 0))
    save_project(path, Document.single(replace(DESIGN, lines=())), SCAN, None)
    assert not left.exists()
    assert fresh.exists(), "another window may be writing it"


def test_where_nothing_can_be_kept_it_is_said_in_words(own_base: Path) -> None:
    (own_base / "recovery").write_text("no folder")
    with pytest.raises(ProjectError, match="Changes cannot be autosaved in"):
        Recovery.new()
