"""Format the length limits of a line: zones, their lengths and reasons."""

from __future__ import annotations

from app.i18n.catalog import number, tr
from core.analysis.length_limits.zones import AMBER, GREEN, RED, SLACK, LengthLimits, Reason, Zone
from core.garment.pressure import pressure_limits
from core.mechanics.constraint_lines import RATIO_LIMITS

KEY_ORDER = GREEN, AMBER, RED, SLACK
"""In which order the kinds of zones are explained."""

_TONES = {AMBER: "warn", RED: "bad"}
_SHORT = 28  # letters that have room in one line


def tone_at(leeway: LengthLimits | None, ratio: float) -> str:
    """Return how a set length [1] stands: "bad" in the red, "warn" in the amber, else nothing."""
    return _TONES.get(leeway.at(ratio).tone, "") if leeway is not None else ""


def legend_entries(leeway: LengthLimits) -> dict[str, str]:
    """Return what zones of each tone mean and from where to where they go, of those that the line has.

    Of all that is red it is what comes first, and where it folds if that is known.
    """
    told = {tone: _in_key(leeway, tone) for tone in KEY_ORDER}
    return {tone: _glued(_upper(_in_a_row(words))) for tone, words in told.items() if words}


def _in_a_row(words: list[str]) -> str:
    """Return words with dots between; short ones stay in one piece, so that no line begins with a number."""
    whole = [each.replace(" ", "\N{NO-BREAK SPACE}") if len(each) <= _SHORT else each for each in words]
    return " \N{MIDDLE DOT} ".join(whole if len(words) > 1 else words)


def _in_key(leeway: LengthLimits, tone: str) -> list[str]:
    zones = [zone for zone in leeway.zones if zone.tone == tone]
    if tone == GREEN:
        valid = (
            tr("valid shape") if leeway.pressure_known else tr("valid shape (contact pressure not checked)")
        )
        return [_range(valid, zone.short, zone.long) for zone in zones]
    reasons = sorted({reason for zone in zones for reason in _told(zone)}, key=lambda each: -each.long)
    if tone == RED:  # what is worse lies below
        red = [reason for zone in zones for reason in _told(zone)]
        folds = [reason for reason in red[1:] if reason.why in ("folded", "inverted")]
        return [short_reason(reason) for reason in (*red[:1], *folds[:1])]
    return [short_reason(reason) for reason in reasons]


def hint(leeway: LengthLimits, ratio: float) -> str:
    """Return the tooltip of a length [1]: its zone, and the reasons of the zone.

    Where a reason holds for just the lengths of the zone, these are told once.
    """
    zone = leeway.at(ratio)
    near = _beside(leeway, zone) if zone.tone == GREEN else (zone,)
    reasons = dict.fromkeys(reason for each in near for reason in _told(each))
    alike = any((each.short, each.long) == (zone.short, zone.long) for each in reasons)
    lines = [] if alike or zone.tone == SLACK else [_range(_name(zone), zone.short, zone.long)]
    explained = tr("{reason}: {meaning}.")
    lines += [explained.format(reason=_upper(short_reason(each)), meaning=meaning(each)) for each in reasons]
    if zone.tone == GREEN and not leeway.pressure_known:
        lines.append(tr("Contact pressure is not checked: no elastic is chosen."))
    return "\n".join(_glued(line) for line in lines)


def length_tip(short: float, long: float) -> str:
    """Return what a slider from ``short`` to ``long`` [1] means, and its keys."""
    text = tr("Set the front length, {short} to {long} % of the original.\n← → 0.1 %, Shift 1 %, Alt 0.01 %")
    return text.format(short=number(100.0 * short, 0), long=number(100.0 * long, 0))


def resistance_reason(leeway: LengthLimits | None) -> str:
    """Return why a hand meets resistance, empty if there is nothing red below."""
    reasons = _told(leeway.zones[0]) if leeway is not None and leeway.zones[0].tone == RED else ()
    return tr("Cannot be shorter: {reason}.").format(reason=short_reason(reasons[0])) if reasons else ""


def short_reason(reason: Reason) -> str:
    """Return a reason in a few words, and the lengths that it holds for."""
    words = {
        "strained": tr("strained"),
        "vibrating": tr("may oscillate"),
        "restless": tr("no convergence"),
        "pressing": tr("contact pressure too high"),
        "slack": tr("slack"),
        "overstrained": tr("overstrained"),
        "folded": tr("folded"),
        "inverted": tr("inverted"),
        "stretched": tr("outside the elastic's curve"),
        "unreachable": tr("no equilibrium"),
    }[reason.why]
    if reason.is_independent:
        return tr("{what} due to other lines, at any length").format(what=words)
    where = _range(words, reason.short, reason.long)
    return tr("{where} (due to other lines)").format(where=where) if _of_others(reason) else where


def meaning(reason: Reason) -> str:
    """Return what a reason means, with the number at which it begins."""
    return {
        "strained": tr("skin is compressed or stretched by over 20 % in places"),
        "vibrating": tr("iterations with conventional volume control do not converge"),
        "restless": tr("with explicit line forces the lines are too stiff; choose Implicit or softer lines"),
        "pressing": tr("contact pressure of the band exceeds {kpa} kPa in places").format(
            kpa=number(pressure_limits().red_kpa, 0)
        ),
        "slack": tr("tension would be negative, which is not possible for a band"),
        "overstrained": tr("skin is compressed or stretched by over 30 % in places"),
        "folded": tr("a triangle of the control mesh is rotated on its side"),
        "inverted": tr("a triangle of the control mesh is inverted"),
        "stretched": tr("the elongation is outside the measured curve of the elastic"),
        "unreachable": tr("no equilibrium is found at these lengths"),
    }[reason.why]


def _told(zone: Zone) -> tuple[Reason, ...]:
    """Return the reasons that make a zone what it is."""
    return tuple(reason for reason in zone.reasons if reason.tone == zone.tone)


def _beside(leeway: LengthLimits, zone: Zone) -> tuple[Zone, ...]:
    """Return the zones beside one, the shorter first."""
    at = leeway.zones.index(zone)
    return (*leeway.zones[max(at - 1, 0) : at], *leeway.zones[at + 1 : at + 2])


def _of_others(reason: Reason) -> bool:
    return reason.others and reason.tone != SLACK


def _name(zone: Zone) -> str:
    return {GREEN: tr("Green"), AMBER: tr("Amber"), RED: tr("Red")}[zone.tone]


def _range(what: str, short: float, long: float) -> str:
    low, high = RATIO_LIMITS
    figures = {"short": number(100.0 * short), "long": number(100.0 * long)}
    if short <= low and long >= high:
        return tr("{what} at any length").format(what=what)
    if short <= low:
        return tr("{what} below {long} %").format(what=what, **figures)
    if long >= high:
        return tr("{what} above {short} %").format(what=what, **figures)
    return tr("{what} from {short} to {long} %").format(what=what, **figures)


def _glued(words: str) -> str:
    return words.replace(" %", "\N{NO-BREAK SPACE}%")


def _upper(words: str) -> str:
    return words[:1].upper() + words[1:]
