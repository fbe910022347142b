"""What a design decides of its pattern pieces: the block, own cloths, and the seam allowance."""

from __future__ import annotations

from dataclasses import dataclass

from core.document.block import LARGEST_ALLOWANCE, Block
from core.document.cloth import Cloth
from core.document.document_limits import check_counts, check_flags, check_numbers
from core.document.printable_name import repeated
from core.errors import PatternError
from core.messages import ClothName, Message, SettingName

ALLOWANCE = 7.0
"""The usual seam allowance of underwear [mm]."""

MOST_CLOTHS = 100
"""Own cloths of a design."""


@dataclass(frozen=True)
class GarmentPattern:
    """A ``block`` with all changes made to it, and ``cloths`` beside those that come with Busk.

    ``allowance`` [mm] is that of seams without their own. Where the pattern is ``bridged``, the cloth spans
    hollows of the skin instead of lying in them. Raises UserError for what cannot be.
    """

    block: Block
    cloths: tuple[Cloth, ...] = ()
    allowance: float = ALLOWANCE
    bridged: bool = True

    def __post_init__(self) -> None:
        check_counts([(len(self.cloths), MOST_CLOTHS, Message("cloths"))])
        check_flags([(self.bridged, SettingName("bridged hollows"))])
        check_numbers([(self.allowance, 0.0, LARGEST_ALLOWANCE, SettingName("seam allowance"))])
        if twice := repeated(cloth.name for cloth in self.cloths):
            raise PatternError(
                Message("Two cloths are named '{name}'.", name=ClothName(twice)),
                Message("Give each cloth a unique name."),
            )
