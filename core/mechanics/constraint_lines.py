"""Constraining lines: polylines on the control mesh whose segments obey Hooke's law (paper section 3).

The paper's lines run through control points. A free line runs between them: each of its vertices is embedded
in a triangle of the control mesh, so that it is a fixed mean of control points, and its force is spread to
them by the same weights (ours).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy import sparse

from core.errors import LineError
from core.geometry.mesh import Flags, Floats, Indices, Points, frozen
from core.length_text import millimetres, parse_length
from core.messages import Length, LengthRange, LineName, Message

RATIO_LIMITS = (0.5, 1.3)
"""Lengths that can be asked for, as parts of the rest length; outside nothing sensible can come out."""


@dataclass(frozen=True, eq=False)
class Line:
    """A band of the garment that lies on the body.

    ``weights`` (k, n) make its vertices of the n control points, from the subject's right to the left: a
    single 1 in each row of a line through control points. ``rest_lengths`` (k - 1,) [mm] are those of its
    segments in the self-balanced rest state. ``spacing`` [mm] is the length at rest over the number of steps
    from control point to control point: line stiffness refers to it, however finely a line is divided.
    ``back_length`` [mm] completes the front part to the whole closed band round the body, and does not
    change. ``tail_length`` [mm] runs on over the shoulder on the fixed body, and is part of the length that
    is set. ``constrains`` is False when no vertex can move. Vertices on ``anchored`` (n,) control points are
    held in space by the band that they are sewn to, whatever the skin does there: ``still`` (k - 1, 3) [mm]
    is their share of the segment vectors.
    """

    name: str
    weights: sparse.csr_array
    rest_lengths: Floats
    spacing: float
    back_length: float
    constrains: bool
    tail_length: float = 0.0
    anchored: Flags | None = None
    still: Points | float = 0.0

    @property
    def rest_length(self) -> float:
        """Length at rest of what is set [mm]: the front part, side to side; of a strap all of it."""
        return float(self.rest_lengths.sum()) + self.tail_length

    @property
    def whole_length(self) -> float:
        """Return the length of the whole closed band at rest [mm]."""
        return self.rest_length + self.back_length

    @cached_property
    def across(self) -> sparse.csr_array:
        """Return the matrix from control points to segment vectors, shape (k - 1, n)."""
        across = sparse.csr_array(self.weights[:-1] - self.weights[1:])
        return across if self.anchored is None else sparse.csr_array(across.multiply(~self.anchored))

    @cached_property
    def closed(self) -> bool:
        """Return whether it ends where it begins."""
        return bool(abs(self.weights[[0]] - self.weights[[-1]]).sum() < 1e-9)

    def places(self, points: Points) -> Points:
        """Return its vertices on control points, shapes (k, 3) and (n, 3) [mm]."""
        return np.asarray(self.weights @ points)

    def length(self, points: Points) -> float:
        """Return the length of what is set on control points, shape (n, 3) [mm]."""
        return float(np.linalg.norm(self.across @ points + self.still, axis=1).sum()) + self.tail_length


def line_on(name: str, path: npt.ArrayLike, points: Points, free: Indices, back_length: float = 0.0) -> Line:
    """Lay a line over control points at rest; its natural length is read there (paper section 3)."""
    nodes = np.asarray(path, dtype=np.int64)
    where = np.arange(len(nodes)), nodes
    weights = sparse.csr_array((np.ones(len(nodes)), where), shape=(len(nodes), len(points)))
    return free_line(name, weights, points, free, len(nodes) - 1, back_length)


def anchored_line(line: Line, points: Points, anchored: Flags, free: Indices) -> Line:
    """Return a line whose vertices on ``anchored`` (n,) control points are held at ``points`` (n, 3) [mm]."""
    held = sparse.diags_array(np.where(anchored, 1.0, 0.0))
    still = np.asarray((line.weights[:-1] - line.weights[1:]) @ held @ points)
    loose = free[~anchored[free]]
    constrains = bool((abs(line.weights[:, loose]).sum(axis=1) > 1e-9).any())
    return replace(line, constrains=constrains, anchored=anchored, still=frozen(still))


def free_line(
    name: str,
    weights: sparse.csr_array,
    points: Points,
    free: Indices,
    steps: float,
    back_length: float = 0.0,
    tail_length: float = 0.0,
) -> Line:
    """Define a line whose vertices have ``weights`` (k, n), with natural lengths ``steps`` (ours)."""
    lengths = np.linalg.norm(np.diff(weights @ points, axis=0), axis=1)
    constrains = bool((abs(weights[:, free]).sum(axis=1) > 1e-9).any())
    spacing = float(lengths.sum()) / steps
    return Line(name, weights, frozen(lengths), spacing, back_length, constrains, tail_length)


def parse_ratio(text: str, rest_mm: float, unit: str = "%") -> float | None:
    """Return what a designer writes for a length as ratio of the rest length [1], or None if it is no length.

    ``97%`` of the front part's rest length, ``-6%`` or ``-20mm`` (also cm, in) shorter or longer, ``400mm``
    or ``15 3/4in`` absolute; ``unit`` is that of a bare number. An absolute length is that of the front part,
    ``rest_mm`` at rest: the one that is shown wherever it can be typed.
    """
    typed = _typed(text, unit)
    if typed is None:
        return None
    sign, number, unit = typed
    length = millimetres(number, unit)
    share = number / 100.0 if length is None else length / rest_mm
    return {"": share, "+": 1.0 + share, "-": 1.0 - share}[sign]


def _typed(text: str, unit: str) -> tuple[str, float, str] | None:
    """Return sign, number and unit of a typed length, or None if it is none."""
    typed = parse_length(text.strip().removeprefix("="))
    if typed is None or not (typed[2] in ("", "%") or millimetres(1.0, typed[2])):
        return None
    return typed[0], typed[1], typed[2] or unit


def _full_length_error(name: str, front: tuple[float, float], back: float, rest: float) -> LineError:
    """Return the refusal of a full length that was entered as a front length; all in mm."""
    short, long = front
    return LineError(
        Message(
            "Front length of {line}: {range}; full length: {short} to {long}.",
            range=LengthRange(short, long),
            line=LineName(name),
            short=f"{short + back:.0f}",
            long=Length(long + back),
        ),
        Message("Enter a front length: {length}mm gives the full length entered.", length=f"{rest:.1f}"),
    )


def length_ratio(text: str, name: str, rest_mm: float, whole_mm: float, unit: str = "%") -> float:
    """Read the length of line ``name`` as ``parse_ratio`` does, within RATIO_LIMITS.

    Raises LineError if it is none, or out of range: what can only be the length of the whole band,
    ``whole_mm`` at rest, is not taken for that of the front part without a word.
    """
    typed, ratio = _typed(text, unit), parse_ratio(text, rest_mm, unit)
    if typed is None or ratio is None:
        raise LineError(
            Message("'{text}' is not a valid length for {line}.", text=text, line=LineName(name)),
            Message(
                "Enter a length such as 97% (of the original length), -20mm (change) or 400mm (absolute)."
            ),
        )
    low, high = RATIO_LIMITS
    if low <= ratio <= high:
        return ratio
    short, long, back = low * rest_mm, high * rest_mm, whole_mm - rest_mm
    rest = ratio * rest_mm - back
    absolute = not typed[0] and typed[2] != "%"
    if absolute and back > 0.0 and short <= rest <= long:
        raise _full_length_error(name, (short, long), back, rest)
    raise LineError(
        Message(
            "{text} sets {line} to {percent} % of its original length.",
            text=text.strip(),
            line=LineName(name),
            percent=f"{100 * ratio:.1f}",
        ),
        Message(
            "Enter {low} to {high} % ({range} front length).",
            range=LengthRange(short, long),
            low=f"{100 * low:.0f}",
            high=f"{100 * high:.0f}",
        ),
    )
