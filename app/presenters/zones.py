"""Format the zones of the lower trunk: titles, and the volume that is taken up inside."""

from __future__ import annotations

from app.i18n.catalog import number, tr
from core.pipeline.live_solver import Frame
from core.pipeline.zone_volumes import ZoneVolume


def zone_title(name: str) -> str:
    """Return the title of a zone of the lower trunk."""
    return {
        "waist": tr("Waist"),
        "belly": tr("Belly"),
        "front": tr("Lower front"),
        "seat-left": tr("Left seat"),
        "seat-right": tr("Right seat"),
    }.get(name, name)


def giving_zones(frame: Frame) -> list[ZoneVolume]:
    """Return the zones of the lower trunk that do not keep all of their volume under the skin."""
    return [] if frame.lower is None else [zone for zone in frame.lower.zones if zone.kept < 1.0]


def taken_up_texts(frame: Frame) -> tuple[str, str]:
    """Return how much volume is taken up inside in the lower trunk, and what that means; or nothing."""
    parts = [f"{zone_title(zone.name)} {number(zone.taken_up_ml, 1)} ml" for zone in giving_zones(frame)]
    if not parts:
        return "", ""
    return tr("Taken up inside: {volumes}").format(volumes=" · ".join(parts)), taken_up_tip()


def taken_up_tip() -> str:
    """Return the definition of the volume taken up inside."""
    return tr(
        "Volume displaced by lines at the waist and assumed to move inward and up under the ribs, not "
        "visible on the skin. Not measured: Model options set the share that stays under the skin."
    )
