"""The unit of a scan, told by the size of the body in it."""

from __future__ import annotations

from dataclasses import dataclass

from core.errors import ScanError
from core.messages import Length, Message, join

MILLIMETRES = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "inch": 25.4}

GIRTHS = (595.0, 1511.0)
"""Trunk girths of bodies [mm]. No two units put the same file inside."""

RARE_GIRTHS = (560.0, 1700.0)
"""Trunk girths of very slim and very stout bodies [mm]: believed, but not of two units."""

TOLD_GIRTHS = (300.0, 2500.0)
"""Trunk girths [mm] that are believed if the unit is told."""


@dataclass(frozen=True)
class UnitEstimate:
    """The unit of a scan, whether it is sure, and the reason in words."""

    unit: str
    is_certain: bool
    reason: Message


def estimate_unit(girth: float, told: str | None = None) -> UnitEstimate:
    """Return the unit in which a trunk girth [file units] is that of a body; ``told`` overrules it.

    Raises ScanError if no body is that big. Source: ours.
    """
    if told is not None:
        return _checked_unit(girth, told)
    usual, rare = (
        [unit for unit, mm in MILLIMETRES.items() if low < girth * mm < high]
        for low, high in (GIRTHS, RARE_GIRTHS)
    )
    if not rare:
        raise ScanError(
            Message(
                "The trunk girth in the file is {girth}, which is implausible for a body in any unit.",
                girth=_plain(girth),
            ),
            Message("Check that the scan contains an upper body, or set the unit of the scan."),
        )
    unit = (usual or rare)[0]
    mm = girth * MILLIMETRES[unit]
    reason = Message("In {unit}, the trunk girth is {mm}, a plausible body size.", unit=unit, mm=Length(mm))
    for other in rare:
        if other != unit:
            also = Message(
                "The unit may also be {unit} ({mm}). Please check.",
                unit=other,
                mm=Length(girth * MILLIMETRES[other]),
            )
            reason = join((reason, also))
    return UnitEstimate(unit, len(rare) == 1, reason)


def _checked_unit(girth: float, unit: str) -> UnitEstimate:
    """Return a unit that was set, if the trunk girth is that of a body in it."""
    mm = girth * MILLIMETRES[unit]
    if TOLD_GIRTHS[0] < mm < TOLD_GIRTHS[1]:
        reason = Message("The unit was set to {unit}: the trunk girth is {mm}.", unit=unit, mm=Length(mm))
        return UnitEstimate(unit, True, reason)
    raise ScanError(
        Message(
            "In {unit}, the trunk girth would be {mm}, which is implausible for a body.",
            unit=unit,
            mm=_plain_length(mm),
        ),
        Message("Check the unit, and that the scan contains an upper body."),
    )


def _plain(number: float) -> str | Message:
    """Return a number in words without powers of ten."""
    if 0.01 < number < 1e6:
        return f"{number:,.0f}" if number > 100.0 else f"{number:.3g}"
    return Message("more than a million") if number > 1.0 else Message("almost zero")


def _plain_length(mm: float) -> Length | Message:
    """Return a length [mm] without powers of ten."""
    return Length(mm) if 1.0 <= mm < 1e6 else Message("{number} mm", number=_plain(mm))
