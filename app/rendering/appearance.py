"""Colours and strengths of the 3D view in either theme."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Appearance:
    """Colours and strengths of the 3D view in one theme; they belong to no widget."""

    centre: str
    edge: str
    clay: str
    deep: str
    plaster: str
    ambient: float
    lights: tuple[float, ...]
    shadow: str
    shadow_alpha: float
    ghost: str
    wire: str


APPEARANCES: dict[bool, Appearance] = {
    False: Appearance(
        centre="#FBFAF9",
        edge="#E3E0DC",
        clay="#EDD8C9",
        deep="#B57E66",
        plaster="#D6D2CC",
        ambient=0.25,
        lights=(0.74, 0.32, 0.13, 0.34, 0.26),
        shadow="#3A302A",
        shadow_alpha=95.0,
        ghost="#AEBBD0",
        wire="#3F4650",
    ),
    True: Appearance(
        centre="#2E3036",
        edge="#16171A",
        clay="#E2CBBC",
        deep="#7A5244",
        plaster="#BDBAB5",
        ambient=0.16,
        lights=(0.83, 0.22, 0.14, 0.57, 0.46),
        shadow="#000000",
        shadow_alpha=190.0,
        ghost="#56657F",
        wire="#10141A",
    ),
}
"""The look by theme: ``LOOKS[dark]``."""


def rgb(colour: str) -> np.ndarray:
    """Return ``"#rrggbb"`` as three numbers 0..255, shape (3,)."""
    return np.array(list(bytes.fromhex(colour.lstrip("#"))), dtype=np.float64)


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
