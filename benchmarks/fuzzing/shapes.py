"""Pathological shapes of any size: what each loop over a skin has to bear without a table of all pairs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from core.landmarks.detect import find_landmarks
from core.scan.body import body_of
from fuzzing.bodies import TOLD, Skin, file_of, sample

BODY = "person.ply"


def _joined(first: Skin, second: Skin) -> Skin:
    return np.concatenate([first[0], second[0]]), np.concatenate([first[1], second[1] + len(first[0])])


def _loose(corners: np.ndarray) -> Skin:
    """Return triangles that share nothing, from corners of shape (m, 3, 3)."""
    return corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3)


def _slivers(count: int, chance: np.random.Generator) -> Skin:
    """Upright needles as high as the body."""
    low, high = sample(BODY)[0].min(axis=0), sample(BODY)[0].max(axis=0)
    foot = chance.uniform(low, high, (count, 3))
    foot[:, 2] = low[2]
    top = foot + np.array([0.0, 0.0, high[2] - low[2]])
    return _joined(sample(BODY), _loose(np.stack([foot, foot + np.array([0.3, 0.2, 0.0]), top], axis=1)))


def _planks(count: int, chance: np.random.Generator) -> Skin:
    """Needles right across the body, each near its middle."""
    low, high = sample(BODY)[0].min(axis=0), sample(BODY)[0].max(axis=0)
    start = chance.uniform(low, high, (count, 3))
    end = low + high - start
    end[:, 2] = start[:, 2] + chance.uniform(0.0, 20.0, count)
    return _joined(sample(BODY), _loose(np.stack([start, start + np.array([0.0, 0.0, 5.0]), end], axis=1)))


def _shreds(count: int, chance: np.random.Generator) -> Skin:
    """Tiny closed pieces along the skin, enough of them to be no specks."""
    points, faces = sample(BODY)
    spots = points[faces[chance.integers(len(faces), size=count)]].mean(axis=1) + chance.normal(
        0, 9, (count, 3)
    )
    corners = spots[:, None] + chance.normal(0.0, 4.0, (count, 4, 3))
    sides = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    all_faces = (4 * np.arange(count)[:, None, None] + sides).reshape(-1, 3)
    return _joined(sample(BODY), (corners.reshape(-1, 3), all_faces))


def _soup(count: int, chance: np.random.Generator) -> Skin:
    """The body in single triangles, again and again, each a little off."""
    points, faces = sample(BODY)
    rows = chance.integers(len(faces), size=count)
    corners = points[faces[rows]] + chance.normal(0.0, 1.5, (count, 1, 3))
    return _loose(corners)


def _book(count: int, chance: np.random.Generator) -> Skin:
    """Pages round one edge."""
    turn = chance.uniform(0.0, 2.0 * np.pi, count)
    pages = np.column_stack([300 * np.cos(turn), 200 * np.sin(turn), chance.uniform(0.0, 600.0, count)])
    faces = np.column_stack([np.zeros(count), np.ones(count), np.arange(count) + 2]).astype(np.int64)
    return np.concatenate([[[0.0, 0.0, 0.0], [0.0, 0.0, 600.0]], pages]), faces


def _star(count: int, chance: np.random.Generator) -> Skin:
    """Triangles round one vertex, the same ones many times."""
    turn = chance.uniform(0.0, 2.0 * np.pi, 1000)
    rim = np.column_stack([200 * np.cos(turn), 200 * np.sin(turn), chance.uniform(0.0, 600.0, 1000)])
    faces = np.column_stack([np.zeros(count), 1 + chance.integers(0, 1000, (count, 2))]).astype(np.int64)
    return np.concatenate([[[0.0, 0.0, 300.0]], rim]), faces


def _rags(count: int, chance: np.random.Generator) -> Skin:
    """A sheet with a hole of many corners that is small enough to be closed."""
    turn = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    radius = 12.0 + chance.uniform(0.0, 2.0, count)
    rim = np.column_stack([radius * np.cos(turn), np.full(count, -160.0), 300.0 + radius * np.sin(turn)])
    outer = np.column_stack([40.0 * np.cos(turn), np.full(count, -160.0), 300.0 + 40.0 * np.sin(turn)])
    a, b = np.arange(count), np.roll(np.arange(count), -1)
    ring = np.concatenate([np.column_stack([a, b, a + count]), np.column_stack([b, b + count, a + count])])
    return _joined(sample(BODY), (np.concatenate([rim, outer]), ring))


def _moths(count: int, chance: np.random.Generator) -> Skin:
    """A fine sheet, every third triangle of which is missing."""
    side = int(np.sqrt(count / 2)) + 2
    x, z = np.meshgrid(np.linspace(-170.0, 170.0, side), np.linspace(0.0, 600.0, side))
    points = np.stack([x, -120.0 - 30.0 * np.cos(x / 60.0), z], axis=-1).reshape(-1, 3)
    at = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    faces = np.concatenate(
        [np.stack([at, at + 1, at + side], 1), np.stack([at + 1, at + side + 1, at + side], 1)]
    )
    return _joined(sample(BODY), (points, faces[chance.random(len(faces)) > 0.33]))


def _wide(count: int, chance: np.random.Generator) -> Skin:
    """Needles to and fro over many metres, far beside the body."""
    start = chance.uniform([-9000.0, -200.0, 0.0], [9000.0, 200.0, 600.0], (count, 3))
    end = start * [-1.0, 1.0, 1.0]
    return _joined(sample(BODY), _loose(np.stack([start, start + np.array([0.0, 0.0, 9.0]), end], axis=1)))


def _one_triangle(count: int, chance: np.random.Generator) -> Skin:
    """Points without number, and one triangle."""
    points = sample(BODY)[0]
    many = points[chance.integers(len(points), size=count)] + chance.normal(0.0, 1.0, (count, 3))
    return many, np.array([[0, 1, 2]])


def _clusters(count: int, chance: np.random.Generator) -> Skin:
    """A cloud in a few places, nearly all points of which are equal."""
    spots = sample(BODY)[0][chance.integers(len(sample(BODY)[0]), size=600)]
    return spots[chance.integers(600, size=count)], np.empty((0, 3), dtype=np.int64)


SHAPES: dict[str, Callable[[int, np.random.Generator], Skin]] = {
    "slivers": _slivers,
    "planks": _planks,
    "shreds": _shreds,
    "soup": _soup,
    "book": _book,
    "star": _star,
    "rags": _rags,
    "moths": _moths,
    "wide": _wide,
    "triangle": _one_triangle,
    "clusters": _clusters,
}


def run(recipe: Any) -> str:
    """Read a shape of so many parts, told or not how it stands, and look for landmarks."""
    skin = SHAPES[recipe["shape"]](recipe["count"], np.random.default_rng(1))
    body = body_of("shape.ply", file_of(skin), **(TOLD if recipe["told"] else {}))
    find_landmarks(body)
    return "landmarks"


def simpler(recipe: Any) -> Iterator[Any]:
    """Give fewer parts."""
    if recipe["count"] > 10:
        yield recipe | {"count": recipe["count"] // 2}
