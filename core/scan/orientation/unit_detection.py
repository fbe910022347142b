"""The unit of a scan, told by the size of the body in it."""

from __future__ import annotations

from dataclasses import dataclass

from core.errors import ScanError

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
    reason: str


def estimate_unit(girth: float, told: str | None = None) -> UnitEstimate:
    """Return the unit in which a trunk girth [file units] is that of a body; ``told`` overrules it.

    Raises ScanError if no body is that big. Source: ours.
    """
    if told is not None:
        mm = girth * MILLIMETRES[told]
        if TOLD_GIRTHS[0] < mm < TOLD_GIRTHS[1]:
            reason = f"The unit was told to be {told}: with it the trunk is {mm:.0f} mm round."
            return UnitEstimate(told, True, reason)
        raise ScanError(
            f"In {told} the trunk would measure {_plain(mm)} mm round, which is not the size of a body.",
            "Check the unit, and that the scan holds an upper body.",
        )
    usual, rare = (
        [unit for unit, mm in MILLIMETRES.items() if low < girth * mm < high]
        for low, high in (GIRTHS, RARE_GIRTHS)
    )
    if not rare:
        raise ScanError(
            f"The trunk measures {_plain(girth)} round in the file, which is the size of a body in no unit.",
            "Check that the scan holds an upper body, or say in which unit it is.",
        )
    unit = (usual or rare)[0]
    mm = girth * MILLIMETRES[unit]
    reason = f"Read in {unit}, the trunk is {mm:.0f} mm round, which is the size of a body."
    for other in rare:
        if other != unit:
            reason += f" It might also be {other} ({girth * MILLIMETRES[other]:.0f} mm): please check it."
    return UnitEstimate(unit, len(rare) == 1, reason)


def _plain(length: float) -> str:
    """Return a length in words without powers of ten."""
    if 0.01 < length < 1e6:
        return f"{length:,.0f}" if length > 100.0 else f"{length:.3g}"
    return "more than a million" if length > 1.0 else "almost nothing"
