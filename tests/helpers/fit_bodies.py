"""Bodies to fit a control mesh on: the samples with their true landmarks, and an analytic one."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import MappingProxyType

import numpy as np

from core.geometry.mesh import Mesh
from core.landmarks.types import Landmark, Landmarks
from core.messages import Message
from core.scan.body import Body, read_scan

HERE = Path(__file__).parents[1]
SAMPLES = ("mannequin", "person")


@cache
def sample_of(name):
    """A sample body and the places of its true landmarks by name."""
    truth = json.loads((HERE / "data" / "landmarks.json").read_text("utf-8"))[name]
    body = read_scan(HERE.parent / "resources" / "samples" / f"{name}.ply")
    return body, {mark: np.array(place) for mark, place in truth.items()}


def body_of(mesh) -> Body:
    """The mannequin's file with another skin."""
    return replace(sample_of("mannequin")[0], mesh=mesh)


def landmarks_at(places) -> Landmarks:
    """Landmarks at given places by name."""
    points = {name: Landmark(name, place, 1.0, Message("given")) for name, place in places.items()}
    bust = np.mean([points[f"bust_point_{side}"].position[2] for side in ("left", "right")])
    return Landmarks(
        MappingProxyType(points), float(bust), float(min(p.position[2] for p in points.values()))
    )


RADIUS, BUST, FOLD, AZIMUTH = 120.0, 340.0, 300.0, np.radians(42.0)


def skin(azimuth, z, bump=45.0):
    """The distance of the analytic skin from the axis [mm]: a round trunk with bumps that end in a fold."""
    breast = np.where(
        z > FOLD, np.clip((z - FOLD) / 12.0, 0.0, 1.0) * np.exp(-(((z - BUST) / 55.0) ** 2)), 0.0
    )
    bumps = sum(np.exp(-(((azimuth - side * AZIMUTH) / 0.42) ** 2)) for side in (1.0, -1.0))
    return RADIUS + bump * breast * bumps


def analytic_body(bump=45.0) -> Mesh:
    azimuth = np.linspace(-np.pi, np.pi, 181)[:-1]
    z = np.arange(100.0, 560.0, 3.0)
    a, h = np.meshgrid(azimuth, z, indexing="ij")
    r = skin(a, h, bump)
    vertices = np.stack([r * np.sin(a), -r * np.cos(a), h], axis=-1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(len(azimuth)), np.arange(len(z) - 1), indexing="ij")
    at = lambda p, q: ((p % len(azimuth)) * len(z) + q).ravel()  # noqa: E731
    a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    return Mesh(vertices, np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])]))


def analytic_landmarks() -> Landmarks:
    places = {}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for name, z in (("bust_point", BUST), ("fold", FOLD), ("lowest", FOLD)):
            r = skin(sign * AZIMUTH, np.array(z))
            places[f"{name}_{side}"] = np.array([sign * r * np.sin(AZIMUTH), -r * np.cos(AZIMUTH), z])
    return landmarks_at(places)


def hanging(sag):
    """The analytic body with breasts pulled down by ``sag`` per mm that they stand out, and its landmarks."""

    def pulled(place):
        x, y, z = np.moveaxis(np.asarray(place, dtype=float), -1, 0)
        return np.stack([x, y, z - sag * (np.hypot(x, y) - RADIUS)], axis=-1)

    places = {name: pulled(mark.position) for name, mark in analytic_landmarks().points.items()}
    for side, sign in (("left", 1.0), ("right", -1.0)):
        z = np.linspace(FOLD, BUST, 400)
        r = skin(sign * AZIMUTH, z)
        below = pulled(np.column_stack([sign * r * np.sin(AZIMUTH), -r * np.cos(AZIMUTH), z]))
        places[f"lowest_{side}"] = below[below[:, 2].argmin()]
    mesh = analytic_body()
    return body_of(mesh.moved(pulled(mesh.vertices))), landmarks_at(places)
