"""Seams of a simple bra on any body: told by angle round the trunk and height, on the outermost skin."""

from __future__ import annotations

import numpy as np

from core.geometry.mesh import Mesh
from core.landmarks.types import Landmarks
from core.pattern.panel import PanelSeed
from core.pattern.surface_trace import SurfaceCurve


class Wrap:
    """Places of a skin by angle round an upright axis [degrees, 0 in front, 90 at +x] and height [mm]."""

    def __init__(self, mesh: Mesh, axis: tuple[float, float]) -> None:
        flat = mesh.vertices[:, :2] - axis
        self._angle = np.degrees(np.arctan2(flat[:, 0], -flat[:, 1]))
        self._mesh, self._axis = mesh, axis
        outward = np.einsum("ij,ij->i", mesh.face_normals[:, :2], flat[mesh.faces].mean(axis=1)) > 0.0
        self._faces = mesh.faces[outward]

    def __call__(self, angle: np.ndarray, height: np.ndarray) -> np.ndarray:
        """Return the outermost place of the skin at each angle and height, (k, 3)."""
        return np.array([self._place(*pair) for pair in np.broadcast(angle, height)])

    def _place(self, angle: float, height: float) -> np.ndarray:
        z = self._mesh.vertices[:, 2]
        turned = (self._angle[self._faces] - angle + 180.0) % 360.0 - 180.0
        near = (np.abs(z[self._faces] - height) < 30.0).any(axis=1) & (np.abs(turned) < 60.0).all(axis=1)
        faces, along = self._faces[near], turned[near]
        up = z[faces] - height
        a, b, c = (np.stack([along[:, k], up[:, k]], axis=1) for k in range(3))
        parts = np.stack([_turn(b, c), _turn(c, a), _turn(a, b)], axis=1)
        total = parts.sum(axis=1)
        inside = ((parts >= 0.0).all(axis=1) | (parts <= 0.0).all(axis=1)) & (np.abs(total) > 1e-12)
        shares = parts[inside] / total[inside, None]
        places = np.einsum("ij,ijk->ik", shares, self._mesh.vertices[faces[inside]])
        away = np.linalg.norm(places[:, :2] - self._axis, axis=1)
        in_front = abs((angle + 180.0) % 360.0 - 180.0) < 75.0
        return places[away.argmax() if in_front else away.argmin()]  # beyond the side there may be an arm


def _turn(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    return p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]


class _Plan:
    """Angles [degrees] and heights [mm] of the seams of one side; the other is its mirror image."""

    def __init__(self, landmarks: Landmarks, centre: np.ndarray) -> None:
        inner, outer, self.apex, lowest, fold = (
            (np.degrees(np.arctan2(point[0], centre[1] - point[1])), point[2])
            for name in ("root_inner", "root_outer", "bust_point", "lowest", "fold")
            for point in [landmarks.position(f"{name}_left")]
        )
        low = min(lowest[1], fold[1]) - 6.0
        self.middle, self.wide = 0.5 * (inner[0] + outer[0]), 2.0 + 0.5 * (outer[0] - inner[0])
        self.level = self.apex[1] + 5.0
        self.tall, self.band = self.level - low, low - 30.0

    def root(self, clock: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        turn = np.radians(clock)
        return self.middle + self.wide * np.sin(turn), self.level + self.tall * np.cos(turn)

    def end(self, clock: float) -> tuple[float, float]:
        angle, height = self.root(np.array(clock))
        return float(angle), float(height)


def _way(*places: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """A smooth curve through two or three places."""
    at, known = np.linspace(0.0, 1.0, 61), np.linspace(0.0, 1.0, len(places))
    return tuple(
        np.polyval(np.polyfit(known, column, len(places) - 1), at) for column in np.transpose(places)
    )


def bra(mesh: Mesh, landmarks: Landmarks) -> tuple[tuple[SurfaceCurve, ...], tuple[PanelSeed, ...]]:
    """Return curves and panels of a bra: two-part cups, bridge, cradle and wings, nine panels."""
    centre = 0.5 * (
        landmarks.position("front_centre_underbust") + landmarks.position("back_centre_underbust")
    )
    wrap, plan = Wrap(mesh, (float(centre[0]), float(centre[1]))), _Plan(landmarks, centre)
    band, back, outer, seam, inner = (
        plan.band,
        plan.band + 45.0,
        plan.end(60.0),
        plan.end(215.0),
        plan.end(300.0),
    )
    side_top = (90.0, outer[1] - 12.0)
    around = wrap(np.linspace(0.0, 360.0, 301), np.full(301, band))
    around[-1] = around[0]
    curves, seeds = [SurfaceCurve("band edge", around, is_edge=True)], []
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for name, (angle, height), edge in (
            ("wire", plan.root(np.linspace(60.0, 300.0, 121)), False),
            ("top edge", plan.root(np.linspace(300.0, 420.0, 61)), True),
            ("cup seam", _way(plan.end(265.0), plan.apex, plan.end(95.0)), False),
            ("bridge seam", _way(seam, (seam[0] - 4.0, band)), False),
            ("wing top", _way(outer, side_top, (180.0, back)), True),
            ("side seam", _way(side_top, (90.0, band)), False),
        ):
            curves.append(SurfaceCurve(f"{name} {side}", wrap(sign * angle, height), is_edge=edge))
        for name, angle, height, cloth in (
            ("upper cup", plan.middle, plan.level + 0.5 * plan.tall, "cup"),
            ("lower cup", plan.middle, plan.level - 0.6 * plan.tall, "cup"),
            ("cradle", plan.middle, band + 10.0, "sheer"),
            ("wing", 130.0, band + 15.0, "power net"),
        ):
            place = wrap(np.array([sign * angle]), np.array([height]))[0]
            seeds.append(PanelSeed(f"{name} {side}", place, cloth))
    top = wrap(*_way((-inner[0], inner[1]), (0.0, inner[1] - 8.0), inner))
    curves.append(SurfaceCurve("bridge top", top, is_edge=True))
    curves.append(SurfaceCurve("centre back", wrap(*_way((180.0, back), (180.0, band))), is_edge=True))
    seeds.append(PanelSeed("bridge", wrap(np.array([0.0]), np.array([band + 12.0]))[0], "sheer"))
    return tuple(curves), tuple(seeds)
