"""The groove of a line's slider: how short the line may become, seen before it is tried."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QPainter, QPen

from app.wording.tokens import Tokens
from app.wording.words import number, tr

GROOVE_Y, GROOVE_HEIGHT = 11.0, 6.0
"""Middle of the groove below the slider's top, and its height [px]."""

SHORTEST, LONGEST = 0.80, 1.12
"""Range of a line's length, as a share of its length at rest [1], that a hand can pull it through."""

RESISTANCE = 24.0
"""How much further a hand must pull to get a line into the red [px]."""

_BESIDE = 0.02  # room beside a typed length that widens the groove [1]
_AT_REST = 0.9995  # amber that begins there is not this line's doing [1]
_GAP = 1.5  # between two zones [px]
_QUIET, _STALE = 0.42, 0.2  # strength of the zones of a line that is not in hand, and of those not up to date


@dataclass(frozen=True)
class Feasible:
    """How short a line can be set, as shares of its rest length [1]; None for what does not begin at all.

    Below ``strained`` the skin strains more than it likes, below ``impossible`` there is no body to show, and
    ``why`` says it: "overstrained", "folded", "inverted", "unreachable" where no balance is found, or
    "stretched" where the table of the line's elastic ends.
    ``stale`` while new limits are worked out.
    """

    strained: float | None = None
    impossible: float | None = None
    why: str = "folded"
    stale: bool = False

    @property
    def amber(self) -> float | None:
        """Where the amber begins, if some of it lies above the red."""
        if self.strained is None or (self.impossible is not None and self.strained <= self.impossible):
            return None
        return self.strained

    def sentence(self) -> str:
        """Return the limits in words."""
        parts = []
        if self.amber is not None and self.amber >= _AT_REST:
            parts.append(tr("Strained by the other lines already"))
        elif self.amber is not None:
            parts.append(tr("Strained below {percent} %").format(percent=number(100.0 * self.amber)))
        if self.impossible is not None:
            parts.append(self.reason())
        words = " · ".join(part.replace(" %", "\N{NO-BREAK SPACE}%") for part in parts) or tr(
            "No limit down to half its length."
        )
        return words[:1].upper() + words[1:]

    def tone(self, ratio: float) -> str:
        """Return how a set length [1] stands: "bad" in the red, "warn" in the amber, else nothing."""
        if self.impossible is not None and ratio < self.impossible:
            return "bad"
        return "warn" if self.amber is not None and ratio < self.amber else ""

    def reason(self) -> str:
        """Return what is wrong in the red."""
        words = {
            "overstrained": tr("overstrained below {percent} %"),
            "inverted": tr("inside out below {percent} %"),
            "unreachable": tr("cannot be reached below {percent} %"),
            "stretched": tr("the table of its elastic ends at {percent} %"),
        }
        percent = number(100.0 * (self.impossible or 0.0))
        return words.get(self.why, tr("folds below {percent} %")).format(percent=percent)


def ends_for(ratio: float) -> tuple[float, float]:
    """Return the range of a groove: the usual one, widened for a typed length that lies outside it [1]."""
    short, long = math.floor(20.0 * (ratio - _BESIDE)) / 20.0, math.ceil(20.0 * (ratio + _BESIDE)) / 20.0
    return (
        SHORTEST if ratio >= SHORTEST else max(short, 0.0),
        LONGEST if ratio <= LONGEST else long,
    )


def wall_of(feasible: Feasible | None, ratio: float) -> float | None:
    """Return the ratio at which a pull that begins at ``ratio`` meets the red, if it does [1]."""
    red = feasible.impossible if feasible is not None else None
    return red if red is not None and ends_for(ratio)[0] < red <= ratio else None


def resisted(ratio: float, wall: float | None, more: float) -> float:
    """Return what a hand gets that pulls to ``ratio``: past the wall it must pull ``more`` [1]."""
    return ratio if wall is None or ratio >= wall else min(ratio + more, wall)


def paint_groove(
    painter: QPainter,
    tokens: Tokens,
    x_of: Callable[[float], float],
    ends: tuple[float, float],
    feasible: Feasible | None,
    strong: bool,
) -> None:
    """Paint the groove between ``ends`` (ratios [1]); ``strong`` for a line that is in hand.

    Longer than at rest nothing was worked out, so the groove stays plain there.
    """
    painter.setPen(Qt.PenStyle.NoPen)
    short, long = x_of(ends[0]), x_of(ends[1])
    top = GROOVE_Y - GROOVE_HEIGHT / 2
    painter.setBrush(QColor(tokens.groove))
    painter.drawRoundedRect(QRectF(short, top, long - short, GROOVE_HEIGHT), 3, 3)
    if feasible is not None:
        opacity = painter.opacity()
        for start, end, colour, hatched in _zones(feasible, tokens, ends[0]):
            left = x_of(start) + (_GAP / 2 if start > ends[0] else 0.0)
            zone = QRectF(left, top, x_of(end) - _GAP / 2 - left, GROOVE_HEIGHT)
            painter.setBrush(QColor(tokens.panel))
            painter.drawRoundedRect(zone.adjusted(-_GAP, 0, _GAP, 0), 1, 1)
            painter.setOpacity(_STALE if feasible.stale else 1.0 if strong else _QUIET)
            painter.setBrush(QColor(colour))
            painter.drawRoundedRect(zone, 2, 2)
            painter.setOpacity(opacity)
            if hatched:
                _hatch(painter, zone, QColor(tokens.panel))
    _tick(painter, x_of(1.0), QColor(tokens.control))


def _zones(feasible: Feasible, tokens: Tokens, least: float) -> list[tuple[float, float, str, bool]]:
    """Return start, end, colour and hatching of the zones from the least ratio to that at rest."""
    red = min(max(feasible.impossible or least, least), 1.0)
    amber = min(max(feasible.amber or red, red), 1.0)
    zones = [
        (least, red, tokens.zone_bad, True),
        (red, amber, tokens.zone_warn, False),
        (amber, 1.0, tokens.zone_ok, False),
    ]
    return [zone for zone in zones if zone[1] > zone[0]]


def _hatch(painter: QPainter, zone: QRectF, colour: QColor) -> None:
    painter.save()
    painter.setClipRect(zone)
    painter.setPen(QPen(QBrush(colour), 1.2))
    x = zone.left() - zone.height()
    while x < zone.right():
        painter.drawLine(int(x), int(zone.bottom() + 1), int(x + zone.height() + 1), int(zone.top()))
        x += 4.0
    painter.restore()


def _tick(painter: QPainter, x: float, colour: QColor) -> None:
    """Mark the length at rest."""
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawRect(QRectF(x - 0.5, GROOVE_Y - GROOVE_HEIGHT / 2 - 3, 1, GROOVE_HEIGHT + 6))
