"""What is known of the pieces and seams of a pattern as plain values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from core.document.block import without_side
from core.messages import Message
from core.pattern.garment import Pattern
from core.pattern.piece import NO_ELASTICS, EdgeElastic, Piece, SideKey


def pattern_values(
    pattern: Pattern, pieces: Sequence[Piece], elastics: Mapping[SideKey, EdgeElastic] = NO_ELASTICS
) -> dict[str, Any]:
    """Return block, ``pieces``, seams and elastics of edges, and whether all fit their cloths, for JSON."""
    return {
        "block": pattern.garment.block.name,
        "pieces": piece_values(pattern, pieces),
        "seams": seam_values(pattern),
        "elastics": elastic_values(pattern, elastics),
        "fits": pattern.fits_cloths,
    }


def piece_values(pattern: Pattern, pieces: Sequence[Piece]) -> list[dict[str, Any]]:
    """Return what is known of each panel; ``cut_as`` is the piece that is cut for it."""
    known, values = {piece.key: piece for piece in pieces}, []
    for flat in pattern.flats:
        name, cloth = flat.panel.name, pattern.cloths[flat.panel.cloth]
        plain, side = without_side(name)
        piece = known.get(name) or known[plain]
        values.append(
            {
                "name": plain,
                "side": side,
                "cloth": cloth.name,
                "cut_as": piece.key,
                "area_mm2": piece.area,
                "strain_p95_percent": 100.0 * pattern.strains[name].within,
                "stretch_worn_percent": [100.0 * each for each in pattern.worn_stretch(flat)],
                "limit_percent": 100.0 * cloth.limit,
                "fits": pattern.fits(flat),
                "reason": _said(pattern.problem(flat)),
                "note": _said(pattern.note(flat)),
            }
        )
    return values


def seam_values(pattern: Pattern) -> list[dict[str, Any]]:
    """Return what is known of each seam."""
    panels = pattern.garment.panels
    return [
        {
            "name": fit.seam.name,
            "pieces": [panels[number].name for number in fit.seam.panels],
            "on_body_mm": pattern.seam_length(fit),
            "lengths_mm": list(fit.together),
            "ratio": fit.seam.ratio,
            "alone_mm": list(fit.alone),
            "misfit_alone_percent": 100.0 * fit.misfit,
            "note": _said(pattern.seam_problem(fit.seam) or pattern.seam_note(fit)),
        }
        for fit in pattern.matched.fits
    ]


def elastic_values(pattern: Pattern, elastics: Mapping[SideKey, EdgeElastic]) -> list[dict[str, Any]]:
    """Return what is known of each edge that carries the elastic of a worn line."""
    flats = {flat.panel.name: flat for flat in pattern.flats}
    return [
        {
            "piece": piece,
            "edge": flats[piece].panel.sides[number].name,
            "edge_mm": flats[piece].side_length(number),
            "line": each.line,
            "elastic": each.elastic,
            "width_mm": each.width_mm,
            "cut_mm": each.cut_mm,
            "part_mm": each.part_mm,
            "quarter_mm": each.quarter_mm,
            "marks_at_mm": [share * flats[piece].side_length(number) for share in each.marks],
        }
        for (piece, number), each in elastics.items()
    ]


def _said(message: Message | None) -> str:
    return "" if message is None else str(message)
