"""Record of a calibration in a design: its scan, its changes and its residual."""

from __future__ import annotations

import math
from dataclasses import dataclass

from core.document.printable_name import is_printable
from core.errors import UserError
from core.messages import Message

LONGEST_NAME = 200
"""Letters of the name of the worn scan's file, and of that of a number."""

MOST_NUMBERS = 20
"""Numbers that a calibration may hold."""

WELL = 0.05
"""A number whose ± is no more than this part of it is told well [1]."""


@dataclass(frozen=True)
class FittedParameter:
    """One number that was found: ``name`` as ``parameters`` says it, ``after`` with its ±.

    Both in the unit of the setting. ``kept`` tells that the scans could not tell it, so it stayed.
    """

    name: str
    before: float
    after: float
    plus_minus: float
    kept: bool = False

    @property
    def is_well_determined(self) -> bool:
        """Return whether the scans tell it well: its ± is ``WELL`` of it or less."""
        return not self.kept and self.plus_minus <= WELL * abs(self.after)


@dataclass(frozen=True)
class Calibration:
    """The numbers of a design after the scan of ``worn``, a file's name; what it was, not the scan itself.

    ``rms_before`` and ``rms_after`` [mm] are of predicted less real on the moving skin, ``thickness`` [mm] is
    that of the cloth. Raises UserError for what no calibration can be.
    """

    worn: str
    rms_before: float
    rms_after: float
    numbers: tuple[FittedParameter, ...] = ()
    thickness: float = 0.0

    def __post_init__(self) -> None:
        names = (self.worn, *(number.name for number in self.numbers))
        figures = [self.rms_before, self.rms_after, self.thickness]
        for number in self.numbers:
            figures += [number.before, number.after, number.plus_minus]
        words = all(name.strip() and is_printable(name, LONGEST_NAME) for name in names)
        if not words or len(names) > MOST_NUMBERS + 1 or not all(map(math.isfinite, figures)):
            raise UserError(
                Message("The calibration data cannot be read."), Message("Run the calibration again.")
            )
