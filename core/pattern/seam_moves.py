"""A point of a seam moved over the body: the block with another word, span or height for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.document.block import RING, WAY, Block
from core.geometry.mesh import Points
from core.landmarks.types import SIDES
from core.pattern.place_words import moved_level, moved_span, moved_word, seam_handles
from core.pattern.seam_curves import SeamCurve, SeamDrawing

LEVEL = 2
"""The number of the handle in the middle of a ring, which moves its level."""


def handles_of(
    drawing: SeamDrawing, block: Block, curve: str, curves: Sequence[SeamCurve]
) -> list[tuple[int, Points]]:
    """Return the handles of a curve on the original body: numbers and positions (3,) [mm].

    ``curves`` are those of the block on that body. The handles of a way are its places; a root and a ring
    have their ends, a ring its level (``LEVEL``) too. Raises PatternError, KeyError for an unknown curve.
    """
    seam, side = block.seam(curve), side_of(block, curve)
    drawn = {each.name: each.points for each in curves}
    found = seam_handles(drawing, seam, side, drawing.levels(block), drawn)
    if seam.kind == RING:
        points = drawn[curve]
        found.append((LEVEL, points[len(points) // 2]))
    return found


def moved_block(drawing: SeamDrawing, block: Block, curve: str, handle: int, place: Points) -> Block:
    """Return the block with a handle of a curve at the place of the skin nearest to ``place`` (3,) [mm].

    A seam on both sides is moved on both, unless its right side has places of its own. Raises PatternError
    for a place that cannot be told, KeyError for an unknown curve.
    """
    seam, side = block.seam(curve), side_of(block, curve)
    levels = drawing.levels(block)
    if seam.kind == RING and handle == LEVEL:
        level = next(each for each in block.levels if each.name == seam.level)
        above = moved_level(drawing.places, level, place)
        moved = tuple(replace(each, above=above) if each is level else each for each in block.levels)
        return replace(block, levels=moved)
    if seam.kind != WAY:
        span = moved_span(drawing.places, seam, handle, side, levels, place)
        return block.with_seam(replace(seam, span=span))
    words = list(seam.places_of(side))
    words[handle] = moved_word(drawing.places, words[handle], side, levels, place)
    own = bool(seam.right) and side == "right"
    return block.with_seam(replace(seam, **{"right" if own else "places": tuple(words)}))  # type: ignore[arg-type]


def side_of(block: Block, curve: str) -> str:
    """Return the side of a curve by its name, nothing for one over the middle."""
    seam = block.seam(curve)
    return next((side for side in SIDES if seam.each and curve == f"{seam.name} {side}"), "")
