"""Where the landmarks of a clean body are, by their definitions, and what a tape reads on it.

Exact cuts of an undamaged mesh in the canonical frame [mm], starting from where the nipple and the fold are
known to be: the truth that found landmarks are held against.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.mesh import Mesh, Points
from core.geometry.plane_sections import cut, hull_perimeter, join_segments, resample

SIDES = ("left", "right")
BUST_OFFSETS = tuple(range(-30, 31, 5))
UNDERBUST_OFFSETS = tuple(range(-40, 16, 5))


@dataclass(frozen=True, eq=False)
class KnownBody:
    """A clean body in the canonical frame with its known points by name, each (3,) [mm].

    ``flags`` say what is special; a breast that is missing has no points.
    """

    mesh: Mesh
    points: dict[str, Points]
    flags: dict[str, Any] = field(default_factory=dict)

    @property
    def sides(self) -> tuple[str, ...]:
        """The sides on which there is a breast."""
        return tuple(side for side in SIDES if f"nipple_{side}" in self.points)


def known_again(body: KnownBody, clear: int = 10) -> KnownBody:
    """Return the body with nipples on its skin, and apex, fold, lowest and middle points found anew.

    A fold lies at least ``clear`` [mm of skin] below the nipple.
    """
    points: dict[str, Points] = {}
    for side in body.sides:
        nipple = body.points[f"nipple_{side}"]
        curve, start = sagittal_profile(body.mesh, nipple)
        fold_at = _fold(curve, start, body.points[f"fold_{side}"], clear)
        under = curve[start : fold_at + 1]
        points[f"nipple_{side}"] = curve[start]
        points[f"bust_apex_{side}"] = _apex(body.mesh, curve[start], curve[fold_at])
        points[f"fold_{side}"] = curve[fold_at]
        points[f"breast_lowest_{side}"] = under[np.argmin(under[:, 2])]
    bust, underbust = levels({**body.points, **points})
    middle = float(np.mean([body.points.get(f"nipple_{s}", np.zeros(3))[0] for s in SIDES]))
    if len(body.sides) < 2:
        middle = 0.0
    points["front_mid_bust"] = _front(body.mesh, middle, bust)
    points["front_mid_underbust"] = _front(body.mesh, middle, underbust)
    return KnownBody(body.mesh, points, body.flags)


def levels(points: dict[str, Points]) -> tuple[float, float]:
    """Return the bust level (mean height of the nipples) and that directly below the breasts [mm]."""
    bust = float(np.mean([points[f"nipple_{s}"][2] for s in SIDES if f"nipple_{s}" in points]))
    names = [f"{what}_{side}" for what in ("fold", "breast_lowest") for side in SIDES]
    return bust, float(min(points[name][2] for name in names if name in points))


def true_girths(body: KnownBody) -> dict[str, Any]:
    """Return the girths of a known body [mm] in the form of truth.json; arms are left out."""
    bust, underbust = levels(body.points)
    folds = [body.points[f"fold_{side}"][2] for side in body.sides]
    around = {z: trunk_outline(body.mesh, bust + z)[0] for z in range(-50, 51, 5)}
    below = {z: trunk_outline(body.mesh, underbust + z)[0] for z in UNDERBUST_OFFSETS}
    stable = stable_offset(below)
    near = [z for z in around if all(abs(around[k] - around[k - 5]) < 40.0 for k in _steps(z))]
    widest = max(near, key=lambda z: around[z])
    return {
        "bust": _girth(body.mesh, bust, {z: around[z] for z in BUST_OFFSETS}),
        "underbust": _girth(body.mesh, underbust, below),
        "underbust_at_fold": _girth(body.mesh, float(np.mean(folds))),
        "bust_max_within_50mm": {"level_z": round(bust + widest, 2), "tape": round(around[widest], 1)},
        "underbust_stable": {
            "level_z": round(underbust + stable, 2),
            "tape": round(below[stable], 1),
            "offset_mm": stable,
        },
    }


def _steps(z: int) -> range:
    """Return the steps between the bust level and ``z``: a jump on the way is an arm that joins the trunk."""
    return range(5, z + 1, 5) if z > 0 else range(z + 5, 1, 5)


def stable_offset(below: dict[int, float]) -> int:
    """Return the first offset down whose tape falls to the next by no more than the ribs taper, + 4 mm."""
    taper = (below[-20] - below[-40]) / 4.0
    falls = {z: below[z] - below[z - 5] for z in range(0, -40, -5)}
    return next((z for z, fall in falls.items() if fall <= taper + 4.0), min(falls, key=lambda z: falls[z]))


def trunk_outline(mesh: Mesh, z: float) -> tuple[float, float]:
    """Return tape and outline length of the curves at height ``z`` that cross or lie within the middle."""
    curves = [curve for curve, _ in join_segments(cut(mesh, (0.0, 0.0, z), (0.0, 0.0, 1.0)))]
    middle = float(np.median(mesh.vertices[:, 0]))
    trunk = [c for c in curves if c[:, 0].min() <= middle + 25.0 and c[:, 0].max() >= middle - 25.0]
    if not trunk:
        return 0.0, 0.0
    low, high = min(c[:, 0].min() for c in trunk), max(c[:, 0].max() for c in trunk)
    trunk = [c for c in curves if low - 1.0 <= c[:, 0].mean() <= high + 1.0]
    length = sum(float(np.linalg.norm(np.diff(c, axis=0), axis=1).sum()) for c in trunk)
    closing = sum(float(np.linalg.norm(c[0] - c[-1])) for c in trunk)
    return hull_perimeter(np.concatenate(trunk)), length + min(closing, 5.0)


def _girth(mesh: Mesh, z: float, around: dict[int, float] | None = None) -> dict[str, Any]:
    tape, contour = trunk_outline(mesh, z)
    girth: dict[str, Any] = {"level_z": round(z, 2), "tape": round(tape, 1), "contour": round(contour, 1)}
    if around:
        girth["tape_5mm_above_below"] = [round(around[5], 1), round(around[-5], 1)]
        girth["tape_by_offset_mm"] = {str(at): round(value, 1) for at, value in around.items()}
    return girth


def sagittal_profile(mesh: Mesh, nipple: Points) -> tuple[Points, int]:
    """Return the sagittal curve through ``nipple`` every millimetre, downward in front, and its place."""
    curves = [curve for curve, _ in join_segments(cut(mesh, nipple, (1.0, 0.0, 0.0)))]
    curve = min(curves, key=lambda c: float(np.linalg.norm(c - nipple, axis=1).min()))
    curve = resample(curve, 1.0)
    start = int(np.argmin(np.linalg.norm(curve - nipple, axis=1)))
    if np.allclose(curve[0], curve[-1], atol=2.0):
        curve, start = np.roll(curve[:-1], len(curve) // 2 - start, axis=0), len(curve) // 2
    window = 25
    if curve[min(start + window, len(curve) - 1), 2] > curve[max(start - window, 0), 2]:
        curve, start = curve[::-1], len(curve) - 1 - start
    return curve, start


def _fold(curve: Points, start: int, near: Points, clear: int) -> int:
    """Return the place of largest concave curvature below the breast, not far from ``near``."""
    y, z = (gaussian_filter1d(curve[:, k], 4.0, mode="nearest") for k in (1, 2))
    dy, dz = np.gradient(y), np.gradient(z)
    bend = dz * np.gradient(dy) - dy * np.gradient(dz)  # concave: the way down turns from back to forward
    expected = start + int(np.argmin(np.linalg.norm(curve[start:] - near, axis=1)))
    first, last = max(start + clear, expected - 30), min(len(curve) - 5, expected + 30)
    return first + int(np.argmax(bend[first:last]))


def _apex(mesh: Mesh, nipple: Points, fold: Points) -> Points:
    v, side = mesh.vertices, np.sign(nipple[0]) or 1.0
    low = fold[2] + 0.3 * (nipple[2] - fold[2]) if fold[2] < nipple[2] else nipple[2] - 15.0
    near = (np.abs(v[:, 0] - nipple[0]) < 60.0) & (v[:, 0] * side > 0.0)
    near &= (v[:, 2] > low) & (v[:, 2] < nipple[2] + 40.0) & (v[:, 1] < nipple[1] + 40.0)
    rows = np.flatnonzero(near)
    return np.asarray(v[rows[np.argmin(v[rows, 1])]])


def _front(mesh: Mesh, x: float, z: float) -> Points:
    points = cut(mesh, (x, 0.0, z), (0.0, 0.0, 1.0)).points
    near = points[np.abs(points[:, 0] - x) < 4.0]
    return np.asarray(near[np.argmin(near[:, 1])]) if len(near) else np.array([x, np.nan, z])
