"""Files that a scan's file names beside it: found in its own folder only."""

from __future__ import annotations

import re
from pathlib import Path


def companion_file(path: Path, name: str) -> Path | None:
    """Return the file in the folder of ``path`` that a plain name means, None if there is none."""
    if not re.fullmatch(r"[^/\\:\0]{1,255}", name):
        return None
    file = (path.parent / name).resolve()
    return file if file.parent == path.parent.resolve() and file.is_file() else None
