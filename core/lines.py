"""Constraining lines: polylines through control points whose segments obey Hooke's law (paper section 3)."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.errors import LineError
from core.mesh import Floats, Indices, Points, frozen

RATIO_LIMITS = (0.5, 1.3)
"""Lengths that can be asked for, as parts of the rest length; outside nothing sensible can come out."""


@dataclass(frozen=True, eq=False)
class Line:
    """A band of the garment that lies on the body.

    ``path`` (k,) control points from the subject's right to the left; ``rest_lengths`` (k - 1,) [mm] of its
    segments in the self-balanced rest state; ``back_length`` [mm] completes the front part to the whole
    closed band round the body, and does not change. ``constrains`` is False when no point of the path can
    move.
    """

    name: str
    path: Indices
    rest_lengths: Floats
    back_length: float
    constrains: bool

    @property
    def rest_length(self) -> float:
        """Length of the front part at rest, side to side [mm]."""
        return float(self.rest_lengths.sum())

    @property
    def whole_length(self) -> float:
        """Length of the whole closed band at rest [mm]."""
        return self.rest_length + self.back_length

    @property
    def pairs(self) -> Indices:
        """The ends of the segments, shape (k - 1, 2)."""
        return np.stack([self.path[:-1], self.path[1:]], axis=1)

    def length(self, points: Points) -> float:
        """Return the length of the front part on control points, shape (n, 3) [mm]."""
        return float(segment_lengths(points, self.path).sum())


def segment_lengths(points: Points, path: Indices) -> Floats:
    """Return the lengths of the segments of ``path``, shape (k - 1,) [mm]."""
    return np.asarray(np.linalg.norm(np.diff(points[path], axis=0), axis=1))


def line_on(name: str, path: npt.ArrayLike, points: Points, free: Indices, back_length: float = 0.0) -> Line:
    """Lay a line over control points at rest; its natural length is read there (paper section 3)."""
    nodes = np.asarray(path, dtype=np.int64)
    nodes.setflags(write=False)
    constrains = bool(np.isin(nodes, free).any())
    return Line(name, nodes, frozen(segment_lengths(points, nodes)), back_length, constrains)


_LENGTH = re.compile(r"^\s*=?\s*([+-]?)\s*(\d+(?:[.,]\d+)?)\s*(%|mm|cm|in)?\s*$")
_MM = {"mm": 1.0, "cm": 10.0, "in": 25.4}


def typed_ratio(text: str, rest_mm: float, whole_mm: float, unit: str = "%") -> float | None:
    """Return what a designer writes for a length as ratio of the rest length [1], or None if it is no length.

    ``97%`` of the front part's rest length, ``-6%`` or ``-20mm`` (also cm, in) shorter or longer, ``400mm``
    absolute; ``unit`` is that of a bare number. An absolute length is that of the front part, ``rest_mm`` at
    rest, or of the whole band, ``whole_mm``, if only that reading makes sense: the two never lie near each
    other.
    """
    # A Japanese keyboard writes full-width digits and signs: the normal form has them plain.
    plain = unicodedata.normalize("NFKC", text).replace("\N{MINUS SIGN}", "-").lower()
    match = _LENGTH.match(plain)
    if match is None:
        return None
    sign, number, unit = match.group(1), float(match.group(2).replace(",", ".")), match.group(3) or unit
    if not sign and unit != "%":
        return _absolute_ratio(number * _MM[unit], rest_mm, whole_mm)
    share = number / 100.0 if unit == "%" else number * _MM[unit] / rest_mm
    return {"": share, "+": 1.0 + share, "-": 1.0 - share}[sign]


def _absolute_ratio(mm: float, rest_mm: float, whole_mm: float) -> float:
    front = mm / rest_mm
    whole = (mm - (whole_mm - rest_mm)) / rest_mm
    low, high = RATIO_LIMITS
    return whole if not low <= front <= high and low <= whole <= high else front


def length_ratio(text: str, line: Line) -> float:
    """Read a length as ``typed_ratio`` does; raises LineError if it is none or lies outside RATIO_LIMITS."""
    ratio = typed_ratio(text, line.rest_length, line.whole_length)
    if ratio is None:
        raise LineError(
            f"'{text}' is not a length for {line.name}.",
            "Write 97% of the rest length, -20mm shorter, or 400mm absolute.",
        )
    low, high = RATIO_LIMITS
    if not low <= ratio <= high:
        raise LineError(
            f"{text} asks {line.name} for {100 * ratio:.1f} % of its rest length.",
            f"Stay between {100 * low:.0f} and {100 * high:.0f} %: "
            f"{low * line.rest_length:.0f} to {high * line.rest_length:.0f} mm of the front part.",
        )
    return ratio
