"""Points of a seam moved over the body: the block with other words, spans and heights for them."""

from __future__ import annotations

from core.document.block import Block
from core.geometry.mesh import Points
from core.pattern.seam_curves import SeamDrawing


def seam_handles(drawing: SeamDrawing, block: Block, curve: str) -> list[tuple[int, Points]]:
    seam = block.seam(curve)
    side = curve.removeprefix(seam.name).strip()
    levels = drawing.levels(block)
    drawn = {each.name: each.points for each in drawing.curves(block)}
    return [(k, drawing.places.place(w, side, levels, drawn)) for k, w in enumerate(seam.places_of(side))]


def moved_block(drawing: SeamDrawing, block: Block, curve: str, number: int, place: Points) -> Block:
    return block
