"""Surfaces whose flat pieces are known, curves on them, and cloths for pattern pieces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
import trimesh

from core.geometry.mesh import Mesh
from core.pattern.panel import Panel, PanelSeed, cut_panels
from core.pattern.surface_cut import cut_surface
from core.pattern.surface_trace import SurfaceCurve


@dataclass(frozen=True)
class PlainCloth:
    """What flattening asks of a cloth; alike in all directions where nothing is said."""

    stiffness: tuple[float, float, float] = (1.0, 1.0, 0.35)
    poisson: float = 0.3
    ease: tuple[float, float] = (0.0, 0.0)


EVEN = PlainCloth()
LACE = PlainCloth((1.0, 3.0, 0.2), 0.2, (0.15, 0.05))


def sheet(place: Callable, width: float, height: float, step: float = 3.0) -> Mesh:
    """A rectangle about the origin of (u, v), bent to ``place`` of u and v; u to the right from outside."""
    columns, rows = round(width / step), round(height / step)
    u, v = np.meshgrid(np.linspace(-0.5, 0.5, columns + 1) * width, np.linspace(-0.5, 0.5, rows + 1) * height)
    v = v + 0.2 * step * np.sin(7.0 * u / width + 1.0)  # no row is level
    index = np.arange(u.size).reshape(u.shape)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    faces = np.concatenate([np.stack(each, axis=-1).reshape(-1, 3) for each in ((a, b, c), (a, c, d))])
    return Mesh(np.stack(place(u.ravel(), v.ravel()), axis=1), faces)


def loop(name: str, place: Callable, corners: list[tuple[float, float]], **flags: bool) -> list[SurfaceCurve]:
    """The sides of a polygon of (u, v), each a curve."""
    ends = [*corners, corners[0]]
    curves = []
    for number, (start, end) in enumerate(pairwise(ends)):
        share = np.linspace(0.0, 1.0, 80)[:, None]
        u, v = (np.array(start) + share * (np.array(end) - np.array(start))).T
        curves.append(SurfaceCurve(f"{name} {number}", np.stack(place(u, v), axis=1), **flags))
    return curves


def cylinder(u: np.ndarray, v: np.ndarray, radius: float = 110.0) -> tuple[np.ndarray, ...]:
    return radius * np.sin(u / radius), -radius * np.cos(u / radius), v


def cone(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, ...]:
    """A cone of 40 degrees; (u, v) are places of its development, the tip at (0, 200)."""
    far, turn = np.hypot(u, v - 200.0), np.arctan2(u, 200.0 - v)
    lean = np.radians(40.0)
    around = turn / np.sin(lean)
    radius = far * np.sin(lean)
    return radius * np.sin(around), -radius * np.cos(around), 200.0 - far * np.cos(lean)


@cache
def ball(radius: float = 70.0, subdivisions: int = 5) -> Mesh:
    shape = trimesh.creation.icosphere(subdivisions, radius)
    turned = shape.vertices @ trimesh.transformations.rotation_matrix(0.3, (1.0, 0.4, 0.2))[:3, :3].T
    return Mesh(turned, shape.faces)


def on_ball(clock: np.ndarray | float, angle: np.ndarray | float, radius: float = 70.0) -> np.ndarray:
    """Places at an ``angle`` from the pole in front (-y), at a ``clock`` round it [degrees], (k, 3)."""
    clock, angle = np.broadcast_arrays(np.radians(clock), np.radians(angle))
    around = np.sin(angle)
    return radius * np.stack([around * np.sin(clock), -np.cos(angle), around * np.cos(clock)], axis=-1)


def circle(angle: float, name: str = "edge") -> SurfaceCurve:
    points = on_ball(np.linspace(0.0, 360.0, 241), angle)
    points[-1] = points[0]
    return SurfaceCurve(name, points)


def meridian(name: str, clock: float, start: float, end: float, **flags: bool) -> SurfaceCurve:
    return SurfaceCurve(name, on_ball(clock, np.linspace(start, end, 60)), **flags)


@cache
def cap(angle: float) -> Panel:
    """The panel of a ball's cap."""
    cut = cut_surface(ball(), (circle(angle),))
    return cut_panels(cut, (PanelSeed("cap", on_ball(10.0, 3.0)),), 5.0)[0]
