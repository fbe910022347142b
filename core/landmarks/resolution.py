"""Resolution of the breasts in a scan: results of a coarse one have a lower confidence."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.geometry.mesh import Mesh, Points
from core.messages import Length, Message

NEAR = 40.0
"""The points of the scan are counted so far round a place [mm]."""

FINE, COARSER = 9.0, 8.0
"""Points so far apart show a fold [mm]; each ``COARSER`` [mm] more divide the confidence by e."""


def spacing(mesh: Mesh, places: Sequence[Points]) -> float:
    """Return how far apart the vertices lie round ``places``, each (3,) [mm], their median [mm]."""
    counts = [int((((mesh.vertices - place) ** 2).sum(axis=1) < NEAR**2).sum()) for place in places]
    return float(np.median(NEAR * np.sqrt(np.pi / np.maximum(counts, 1))))


def confidence_factor(apart: float) -> float:
    """Return how much (0..1) of a confidence holds where the points of the scan lie ``apart`` [mm]. Ours."""
    return float(np.exp(-max(apart - FINE, 0.0) / COARSER))


def coarse_warning(apart: float) -> tuple[Message, ...]:
    """Return one sentence if the points of the scan lie too far ``apart`` [mm] for sure landmarks."""
    if apart <= FINE + 1.0:
        return ()
    return (
        Message(
            "The scan is coarse (point spacing about {apart}). Landmarks and girths are less accurate.",
            apart=Length(apart),
        ),
    )
