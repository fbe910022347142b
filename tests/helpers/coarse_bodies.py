"""A sample body with fewer vertices, for tests that measure it many times."""

from __future__ import annotations

from pathlib import Path

import trimesh
from worn_scans import decimated

from app.presenters.samples import sample_path

VERTICES = 6000
"""So many of the mannequin's 33,000."""


def coarse_mannequin(folder: Path) -> Path:
    """Write the mannequin with few vertices into a folder, and return the file."""
    whole, file = trimesh.load(sample_path("mannequin"), process=False), folder / "mannequin.ply"
    trimesh.Trimesh(*decimated((whole.vertices, whole.faces), VERTICES), process=False).export(file)
    return file
