"""Cups of a design: what they cover, the shape that they give or the cut of their cloth, and their wire."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from core.document.document_limits import check_flags, check_numbers, check_words
from core.messages import SettingName

KINDS = ("moulded", "sewn")
COVERAGES = ("half", "three-quarter", "full")

CUP_RANGES: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "lift": (-10.0, 50.0),
        "forward": (-20.0, 30.0),
        "gather": (-20.0, 30.0),
        "across": (0.7, 1.1),
        "upright": (0.7, 1.1),
        "cloth": (10.0, 5000.0),
        "wire_width": (0.7, 1.3),
    }
)
"""The least and the largest number that each setting of a cup allows."""


@dataclass(frozen=True)
class Cup:
    """Both cups of a garment.

    A "moulded" cup keeps its shape: that of the breast with the apex raised by ``lift``, moved ``forward``
    and inward by ``gather`` [mm]. A "sewn" cup is of cloth as long ``across`` and ``upright`` as the skin
    under it times these ratios [1], of stiffness ``cloth`` [N/m] both ways. ``coverage`` tells how far up
    it goes. With a ``wire`` the root of the breast keeps its form, ``wire_width`` [1] times as wide as it is.
    Raises UserError for what no cup can be.
    """

    kind: str = "moulded"
    coverage: str = "three-quarter"
    lift: float = 0.0
    forward: float = 0.0
    gather: float = 0.0
    across: float = 1.0
    upright: float = 1.0
    cloth: float = 300.0
    wire: bool = False
    wire_width: float = 1.0

    def __post_init__(self) -> None:
        check_words(
            ((self.kind, KINDS, SettingName("cup")), (self.coverage, COVERAGES, SettingName("cup coverage")))
        )
        check_flags([(self.wire, SettingName("underwire"))])
        check_numbers(
            (getattr(self, key), *limits, SettingName(f"cup {key.replace('_', ' ')}"))
            for key, limits in CUP_RANGES.items()
        )
