"""What a design decides of the lower trunk: waist, belly, hips and seat."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType

from core.control_mesh.lower_template import read_lower_template
from core.document.document_limits import check_numbers
from core.document.lines import ActiveLine, LineSettings
from core.messages import SettingName

LOWER_RANGES: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "belly_height": (0.35, 0.55),
        "firmness": (0.0, 1.0),
        "waist_kept": (0.0, 1.0),
        "stiffness": (10.0, 5000.0),
    }
)
"""The least and the largest number that each setting of the lower trunk allows."""

LOWER_SETTINGS: Mapping[str, str] = MappingProxyType(
    {
        "belly_line_height": "belly_height",
        "lower_firmness": "firmness",
        "waist_kept": "waist_kept",
        "lower_stiffness": "stiffness",
    }
)
"""Names of these settings among those of a whole design, each with its field of ``LowerTrunk``."""

WAIST_STIFFNESS = 130.0
"""What the tissue at the waist resists a stretch with [N/m].

With it a waistband 25 mm wide and 5 % shorter presses with about 2.3 kPa, as was measured on persons; ours.
"""


@dataclass(frozen=True)
class LowerTrunk:
    """The region below the bust, with the ``lines`` that are worn there and the ``traits`` of any.

    ``belly_height`` [1] is where the belly row runs from waist (0) to hip (1). ``firmness`` [1] ties skin to
    bone, the more the thinner the tissue: 0 not at all. ``waist_kept`` [1] is how much of the volume that
    lines displace at the waist stays under the skin there; the rest goes inward. ``stiffness`` [N/m] of the
    tissue tells what forces are in newtons. Raises UserError for a number that cannot be.
    """

    lines: tuple[ActiveLine, ...] = ()
    traits: tuple[LineSettings, ...] = ()
    belly_height: float = 0.45
    firmness: float = 0.1
    waist_kept: float = 0.5
    stiffness: float = WAIST_STIFFNESS

    def __post_init__(self) -> None:
        names = {
            "belly_height": SettingName("belly row height"),
            "firmness": SettingName("firmness of the lower trunk"),
            "waist_kept": SettingName("volume kept at the waist"),
            "stiffness": SettingName("tissue stiffness of the lower trunk"),
        }
        check_numbers((getattr(self, key), *limits, names[key]) for key, limits in LOWER_RANGES.items())


@cache
def lower_line_names() -> frozenset[str]:
    """Return the names of all lines of the lower trunk: no line of the bust has one of them."""
    return frozenset(read_lower_template().paths)


GROUPS = ("waist", "seat", "legs")
"""Where a garment has lines of the lower trunk, from above."""


def line_group(name: str) -> str:
    """Return which of GROUPS a line belongs to, "bust" for one above."""
    if name not in lower_line_names():
        return "bust"
    kind = name.removesuffix("-left").removesuffix("-right")
    if kind in ("leg-opening", "high-leg"):
        return "legs"
    on_seat = ("high-hip", "hip", "under-hip", "sling", "high-sling", "buttock-lift")
    return "seat" if kind in on_seat else "waist"


def lower_lines_of(name: str) -> tuple[str, ...]:
    """Return the lines of the lower trunk that a name stands for: one, both sides, or none."""
    known = lower_line_names()
    return tuple(each for each in (name, f"{name}-left", f"{name}-right") if each in known)
