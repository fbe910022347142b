"""Words of places that a designer has dragged, so that the block fits the next body too (ours)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from core.control_mesh.fit import BUST, LOWER
from core.document.block import REFERENCES, ROOT, WAY, Level, Seam
from core.errors import PatternError
from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Mesh, Points
from core.geometry.plane_sections import arc_length
from core.messages import Message
from core.pattern.places import CELL_WORD, CENTRE_WORD, RING_WORD, ROOT_WORD, BodyPlaces, parts_of
from core.pattern.seam_curves import SeamDrawing

OFF = 3.0
"""A place dragged less than this off its root or level stays on it [mm]."""

SAME = 0.5
"""A place dragged less than this keeps its word [mm]."""

SHARE = 0.005
"""Shares of a half round are told in steps of this [1]; those of a root in hundredths, cells in tenths."""

_BREAST = 1.2  # up to this share of the way to the root a new place is on the breast [1]

_TURNS = 5  # of finding the place of a control mesh whose nearest place on the skin is the one that is meant


def moved_word(places: BodyPlaces, word: str, side: str, levels: Mapping[str, float], target: Points) -> str:
    """Return the word of the same kind for the place nearest to ``target`` (3,) [mm] on the skin.

    ``word`` and ``side`` are those of the seam before, ``levels`` heights by name [mm]. Angles are told to
    1 degree, heights and distances to 1 mm. The bust point becomes a place of its root, a landmark one of a
    control mesh or a level. Raises PatternError for a word that is none.
    """
    text, own, onto = parts_of(word)
    before = places.place(f"{text} {own}".rstrip(), side, levels, {})
    if np.linalg.norm(before - target) < SAME:
        return word
    moved = _moved(places, text, own or side, levels, target)
    return " ".join(part for part in (moved, own, onto and f"> {onto}") if part)


def _moved(places: BodyPlaces, text: str, side: str, levels: Mapping[str, float], target: Points) -> str:
    if text == "apex":
        return _on_root(places, side, target, share=True, off=None)
    if match := ROOT_WORD.fullmatch(text):
        return _on_root(places, side, target, share=match[2] is not None, off=match[3])
    if match := RING_WORD.fullmatch(text):
        z = places.level_height(match[1], levels)
        off = _off(float(target[2]) - z, match[3])
        return f"ring {match[1]} {share_at(places, z + float(off or 0.0), side, target):g}{off}"
    if match := CENTRE_WORD.fullmatch(text):
        z = places.level_height(match[2], levels)
        return f"{match[1]} {match[2]}{_off(float(target[2]) - z, '')}"
    if match := CELL_WORD.fullmatch(text):
        cell = _cell(places, LOWER if match[1] else BUST, side, target)
        if np.linalg.norm(places.place(cell, side, levels, {}) - target) < 2.0 * OFF:
            return cell
    return word_at(places, side, target)  # beyond the control mesh, as where a landmark is left


def _off(value: float, former: str | None) -> str:
    """Return a signed number of millimetres; none for a word without one, if it is small."""
    small = abs(value) < 0.5 if former is not None else abs(value) <= OFF
    return "" if small else f"{round(value):+d}"


def _on_root(places: BodyPlaces, side: str, target: Points, *, share: bool, off: str | None) -> str:
    """Return a word on the root of a breast: at a share of the way to it, or so far beyond."""
    breast = places.breasts[side]
    exact, far = breast.locate(target)
    clock = round(exact) % 360
    root = float(breast.root_distance(clock))
    if not share:
        return f"root {clock}{_off(far - root, off)}"
    part = max((far - float(off or 0.0)) / root, 0.0)
    return f"root {clock}*{part:.2f}{off or ''}"


def share_at(places: BodyPlaces, z: float, side: str, target: Points) -> float:
    """Return the share of the half round at a height [mm] that is nearest to ``target`` (3,), in 0.005."""
    ring = places.ring(z, side)
    steps = np.diff(ring, axis=0)
    length = np.maximum((steps**2).sum(axis=1), 1e-12)
    at = np.clip(((target - ring[:-1]) * steps).sum(axis=1) / length, 0.0, 1.0)
    away = np.linalg.norm(ring[:-1] + at[:, None] * steps - target, axis=1)
    best, along = int(away.argmin()), arc_length(ring)
    share = (along[best] + at[best] * (along[best + 1] - along[best])) / along[-1]
    return round(round(float(share) / SHARE) * SHARE, 3)


def _cell(places: BodyPlaces, region: str, side: str, target: Points) -> str:
    """Return row and column of the place of a control mesh that is laid on the skin at ``target``."""
    control = places.meshes[region]
    grid, sign = control.grid, -1.0 if side == "right" else 1.0
    mesh = Mesh(control.mesh.vertices, grid.faces)
    place = target
    for _ in range(_TURNS):
        face, foot = nearest_faces(mesh, place[None], mesh.centroid_tree)
        laid = nearest_faces(places.skin, foot, places.skin.centroid_tree)[1][0]
        place = place + target - laid
    weights = barycentric(mesh.vertices[mesh.faces[face]], foot)
    row, column = grid.places(mesh.faces[face], weights)[0]
    row = np.clip(row, 0.0, grid.top)
    column = np.clip(sign * column, 0.0, grid.half)
    return f"{'below ' if region == LOWER else ''}r{round(float(row), 1):g}c{round(float(column), 1):g}"


def word_at(places: BodyPlaces, side: str, target: Points) -> str:
    """Return a word for a new place of a seam on a side at ``target`` (3,) [mm] of the skin.

    On a breast it is told by the root, elsewhere by a control mesh, beyond that by a level; for a seam over
    the middle, side "", it has a side of its own. Raises PatternError where there is no skin.
    """
    own = side or ("left" if target[0] > places.middle else "right")

    def off(word: str) -> float:
        return float(np.linalg.norm(places.place(word, own, {}, {}) - target))

    word = min((_cell(places, region, own, target) for region in places.meshes), key=off)
    if off(word) >= OFF:  # beyond the control meshes
        word = min(word, _on_level(places, own, target), key=off)
    if f"bust_point_{own}" in places.landmarks.points:
        breast = places.breasts[own]
        clock, far = breast.locate(target)
        root = _on_root(places, own, target, share=True, off=None)
        if far < _BREAST * float(breast.root_distance(clock)) and off(root) < OFF:
            word = root
    return word if side else f"{word} {own}"


def _on_level(places: BodyPlaces, side: str, target: Points) -> str:
    """Return a word by the share of the half round, so far above or below the nearest of known levels."""
    lower = () if places.lower is None else tuple(places.lower.points)
    heights = {name: places.height(name) for name in ("under", "bust", *lower) if name in REFERENCES}
    name = min(heights, key=lambda each: abs(float(target[2]) - heights[each]))
    off = round(float(target[2]) - heights[name])
    share = share_at(places, heights[name] + off, side, target)
    return f"ring {name} {share:g}" + (f"{off:+d}" if off else "")


def moved_span(
    places: BodyPlaces, seam: Seam, end: int, side: str, levels: Mapping[str, float], target: Points
) -> tuple[float, float]:
    """Return the span of a root or ring whose ``end``, 0 or 1, is dragged to ``target`` (3,) [mm].

    Clock positions [degrees] of a root, to 1 degree; shares of the half round of a ring, to 0.005. Raises
    PatternError for a seam of places.
    """
    if seam.kind == WAY:
        raise PatternError(
            Message("The seam '{seam}' is drawn through places.", seam=seam.name),
            Message("Change its places instead."),
        )
    if seam.kind == ROOT:
        value = float(round(places.breasts[side].locate(target)[0]) % 360)
    else:
        value = share_at(places, levels[seam.level], side, target)
        start, stop = seam.span  # the end that is dragged stops short of the other one
        value = min(value, stop - SHARE) if end == 0 else max(value, start + SHARE)
    return (value, seam.span[1]) if end == 0 else (seam.span[0], value)


def moved_level(places: BodyPlaces, level: Level, target: Points) -> float:
    """Return how far a level that is dragged to ``target`` (3,) is above its reference, to 1 mm [mm]."""
    return float(round(float(target[2]) - places.height(level.reference)))


def seam_handles(
    drawing: SeamDrawing, seam: Seam, side: str, levels: Mapping[str, float], drawn: Mapping[str, Points]
) -> list[tuple[int, Points]]:
    """Return the handles of a seam on a side: numbers and positions (3,) [mm].

    Those of a way are its places, the number is that of the word; a root and a ring have their ends, 0 and 1.
    ``drawn`` are the curves of the block by name with side. Raises PatternError.
    """
    if seam.kind == WAY:
        words = seam.places_of(side)
        return [(at, drawing.places.place(word, side, levels, drawn)) for at, word in enumerate(words)]
    curve = drawn[f"{seam.name} {side}".rstrip()]
    return [(0, curve[0]), (1, curve[-1])]
