"""How far each line can go, in words and figures, or as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from app.presenters.assessment import assessment_lines
from core.analysis.length_limits.limits import Length, Limits
from core.analysis.length_limits.zones import GREEN, Leeway, leeway
from core.garment.assessment import Assessment
from core.garment.pressure_limits import comfort
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.pipeline.build import Stages
from core.pipeline.warnings import still_lines

MEANING = {
    "strained": "edges outside 80 to 120 %",
    "overstrained": "edges outside 70 to 130 %",
    "folded": "a triangle rotated by 78 degrees",
    "inverted": "a triangle is inverted",
}
"""What begins where, as it is seen on the control mesh."""

OTHERS = {
    "vibrating": "iterations with conventional volume control",
    "restless": "iterations with any volume control: explicit line forces",
    "pressing": "contact pressure above {kpa:g} kPa along the band",
    "slack": "the line would carry compression, which is impossible for a band",
}
"""What else there is at some lengths, in words."""


def limits_text(
    found: Sequence[Limits], stages: Stages, assessment: Assessment, as_json: bool = False
) -> str:
    """Return what is to be printed, the verdict on the design as it is set first: tables, or JSON."""
    if as_json:
        data = {"assessment": assessment.as_data(), **_figures_of(found, stages)}
        return json.dumps(data, indent=1)
    tables = [line for limits in found for line in _table(limits, stages)]
    return "\n".join([*assessment_lines(assessment, stages.design), "", *tables, *still_lines(stages)])


def _table(limits: Limits, stages: Stages) -> Iterator[str]:
    rest = limits.line.rest_length
    yield f"{limits.line.name}, original length {rest:.1f} mm; {_present(limits, stages)}"
    if not limits.found:
        yield "  no equilibrium at any length: the other lines are too short"
        return
    for sign, meaning in MEANING.items():
        yield f"  {sign:12}  {_beginning(limits, sign):39}  {meaning}"
    for sign, meaning in OTHERS.items():
        if sign == "restless" and sign not in limits.shows:
            continue  # lines act in step
        yield f"  {sign:12}  {_stretches(limits, sign):39}  {meaning.format(kpa=comfort().red_kpa)}"
    yield f"  green         {_green(leeway(limits))}"
    if limits.last is not None:
        yield f"  below {_inline(limits.last, rest)} no equilibrium found"
    if limits.stretched is not None:
        yield f"  below {_inline(limits.stretched, rest)} the elongation of its elastic exceeds its table"


def _present(limits: Limits, stages: Stages) -> str:
    if limits.line.name not in stages.design.worn():
        return "off"
    if limits.present is None:
        return "no equilibrium found at the set length"
    beyond = f"; already {' and '.join(limits.beyond)}" if limits.beyond else ""
    return f"set to {_inline(limits.present, limits.line.rest_length)}{beyond}"


def _beginning(limits: Limits, sign: str) -> str:
    begins = limits.begins[sign]
    if begins is None:
        least = RATIO_LIMITS[0] if limits.last is None else limits.last.ratio
        return f"not reached down to {100.0 * least:.1f} %"
    return (
        "at the original length: caused by other lines"
        if begins.ratio >= 1.0
        else _length(begins, limits.line.rest_length)
    )


def _stretches(limits: Limits, sign: str) -> str:
    """Return the lengths that show a sign."""
    if sign == "pressing" and not limits.pressure_known:
        return "unknown: no elastic selected"
    assert limits.looked is not None
    first, last = limits.looked.short, limits.looked.long
    said = []
    for span in limits.shows[sign]:
        short, long = f"{100.0 * span.short.ratio:.1f}", f"{100.0 * span.long.ratio:.1f}"
        if span.short == first:
            said.append("at any length" if span.long == last else f"below {long} %")
        else:
            said.append(f"above {short} %" if span.long == last else f"from {short} to {long} %")
    return ", ".join(said) or "nowhere"


def _green(found: Leeway | None) -> str:
    """Return the lengths at which all is well."""
    zones = [zone for zone in found.zones if zone.tone == GREEN] if found is not None else []
    return ", ".join(f"{100.0 * z.short:.1f} to {100.0 * z.long:.1f} %" for z in zones) or "at no length"


def _length(length: Length, rest: float) -> str:
    reached = length.reached
    return f"{100.0 * length.ratio:5.1f} %, reached {reached:6.1f} mm = {100.0 * reached / rest:5.1f} %"


def _inline(length: Length, rest: float) -> str:
    return " ".join(_length(length, rest).split())


def _figures_of(found: Sequence[Limits], stages: Stages) -> dict[str, Any]:
    return {
        "lines": {
            limits.line.name: {
                "worn": limits.line.name in stages.design.worn(),
                "rest_mm": limits.line.rest_length,
                "present": _figures(limits.present, limits),
                "beyond": list(limits.beyond),
                "begins": {sign: _figures(limits.begins[sign], limits) for sign in MEANING},
                "found": limits.found,
                "no_balance_below": _figures(limits.last, limits),
                "elastic_ends": _figures(limits.stretched, limits),
                "pressure_known": limits.pressure_known,
                "zones": _zones(leeway(limits)),
            }
            for limits in found
        },
        "notes": still_lines(stages),
        "definition": (
            "each line and its linked partner, shorter and longer than 100 %, other lines as set; % "
            "of rest_mm. On the control mesh: "
        )
        + "; ".join(f"{sign}: {meaning}" for sign, meaning in MEANING.items())
        + ". Further limits: "
        + "; ".join(f"{sign}: {meaning.format(kpa=comfort().red_kpa)}" for sign, meaning in OTHERS.items())
        + ". Limits caused by other lines also apply at 100 %",
    }


def _zones(found: Leeway | None) -> list[dict[str, Any]] | None:
    if found is None:
        return None
    return [
        {
            "tone": zone.tone,
            "from_percent": 100.0 * zone.short,
            "to_percent": 100.0 * zone.long,
            "reasons": [
                {
                    "why": reason.why,
                    "from_percent": 100.0 * reason.short,
                    "to_percent": 100.0 * reason.long,
                    "of_others": reason.others,
                }
                for reason in zone.reasons
            ],
        }
        for zone in found.zones
    ]


def _figures(length: Length | None, limits: Limits) -> dict[str, float] | None:
    if length is None:
        return None
    return {
        "set_percent": 100.0 * length.ratio,
        "reached_mm": length.reached,
        "reached_percent": 100.0 * length.reached / limits.line.rest_length,
    }
