"""Thumbnails of a body: for the start page, and of the orientations to choose from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.geometry.mesh import Floats, Mesh, Points, unit
from core.progress import Progress, quiet
from core.scan.body import Body
from core.scan.orientation.axis_override import AXES, nearest_axis
from core.scan.orientation.pose import Pose

Picture = NDArray[np.uint8]

FINER = 2
"""Pixels painted for each one that is seen, in both directions: no stairs at the outlines."""

MOST_TRIANGLES = 4e6
"""Points on a skin: many large triangles get fewer points each, and perhaps holes in the picture."""

LIGHT = np.array([-0.35, -0.80, 0.49])
"""Where the light comes from, in the canonical frame [1]."""


def render_thumbnail(mesh: Mesh, turn: Floats, size: tuple[int, int], clay: tuple[int, int, int]) -> Picture:
    """Return a body turned by ``turn``, shape (3, 3), seen from -y with z up: RGBA, shape (h, w, 4).

    ``size`` is width and height [px], ``clay`` the colour of the skin in full light. Nothing is where no body
    is. Source: ours; each triangle is a few points, the nearest point of a pixel is seen.
    """
    width, height = FINER * size[0], FINER * size[1]
    places, normals = mesh.vertices @ turn.T, mesh.vertex_normals @ turn.T
    low, high = places.min(axis=0), places.max(axis=0)
    grain = max((high[0] - low[0]) / (0.92 * width), (high[2] - low[2]) / (0.92 * height))
    points, facing = _samples(places, normals, mesh, grain)
    middle = 0.5 * (low + high)
    x = np.round((points[:, 0] - middle[0]) / grain + 0.5 * width - 0.5).astype(np.int64)
    y = np.round((middle[2] - points[:, 2]) / grain + 0.5 * height - 0.5).astype(np.int64)
    cell = y * width + x
    far_first = np.argsort(-points[:, 1], kind="stable")  # the last written stays: the one nearest to the eye
    shade = np.full(width * height, -1.0)
    shade[cell[far_first]] = (0.34 + 0.66 * np.clip(facing @ unit(LIGHT[None])[0], 0.0, 1.0))[far_first]
    return _shrunk(shade.reshape(height, width), np.asarray(clay, dtype=np.float64))


def _samples(places: Points, normals: Points, mesh: Mesh, grain: float) -> tuple[Points, Points]:
    """Return points so dense on the skin that no pixel of ``grain`` [mm] stays empty, with their normals."""
    faces = mesh.faces
    corners = places[faces]
    longest = np.sqrt(((corners - np.roll(corners, 1, axis=1)) ** 2).sum(axis=2).max(axis=1))
    found = [(places, normals)]
    steps = np.maximum(np.ceil(1.5 * longest / grain), 1.0)
    crowd = 0.5 * float((steps**2).sum()) / MOST_TRIANGLES
    steps = np.ceil(steps / max(crowd, 1.0) ** 0.5).astype(int)
    for count in np.unique(steps[steps > 1]):  # of a smaller triangle the corners are enough
        chosen = faces[steps == count]
        u, v = (grid.ravel() / count for grid in np.meshgrid(np.arange(count + 1), np.arange(count + 1)))
        mix = np.stack([1.0 - u - v, u, v], axis=1)[u + v <= 1.0 + 1e-9]
        found += [
            (
                np.einsum("sk,mkj->msj", mix, places[chosen]).reshape(-1, 3),
                np.einsum("sk,mkj->msj", mix, normals[chosen]).reshape(-1, 3),
            )
        ]
    return np.concatenate([p for p, _ in found]), np.concatenate([n for _, n in found])


def _shrunk(shade: Floats, clay: Floats) -> Picture:
    """Return the mean of ``FINER`` by ``FINER`` pixels in colour, clear where there is no body."""
    height, width = (side // FINER for side in shade.shape)
    blocks = shade.reshape(height, FINER, width, FINER)
    body = blocks >= 0.0
    share = body.mean(axis=(1, 3))
    light = np.where(body, blocks, 0.0).sum(axis=(1, 3)) / np.maximum(body.sum(axis=(1, 3)), 1)
    picture = np.empty((height, width, 4), dtype=np.uint8)
    picture[..., :3] = np.clip(light[..., None] * clay, 0.0, 255.0)
    picture[..., 3] = 255.0 * share
    return picture


MOST = 4
"""Ways that are offered."""

SAME = np.cos(np.radians(20.0))
"""Two ways whose up and front lie nearer than this look the same."""

ON_AXIS = np.cos(np.radians(1.5))
"""A direction as near to an axis of the file as this has the name of the axis."""


@dataclass(frozen=True, eq=False)
class OrientationOption:
    """``up`` and ``front`` as a scan is told them, the nearest axes, the ``rotation`` (3, 3) from the
    body.
    """

    up: str
    front: str
    axes: tuple[str, str]
    rotation: Floats


def orientation_options(pose: Pose) -> list[OrientationOption]:
    """Return how a body may stand, the likeliest first: what its shape allows, then turns about up."""
    now = unit(pose.file_to_mm[:3, :3])
    about = [np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) for c, s in ((0, 1), (0, -1), (-1, 0))]
    found: list[Floats] = []
    for turn in [
        now,
        *(unit(other[:3, :3]) for other in pose.others),
        *(turn @ now for turn in about),
    ]:
        if not any(_alike(turn, old) for old in found):
            found.append(turn)
    return [_way(turn, turn @ now.T) for turn in found[:MOST]]


def option_thumbnails(
    body: Body, size: tuple[int, int], clay: tuple[int, int, int], progress: Progress = quiet
) -> list[tuple[OrientationOption, Picture]]:
    """Return each way with a picture of the body as it would stand; see ``render_thumbnail``. Raises
    Cancelled.
    """
    painted: list[tuple[OrientationOption, Picture]] = []
    for way in orientation_options(body.pose):
        progress("painting", len(painted) / MOST)
        painted.append((way, render_thumbnail(body.smoothed, way.rotation, size, clay)))
    return painted


def _alike(turn: Floats, old: Floats) -> bool:
    """Return whether two ways look the same, or would be told by the same axes."""
    near = bool(turn[2] @ old[2] > SAME and turn[1] @ old[1] > SAME)
    return near or all(nearest_axis(turn[k]) == nearest_axis(old[k]) for k in (1, 2))


def _way(file_to_body: Floats, turn: Floats) -> OrientationOption:
    up, front = file_to_body[2], -file_to_body[1]
    return OrientationOption(_told(up), _told(front), (nearest_axis(up), nearest_axis(front)), turn)


def _told(direction: Floats) -> str:
    name = nearest_axis(direction)
    if AXES[name] @ direction > ON_AXIS:
        return name
    return ",".join(f"{value:.5f}" for value in direction)
