"""What the window says of contact pressure: lights and limits, as plain values."""

from __future__ import annotations

from app.wording.words import tr
from core.sewing.comfort import AMBER, GREEN, RED, comfort


def light_word(light: str) -> str:
    """Return in a word what "green", "amber" or "red" means."""
    return {GREEN: tr("gentle"), AMBER: tr("snug"), RED: tr("tight")}[light]


def tone_of(light: str) -> str:
    """Return the tone in which a light is shown, see ``app.wording.tokens``."""
    return {GREEN: "ok", AMBER: "warn", RED: "bad"}[light]


def light_limits() -> tuple[tuple[float, str], ...]:
    """Return from which pressure [kPa] which light is shown, where it is not green."""
    limits = comfort()
    return (limits.amber_kpa, AMBER), (limits.red_kpa, RED)
