"""What is known of the pieces and seams of a pattern as plain values."""

from __future__ import annotations

from typing import Any

from core.landmarks.types import SIDES
from core.pattern.garment import Pattern


def pattern_values(pattern: Pattern) -> dict[str, Any]:
    """Return block, pieces and seams of a pattern, and whether all fit their cloths, ready for JSON."""
    return {
        "block": pattern.garment.block.name,
        "pieces": piece_values(pattern),
        "seams": seam_values(pattern),
        "fits": pattern.fits_cloths,
    }


def piece_values(pattern: Pattern) -> list[dict[str, Any]]:
    """Return what is known of each panel."""
    values = []
    for flat in pattern.flats:
        name, cloth = flat.panel.name, pattern.cloths[flat.panel.cloth]
        side = next((each for each in SIDES if name.endswith(f" {each}")), "")
        values.append(
            {
                "name": name.removesuffix(f" {side}"),
                "side": side,
                "cloth": cloth.name,
                "area_mm2": float(flat.areas.sum()),
                "strain_p95_percent": 100.0 * pattern.strains[name].within,
                "limit_percent": 100.0 * cloth.limit,
                "fits": pattern.fits(flat),
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
            "misfit_alone_percent": 100.0 * fit.misfit,
        }
        for fit in pattern.matched.fits
    ]
