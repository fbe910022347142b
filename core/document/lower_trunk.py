"""What a design decides of the lower trunk: waist, belly, hips and seat."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from core.document.document_limits import check_numbers
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

WAIST_STIFFNESS = 130.0
"""What the tissue at the waist resists a stretch with [N/m].

With it a waistband 25 mm wide and 5 % shorter presses with about 2.3 kPa, as was measured on persons; ours.
"""


@dataclass(frozen=True)
class LowerTrunk:
    """The region below the bust.

    ``belly_height`` [1] is where the belly row runs from waist (0) to hip (1). ``firmness`` [1] ties skin to
    bone, the more the thinner the tissue: 0 not at all. ``waist_kept`` [1] is how much of the volume that
    lines displace at the waist stays under the skin there; the rest goes inward. ``stiffness`` [N/m] of the
    tissue tells what forces are in newtons. Raises UserError for what cannot be.
    """

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
