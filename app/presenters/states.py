"""States of a run and levels of the overall verdict: their words, tones and icons."""

from __future__ import annotations

from app.i18n.catalog import tr

TONES = {
    "settled": ("ok", "check-circle"),
    "strained": ("warn", "overstrained"),
    "settling": ("info", "arc"),
    "vibrating": ("warn", "wave"),
    "diverging": ("bad", "arrow-up-right"),
    "folded": ("bad", "folded"),
    "overstrained": ("bad", "overstrained"),
    "stale": ("plain", "clock-counter-clockwise"),
    "paused": ("plain", "pause"),
    "good": ("ok", "check-circle"),
    "pending": ("info", "arc"),
    "caution": ("warn", "warning"),
    "bad": ("bad", "warning-octagon"),
    "idle": ("plain", "lines"),
}
"""Tone and drawing of each state of a run, and of each level of an overall verdict."""


TROUBLED = ("caution", "bad", "strained", "overstrained", "folded", "vibrating", "diverging")
"""States that there is more to say of: a click asks for it."""


def state_title(state: str) -> str:
    """Return the word for a state of a run in ``TONES``."""
    return {
        "settled": tr("Settled"),
        "strained": tr("Settled, strained"),
        "settling": tr("Settling"),
        "vibrating": tr("Vibrating"),
        "diverging": tr("Diverging"),
        "folded": tr("Folded"),
        "overstrained": tr("Overstrained"),
        "stale": tr("Stale"),
        "paused": tr("Paused"),
    }[state]
