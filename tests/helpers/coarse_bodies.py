"""Sample bodies with fewer vertices, for tests that measure or draw them many times."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import trimesh
from worn_scans import decimated

from app.presenters.samples import sample_path

VERTICES = 6000
"""So many of the 33,000."""


@cache
def coarse_arrays(sample: str) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices (n, 3) [mm] and faces (m, 3) of a sample body with few vertices."""
    whole = trimesh.load(sample_path(sample), process=False)
    return decimated((whole.vertices, whole.faces), VERTICES)


def coarse_body(sample: str, folder: Path) -> Path:
    """Write a sample body with few vertices into a folder, and return the file."""
    file = folder / f"{sample}.ply"
    trimesh.Trimesh(*coarse_arrays(sample), process=False).export(file)
    return file
