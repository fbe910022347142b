"""Chests with one breast each, whose volume is known: caps of balls on a flat or a round chest."""

from __future__ import annotations

from types import MappingProxyType

import numpy as np

from core.geometry.mesh import Mesh
from core.landmarks.types import Landmark, Landmarks
from core.measurements.breast_root import Root, Side, side_of
from core.measurements.chest_wall import UnrolledTorso
from core.messages import Message

DEEP = 110.0
"""How far a chest lies before the axis of the trunk [mm]."""


def cap(
    height: float,
    radius: float = 60.0,
    *,
    chest: str = "flat",
    overhang: float = 0.0,
    rings: int = 44,
    sectors: int = 144,
) -> tuple[Side, Root, float]:
    """A cap of a ball of ``radius`` [mm], ``height`` high, on a chest: its side, its root, its volume [mm^3].

    The ``chest`` is "flat", "round" or "oval". ``overhang`` shears the cap down by so much for each mm of
    height, which keeps its volume. Rings of triangles lie round its top, so that one of them is its root.
    """
    rim = float(np.sqrt(2.0 * radius * height - height**2))
    inner = np.linspace(0.0, np.arccos(1.0 - height / radius), rings + 1)[1:]
    across = np.concatenate([radius * np.sin(inner), rim + np.linspace(4.0, 90.0, 22)])
    up = np.concatenate([radius * np.cos(inner) - (radius - height), np.zeros(22)])
    angle = np.linspace(0.0, 2.0 * np.pi, sectors, endpoint=False)
    x = np.append(np.outer(across, np.cos(angle)).ravel(), 0.0)
    z = np.append(np.outer(across, np.sin(angle)).ravel(), 0.0)
    out = np.append(np.repeat(up, sectors), height)
    on_chest = {"flat": _on_flat, "round": _on_round, "oval": _on_oval}[chest]
    places = on_chest(x, z - overhang * out, out)
    mesh = Mesh(places, _disc(len(across), sectors))
    volume = np.pi * height**2 * (3.0 * radius - height) / 3.0
    if chest == "oval":  # no formula: what lies between the skin and the same chest without a breast
        volume = mesh.enclosed_volume() - mesh.moved(on_chest(x, z, 0.0 * out)).enclosed_volume()
    # The root runs from the inner end, which on the left side is that of lesser x, down and round.
    loop = np.roll(places[(rings - 1) * sectors : rings * sectors], -sectors // 2, axis=0)
    chart = UnrolledTorso(np.zeros(2), DEEP)
    side = side_of(mesh, _landmarks(places[-1], loop), "left", chart)
    assert side is not None
    return side, Root(loop, sectors // 2 + 1, chart, 1.0), volume


def _on_flat(x: np.ndarray, z: np.ndarray, out: np.ndarray) -> np.ndarray:
    return np.stack([x, -DEEP - out, z], axis=1)


def _on_round(x: np.ndarray, z: np.ndarray, out: np.ndarray) -> np.ndarray:
    """Bend the plate about the axis; a place goes so much further out that volumes stay as they are."""
    far, turn = np.sqrt(DEEP**2 + 2.0 * DEEP * out), x / DEEP
    return np.stack([far * np.sin(turn), -far * np.cos(turn), z], axis=1)


def _on_oval(x: np.ndarray, z: np.ndarray, out: np.ndarray) -> np.ndarray:
    """Lay it on the front corner of an oval trunk, as wide as 1.4 times its depth."""
    turn = x / DEEP + 0.6
    return np.stack([1.4 * (DEEP + out) * np.sin(turn), -(DEEP + out) * np.cos(turn), z], axis=1)


def _disc(rings: int, sectors: int) -> np.ndarray:
    """Faces of rings of vertices round a last one, wound so that they look to -y."""
    k = np.arange(sectors)
    after = (k + 1) % sectors
    faces = [np.stack([np.full(sectors, rings * sectors), k, after], axis=1)]
    for ring in range(rings - 1):
        a, b, c, d = (ring * sectors + k, ring * sectors + after, (ring + 1) * sectors + k, 0)
        d = (ring + 1) * sectors + after
        faces += [np.stack([a, c, d], axis=1), np.stack([a, d, b], axis=1)]
    return np.concatenate(faces)


def _landmarks(bust: np.ndarray, loop: np.ndarray) -> Landmarks:
    half = len(loop) // 2
    places = {
        "bust_point_left": bust,
        "root_inner_left": loop[0],
        "root_outer_left": loop[half],
        "fold_left": loop[half // 2],
    }
    points = {name: Landmark(name, place, 1.0, Message("known")) for name, place in places.items()}
    return Landmarks(MappingProxyType(points), float(bust[2]), float(loop[:, 2].min()))
