"""Values along the bands of a body: how they pull, how they press, how that is painted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING
from weakref import WeakSet

import numpy as np

from app.rendering.band import Rise
from app.rendering.vertex_colors import Ramp
from core.garment.pressure import LinePressure
from core.geometry.mesh import Floats, Points
from core.geometry.plane_sections import interpolate

if TYPE_CHECKING:
    from app.rendering.band_actors import Bands

_NONE = np.empty(0)
_DASH = 2  # rows of a dash where a band bridges a hollow
_PALE = np.array([255.0, 255.0, 255.0])
_PALER = 0.75  # how pale every other dash is
_STALE = 0.42  # how much is left of the colours of a former shape


@dataclass(frozen=True, eq=False)
class BandValues:
    """A map's values at the rows of the bands, by line, (rows,); NaN where there is none.

    ``off`` [mm] tells how far the band is off the skin where it bridges a hollow, NaN elsewhere; ``rises``
    holds it there. ``stale`` values are those of a former shape.
    """

    values: Mapping[str, Floats]
    off: Mapping[str, Floats] = field(default_factory=dict)
    rises: Mapping[str, Rise] = field(default_factory=dict)
    stale: bool = False

    def at(self, line: str, row: int) -> tuple[float, float]:
        """Return the value in a row of a line's band, and how far off the skin it bridges there, or NaN.

        A value of a former shape is none.
        """
        values, off = self.values.get(line, _NONE), self.off.get(line, _NONE)
        if self.stale or row >= len(values):
            return np.nan, np.nan
        return float(values[row]), float(off[row]) if len(off) else np.nan

    def colours(self, name: str, ramp: Ramp) -> Floats:
        """Return the colours of a band, (rows, 3) 0..255; it is dashed where it bridges a hollow."""
        colours = ramp(self.values[name])
        if name in self.off:
            dash = np.arange(len(colours)) // _DASH % 2 == 0
            pale = dash & ~np.isnan(self.off[name])
            colours[pale] += _PALER * (_PALE - colours[pale])
        return _STALE * colours + (1.0 - _STALE) * ramp(np.full(1, np.nan)) if self.stale else colours


def pulls_on(bands: Bands, pulls: Mapping[str, Floats]) -> BandValues:
    """Return how the segments of lines pull, (k,) [%] by line, on the rows of their bands."""
    parts = {name: bands.ribbon(name).part for name in bands.names if name in pulls}
    return BandValues({name: np.where(part < 0, np.nan, pulls[name][part]) for name, part in parts.items()})


def pressures_on(bands: Bands, worn: Mapping[str, LinePressure], stale: bool) -> BandValues:
    """Return what lines press with [kPa] on the rows of their bands, which are held as taut as they are."""
    values, off = {}, {}
    for name in bands.names:
        if name in worn:
            band = worn[name]
            places = np.round(_places(band, bands.ribbon(name).at)).astype(np.int64) % len(band.places)
            values[name] = band.kpa[places]
            off[name] = np.where(band.bridged, band.gap, np.nan)[places]
    return BandValues(values, off, {name: _rise(worn[name]) for name in values}, stale)


def _places(worn: LinePressure, at: Floats) -> Floats:
    """Return which places of a band lie so far along it, 0 to 1; between two of them a broken number."""
    count = len(worn.places)
    return at * (count if worn.closed else count - 1)


def _rise(worn: LinePressure) -> Rise:
    apart = worn.places - worn.skin
    if worn.closed:
        apart = np.concatenate([apart, apart[:1]])

    def rise(at: Floats) -> Points:
        places, known = _places(worn, at), np.arange(len(apart))
        return interpolate(places, known, apart)

    return rise


class BandPainter:
    """Paints bands, and knows which ones have other colours than their own."""

    def __init__(self) -> None:
        self._painted: WeakSet[Bands] = WeakSet()

    def paint(self, bands: Bands, shown: BandValues, ramp: Ramp) -> None:
        """Colour bands by ``shown`` values in a ``ramp``."""
        bands.paint({name: shown.colours(name, ramp) for name in shown.values}, ramp.blank)
        bands.raise_to(shown.rises)
        self._painted.add(bands)

    def give_back(self, bands: Bands) -> None:
        """Restore the original colours of bands."""
        if bands in self._painted:
            bands.paint(None)
            bands.raise_to({})
            self._painted.discard(bands)
