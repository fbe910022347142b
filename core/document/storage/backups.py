"""Backups: the former versions of a project, copied whenever a save replaces one by another."""

from __future__ import annotations

import filecmp
import hashlib
import logging
import os
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import platformdirs

from core.document.storage.project_file import SUFFIX, safe_name
from core.errors import UserError
from core.files.atomic_write import atomic_path, private_folder, remove_abandoned, resolve_links
from core.files.regular_file import open_regular, read_text

MOST = 5
"""Former versions that are kept of a project, unless told otherwise."""

_SOURCE = "project.txt"
_LONGEST_PATH = 100_000  # bytes


def backups_folder() -> Path:
    """Return the folder that holds the backups of all projects."""
    return Path(platformdirs.user_data_path("Busk", appauthor=False)) / "backups"


@dataclass(frozen=True)
class Backup:
    """A former version of ``project``; ``time`` [s] since 1970 tells when that version was saved."""

    path: Path
    project: Path
    time: float


@contextmanager
def backup_before_write(project: Path, most: int = MOST) -> Iterator[None]:
    """Keep the project as it is now, before anything can fail, while it is overwritten.

    The oldest versions beyond ``most`` go only when that went well. Where none can be kept the project is
    overwritten all the same: without a backup is better than not at all.
    """
    try:
        back_up(project, most)
    except (OSError, UserError) as problem:
        logging.error("the former version could not be kept: %s", problem)
    yield
    with suppress(OSError):
        for old in _versions(_folder_of(project))[:-most] if most > 0 else ():
            old.unlink(missing_ok=True)


def back_up(project: Path, most: int = MOST) -> Path | None:
    """Copy the project into its folder of backups, unless the last one there is the same.

    Returns where the copy is, None if there is nothing to keep. Raises OSError, ProjectError.
    """
    if most < 1 or not project.is_file():
        return None
    folder = _folder_of(project)
    private_folder(backups_folder())
    private_folder(folder)
    remove_abandoned(folder)
    versions = _versions(folder)
    filecmp.clear_cache()  # it takes files of one size and time for the same
    if versions and filecmp.cmp(project, versions[-1], shallow=False):
        return versions[-1]
    with atomic_path(folder / _SOURCE, private=True) as partial:
        partial.write_text(str(project), encoding="utf-8", errors="surrogateescape")
    # The clock may have been set back: the newest version is the last by name all the same.
    number = max(time.time_ns(), *(int(each.stem) + 1 for each in versions if each.stem.isdecimal()), 0)
    backup = folder / f"{number:020d}{SUFFIX}"
    with atomic_path(backup, private=True) as partial:
        _copy(project, partial)
    return backup


def backups() -> list[Backup]:
    """Return all backups, those saved last first."""
    found = []
    for folder in backups_folder().glob("*/"):
        with suppress(OSError):
            text = read_text(folder / _SOURCE, _LONGEST_PATH, "utf-8", "surrogateescape")
            found += [Backup(each, Path(text), each.stat().st_mtime) for each in _versions(folder)]
    return sorted(found, key=lambda backup: (-backup.time, backup.path.name))


def _versions(folder: Path) -> list[Path]:
    """Return the backups in a folder, the oldest first; what is no file any more, such as a link, is none."""
    return sorted(each for each in folder.glob(f"*{SUFFIX}") if each.is_file())


def _folder_of(project: Path) -> Path:
    absolute = str(resolve_links(project))
    mark = hashlib.sha256(absolute.encode("utf-8", "surrogateescape")).hexdigest()[:12]
    return backups_folder() / f"{safe_name(project.stem)}-{mark}"


def _copy(project: Path, copy: Path) -> None:
    """Copy bytes and time of a file; where the system can, both share their place until one is changed."""
    with open(open_regular(project), "rb") as source, open(copy, "wb") as target:
        times = os.fstat(source.fileno())
        try:
            while os.copy_file_range(source.fileno(), target.fileno(), 1 << 30):
                pass
            if os.fstat(target.fileno()).st_size != times.st_size:
                raise OSError("not all of it")
        except (OSError, AttributeError):
            source.seek(0)
            target.seek(0)
            shutil.copyfileobj(source, target, 1 << 20)
            target.truncate()
    os.utime(copy, ns=(times.st_atime_ns, times.st_mtime_ns))
