"""Backups: the former versions of a project, kept whenever it is overwritten."""

from __future__ import annotations

import hashlib
import os
import shutil
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import platformdirs

from core.project import SUFFIX, safe_name, whole_file

MOST = 5
"""Former versions that are kept of a project, unless told otherwise."""

_SOURCE = "project.txt"


def backups_folder() -> Path:
    """Return the folder that holds the backups of all projects."""
    return Path(platformdirs.user_data_path("Busk", appauthor=False)) / "backups"


@dataclass(frozen=True)
class Backup:
    """A former version of ``project``; ``time`` [s] since 1970 tells when that version was saved."""

    path: Path
    project: Path
    time: float


def back_up(project: Path, most: int = MOST) -> Path | None:
    """Keep the project as it is now, before it is overwritten; returns where, or None if there is none yet.

    Only the last ``most`` versions stay. Raises OSError if it cannot be kept.
    """
    if most < 1 or not project.is_file():
        return None
    folder = _folder_of(project)
    folder.mkdir(parents=True, exist_ok=True)
    with whole_file(folder / _SOURCE) as partial:
        partial.write_text(str(project), encoding="utf-8")
    backup = folder / f"{time.time_ns():020d}{SUFFIX}"
    try:
        # Saving puts a new file in the place of the old one, which from then on is the backup's alone.
        os.link(project, backup)
    except OSError:
        with whole_file(backup) as partial:
            shutil.copy2(project, partial)
    for old in sorted(folder.glob(f"*{SUFFIX}"))[:-most]:
        old.unlink(missing_ok=True)
    return backup


def backups() -> list[Backup]:
    """Return all backups, those saved last first."""
    found = []
    for folder in backups_folder().glob("*/"):
        with suppress(OSError, ValueError):
            project = Path((folder / _SOURCE).read_text("utf-8"))
            found += [Backup(each, project, each.stat().st_mtime) for each in folder.glob(f"*{SUFFIX}")]
    return sorted(found, key=lambda backup: (-backup.time, backup.path.name))


def _folder_of(project: Path) -> Path:
    absolute = str(project.absolute())
    mark = hashlib.sha256(absolute.encode("utf-8", "surrogateescape")).hexdigest()[:12]
    return backups_folder() / f"{safe_name(project.stem)}-{mark}"
