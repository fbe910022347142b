"""Bodies that were bent, cropped, torn and glued, from the scan file to the fitted control mesh."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from core.control_mesh.fit import fit_control_mesh
from core.control_mesh.template import read_template
from core.errors import UserError
from core.geometry.mesh import Points
from core.landmarks.as_dict import detection
from core.landmarks.detect import find_landmarks
from core.scan.body import body_of
from core.scan.readers.registry import read_raw
from fuzzing.simpler import without_items

SAMPLES = Path(__file__).parents[2] / "resources" / "samples"
NAMES = ("mannequin.ply", "person.ply")
TOLD = {"unit": "mm", "up": "+z", "front": "-y"}

Skin = tuple[Points, np.ndarray]
Chance = np.random.Generator


@cache
def sample(name: str) -> Skin:
    scan = read_raw(name, (SAMPLES / name).read_bytes())
    upright = body_of(name, (SAMPLES / name).read_bytes())
    return scan.vertices @ upright.pose.file_to_mm[:3, :3].T, scan.faces


def _thinned(skin: Skin, edge: float) -> Skin:
    """Join the vertices in cubes of an edge [mm]: coarse scans are quick and odd."""
    cell = np.floor(skin[0] / edge).astype(np.int64)
    _, first, member = np.unique(cell, axis=0, return_index=True, return_inverse=True)
    faces = member.reshape(-1)[skin[1]]
    return skin[0][first], faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]


def _bent(skin: Skin, chance: Chance) -> Skin:
    axis, most = int(chance.integers(2)), np.radians(chance.uniform(-60.0, 60.0))
    p = skin[0].copy()
    low, high = p[:, 2].min(), p[:, 2].max()
    angle = most * np.clip((p[:, 2] - low) / max(high - low, 1e-9) - chance.uniform(0.0, 0.6), 0.0, 1.0)
    other, z = p[:, 1 - axis].copy(), p[:, 2] - 0.5 * (low + high)
    p[:, 1 - axis] = np.cos(angle) * other - np.sin(angle) * z
    p[:, 2] = np.sin(angle) * other + np.cos(angle) * z
    return p, skin[1]


def _twisted(skin: Skin, chance: Chance) -> Skin:
    p = skin[0].copy()
    share = (p[:, 2] - p[:, 2].min()) / max(float(np.ptp(p[:, 2])), 1e-9)
    angle = np.radians(chance.uniform(-90.0, 90.0)) * (share - 0.5)
    x, y = p[:, 0].copy(), p[:, 1].copy()
    p[:, 0], p[:, 1] = np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y
    return p, skin[1]


def _cropped(skin: Skin, chance: Chance) -> Skin:
    """Cut along a plane through the body, level as a rule."""
    normal = (
        chance.normal(size=3) if chance.random() < 0.4 else np.array([0.0, 0.0, chance.choice((-1.0, 1.0))])
    )
    height = skin[0] @ (normal / np.linalg.norm(normal))
    keep = height < np.quantile(height, chance.uniform(0.3, 0.98))
    return skin[0], skin[1][keep[skin[1]].all(axis=1)]


def _holed(skin: Skin, chance: Chance) -> Skin:
    centres = skin[0][skin[1][:, 0]]
    gone = np.zeros(len(centres), dtype=bool)
    for _ in range(int(chance.integers(1, 25))):
        spot, size = centres[chance.integers(len(centres))], chance.exponential(25.0)
        gone |= ((centres - spot) ** 2).sum(axis=1) < size**2
    return skin[0], skin[1][~gone]


def _scaled(skin: Skin, chance: Chance) -> Skin:
    sizes = np.exp(chance.normal(0.0, 0.25, 3)) if chance.random() < 0.5 else np.exp(chance.normal(0.0, 0.4))
    return skin[0] * sizes, skin[1]


def _huge(skin: Skin, chance: Chance) -> Skin:
    return skin[0] * 10.0 ** chance.uniform(-8.0, 8.0) + 10.0 ** chance.uniform(-3.0, 8.0), skin[1]


def _noised(skin: Skin, chance: Chance) -> Skin:
    return skin[0] + chance.normal(0.0, chance.exponential(4.0), skin[0].shape), skin[1]


def _torn(skin: Skin, chance: Chance) -> Skin:
    """Give each triangle corners of its own, a little apart."""
    corners = skin[0][skin[1]].reshape(-1, 3)
    return corners + chance.normal(0.0, chance.exponential(1.0), corners.shape), np.arange(
        len(corners)
    ).reshape(-1, 3)


def _glued(skin: Skin, chance: Chance) -> Skin:
    """Add the same skin once more, moved, turned or mirrored."""
    turn = np.linalg.qr(chance.normal(size=(3, 3)))[0] if chance.random() < 0.5 else np.eye(3)
    more = skin[0] @ turn * chance.uniform(0.2, 1.1) + chance.normal(0.0, 150.0, 3)
    return np.concatenate([skin[0], more]), np.concatenate([skin[1], skin[1] + len(skin[0])])


def _shredded(skin: Skin, chance: Chance) -> Skin:
    """Add thousands of tiny closed pieces near the skin."""
    count = int(chance.integers(500, 8000))
    spots = skin[0][chance.integers(len(skin[0]), size=count)] + chance.normal(0.0, 30.0, (count, 3))
    corners = (spots[:, None] + chance.normal(0.0, 3.0, (count, 4, 3))).reshape(-1, 3)
    sides = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    faces = (4 * np.arange(count)[:, None, None] + sides).reshape(-1, 3) + len(skin[0])
    return np.concatenate([skin[0], corners]), np.concatenate([skin[1], faces])


def _slivers(skin: Skin, chance: Chance) -> Skin:
    """Add long thin triangles right through the body."""
    count = int(chance.integers(10, 3000))
    ends = chance.integers(len(skin[0]), size=(count, 2))
    third = skin[0][ends[:, 1]] + chance.normal(0.0, 0.5, (count, 3))
    faces = np.column_stack([ends, len(skin[0]) + np.arange(count)])
    return np.concatenate([skin[0], third]), np.concatenate([skin[1], faces])


def _shuffled(skin: Skin, chance: Chance) -> Skin:
    """Swap corners of some triangles for others, turn some round, list some twice."""
    faces = skin[1].copy()
    rows = chance.random(len(faces)) < chance.exponential(0.02)
    faces[rows, 0] = chance.integers(len(skin[0]), size=int(rows.sum()))
    turned = chance.random(len(faces)) < chance.exponential(0.1)
    faces[turned] = faces[turned, ::-1]
    return skin[0], np.concatenate([faces, faces[chance.random(len(faces)) < 0.01]])


def _lost(skin: Skin, chance: Chance) -> Skin:
    """Set some vertices to one place, to no number, or far away."""
    p = skin[0].copy()
    rows = chance.random(len(p)) < chance.exponential(0.01)
    p[rows] = chance.choice((0.0, np.nan, np.inf, 1e8, -1e30, 600.0))
    return p, skin[1]


def _turned(skin: Skin, chance: Chance) -> Skin:
    return skin[0] @ np.linalg.qr(chance.normal(size=(3, 3)))[0], skin[1]


def _as_cloud(skin: Skin, chance: Chance) -> Skin:
    return skin[0], skin[1][: int(chance.integers(3))]


CHANGES: dict[str, Callable[[Skin, Chance], Skin]] = {
    "bent": _bent,
    "twisted": _twisted,
    "cropped": _cropped,
    "holed": _holed,
    "scaled": _scaled,
    "huge": _huge,
    "noised": _noised,
    "torn": _torn,
    "glued": _glued,
    "shredded": _shredded,
    "slivers": _slivers,
    "shuffled": _shuffled,
    "lost": _lost,
    "turned": _turned,
    "cloud": _as_cloud,
}

GENTLE = ("bent", "cropped", "twisted", "holed", "scaled", "noised")
"""Changes that leave a body a body, so that most of these come to a fit."""


def make(chance: random.Random) -> Any:
    """Return a sample, how coarse it is made, and what is done to it."""
    names = GENTLE if chance.random() < 0.7 else tuple(CHANGES)
    changes = [[chance.choice(names), chance.randrange(10**6)] for _ in range(chance.randrange(1, 4))]
    told = TOLD if chance.random() < 0.5 else {}
    placed = chance.randrange(10**6) if chance.random() < 0.3 else None
    edge = chance.choice((0, 8, 12, 12, 20, 30))
    return {
        "sample": chance.choice(NAMES),
        "edge": edge,
        "changes": changes,
        "told": told,
        "placed": placed,
        "template": chance.choice(("168", "120")),
    }


def run(recipe: Any) -> str:
    """Write the scan, read it, find the landmarks, lay the control mesh."""
    skin = sample(recipe["sample"])
    with np.errstate(all="ignore"):
        skin = _thinned(skin, recipe["edge"]) if recipe["edge"] else skin
        for name, seed in recipe["changes"]:
            if len(skin[1]):
                skin = CHANGES[name](skin, np.random.default_rng(seed))
    body = body_of("body.ply", file_of(skin), **recipe["told"])
    placed = _placed(body.smoothed.vertices, recipe["placed"])
    landmarks = find_landmarks(body, placed)
    detection(body, landmarks)
    try:
        fit_control_mesh(read_template(recipe["template"]), body, landmarks)
    except UserError as problem:
        return f"landmarks; {problem.message}"
    return "fit"


def _placed(skin: Points, seed: int | None) -> dict[str, Points]:
    """Return bust points and folds placed by hand: somewhere likely on the skin, now and then anywhere."""
    if seed is None:
        return {}
    chance = np.random.default_rng(seed)
    low, high = np.percentile(skin, (1, 99), axis=0)
    places = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for name, up in (("bust_point", 0.62), ("fold", 0.5)):
            share = np.array([0.5 + 0.18 * sign, 0.1, up]) + chance.normal(0.0, 0.05, 3)
            wanted = low + share * (high - low) if chance.random() < 0.95 else chance.uniform(low, high)
            places[f"{name}_{side}"] = skin[((skin - wanted) ** 2).sum(axis=1).argmin()]
    return places


def file_of(skin: Skin) -> bytes:
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(skin[0])}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz")
    head += f"element face {len(skin[1])}\nproperty list uchar int vertex_indices\nend_header\n"
    rows = np.empty(len(skin[1]), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    rows["count"], rows["corners"] = 3, skin[1]
    return head.encode() + skin[0].astype("<f8").tobytes() + rows.tobytes()


def simpler(recipe: Any) -> Iterator[Any]:
    """Give fewer changes, a coarser body, nothing told."""
    yield from (recipe | {"changes": changes} for changes in without_items(recipe["changes"]))
    yield from (recipe | {"edge": edge} for edge in (40, 20, 12) if edge > recipe["edge"])
    if recipe["placed"] is not None:
        yield recipe | {"placed": None}
