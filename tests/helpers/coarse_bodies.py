"""Sample bodies with fewer vertices, for tests that measure or draw them many times."""

from __future__ import annotations

from pathlib import Path

import trimesh
from worn_scans import decimated

from app.presenters.samples import sample_path

VERTICES = 6000
"""So many of the 33,000."""


def coarse_body(sample: str, folder: Path) -> Path:
    """Write a sample body with few vertices into a folder, and return the file."""
    whole, file = trimesh.load(sample_path(sample), process=False), folder / f"{sample}.ply"
    trimesh.Trimesh(*decimated((whole.vertices, whole.faces), VERTICES), process=False).export(file)
    return file
