"""Other bodies made of a known one by smooth deformation; its known points move along.

Every function takes a KnownBody in the canonical frame [mm] (+x its left, -y front, z up) and returns another
one. The maps are smooth functions of place, so a point of the skin goes where the skin goes; what depends on
a definition (fold, lowest point, apex) is to be found again with ``known_again``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from body_truth import SIDES, KnownBody, known_again, levels, trunk_outline
from scipy import sparse

from core.geometry.mesh import Floats, Mesh, Points

Alteration = Callable[[KnownBody], KnownBody]


def smooth_step(at: Floats, low: float, high: float) -> Floats:
    """Return 0 up to ``low``, 1 from ``high``, and a smooth way between."""
    t = np.clip((at - low) / (high - low), 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))


def warped(body: KnownBody, move: Callable[[Points], Points], **flags: object) -> KnownBody:
    """Return the body with its skin and its points moved by ``move``."""
    points = {name: move(point[None])[0] for name, point in body.points.items()}
    return KnownBody(body.mesh.moved(move(body.mesh.vertices)), points, {**body.flags, **flags})


def _turned(p: Points, angle: Floats, axis: int, centre: tuple[float, float]) -> Points:
    """Turn points about a line along ``axis`` through ``centre`` (the other two coordinates)."""
    a, b = [k for k in range(3) if k != axis]
    u, v, moved = p[:, a] - centre[0], p[:, b] - centre[1], p.copy()
    moved[:, a] = centre[0] + np.cos(angle) * u - np.sin(angle) * v
    moved[:, b] = centre[1] + np.sin(angle) * u + np.cos(angle) * v
    return moved


def lean(degrees: float) -> Alteration:
    """Bend forward (or back, if negative) above the hips."""

    def move(p: Points) -> Points:
        return _turned(p, np.radians(degrees) * smooth_step(p[:, 2], 20.0, 160.0), 0, (-90.0, 90.0))

    return lambda body: warped(body, move)


def twist(degrees: float) -> Alteration:
    """Turn the shoulders against the hips; the breasts go on facing forward."""

    def alter(body: KnownBody) -> KnownBody:
        bust, _ = levels(body.points)
        still = smooth_step(np.array([bust - 20.0]), 60.0, 460.0)

        def move(p: Points) -> Points:
            angle = np.radians(degrees) * (smooth_step(p[:, 2], 60.0, 460.0) - still)
            return _turned(p, angle, 2, (0.0, -90.0))

        return warped(body, move)

    return alter


def trunk_scale(width: float, depth: float) -> Alteration:
    """Make the body wider and deeper, about a line through the trunk."""
    factor = np.array([width, depth, 1.0])
    middle = np.array([0.0, -90.0, 0.0])
    return lambda body: warped(body, lambda p: middle + factor * (p - middle))


def belly(forward: float) -> Alteration:
    """Push the belly forward [mm], most of it between waist and under-bust."""

    def alter(body: KnownBody) -> KnownBody:
        _, underbust = levels(body.points)
        top = underbust - 12.0
        middle = min(0.5 * (top + 40.0), 165.0)

        def move(p: Points) -> Points:
            up = smooth_step(p[:, 2], middle - 190.0, middle) * (1.0 - smooth_step(p[:, 2], middle, top + 10))
            round_front = np.exp(-((p[:, 0] / 130.0) ** 2)) * smooth_step(-p[:, 1], 60.0, 180.0)
            return np.asarray(p - np.outer(forward * up * round_front, (0.0, 1.0, 0.0)))

        return warped(body, move)

    return alter


class Breast:
    """One breast as a field over the body: how much a place belongs to it, and its height over the chest."""

    def __init__(self, body: KnownBody, side: str) -> None:
        self.nipple, fold = body.points[f"nipple_{side}"], body.points[f"fold_{side}"]
        self.sign = 1.0 if side == "left" else -1.0
        self.across = abs(self.nipple[0])
        drop = max(self.nipple[2] - fold[2], 25.0)
        self.centre = self.nipple[2] - 0.1 * drop
        self.below, self.above = 1.7 * drop + 12.0, 1.7 * drop + 60.0
        self.wall = max(fold[1], body.points["front_mid_bust"][1])
        self.middle = body.points["front_mid_bust"][1]
        self.height = max(self.wall - self.nipple[1], 15.0)

    def weight(self, p: Points) -> Floats:
        """Return 1 on the breast, 0 off it, shape (n,)."""
        x, dz = self.sign * p[:, 0], p[:, 2] - self.centre
        tall = np.where(dz < 0.0, self.below, self.above)
        radius = np.sqrt(((x - self.across) / (1.05 * self.across)) ** 2 + (dz / tall) ** 2)
        return (1.0 - smooth_step(radius, 0.35, 1.0)) * smooth_step(x, 0.0, 25.0)

    def lift(self, p: Points) -> Floats:
        """Return the height over the chest wall, which curves back to the side, shape (n,) [mm]."""
        x = np.clip(np.abs(p[:, 0]) / self.across, 0.0, 1.4)
        front = min(self.middle + 6.0, self.wall)
        wall = front + (self.wall - front) * x**2 + np.maximum(x - 1.0, 0.0) * 60.0
        return np.asarray(np.maximum(wall - p[:, 1], 0.0))

    def share(self, p: Points) -> Floats:
        """Return the weight times the height as a share of that of the nipple, shape (n,)."""
        return self.weight(p) * np.clip(self.lift(p) / self.height, 0.0, 1.5)


def cup(factor: float, *, sides: tuple[str, ...] = SIDES) -> Alteration:
    """Scale the breasts away from the chest."""

    def alter(body: KnownBody) -> KnownBody:
        for side in sides:
            breast = Breast(body, side)

            def move(p: Points, breast: Breast = breast) -> Points:
                out = np.array([0.25 * breast.sign, -1.0, 0.0])
                return np.asarray(p + np.outer((factor - 1.0) * breast.weight(p) * breast.lift(p), out))

            body = warped(body, move)
        return body

    return alter


def sag(down: float) -> Alteration:
    """Let the breasts hang: what stands out furthest sinks most [mm]."""

    def alter(body: KnownBody) -> KnownBody:
        breasts = [Breast(body, side) for side in body.sides]

        def move(p: Points) -> Points:
            sunk = sum(breast.share(p) ** 1.3 for breast in breasts)
            return np.asarray(p - np.outer(down * sunk, (0.0, 0.0, 1.0)))

        return warped(body, move)

    return alter


def touching(body: KnownBody) -> KnownBody:
    """Push the breasts together until hardly a gap is left between them."""
    body = cup(1.3)(body)
    breasts = [Breast(body, side) for side in body.sides]

    def move(p: Points) -> Points:
        inward = sum(breast.share(p) for breast in breasts)
        return np.stack([p[:, 0] * (1.0 - 0.3 * np.minimum(inward, 1.0)), p[:, 1], p[:, 2]], axis=1)

    return warped(body, move)


def missing(side: str) -> Alteration:
    """Take one breast away: the chest is flat there, and there is no truth for that side."""

    def alter(body: KnownBody) -> KnownBody:
        breast = Breast(body, side)
        flat = cup(0.1, sides=(side,))(smooth_nipples(body, sides=(side,)))
        moved = smooth_step(np.linalg.norm(flat.mesh.vertices - body.mesh.vertices, axis=1), 1.0, 6.0)
        flat = _smoothed(flat, np.minimum(1.0, breast.weight(body.mesh.vertices) + moved), 300, -0.5)
        points = {name: point for name, point in flat.points.items() if not name.endswith(side)}
        return KnownBody(flat.mesh, points, {**body.flags, "missing": side})

    return alter


def smooth_nipples(body: KnownBody, radius: float = 24.0, *, sides: tuple[str, ...] = SIDES) -> KnownBody:
    """Take the relief of the nipples away: there the skin goes on as it curves ``radius`` [mm] around."""
    v = body.mesh.vertices.copy()
    for nipple in [body.points[f"nipple_{side}"] for side in sides if side in body.sides]:
        away = np.linalg.norm(v - nipple, axis=1)
        near = np.flatnonzero(away < 1.4 * radius)
        ring = near[away[near] > 0.6 * radius]
        out = body.mesh.vertex_normals[ring].mean(axis=0)
        _, _, (across, along, out) = np.linalg.svd(np.eye(3) - np.outer(out, out) / (out @ out))
        places, around = (_cubic((v[rows] - nipple) @ np.stack([across, along]).T) for rows in (near, ring))
        height = (v - nipple) @ out
        curved = np.linalg.lstsq(around, height[ring], rcond=None)[0]
        share = 1.0 - smooth_step(away[near], 0.6 * radius, 0.9 * radius)
        v[near] += np.outer(share * (places @ curved - height[near]), out)
    return replace(body, mesh=body.mesh.moved(v), flags={**body.flags, "nipple_relief": False})


def _cubic(at: Floats) -> Floats:
    """Return the powers up to the third of places, shape (n, 2), as columns."""
    x, y = at.T / 20.0
    return np.stack([x**k * y**m for k in range(4) for m in range(4 - k)], axis=1)


def _smoothed(body: KnownBody, weight: Floats, rounds: int, back: float = -0.61) -> KnownBody:
    """Smooth the skin where ``weight``, shape (n,), is one; hardly shrinking it (Taubin 1995)."""
    corner, count, v = body.mesh.faces, len(body.mesh.vertices), body.mesh.vertices
    pairs = (corner.ravel(), corner[:, [1, 2, 0]].ravel())
    around = sparse.csr_array((np.ones(corner.size), pairs), shape=(count, count))
    around = around + around.T
    mean = sparse.diags_array(1.0 / np.maximum(around.sum(axis=0), 1.0)) @ around
    for _ in range(rounds):
        for share in (0.6, back):
            v = v + (share * weight)[:, None] * (mean @ v - v)
    return replace(body, mesh=body.mesh.moved(v))


def in_a_bra(body: KnownBody) -> KnownBody:
    """Form the breasts as a bra does: no nipples, and cloth from breast to breast."""
    body = smooth_nipples(body, 32.0)
    bust, underbust = levels(body.points)
    front = body.points["front_mid_bust"][1]
    tip = float(np.mean([body.points[f"nipple_{side}"][1] for side in body.sides]))
    across = abs(body.points[f"nipple_{body.sides[0]}"][0])

    def move(p: Points) -> Points:
        tall = smooth_step(p[:, 2], underbust, bust) * (1.0 - smooth_step(p[:, 2], bust + 20.0, bust + 90.0))
        near = 1.0 - smooth_step(np.abs(p[:, 0]), 0.55 * across, 1.0 * across)
        cloth = front + 0.75 * (tip - front) * tall
        out = p[:, 1] - cloth
        # a soft maximum: hardly anything moves that already stands in front of the cloth
        moved = cloth + 0.5 * (out - np.sqrt(out**2 + 36.0))
        share = near * tall * smooth_step(-p[:, 1], 90.0, 130.0)
        return np.stack([p[:, 0], p[:, 1] + share * (np.minimum(moved, p[:, 1]) - p[:, 1]), p[:, 2]], axis=1)

    return warped(body, move)


def part(body: KnownBody, keep: Callable[[Points], np.ndarray]) -> KnownBody:
    """Keep the faces whose corners all lie where ``keep`` says."""
    chosen = body.mesh.faces[keep(body.mesh.vertices)[body.mesh.faces].all(axis=1)]
    used, faces = np.unique(chosen, return_inverse=True)
    return replace(body, mesh=Mesh(body.mesh.vertices[used], faces.reshape(-1, 3)))


def no_arms(body: KnownBody) -> KnownBody:
    """Cut the arms off, close to the trunk."""
    bust, _ = levels(body.points)
    half = 0.5 * trunk_width(body.mesh, bust - 20.0) + 14.0
    return part(body, lambda v: (np.abs(v[:, 0]) < half) | (v[:, 2] < bust - 90.0))


def no_neck(body: KnownBody) -> KnownBody:
    """Cut neck and shoulders off above the arm-pits."""
    bust, _ = levels(body.points)
    return part(body, lambda v: v[:, 2] < bust + 150.0)


def short(above: float, below: float) -> Alteration:
    """Keep the bust alone, from ``below`` under the fold to ``above`` over the bust level [mm]."""

    def alter(body: KnownBody) -> KnownBody:
        bust, underbust = levels(body.points)
        return part(no_arms(body), lambda v: (v[:, 2] < bust + above) & (v[:, 2] > underbust - below))

    return alter


def trunk_width(mesh: Mesh, z: float) -> float:
    """Return how wide the trunk is at height ``z`` [mm], its arms left out."""
    tape, _ = trunk_outline(mesh, z)
    return 0.36 * tape


def altered(body: KnownBody, *steps: Alteration) -> KnownBody:
    """Return the body after all ``steps``, its points found again by their definitions."""
    for step in steps:
        body = step(body)
    return known_again(body)
