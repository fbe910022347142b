"""Cloth over a body: bras as membranes over the bust, and loose T-shirts.

The trunk is a field of radii around an upright axis. A membrane under tension lies on it or bridges it: in
each place its radius is the larger of that of the body (which gives way a little) and of what straight
threads from neighbour to neighbour ask for. Vertices keep their direction and height, so that the nipple is
carried along under the cloth.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from altered_bodies import smooth_step
from people import Figure, Rng
from scipy.ndimage import gaussian_filter, map_coordinates

from core.geometry.mesh import Floats, Points

COLUMNS, STEP = 240, 3.0
"""Directions around the trunk, and the height of a row of the field [mm]."""


@dataclass(frozen=True)
class Bra:
    """A bra and how it sits.

    ``around``: the share of the tension that runs around the body; ``soft``: the width over which the
    breast gives way to it [mm]; ``bridge``: how much of the gap between the breasts is bridged; ``edge``:
    how far band and straps stand out [mm]; ``rounding``: how wide the cup is rounded [mm]; ``bite``: how
    deep the band presses into the skin, and how far that swells above and below [mm].
    """

    around: float
    soft: float
    bridge: float
    edge: float
    rounding: float
    bite: float


def soft_bra(rng: Rng) -> Bra:
    """Draw a seamless bra without wires: cloth lies from breast to breast."""
    around, soft, bridge = rng.uniform(0.5, 0.85), rng.uniform(3.0, 12.0), rng.uniform(0.6, 1.0)
    return Bra(around, soft, bridge, rng.uniform(0.0, 0.8), rng.uniform(6.0, 12.0), _bite(rng))


def moulded_bra(rng: Rng) -> Bra:
    """Draw a bra of two formed cups, its middle more or less on the breast bone."""
    around, soft, bridge = rng.uniform(0.3, 0.5), rng.uniform(0.0, 4.0), rng.uniform(0.2, 0.8)
    return Bra(around, soft, bridge, rng.uniform(0.8, 2.0), rng.uniform(10.0, 18.0), _bite(rng))


def sports_bra(rng: Rng) -> Bra:
    """Draw a bra that presses both breasts flat."""
    around, soft = rng.uniform(0.7, 0.9), rng.uniform(8.0, 22.0)
    return Bra(around, soft, 1.0, rng.uniform(0.5, 2.0), rng.uniform(8.0, 16.0), _bite(rng))


def _bite(rng: Rng) -> float:
    return float(max(rng.uniform(-3.0, 5.0), 0.0))


BRAS = {"soft": soft_bra, "moulded": moulded_bra, "sports": sports_bra}


class Field:
    """Radii of the trunk's skin around an upright axis, by row (height) and column (direction) [mm]."""

    def __init__(self, figure: Figure) -> None:
        v = figure.mesh.vertices
        self.low = float(v[:, 2].min())
        nipple = np.mean(list(figure.nipples.values()), axis=0)
        trunk = (figure.limbs["arms"] < 0.5) & (figure.limbs["head"] < 0.5)
        level = trunk & (np.abs(v[:, 2] - nipple[2]) < 30.0)
        back = float(v[level][:, 1].max())
        self.axis = np.array([float(np.median(v[trunk, 0])), back - 0.42 * (back - float(v[level, 1].min()))])
        self.rows = int((v[trunk, 2].max() - self.low) / STEP) + 2
        self.radius = self._filled(figure, trunk)

    def places(self, points: Points) -> tuple[Floats, Floats, Floats]:
        """Return row, column (both fractional) and radius [mm] of points; column 0 faces front."""
        x, y = points[:, 0] - self.axis[0], points[:, 1] - self.axis[1]
        column = np.arctan2(x, -y) / (2.0 * np.pi) * COLUMNS % COLUMNS
        return (points[:, 2] - self.low) / STEP, column, np.hypot(x, y)

    def at(self, values: Floats, points: Points) -> Floats:
        """Return a field's values at points, interpolated."""
        row, column, _ = self.places(points)
        wide = np.concatenate([values, values[:, :1]], axis=1)
        return np.asarray(map_coordinates(wide, [row, column], order=1, mode="nearest"))

    def with_radius(self, points: Points, radius: Floats) -> Points:
        """Return points at the same height and direction, but this far from the axis [mm]."""
        moved, old = points.copy(), self.places(points)[2]
        moved[:, :2] = self.axis + (points[:, :2] - self.axis) * (radius / np.maximum(old, 1.0))[:, None]
        return moved

    def _filled(self, figure: Figure, trunk: Floats) -> Floats:
        """Return the outermost radius of the skin in each cell, holes filled from their neighbours."""
        faces = figure.mesh.faces[trunk[figure.mesh.faces].all(axis=1)]
        corners = figure.mesh.vertices[faces]
        grid = [(i / 4, j / 4, (4 - i - j) / 4) for i in range(5) for j in range(5 - i)]
        points = np.concatenate([np.tensordot(share, corners, (0, 1)) for share in np.array(grid)[:, :]])
        row, column, radius = self.places(points)
        cell = np.clip(np.round(row), 0, self.rows - 1).astype(int) * COLUMNS
        cell += np.round(column).astype(int) % COLUMNS
        out = np.zeros(self.rows * COLUMNS)
        np.maximum.at(out, cell, radius)
        out = out.reshape(self.rows, COLUMNS)
        while (out == 0.0).any():
            gap = out == 0.0
            around = [np.roll(out, k, axis=a) for k in (1, -1) for a in (0, 1)]
            known = sum((value > 0.0).astype(float) for value in around)
            mean = sum(around) / np.maximum(known, 1.0)
            if not (known[gap] > 0.0).any():
                break
            out[gap] = mean[gap]
        return out


def membrane(body: Floats, free: Floats, around: float, soft: float) -> Floats:
    """Return the radii of a membrane over ``body`` where ``free`` is 1, fast at the body where it is 0 [mm].

    Threads around the body are straight in 1/r, threads up and down in r. Solved by relaxation, first on
    coarse fields. Where they press on the body it gives way over a width of ``soft`` [mm].
    """
    r = body.copy()
    mean = float(np.median(body))
    for hop, rounds in ((8, 60), (4, 80), (2, 120), (1, 160)):
        angle = 2.0 * np.pi * hop / COLUMNS
        across = around / (mean * angle) ** 2
        along = (1.0 - around) / (STEP * hop) ** 2
        for _ in range(rounds):
            left, right = np.roll(r, hop, axis=1), np.roll(r, -hop, axis=1)
            chord = 2.0 * np.cos(angle) * left * right / np.maximum(left + right, 1.0)
            up = np.concatenate([r[hop:], np.repeat(r[-1:], hop, axis=0)])
            down = np.concatenate([np.repeat(r[:1], hop, axis=0), r[:-hop]])
            straight = (across * chord + along * 0.5 * (up + down)) / (across + along)
            pressed = (straight * (soft / (STEP * hop)) ** 2 + body) / (1.0 + (soft / (STEP * hop)) ** 2)
            r = np.where(straight >= body, straight, pressed) * free + body * (1.0 - free)
    return r


def in_bra(figure: Figure, bra: Bra, name: str) -> Figure:
    """Return the figure in a bra: nipples without relief, the cloth from breast to breast."""
    field = Field(figure)
    v = figure.mesh.vertices
    points = figure.known().points
    fold = min(points[f"{what}_{side}"][2] for what in ("fold", "breast_lowest") for side in figure.nipples)
    nipple = float(np.mean([at[2] for at in figure.nipples.values()]))
    drop = nipple - fold
    z = field.low + STEP * np.arange(field.rows)[:, None]
    turn = np.abs((np.arange(COLUMNS)[None, :] + COLUMNS / 2) % COLUMNS - COLUMNS / 2) * (360.0 / COLUMNS)
    front = 1.0 - smooth_step(turn, 70.0, 110.0)
    across = np.degrees(
        np.arctan2(abs(points["nipple_left"][0]), -(points["nipple_left"][1] - field.axis[1]))
    )
    strap = np.exp(-(((turn - across) / 9.0) ** 2))
    top = nipple + front * (0.35 * drop + 25.0 + 40.0 * strap) - (1.0 - front) * 0.2 * drop
    bottom = np.full_like(turn, fold - 4.0)
    free = smooth_step(z, bottom - 3.0, bottom + 6.0) * (1.0 - smooth_step(z, top - 6.0, top + 20.0))
    smooth = gaussian_filter(
        field.radius, (bra.rounding / STEP, bra.rounding / STEP), mode=("nearest", "wrap")
    )
    body = field.radius + free * (smooth - field.radius)
    cloth = membrane(body, free, bra.around, bra.soft)
    gore = np.exp(-((turn / (0.8 * across)) ** 2)) * (1.0 - bra.bridge)
    cloth = cloth + gore * (body - cloth)
    cloth = gaussian_filter(cloth, (4.0 / STEP, 1.2), mode=("nearest", "wrap")) * free + cloth * (1.0 - free)
    band = smooth_step(z, bottom - 22.0, bottom - 17.0) * (1.0 - smooth_step(z, bottom - 2.0, bottom + 3.0))
    straps = strap * front * smooth_step(z, top - 8.0, top) * (strap > 0.3)
    roll = np.exp(-(((z - bottom + 45.0) / 14.0) ** 2)) + (1.0 - front) * np.exp(
        -(((z - top - 15.0) / 16.0) ** 2)
    )
    cloth = cloth + bra.edge * np.maximum(band, straps) + bra.bite * (roll - 0.7 * band)
    share = np.maximum.reduce([free, band, straps, np.minimum(1.0, 2.0 * roll) * (bra.bite > 0.0)])
    worn = (figure.limbs["arms"] < 0.6).astype(float) * field.at(share, v)
    radius = field.places(v)[2]
    hidden = worn * (field.at(cloth, v) - radius)
    figure = figure.moved(field.with_radius(v, radius + hidden), bra=name, nipple_relief=False)
    return figure


def in_shirt(figure: Figure, rng: Rng) -> Figure:
    """Return the figure in a loose T-shirt that hangs from shoulders and bust."""
    field = Field(figure)
    v = figure.mesh.vertices
    z = field.low + STEP * np.arange(field.rows)[:, None]
    shoulder = 0.5 * (figure.joints["l-shoulder"] + figure.joints["r-shoulder"])[2]
    free = np.broadcast_to(1.0 - smooth_step(z, shoulder - 60.0, shoulder), field.radius.shape)
    body = field.radius
    cloth = membrane(body, free, 0.9, 0.0)
    ease, slope = rng.uniform(2.0, 14.0), rng.uniform(0.0, 0.7)
    for row in range(field.rows - 2, -1, -1):  # what hangs from the bust keeps its distance downward
        hung = np.maximum(cloth[row], cloth[row + 1] - slope * STEP)
        cloth[row] += free[row] * (hung - cloth[row])
    turn = np.arange(COLUMNS)[None, :] * (2.0 * np.pi / COLUMNS)
    down = np.linspace(1.0, 0.0, field.rows)[:, None]
    folds = sum(
        rng.normal(0.0, 0.5) * np.sin(k * turn + rng.uniform(0, 6.3) + rng.uniform(-2, 2) * down)
        for k in range(5, 16)
    )
    cloth = gaussian_filter(cloth, (3.0, 2.0), mode=("nearest", "wrap")) + free * down * (ease + ease * folds)
    cloth = np.maximum(cloth, body + free)
    worn = (figure.limbs["arms"] < 0.6) & (figure.limbs["head"] < 0.4)
    radius = field.places(v)[2]
    radius = np.where(worn, field.at(cloth, v), radius)
    return figure.moved(field.with_radius(v, radius), clothes="T-shirt", nipple_relief=False)
