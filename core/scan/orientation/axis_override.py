"""Directions in a scan file set by the user: an axis, or three numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.errors import ScanError
from core.geometry.mesh import Floats, unit
from core.messages import Message

AXES: dict[str, Floats] = {
    sign + name: direction * np.eye(3)[k]
    for k, name in enumerate("xyz")
    for sign, direction in (("+", 1.0), ("-", -1.0))
}

NEAR = 0.69
"""Cosine of the angle, a little over 45 degrees, within which a direction has the name of an axis."""


@dataclass(frozen=True, eq=False)
class AxisOverride:
    """A unit vector, shape (3,), that up or front is: ``exact``, or the nearest of the six axes."""

    direction: Floats
    exact: bool

    def allows(self, direction: Floats) -> bool:
        """Return whether up or front may be ``direction``, a unit vector, shape (3,)."""
        return bool(self.direction @ direction > (1.0 - 1e-9 if self.exact else NEAR))


def parse_axis(text: str | None) -> AxisOverride | None:
    """Read "+x" .. "-z", "x" for "+x", or "x,y,z" as numbers. Raises ScanError."""
    if text is None:
        return None
    axis = text.strip().lower()
    axis = axis if axis.startswith(("+", "-")) else "+" + axis
    if axis in AXES:
        return AxisOverride(AXES[axis], exact=False)
    try:
        direction = np.array([float(number) for number in text.split(",")])
    except ValueError:
        direction = np.zeros(0)
    length = float(np.linalg.norm(direction))
    if direction.shape != (3,) or not (np.isfinite(length) and length > 0.0):
        raise ScanError(
            Message("Unknown axis {axis}.", axis=f"{text!r}"),
            Message("Choose one of {axes}, or a direction such as 0,0.2,1.", axes=", ".join(AXES)),
        )
    return AxisOverride(direction / length, exact=True)


def parse_axes(up: str | None, front: str | None) -> tuple[AxisOverride | None, AxisOverride | None]:
    """Read what was told of up and front. Raises ScanError."""
    told_up, told_front = parse_axis(up), parse_axis(front)
    if told_up and told_front and abs(told_up.direction @ told_front.direction) > 0.9:
        raise ScanError(
            Message("Up {up} and front {front} are on the same axis.", up=up or "", front=front or ""),
            Message("Choose two different axes."),
        )
    if told_up and told_front and told_front.exact:  # up is believed first, front lies level
        level = told_front.direction - (told_front.direction @ told_up.direction) * told_up.direction
        told_front = AxisOverride(unit(level), exact=True)
    return told_up, told_front


def nearest_axis(direction: Floats) -> str:
    """Return the name of the axis nearest to a direction, shape (3,)."""
    return max(AXES, key=lambda name: float(AXES[name] @ direction))
