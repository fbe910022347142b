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


def bra(mesh: Mesh, landmarks: Landmarks) -> tuple[tuple[SurfaceCurve, ...], tuple[PanelSeed, ...]]:
    """Return curves and panels of a bra: two-part cups, bridge, cradle and wings, nine panels."""
    centre = 0.5 * (
        landmarks.position("front_centre_underbust") + landmarks.position("back_centre_underbust")
    )
    wrap = Wrap(mesh, (float(centre[0]), float(centre[1])))
    marks = {
        name: (np.degrees(np.arctan2(point[0], centre[1] - point[1])), point[2])
        for name in ("bust_point", "root_inner", "root_outer", "lowest", "fold")
        for point in [landmarks.position(f"{name}_left")]
    }
    low = min(marks["lowest"][1], marks["fold"][1]) - 6.0
    band, apex = low - 30.0, marks["bust_point"]
    middle, wide = 0.5 * (marks["root_inner"][0] + marks["root_outer"][0]), 2.0
    wide += 0.5 * (marks["root_outer"][0] - marks["root_inner"][0])
    level = apex[1] + 5.0

    def root(clock: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        turn = np.radians(clock)
        return middle + wide * np.sin(turn), level + (level - low) * np.cos(turn)

    def way(*places: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
        at = np.linspace(0.0, 2.0, 61)
        known = np.linspace(0.0, 2.0, len(places))
        return tuple(
            np.polyval(np.polyfit(known, column, len(places) - 1), at) for column in np.transpose(places)
        )

    def ends(clock: float) -> tuple[float, float]:
        return tuple(float(each) for each in root(np.array(clock)))

    back = band + 45.0
    outer, seam = ends(60.0), ends(215.0)
    curves, seeds = [], []
    around = np.linspace(0.0, 360.0, 301)
    places = wrap(around, np.full(301, band))
    places[-1] = places[0]
    curves.append(SurfaceCurve("band edge", places, is_edge=True))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for name, (angle, height), edge in (
            ("wire", root(np.linspace(60.0, 300.0, 121)), False),
            ("top edge", root(np.linspace(300.0, 420.0, 61)), True),
            ("cup seam", way(ends(265.0), apex, ends(95.0)), False),
            ("bridge seam", way(seam, (seam[0] - 4.0, band)), False),
            ("wing top", way(outer, (90.0, outer[1] - 12.0), (180.0, back)), True),
            ("side seam", way((90.0, outer[1] - 12.0), (90.0, band)), False),
        ):
            curves.append(SurfaceCurve(f"{name} {side}", wrap(sign * angle, height), is_edge=edge))
        for name, place, cloth in (
            ("upper cup", (middle, level + 0.5 * (level - low)), "cup"),
            ("lower cup", (middle, level - 0.6 * (level - low)), "cup"),
            ("cradle", (middle, band + 10.0), "sheer"),
            ("wing", (130.0, band + 15.0), "power net"),
        ):
            at = wrap(np.array([sign * place[0]]), np.array([place[1]]))[0]
            seeds.append(PanelSeed(f"{name} {side}", at, cloth))
    inner = ends(300.0)
    top = wrap(*way((-inner[0], inner[1]), (0.0, inner[1] - 8.0), inner))
    curves.append(SurfaceCurve("bridge top", top, is_edge=True))
    curves.append(SurfaceCurve("centre back", wrap(*way((180.0, back), (180.0, band))), is_edge=True))
    seeds.append(PanelSeed("bridge", wrap(np.array([0.0]), np.array([band + 12.0]))[0], "sheer"))
    return tuple(curves), tuple(seeds)
