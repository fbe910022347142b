"""What scanners and programs do to a body: noise, holes, specks, broken triangles, turns, units.

Every function takes vertices (n, 3) [mm, canonical frame] and faces (m, 3), and returns such a pair; ``rng``
makes it the same again. What is done to a scan leaves its truth as it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations

import numpy as np

from core.geometry.mesh import Faces, Floats, Mesh, Points

Scan = tuple[Points, Faces]

UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "inch": 25.4}


def noise(scan: Scan, rng: np.random.Generator, sigma: float) -> Scan:
    """Move every vertex along its normal (and a third of that across) at random [mm]."""
    v, f = scan
    along = Mesh(v, f).vertex_normals * rng.normal(0.0, sigma, (len(v), 1))
    return v + along + rng.normal(0.0, sigma / 3.0, v.shape), f


def hole(scan: Scan, centre: Points, radius: float) -> Scan:
    """Take the faces away whose middle is nearer than ``radius`` to ``centre`` [mm]."""
    v, f = scan
    return v, f[np.linalg.norm(v[f].mean(axis=1) - centre, axis=1) > radius]


def holes_anywhere(scan: Scan, rng: np.random.Generator, count: int) -> Scan:
    """Make ``count`` holes of 8 to 28 mm anywhere on the skin."""
    for centre in scan[0][rng.integers(len(scan[0]), size=count)]:
        scan = hole(scan, centre, rng.uniform(8.0, 28.0))
    return scan


def specks(scan: Scan, rng: np.random.Generator, count: int) -> Scan:
    """Add lone small triangles in and around the body."""
    v, f = scan
    low, high = v.min(axis=0) - 60.0, v.max(axis=0) + 60.0
    corners = rng.uniform(low, high, (count, 1, 3)) + rng.normal(0.0, 3.0, (count, 3, 3))
    more = len(v) + np.arange(3 * count).reshape(-1, 3)
    return np.concatenate([v, corners.reshape(-1, 3)]), np.concatenate([f, more])


def floor_plate(scan: Scan, rng: np.random.Generator) -> Scan:
    """Add the plate or turntable on which the body stands."""
    v, f = scan
    count, half = 24, rng.uniform(260.0, 420.0)
    x, y = (at.ravel() for at in np.meshgrid(*2 * [np.linspace(-half, half, count)]))
    plate = np.stack([x, y - 100.0, np.full(len(x), v[:, 2].min() - rng.uniform(1.0, 20.0))], axis=1)
    a = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    sheet = np.concatenate(
        [np.stack([a, a + 1, a + count], 1), np.stack([a + 1, a + count + 1, a + count], 1)]
    )
    return np.concatenate([v, plate]), np.concatenate([f, sheet + len(v)])


def with_legs(scan: Scan, into: float = -1.0, length: float = 800.0) -> Scan:
    """Stand the body on two legs with feet, as whole figures are; they reach ``into`` the trunk [mm]."""
    v, f = scan
    low, rows, count = v[:, 2].min(), 161, 48
    middle = v[v[:, 2] < low + 30.0].mean(axis=0)
    turn, height = np.arange(count) * (2.0 * np.pi / count), np.linspace(into, -length, rows)
    down = -height / length
    thick = np.interp(down, (-0.2, 0.0, 0.5, 0.65, 0.93, 1.0), (30.0, 78.0, 55.0, 58.0, 38.0, 42.0))[:, None]
    foot = np.where(np.sin(turn) < 0.0, np.interp(down, (0.93, 0.98), (1.0, 3.2))[:, None], 1.0)
    at = (np.arange(rows - 1)[:, None] * count + np.arange(count)).ravel()
    beside = at - at % count + (at + 1) % count
    last = (rows - 1) * count
    sole = np.array([[last + k, last, last + k + 1] for k in range(1, count - 1)])
    tube = np.concatenate(
        [np.stack([at, at + count, beside], 1), np.stack([beside, at + count, beside + count], 1), sole]
    )
    for side in (1.0, -1.0):
        x = middle[0] + side * np.maximum(85.0 + 20.0 * down, 85.0)[:, None] + thick * np.cos(turn)
        y = middle[1] + thick * foot * np.sin(turn)
        z = np.broadcast_to(low + height[:, None], x.shape)
        f = np.concatenate([f, tube + len(v)])
        v = np.concatenate([v, np.stack([x, y, z], axis=2).reshape(-1, 3)])
    return v, f


def soup(scan: Scan) -> Scan:
    """Give each triangle corners of its own."""
    v, f = scan
    return v[f].reshape(-1, 3), np.arange(f.size).reshape(-1, 3)


def flipped(scan: Scan, rng: np.random.Generator, share: float) -> Scan:
    """Wind a share of the triangles the other way."""
    v, f = scan
    f = f.copy()
    turn = rng.random(len(f)) < share
    f[turn] = f[turn][:, ::-1]
    return v, f


def doubled(scan: Scan, rng: np.random.Generator, share: float) -> Scan:
    """Give a share of the corners vertices of their own, and repeat some faces."""
    v, f = scan
    f = f.copy()
    own = rng.random(f.shape) < share
    vertices = np.concatenate([v, v[f[own]]])
    f[own] = len(v) + np.arange(own.sum())
    return vertices, np.concatenate([f, f[rng.integers(len(f), size=100)]])


def decimated(scan: Scan, count: int) -> Scan:
    """Keep about ``count`` vertices: those in the same cell of a grid become one."""
    v, f = scan
    area = float(Mesh(v, f).face_areas.sum())
    size = 1.15 * np.sqrt(area / count)
    cell = np.floor(v / size).astype(np.int64)
    _, place = np.unique(cell, axis=0, return_inverse=True)
    place = place.ravel()
    many = np.bincount(place)
    merged = np.stack([np.bincount(place, weights=v[:, k]) / many for k in range(3)], axis=1)
    f = place[f]
    f = f[(f[:, 0] != f[:, 1]) & (f[:, 1] != f[:, 2]) & (f[:, 2] != f[:, 0])]
    _, first = np.unique(np.sort(f, axis=1), axis=0, return_index=True)
    return merged, f[np.sort(first)]


def cloud(scan: Scan, rng: np.random.Generator, count: int) -> Scan:
    """Return ``count`` points spread over the skin, and no faces."""
    v, f = scan
    areas = Mesh(v, f).face_areas
    rows = rng.choice(len(f), size=count, p=areas / areas.sum())
    a, b = rng.random((2, count, 1))
    over = a + b > 1.0
    a, b = np.where(over, 1.0 - a, a), np.where(over, 1.0 - b, b)
    p, q, r = (v[f[rows, k]] for k in range(3))
    return p + a * (q - p) + b * (r - p), np.empty((0, 3), dtype=np.int64)


@dataclass(frozen=True)
class Standing:
    """How a body stands in its file: axes, turn and tilt [degrees], unit, shift [mm]."""

    order: int = 0
    yaw: float = 0.0
    tilt: float = 0.0
    tilt_about: tuple[float, float, float] = (1.0, 0.0, 0.0)
    unit: str = "mm"
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def matrix(self) -> Floats:
        """The (4, 4) matrix from the canonical frame to the file; never a mirror."""
        turn = axis_orders()[self.order] @ turned(self.tilt_about, self.tilt) @ turned((0, 0, 1), self.yaw)
        matrix = np.eye(4)
        matrix[:3, :3] = turn / UNITS[self.unit]
        matrix[:3, 3] = np.array(self.shift) / UNITS[self.unit]
        return matrix


def axis_orders() -> list[Floats]:
    """Return the 24 turns that take axes to axes."""
    orders = []
    for order in permutations(range(3)):
        for signs in np.ndindex(2, 2, 2):
            turn = np.eye(3)[list(order)] * (1.0 - 2.0 * np.array(signs))[:, None]
            if np.linalg.det(turn) > 0.0:
                orders.append(turn)
    return orders


def turned(about: tuple[float, float, float], degrees: float) -> Floats:
    """Return the turn about an axis (Rodrigues), shape (3, 3)."""
    x, y, z = np.array(about) / np.linalg.norm(about)
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = np.radians(degrees)
    return np.asarray(np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * k @ k)


def ply_bytes(scan: Scan) -> bytes:
    """Return a binary PLY file."""
    v, f = scan
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(v)}\n"
    head += "".join(f"property float {axis}\n" for axis in "xyz")
    if len(f):
        head += f"element face {len(f)}\nproperty list uchar int vertex_indices\n"
    rows = np.zeros(len(f), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, f
    return (head + "end_header\n").encode() + v.astype("<f4").tobytes() + rows.tobytes()


def stl_bytes(scan: Scan) -> bytes:
    """Return a binary STL file."""
    v, f = scan
    rows = np.zeros(len(f), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("free", "<u2")])
    rows["corners"], rows["normal"] = v[f], Mesh(v, f).face_normals
    return bytes(80) + len(f).to_bytes(4, "little") + rows.tobytes()
