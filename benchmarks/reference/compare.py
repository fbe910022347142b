"""Comparison of the model with a stored case, and its own error from a finer mesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from core.geometry.mesh import Floats, Points
from reference.cases import Case, model_of, read_case, solved
from reference.model import COUNT
from reference.solid_mesh import over_fixed

FINER = 603
"""Points of the skin of the mesh with about 1.7 times the unknowns."""

DISC = 20.0
"""Radius of the disc around a bust point over which the rise is averaged [mm]."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Displacements of the nodes ``places`` (n, 3) [mm]: stored, of the model and of a finer one."""

    case: Case
    places: Points
    stored: Floats
    usual: Floats
    finer: Floats
    info: dict[str, Any]
    unknowns: tuple[int, int]

    def lines(self) -> list[str]:
        """Return the comparison in words, one line for each quantity."""
        size = root_mean_square(self.stored)
        error, own = root_mean_square(self.usual - self.stored), root_mean_square(self.finer - self.usual)
        fine = root_mean_square(self.finer - self.stored)
        free = ~over_fixed(self.places, self.case.control, self.case.fixed)
        error_free = root_mean_square((self.usual - self.stored)[free])
        size_free = root_mean_square(self.stored[free])
        return [
            f"rms difference {error:.2f} of {size:.2f} mm ({100.0 * error / size:.1f} %), "
            f"finer mesh {fine:.2f} mm ({100.0 * fine / size:.1f} %)",
            f"own error {own:.2f} mm ({100.0 * own / size:.1f} %), "
            f"{self.unknowns[0]} and {self.unknowns[1]} unknowns",
            f"skin over free control points: difference {error_free:.2f} of {size_free:.2f} mm "
            f"({100.0 * error_free / size_free:.1f} %)",
            *(
                f"rise of the disc, {side}: stored {disc_rise(self.places, self.stored, bust):.2f}, "
                f"model {disc_rise(self.places, self.usual, bust):.2f}, "
                f"finer mesh {disc_rise(self.places, self.finer, bust):.2f} mm"
                for side, bust in zip(("left", "right"), self.case.busts, strict=True)
            ),
            str(self.info),
        ]


def compare(path: Path, bodies: Path) -> Comparison:
    """Return the comparison with the case stored in ``path``; its body is in the folder ``bodies``."""
    case, places, stored = read_case(path)
    moved, infos, unknowns = [], [], []
    for count in (COUNT, FINER):
        model = model_of(case, bodies, count)
        nodes, info = solved(case, model)
        moved.append(model.surface.weights(places) @ (nodes - model.nodes))
        infos.append(info)
        unknowns.append(len(model.loaded_body.tissue.free))
    return Comparison(case, places, stored, moved[0], moved[1], infos[0], (unknowns[0], unknowns[1]))


def disc_rise(places: Points, displacement: Floats, centre: Floats) -> float:
    """Return the mean rise of ``places`` (n, 3) within the disc around ``centre`` [mm]."""
    return float(displacement[np.linalg.norm(places - centre, axis=1) < DISC, 2].mean())


def root_mean_square(vectors: Floats) -> float:
    """Return the root of the mean square length of ``vectors`` (n, 3)."""
    return float(np.sqrt((vectors**2).sum(axis=1).mean()))
