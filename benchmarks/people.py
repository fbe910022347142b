"""People drawn at random on the MakeHuman base mesh, with the truth that its topology tells.

Every body of this mesh has the same vertices at the nipples and the same breast tissue, so the truth needs
no eye: nipples are vertices, folds and lowest points follow from the section (tests/body_truth.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import pyvista as pv
import trimesh
from altered_bodies import smooth_step
from body_truth import SIDES, KnownBody, known_again, sagittal_profile
from human_base import LIMBS, HumanBase, kept, refined
from scipy import sparse
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

from core.geometry.mesh import Faces, Flags, Floats, Mesh, Points

Rng = np.random.Generator
SIGN = {"left": 1.0, "right": -1.0}
SKULL = ("head", "jaw", "neck03", "eye", "oculi", "orbi", "ori", "levator", "ris", "spec", "temp", "tongue")
LEGS = ("upperleg", "lowerleg", "foot", "toe")
FULL = 70_000
"""Triangles of a whole figure; a trunk has about as many."""

AREOLA = 26
"""The nipple's own relief ends so far below it [mm of skin]: its rim is as concave as a shallow fold."""


@dataclass(frozen=True)
class Person:
    """What a body is made of: macro factors and details of MakeHuman, and what is done to it then [mm].

    ``down``: how far the breasts sink by their own weight; ``sides``: share of breast tissue left and right.
    """

    macros: Mapping[str, float]
    details: Mapping[str, float] = field(default_factory=dict)
    down: float = 0.0
    sides: tuple[float, float] = (1.0, 1.0)
    arms: float = 10.0
    uneven: float = 2.0
    relief: bool = True


@dataclass(frozen=True, eq=False)
class Figure:
    """A body as a fine mesh before it is cut: skin, breast tissue and limbs of each vertex.

    ``tissue``, shape (n, 3) [mm], is how far the skin lies from where it would be without breasts; ``limbs``
    weights of arms, head and legs, each (n,) [1]; ``joints`` places by name, (3,) [mm].
    """

    mesh: Mesh
    tissue: Points
    nipples: dict[str, Points]
    limbs: dict[str, Floats]
    joints: dict[str, Points]
    flags: dict[str, Any] = field(default_factory=dict)

    def moved(self, vertices: Points, **flags: Any) -> Figure:
        """Return the figure with its skin at other places; the nipples go along."""
        tree = cKDTree(self.mesh.vertices)
        nipples = {}
        for side, at in self.nipples.items():
            away, rows = tree.query(at, 4)
            share = 1.0 / (away + 1e-6)
            nipples[side] = at + share @ (vertices - self.mesh.vertices)[rows] / share.sum()
        return replace(self, mesh=self.mesh.moved(vertices), nipples=nipples, flags={**self.flags, **flags})

    @cached_property
    def share(self) -> Floats:
        """How much a place belongs to a breast, 0..1, shape (n,)."""
        size = np.linalg.norm(self.tissue, axis=1)
        most = float(np.quantile(size[size > 1e-9], 0.995)) if (size > 1e-9).any() else 1.0
        return np.asarray(size / most).clip(0.0, 1.0)

    def known(self) -> KnownBody:
        """Return the body with its landmarks by their definitions."""
        points = {f"nipple_{side}": at for side, at in self.nipples.items()}
        body = KnownBody(self.mesh, points, self.flags)
        tree = cKDTree(self.mesh.vertices)
        for side in body.sides:
            curve, start = sagittal_profile(self.mesh, points[f"nipple_{side}"])
            points[f"fold_{side}"] = curve[self._crease(curve, start, tree)]
        points["front_mid_bust"] = np.mean([points[f"nipple_{s}"] for s in body.sides], axis=0)
        return known_again(body, AREOLA)

    def _crease(self, curve: Points, start: int, tree: cKDTree) -> int:
        """Return the most concave place below the nipple where there is breast, or just below it."""
        share, first = self.share[tree.query(curve)[1]], start + AREOLA
        last = first + int(np.argmax(np.append(share[first:], 0.0) < 0.05)) + 25
        y, z = (gaussian_filter1d(curve[:, k], 4.0, mode="nearest") for k in (1, 2))
        bend = np.gradient(z) * np.gradient(np.gradient(y)) - np.gradient(y) * np.gradient(np.gradient(z))
        return first + int(np.argmax(bend[first : min(last, len(curve) - 5)]))


class People:
    """Makes figures of people on one base mesh; what is the same for all is computed once."""

    def __init__(self, base: HumanBase) -> None:
        self.base = base

    @cached_property
    def trunk(self) -> tuple[sparse.csr_array, Faces]:
        """The fine trunk with neck and upper arms: matrix from the base mesh, and triangles."""
        away = self.base.weight(*SKULL, *LEGS, *LIMBS[1:])
        thighs = self.base.weight("upperleg01")
        return refined(kept(self.base.quads, (away - 0.6 * thighs) < 0.6), len(self.base.rest), 2)

    @cached_property
    def whole(self) -> tuple[sparse.csr_array, Faces]:
        """The whole figure, as fine."""
        return refined(self.base.quads, len(self.base.rest), 2)

    def figure(self, person: Person, rng: Rng, *, whole: bool = False) -> Figure:
        """Return the figure of a person; ``rng`` draws what makes left and right uneven."""
        base = self.base
        v = base.mixed(person.macros, person.details)
        own = {name: share for name, share in person.details.items() if name.startswith("breast/")}
        breast = base.mixed(person.macros, own) - base.mixed(
            {**person.macros, "cup": 0.0, "firmness": 1.0}, {}
        )
        if not person.relief:
            v = self._without_nipples(v)
        left, right = person.sides
        breast *= np.linalg.norm(breast, axis=1, keepdims=True) > 0.5
        v = v + breast * (np.where(v[:, :1] > 0.0, left, right) - 1.0)
        v = base.arms_lowered(v, person.arms)
        matrix, faces = self.whole if whole else self.trunk
        used, faces = np.unique(faces, return_inverse=True)
        matrix, faces = matrix[used], faces.reshape(-1, 3)
        nipple = base.target("breast/nipple-point-incr")[0]
        skin = matrix @ v
        nipples = {side: v[nipple[SIGN[side] * base.rest[nipple, 0] > 0.0]].mean(axis=0) for side in SIDES}
        limbs = {"arms": LIMBS, "head": SKULL, "legs": LEGS}
        figure = Figure(
            Mesh(skin, faces),
            matrix @ breast,
            nipples,
            {name: matrix @ base.weight(*bones) for name, bones in limbs.items()},
            {name[6:]: base.joint(v, name) for name in base.joints},
            {"nipple_relief": person.relief},
        )
        figure = figure.moved(skin + _waves(skin, rng, person.uneven))
        return sunk(figure, person.down)

    def _without_nipples(self, v: Points) -> Points:
        """Flatten the nipples: nothing of the areola stands out."""
        rows, _ = self.base.target("breast/nipple-size-incr")
        v = v.copy()
        for side in SIDES:
            spot = rows[SIGN[side] * self.base.rest[rows, 0] > 0.0]
            around = np.setdiff1d(self.base.quads[np.isin(self.base.quads, spot).any(axis=1)], spot)
            middle = v[around].mean(axis=0)
            out = np.linalg.svd(v[around] - middle)[2][2]
            v[spot] -= np.outer((v[spot] - middle) @ out, out) * 0.85
        return v


def _waves(at: Points, rng: Rng, size: float) -> Points:
    """Return a smooth random displacement, shape (n, 3) [mm], of waves of 150 to 500 mm."""
    moved = np.zeros_like(at)
    for _ in range(8):
        way = rng.normal(size=3)
        way *= 2.0 * np.pi / (rng.uniform(150.0, 500.0) * np.linalg.norm(way))
        moved += np.outer(np.sin(at @ way + rng.uniform(0.0, 2.0 * np.pi)), rng.normal(0.0, size / 2.0, 3))
    return moved


def sunk(figure: Figure, down: float) -> Figure:
    """Let the breasts hang [mm]: what stands out furthest sinks most, and lies on what is below it.

    The fold stays where it is. Skin that would sink into the trunk is laid in front of it, so that breast
    and trunk touch; the lower half comes forward as the upper half flattens.
    """
    v, share = figure.mesh.vertices, figure.share
    sink = down * share**1.4
    moved = v - np.stack([np.zeros_like(sink), 0.15 * sink, sink], axis=1)
    trunk = (share < 0.06) & (figure.limbs["arms"] < 0.2) & (figure.mesh.vertex_normals[:, 1] < 0.3)
    wall = cKDTree(v[trunk][:, [0, 2]])
    breast = np.flatnonzero(share > 0.06)
    away, rows = wall.query(moved[breast][:, [0, 2]], 6)
    near = away[:, 0] < 15.0
    front = v[trunk][:, 1][rows]
    weight = 1.0 / (away + 1.0)
    skin = (front * weight).sum(axis=1) / weight.sum(axis=1)
    laid = np.where(near, np.minimum(moved[breast, 1], skin - 1.0), moved[breast, 1])
    moved[breast, 1] += smooth_step(share[breast], 0.06, 0.25) * (laid - moved[breast, 1])
    return figure.moved(moved, sunk_mm=round(down, 1))


def is_plausible(body: KnownBody) -> bool:
    """Tell whether the truth is that of a bust whose folds lie on the trunk, below the nipples.

    Very large breasts on slim trunks stand out beyond its sides: the section through the nipple does not meet
    the trunk then, and no fold is defined.
    """
    points = body.points
    if len(body.sides) < 2:
        return True
    if abs(points["fold_left"][2] - points["fold_right"][2]) > 25.0:
        return False
    for side in body.sides:
        nipple, fold = points[f"nipple_{side}"], points[f"fold_{side}"]
        curve, start = sagittal_profile(body.mesh, nipple)
        at = start + int(np.argmin(np.linalg.norm(curve[start:] - fold, axis=1)))
        runs_on = at + 40 < len(curve) and curve[at + 40, 2] < fold[2] - 25.0
        overhang = fold[2] - points[f"breast_lowest_{side}"][2]
        near = np.linalg.norm(points[f"bust_apex_{side}"] - nipple) < 45.0
        if not (runs_on and near and overhang < 110.0 and np.linalg.norm(nipple - fold) > 28.0):
            return False
    return True


@dataclass(frozen=True)
class Cut:
    """Where a scan ends: shares of the way down the upper arm and up the neck, and height over the crotch."""

    arm: float = 0.3
    neck: float = 0.5
    hips: float = 60.0
    tilt: float = 0.0


def cut_out(figure: Figure, cut: Cut) -> Figure:
    """Cut arms (along their weights), neck and hips (by planes) off."""
    v, joints = figure.mesh.vertices, figure.joints
    gone = np.zeros(len(v), dtype=bool)
    for side in "lr":
        start, end = joints[f"{side}-shoulder"], joints[f"{side}-elbow"]
        along = (v - start) @ (end - start) / ((end - start) @ (end - start))
        own = (v[:, 0] * (1.0 if side == "l" else -1.0) > 0.0) & (figure.limbs["arms"] > 0.5)
        gone |= own & (along > cut.arm)
    figure = _part(figure, ~gone)
    neck = joints["neck"] + cut.neck * (joints["head"] - joints["neck"])
    figure = _sliced(figure, neck, np.array([0.0, np.sin(cut.tilt), -np.cos(cut.tilt)]))
    crotch = 0.5 * (joints["l-upper-leg"] + joints["r-upper-leg"])
    return _sliced(figure, crotch + cut.hips * np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0]))


def _part(figure: Figure, keep: Flags) -> Figure:
    used, faces = np.unique(figure.mesh.faces[keep[figure.mesh.faces].all(axis=1)], return_inverse=True)
    return _rows(figure, figure.mesh.vertices[used], faces.reshape(-1, 3), used)


def _sliced(figure: Figure, origin: Points, normal: Points) -> Figure:
    mesh = figure.mesh
    v, f = trimesh.intersections.slice_faces_plane(mesh.vertices, mesh.faces, normal, origin)[:2]
    return _rows(figure, v, f, cKDTree(mesh.vertices).query(v)[1])


def _rows(figure: Figure, vertices: Points, faces: Faces, rows: Any) -> Figure:
    limbs = {name: weight[rows] for name, weight in figure.limbs.items()}
    return replace(figure, mesh=Mesh(vertices, faces), tissue=figure.tissue[rows], limbs=limbs)


def thinned(mesh: Mesh, count: int) -> Mesh:
    """Return the surface with about ``count`` triangles, small where it bends (Garland and Heckbert 1997)."""
    if len(mesh.faces) <= count:
        return mesh
    surface = pv.PolyData(mesh.vertices, np.c_[np.full(len(mesh.faces), 3), mesh.faces].ravel())
    less = surface.decimate(1.0 - count / len(mesh.faces))
    return Mesh(np.asarray(less.points, dtype=float), less.faces.reshape(-1, 4)[:, 1:])


def rotated(figure: Figure, forward: float, aside: float) -> Figure:
    """Lean a whole figure stiffly forward and to its left [degrees] about the middle of its hips."""
    at = 0.5 * (figure.joints["l-upper-leg"] + figure.joints["r-upper-leg"])
    a, b = np.radians(forward), np.radians(aside)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, np.cos(a), -np.sin(a)], [0.0, np.sin(a), np.cos(a)]])
    turn = np.array([[np.cos(b), 0.0, np.sin(b)], [0.0, 1.0, 0.0], [-np.sin(b), 0.0, np.cos(b)]]) @ turn
    joints = {name: (place - at) @ turn.T + at for name, place in figure.joints.items()}
    return replace(figure.moved((figure.mesh.vertices - at) @ turn.T + at), joints=joints)
