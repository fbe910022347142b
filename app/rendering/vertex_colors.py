"""The colours of skin: clay that is darker in folds, those of the scan, or a map of values with its folds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.rendering.appearance import Appearance, rgb
from core.geometry.mesh import Flags, Floats
from core.geometry.plane_sections import interpolate

Colours = npt.NDArray[np.uint8]

FOLDS = 0.16
"""How much of its light a map loses in the deepest folds [1]."""


@dataclass(frozen=True)
class Ramp:
    """Colours of values: ``stops``, "#rrggbb", spread evenly from ``low`` to ``high``; the ends go on.

    Where there is no value the colour is ``blank``.
    """

    stops: tuple[str, ...]
    low: float
    high: float
    blank: str

    def __call__(self, values: Floats) -> Floats:
        """Return the colours of values, shapes (k,) and (k, 3) 0..255."""
        at = np.linspace(self.low, self.high, len(self.stops))
        table = np.stack([rgb(stop) for stop in self.stops])
        colours = interpolate(values, at, table)
        colours[np.isnan(values)] = rgb(self.blank)
        return colours


def clay_colours(occlusion: Floats, plate: Flags, look: Appearance) -> Colours:
    """Return the colour of each vertex, (n, 3) uint8: clay in the open, deep in folds, plaster plates."""
    open_sky = np.clip((occlusion - 0.36) / 0.50, 0.0, 1.0)
    deep, clay = rgb(look.deep), rgb(look.clay)
    colours = np.empty((len(occlusion), 3), dtype=np.uint8)
    for k in range(3):  # channel by channel a million vertices take half the time
        colours[:, k] = np.round(deep[k] + (clay[k] - deep[k]) * open_sky)
    colours[plate] = np.round(rgb(look.plaster))
    return colours


def scan_colours(clay: Colours, scanned: Colours, occlusion: Floats) -> Colours:
    """Return the colours of a scan, (n, 4), a little darker in folds, and ``clay`` where it has none."""
    shade = 1.0 - FOLDS + FOLDS * np.clip(occlusion, 0.0, 1.0)
    known = scanned[:, 3] > 0
    clay[known] = np.round(scanned[known, :3] * shade[known, None])
    return clay


def map_colours(colours: Floats, occlusion: Floats, plate: Flags, look: Appearance) -> Colours:
    """Return the colours of a map, (n, 3) 0..255, a little darker in folds; plates stay plaster."""
    shaded = colours * (1.0 - FOLDS + FOLDS * np.clip(occlusion, 0.0, 1.0))[:, None]
    shaded[plate] = rgb(look.plaster)
    return np.asarray(np.round(shaded), dtype=np.uint8)
