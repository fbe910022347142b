"""Things that are no upper body, the size of one: solids, furniture, limbs, animals, and pieces of a body."""

from __future__ import annotations

import numpy as np
import trimesh
from trimesh.creation import box, capsule, cone, cylinder, icosphere, torus

Shape = tuple[np.ndarray, np.ndarray]


def limb(start, end, first, last=None) -> trimesh.Trimesh:
    """Return a round limb between two points [mm], with radii at both ends."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    last = first if last is None else last
    length = float(np.linalg.norm(end - start))
    shape = capsule(length, 1.0, count=[48, 48])
    z = shape.vertices[:, 2] - shape.vertices[:, 2].min() - 1.0
    radius = np.interp(z, [0.0, length], [first, last])
    cap = np.where(z < 0.0, first * z, np.where(z > length, length + last * (z - length), z))
    shape.vertices = np.column_stack([shape.vertices[:, :2] * radius[:, None], cap])
    axis = (end - start) / length
    shape.apply_transform(trimesh.geometry.align_vectors([0.0, 0.0, 1.0], axis))
    return shape.apply_translation(start)


def ball(centre, radii) -> trimesh.Trimesh:
    """Return an ellipsoid [mm]."""
    shape = icosphere(subdivisions=4)
    shape.vertices = shape.vertices * radii + centre
    return shape


def block(centre, extents) -> trimesh.Trimesh:
    """Return a box of small triangles [mm]."""
    return box(extents).subdivide().subdivide().subdivide().subdivide().apply_translation(centre)


def together(*parts: trimesh.Trimesh) -> Shape:
    """Return one soup of parts."""
    whole = trimesh.util.concatenate(parts)
    return np.asarray(whole.vertices), np.asarray(whole.faces)


def chair() -> Shape:
    legs = [block((x, y, 220), (40, 40, 440)) for x in (-200, 200) for y in (-200, 200)]
    return together(block((0, 0, 450), (450, 450, 40)), block((0, 215, 700), (450, 30, 460)), *legs)


def table() -> Shape:
    legs = [block((x, y, 340), (50, 50, 680)) for x in (-500, 500) for y in (-300, 300)]
    return together(block((0, 0, 700), (1100, 700, 40)), *legs)


def head(lift: float = 0.0) -> list[trimesh.Trimesh]:
    skull = ball((0, 0, 140 + lift), (75, 95, 115))
    nose = ball((0, -98, 130 + lift), (14, 16, 20))
    chin = ball((0, -70, 50 + lift), (30, 25, 22))
    ears = [ball((x, 5, 135 + lift), (8, 20, 30)) for x in (-78, 78)]
    return [skull, nose, chin, *ears, limb((0, 15, -60 + lift), (0, 10, 80 + lift), 58)]


def figure(trunk: float, thigh, shin, bust: float = 0.0) -> Shape:
    """Return a coarse figure: ``thigh`` and ``shin`` point from hip and knee [mm]."""
    parts = [
        limb((0, 0, 0), (0, 0, trunk), 120, 110),
        limb((-150, 0, trunk), (150, 0, trunk), 60),
        *head(trunk + 110),
    ]
    for x in (-1, 1):
        hip = np.array((80.0 * x, 0, 0))
        knee = hip + thigh
        parts += [limb(hip, knee, 85, 60), limb(knee, knee + shin, 58, 40)]
        parts += [limb((170 * x, 0, trunk), (200 * x, -60, trunk - 280), 48, 40)]
        parts += [limb((200 * x, -60, trunk - 280), (90 * x, -250, trunk - 400), 38, 30)]
        if bust:
            parts.append(ball((60 * x, -85, trunk - 110), (bust, bust, bust)))
    return together(*parts)


def seated() -> Shape:
    return figure(430.0, np.array((0, -420, 0)), np.array((0, 0, -430)))


def lying_dog() -> Shape:
    legs = [limb((x, y, 300), (x, y - 20, 20), 45, 25) for x in (-70, 70) for y in (-250, 250)]
    trunk = limb((0, -280, 350), (0, 280, 350), 120, 100)
    return together(
        trunk, *legs, limb((0, -300, 400), (0, -420, 520), 70, 60), ball((0, -480, 540), (60, 110, 60)),
        limb((0, 300, 380), (0, 480, 520), 20, 12),
    )  # fmt: skip


def scene() -> Shape:
    floor, wall = block((0, 0, -20), (3000, 3000, 40)), block((0, 1500, 1200), (3000, 40, 2400))
    parts = [trimesh.Trimesh(*each, process=False) for each in (chair(), table())]
    parts[1].apply_translation((900, 0, 0))
    return together(floor, wall, *parts)


def plain(shape: trimesh.Trimesh) -> Shape:
    return np.asarray(shape.vertices), np.asarray(shape.faces)


def objects() -> dict[str, Shape]:
    """Return things without a body in them, by name."""
    vase = trimesh.creation.revolve(
        [(0, 0), (90, 0), (140, 120), (150, 220), (90, 380), (60, 450), (100, 520)], sections=90
    )
    return {
        "cube": plain(box((300.0, 300.0, 300.0))),
        "brick": plain(box((340.0, 220.0, 700.0))),
        "ball": plain(icosphere(subdivisions=4, radius=150.0)),
        "egg": together(ball((0, 0, 0), (150, 110, 300))),
        "pillar": plain(cylinder(140.0, 700.0, sections=60)),
        "cone": plain(cone(200.0, 600.0, sections=60)),
        "ring": plain(torus(250.0, 90.0)),
        "vase": plain(vase),
        "chair": chair(),
        "table": table(),
        # so large that whichever girth is taken for that of a trunk could be one
        "head": together(*(part.apply_scale(1.3) for part in head())),
        "head and shoulders": together(
            *head(40), limb((-170, 10, -50), (170, 10, -50), 75), ball((0, 0, -60), (150, 90, 80))
        ),
        "arm": together(
            limb((0, 0, 0), (0, -20, -300), 55, 42),
            limb((0, -20, -300), (0, -60, -560), 42, 28),
            ball((0, -70, -640), (40, 20, 80)),
        ),
        "leg": together(
            limb((0, 0, 0), (0, 0, -420), 95, 60),
            limb((0, 0, -420), (0, 20, -850), 62, 40),
            limb((0, 30, -880), (0, -160, -890), 40, 30),
        ),
        "seated figure": seated(),
        "dog": lying_dog(),
        "scene": scene(),
    }  # fmt: skip


def part(body: Shape, keep) -> Shape:
    """Return the faces of a body whose corners all fulfil ``keep``, a test of (n, 3) [mm]."""
    vertices, faces = body
    return vertices, faces[keep(vertices)[faces].all(axis=1)]


def pieces(body: Shape, fold: float, bust: float) -> dict[str, Shape]:
    """Return pieces of a canonical body that are no upper body; heights of fold and bust in mm."""
    depth = float(np.median(body[0][np.abs(body[0][:, 2] - fold) < 20.0, 1]))
    return {
        "left half": part(body, lambda p: p[:, 0] > 0.0),
        "right half": part(body, lambda p: p[:, 0] < 0.0),
        "front half": part(body, lambda p: p[:, 1] < depth),
        "back half": part(body, lambda p: p[:, 1] > depth),
        "belly": part(body, lambda p: p[:, 2] < fold - 30.0),
        "above the bust": part(body, lambda p: p[:, 2] > bust + 50.0),
    }
