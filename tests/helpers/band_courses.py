"""Courses of bands over shapes whose curvature is known by formula."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from core.garment.band_path import BandPath
from core.geometry.mesh import Points, unit
from core.geometry.plane_sections import arc_length

NEWTONS = 5.0
STEP = 4.0
Curve = Callable[[np.ndarray], np.ndarray]


def course(curve: Curve, normal: Curve, end: float = 2.0 * np.pi, closed: bool = True) -> BandPath:
    """A band with even tension on curve(t), t from 0 to ``end``, both curves (k,) -> (k, 3)."""
    t = np.linspace(0.0, end, 40_001)
    s = arc_length(curve(t))
    count = round(s[-1] / STEP)
    at = np.interp(np.linspace(0.0, s[-1], count + 1), s, t)
    at = at[:-1] if closed else at
    even = np.ones(len(at))
    return BandPath(curve(at), unit(normal(at)), NEWTONS * even, even > 0.0, closed)


def polar(radius: Curve) -> BandPath:
    """A level band round a cylinder whose outline has ``radius`` (t) [mm]."""
    return course(lambda t: flat(radius(t) * np.cos(t), radius(t) * np.sin(t)), lambda t: _out(radius, t))


def ellipse(a: float, b: float) -> BandPath:
    """A level band round an elliptic cylinder with half axes a and b [mm]."""
    return course(lambda t: flat(a * np.cos(t), b * np.sin(t)), lambda t: flat(np.cos(t) / a, np.sin(t) / b))


def arc(radius: float, angle: float) -> BandPath:
    """A strap over a round shoulder, open, from the front up and over, through ``angle`` [rad]."""
    return course(lambda t: radius * _upright(t), _upright, angle, closed=False)


def parallel(radius: float, latitude: float) -> BandPath:
    """A band round a ball, a great circle at latitude 0 [rad]."""

    def out(t: np.ndarray) -> Points:
        c, s = np.cos(latitude), np.sin(latitude)
        return np.stack([c * np.cos(t), c * np.sin(t), np.full_like(t, s)], axis=1)

    return course(lambda t: radius * out(t), out)


def flat(x: np.ndarray, y: np.ndarray) -> Points:
    return np.stack([x, y, np.zeros_like(x)], axis=1)


def _upright(t: np.ndarray) -> Points:
    return np.stack([np.zeros_like(t), -np.cos(t), np.sin(t)], axis=1)


def _out(radius: Curve, t: np.ndarray) -> Points:
    h = 1e-5
    slope = (radius(t + h) - radius(t - h)) / (2.0 * h)
    r = radius(t)
    return flat(r * np.cos(t) + slope * np.sin(t), r * np.sin(t) - slope * np.cos(t))


def winding(waist: float, wave: float) -> BandPath:
    """A band round a cylinder with two hollows that swings up and down by ``wave`` [mm] as it goes."""

    def radius(t: np.ndarray) -> np.ndarray:
        return np.asarray(100.0 + waist * np.cos(2.0 * t))

    def swinging(t: np.ndarray) -> Points:
        level = flat(radius(t) * np.cos(t), radius(t) * np.sin(t))
        return np.asarray(level + wave * np.sin(4.0 * t + 0.7)[:, None] * np.array([0.0, 0.0, 1.0]))

    return course(swinging, lambda t: _out(radius, t))
