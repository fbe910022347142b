"""What the body looks as if it were made of: skin is of many colours, and none of them is everybody's."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from app.rendering.appearance import APPEARANCES, Appearance

CLAY, PLASTER, GRAPHITE = MATERIALS = ("clay", "plaster", "graphite")
"""The materials; clay is the one of ``APPEARANCES``."""

_COLOURS: dict[tuple[str, bool], dict[str, Any]] = {
    (PLASTER, False): {"clay": "#EEEBE6", "deep": "#8E8A84", "plaster": "#BFBAB3"},
    (PLASTER, True): {"clay": "#DAD7D2", "deep": "#6B6863", "plaster": "#97938D"},
    (GRAPHITE, False): {"clay": "#8F949B", "deep": "#3F4349", "plaster": "#C9C7C3"},
    (GRAPHITE, True): {"clay": "#7D828A", "deep": "#2A2D32", "plaster": "#A9A7A3"},
}


def appearance_of(dark: bool, material: str) -> Appearance:
    """Return the look of one theme with one of ``MATERIALS``; raises KeyError for another word."""
    return APPEARANCES[dark] if material == CLAY else replace(APPEARANCES[dark], **_COLOURS[material, dark])
