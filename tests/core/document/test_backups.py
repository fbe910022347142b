"""Backups: what was saved before can be had back, whatever happens to a save or to the project's file."""

import os
import stat
import sys
from pathlib import Path

import pytest
from small_project import DESIGN, PICTURE, SCAN, write_project

import core.document.storage.backups
from core.document.document import Document
from core.document.storage.backups import back_up, backup_before_write, backups
from core.document.storage.project_file import open_project, save_project
from core.errors import ProjectError

posix = pytest.mark.skipif(sys.platform == "win32", reason="links and access rights of POSIX")


@pytest.fixture(autouse=True)
def own_base(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(core.document.storage.backups, "backups_folder", lambda: tmp_path / "backups")
    return tmp_path


def save(path: Path, ratio: float, most: int = 3) -> None:
    with backup_before_write(path, most):
        save_project(path, Document.single(DESIGN.with_line("mid-bust", ratio)), SCAN, PICTURE)


def kept() -> list[float]:
    return sorted(open_project(each.path).design.ratio("mid-bust") for each in backups())


def fail_to_sync(*_: int) -> None:
    raise OSError(28, "No space left on device")


def test_former_versions_are_kept_and_the_oldest_go(tmp_path: Path) -> None:
    assert back_up(tmp_path / "anna.busk") is None
    path = write_project(tmp_path)
    for ratio in (0.9, 0.8, 0.7, 0.6):
        save(path, ratio)
    assert {each.project for each in backups()} == {path}
    assert kept() == [0.7, 0.8, 0.9]
    assert open_project(path).design.ratio("mid-bust") == 0.6


def test_saves_that_fail_take_no_good_backup_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_project(tmp_path)
    for ratio in (0.9, 0.8, 0.7, 0.6):
        save(path, ratio)
    for _ in range(6):
        with pytest.raises(RuntimeError), backup_before_write(path, 3):
            raise RuntimeError("the program is killed")
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", fail_to_sync)
        for _ in range(6):
            with pytest.raises(ProjectError):
                save(path, 0.5)
    assert kept() == [0.6, 0.7, 0.8, 0.9], "one more, and no two alike"
    save(path, 0.5)
    assert kept() == [0.6, 0.7, 0.8]


def test_a_backup_is_a_copy_that_nothing_done_to_the_project_reaches(tmp_path: Path) -> None:
    path = write_project(tmp_path)
    whole = path.read_bytes()
    backup = back_up(path)
    assert backup is not None
    with open(path, "r+b") as file:  # as programs that keep folders alike write
        file.write(b"\0" * 100)
    assert backup.read_bytes() == whole
    assert back_up(path) != backup
    path.write_bytes(whole)
    (newest, _) = backups()
    assert newest.project == path


def test_without_what_shares_bytes_they_are_copied(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_project(tmp_path)
    monkeypatch.setattr(os, "copy_file_range", fail_to_sync, raising=False)
    backup = back_up(path)
    assert backup is not None
    assert backup.read_bytes() == path.read_bytes()
    assert backup.stat().st_mtime_ns == path.stat().st_mtime_ns


def test_a_project_that_is_as_its_last_backup_needs_no_other(tmp_path: Path) -> None:
    path = write_project(tmp_path)
    assert back_up(path) == back_up(path)
    assert len(backups()) == 1


def test_a_clock_that_was_set_back_takes_the_oldest_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_project(tmp_path)
    for ratio in (0.9, 0.8, 0.7, 0.6):
        monkeypatch.setattr(
            "core.document.storage.backups.time.time_ns", lambda ratio=ratio: round(ratio * 1e6)
        )
        save(path, ratio, most=2)
    assert kept() == [0.7, 0.8]


@posix
def test_a_project_behind_a_link_has_the_backups_of_its_file(tmp_path: Path) -> None:
    path, link = write_project(tmp_path), tmp_path / "link.busk"
    link.symlink_to("anna.busk")
    save(link, 0.9)
    save(path, 0.8)
    assert link.is_symlink()
    assert open_project(link).design.ratio("mid-bust") == 0.8
    assert kept() == [0.9, 0.97]


@posix
def test_a_backup_that_is_no_file_hides_no_other(tmp_path: Path) -> None:
    path = write_project(tmp_path)
    backup = back_up(path)
    assert backup is not None
    backup.with_name(f"{0:020d}.busk").symlink_to("gone.busk")
    assert [each.path for each in backups()] == [backup]
    save(path, 0.9)
    assert kept() == [0.97]


@posix
def test_backups_are_their_owner_s_alone(tmp_path: Path) -> None:
    path = write_project(tmp_path)
    path.chmod(0o644)
    (tmp_path / "backups").mkdir(0o755)
    backup = back_up(path)
    assert backup is not None
    for each in (backup, backup.with_name("project.txt")):
        assert stat.S_IMODE(each.stat().st_mode) == 0o600
    for each in (backup.parent, backup.parent.parent):
        assert stat.S_IMODE(each.stat().st_mode) == 0o700


def test_what_a_killed_copy_left_goes_with_the_next(tmp_path: Path) -> None:
    path = write_project(tmp_path)
    backup = back_up(path)
    assert backup is not None
    left = backup.with_name(".00000000000000000001.busk.0123456789abcdef.part")
    left.write_bytes(b"half")
    os.utime(left, (0, 0))
    save(path, 0.9)
    assert not left.exists()


@pytest.mark.parametrize("name", ["x" * 250 + ".busk", "胸" * 80 + ".busk"])
def test_projects_with_long_names_have_backups(tmp_path: Path, name: str) -> None:
    path = write_project(tmp_path).rename(tmp_path / name)
    save(path, 0.9)
    assert kept() == [0.97]
