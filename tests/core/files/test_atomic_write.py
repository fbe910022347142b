"""Files are written whole or not at all, at the end of links, with their rights, under names of their own."""

import errno
import os
import stat
import sys
from pathlib import Path

import pytest

import core.files.atomic_write
from core.errors import ProjectError
from core.files.atomic_write import atomic_path, private_folder, safe_ending, write_text

posix = pytest.mark.skipif(sys.platform == "win32", reason="links, pipes and access rights of POSIX")


def left_over(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def write(target: Path, text: str = "new", private: bool = False) -> None:
    with atomic_path(target, private) as partial:
        partial.write_text(text)


def rights(path: Path) -> int:
    return stat.S_IMODE(path.stat().st_mode)


def test_nobody_sees_a_half_written_file(tmp_path: Path) -> None:
    target = tmp_path / "table.csv"
    target.write_text("old")
    with atomic_path(target) as partial:
        partial.write_text("new, not yet whole")
        assert target.read_text() == "old"
        assert partial.parent == target.parent
    assert target.read_text() == "new, not yet whole"
    assert left_over(tmp_path) == ["table.csv"]


def test_one_file_is_not_written_by_two_at_once(tmp_path: Path) -> None:
    target = tmp_path / "table.csv"
    with atomic_path(target) as partial:
        partial.write_text("the first")
        with pytest.raises(ProjectError, match=r"table\.csv is still being written"), atomic_path(target):
            pass
    assert target.read_text() == "the first"
    write(target, "the second")
    assert target.read_text() == "the second"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
def test_a_really_full_device(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(core.files.atomic_write, "_new_partial", lambda *_: Path("/dev/full"))
    monkeypatch.setattr(Path, "unlink", lambda self, missing_ok: None)
    with pytest.raises(ProjectError, match=r"No space left.*free up disk space"):
        write(tmp_path / "table.csv")
    assert left_over(tmp_path) == []


@posix
@pytest.mark.parametrize("relative", [True, False])
def test_a_link_stays_and_its_target_is_written(tmp_path: Path, relative: bool) -> None:
    inner = tmp_path / "bodies"
    inner.mkdir()
    target, link, second = inner / "anna.busk", tmp_path / "anna.busk", tmp_path / "again.busk"
    target.write_text("old")
    link.symlink_to(Path("bodies", "anna.busk") if relative else target)
    second.symlink_to("anna.busk")
    write(second)
    assert (link.is_symlink(), second.is_symlink(), target.read_text()) == (True, True, "new")
    assert left_over(inner) == ["anna.busk"]


@posix
def test_a_link_that_leads_nowhere_yet_leads_to_the_new_file(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("made.csv")
    write(tmp_path / "link")
    assert (tmp_path / "made.csv").read_text() == "new"
    assert (tmp_path / "link").is_symlink()
    (tmp_path / "lost").symlink_to("gone/made.csv")
    with pytest.raises(ProjectError, match=r"lost cannot be written: No such file"):
        write(tmp_path / "lost")


@posix
def test_links_in_a_circle_pipes_and_devices_stay_what_they_are(tmp_path: Path) -> None:
    (tmp_path / "one").symlink_to("two")
    (tmp_path / "two").symlink_to("one")
    os.mkfifo(tmp_path / "pipe")
    for name in ("one", "pipe"):
        with pytest.raises(ProjectError, match="cannot be written: not a file"):
            write(tmp_path / name)
    assert left_over(tmp_path) == ["one", "pipe", "two"]
    with pytest.raises(ProjectError, match="cannot be written"):
        write(Path(os.devnull))


@posix
@pytest.mark.parametrize("private", [True, False])
def test_a_file_keeps_its_rights_and_a_new_private_one_is_its_owner_s(tmp_path: Path, private: bool) -> None:
    former = os.umask(0o022)
    try:
        for mode in (0o600, 0o640, 0o644, 0o400):
            path = tmp_path / f"{mode:o}"
            path.write_text("old")
            path.chmod(mode)
            write(path, private=private)
            assert (rights(path), path.read_text()) == (mode, "new")
        with atomic_path(tmp_path / "fresh", private) as partial:
            assert rights(partial) == (0o600 if private else 0o644), (
                "never readable by others, not for a moment"
            )
            partial.write_text("new")
        assert rights(tmp_path / "fresh") == (0o600 if private else 0o644)
        with atomic_path(tmp_path / "600") as partial:
            assert rights(partial) == 0o600
    finally:
        os.umask(former)


@posix
def test_folders_of_personal_data_are_their_owner_s(tmp_path: Path) -> None:
    wide = tmp_path / "wide"
    wide.mkdir(0o755)
    assert rights(private_folder(wide)) == 0o700
    assert rights(private_folder(tmp_path / "new" / "inner")) == 0o700


def test_no_name_beside_the_file_can_be_guessed_or_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = []
    for _ in range(2):
        with atomic_path(tmp_path / "table.csv") as partial:
            names.append(partial.name)
            partial.write_text("new")
    assert len(set(names)) == 2
    other = tmp_path / "other"
    other.write_text("not ours")
    monkeypatch.setattr("core.files.atomic_write.secrets.token_hex", lambda _: "guessed")
    (tmp_path / ".table.csv.guessed.part").symlink_to(other)
    with pytest.raises(ProjectError, match="cannot be written"):
        write(tmp_path / "table.csv", "secret")
    assert other.read_text() == "not ours"


@pytest.mark.parametrize("name", ["x" * 250 + ".busk", "胸" * 83 + ".csv", "🧵" * 62 + ".csv"])
def test_the_longest_names_can_be_written(tmp_path: Path, name: str) -> None:
    write(tmp_path / name)
    write(tmp_path / name)
    assert left_over(tmp_path) == [name]
    (tmp_path / safe_ending(name, "lock")).touch()


def test_a_name_that_is_too_long_is_said_to_be(tmp_path: Path) -> None:
    with pytest.raises(ProjectError) as refused:
        write(tmp_path / ("x" * 300))
    assert str(refused.value.hint) == "Choose a shorter name."


def test_what_fails_is_told_and_nothing_is_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "table.csv"
    target.write_text("old")

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(ProjectError, match="No space left"):
        write(target)
    assert target.read_text() == "old"
    assert left_over(tmp_path) == ["table.csv"]


def test_a_text_with_half_a_letter_from_the_name_of_a_file_is_written(tmp_path: Path) -> None:
    write_text(tmp_path / "report.json", "K\udcf6rper 胸\n")
    assert (tmp_path / "report.json").read_bytes().decode() == "K?rper 胸\n"
