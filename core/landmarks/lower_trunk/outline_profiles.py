"""Profiles of the lower trunk, read from its outlines level by level: tape, front, back and sides."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.mesh import Floats, Points
from core.geometry.plane_sections import hull_perimeter
from core.landmarks.lower_trunk.sections import LowerSection, LowerSections

FINE = 2.0
"""Distance of the levels of a profile [mm]. Ours."""

ACROSS_PROFILE = 8.0
"""Profiles are smoothed by a Gaussian of this standard deviation [mm]. Source: measured, ours."""


def heights(low: float, high: float, step: float = FINE) -> Floats:
    """Return heights from ``low`` up to ``high`` [mm] in steps, ascending, shape (k,) [mm]; at least one."""
    return np.asarray(low + step * np.arange(max(int((high - low) / step), 0) + 1), dtype=np.float64)


def smoothed(values: Floats, step: float, width: float = ACROSS_PROFILE) -> Floats:
    """Return values at even steps [mm], shape (k,), smoothed over ``width`` [mm]; NaN stay NaN."""
    known = np.isfinite(values)
    if known.sum() < 2:
        return values
    rows = np.arange(len(values))
    whole = np.interp(rows, rows[known], values[known])
    return np.where(known, gaussian_filter1d(whole, width / step, mode="nearest"), np.nan)


def tapes(sections: Iterable[LowerSection]) -> Floats:
    """Return the length of a tape round the trunk at each section, shape (k,) [mm]; NaN without a trunk."""
    return np.array([np.nan if s.trunk is None else hull_perimeter(s.trunk) for s in sections])


def crossings(outline: Points, at: float, axis: int = 0) -> Floats:
    """Return where a closed outline (k, 3) crosses x = ``at`` (``axis`` 0) or y = ``at`` (1): y or x [mm]."""
    along, other = outline[:, axis] - at, outline[:, 1 - axis]
    after, beyond = np.roll(along, -1), np.roll(other, -1)
    over = (along < 0.0) != (after < 0.0)
    share = along[over] / (along[over] - after[over])
    return np.sort(other[over] + share * (beyond[over] - other[over]))


def front(sections: Iterable[LowerSection], x: float) -> Floats:
    """Return y of the foremost skin of the trunk at ``x`` on each level, shape (k,) [mm]; NaN for none."""
    found = [np.empty(0) if s.trunk is None else crossings(s.trunk, x) for s in sections]
    return np.array([ys[0] if len(ys) else np.nan for ys in found])


def back(sections: Iterable[LowerSection], xs: Floats, side: int) -> Floats:
    """Return y of the hindmost skin at ``xs``, shape (c,), of the trunk, else of the leg of a side (0 left).

    Shape (k, c) [mm], NaN where there is none.
    """
    result = []
    for section in sections:
        outline = section.legs[side] if section.trunk is None else section.trunk
        rows = [np.empty(0) if outline is None else crossings(outline, x) for x in xs.tolist()]
        result.append([ys[-1] if len(ys) else np.nan for ys in rows])
    return np.array(result)


def peak(at: Floats, values: Floats) -> tuple[float, bool]:
    """Return where ``values`` (k,) at even heights ``at`` (k,) [mm] are greatest, and whether inside.

    Within the step by a parabola through three values.
    """
    best = int(np.nanargmax(values))
    if best in (0, len(values) - 1) or not np.isfinite(values[[best - 1, best + 1]]).all():
        return float(at[best]), False
    one, two, three = values[best - 1 : best + 2]
    bend = one - 2.0 * two + three
    shift = 0.5 * (one - three) / bend if bend < 0.0 else 0.0
    return float(at[best] + shift * (at[1] - at[0])), True


def midline_point(sections: LowerSections, z: float) -> Points:
    """Return the front midline point at height ``z``, shape (3,) [mm]; its y is NaN without a trunk."""
    return np.array([sections.middle, front([sections.at(z)], sections.middle)[0], z])
