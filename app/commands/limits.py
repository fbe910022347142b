"""How short each line can be made, in words and figures, or as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import Any

from core.advice.limits import Length, Limits
from core.lines import RATIO_LIMITS
from core.pipeline import Stages
from core.report import still_lines

MEANING = {
    "strained": "edges outside 80 to 120 %",
    "overstrained": "edges outside 70 to 130 %",
    "folded": "a triangle turned by 78 degrees",
    "inverted": "a triangle shows its back",
}
"""What begins where, as it is seen on the control mesh."""


def limits_text(found: Sequence[Limits], stages: Stages, as_json: bool = False) -> str:
    """Return what is to be printed: tables for people, or the same figures as JSON."""
    if as_json:
        return json.dumps(_figures_of(found, stages), indent=1)
    tables = [line for limits in found for line in _table(limits, stages)]
    return "\n".join([*tables, *still_lines(stages)])


def _table(limits: Limits, stages: Stages) -> Iterator[str]:
    rest = limits.line.rest_length
    yield f"{limits.line.name}, at rest {rest:.1f} mm; {_present(limits, stages)}"
    if not limits.found:
        yield "  no balance is found at any length: the other lines ask for too much"
        return
    for sign, meaning in MEANING.items():
        yield f"  {sign:12}  {_beginning(limits, sign):39}  {meaning}"
    if limits.last is not None:
        yield f"  below {_inline(limits.last, rest)} no balance is found"
    if limits.stretched is not None:
        yield f"  below {_inline(limits.stretched, rest)} its elastic would go beyond its table"


def _present(limits: Limits, stages: Stages) -> str:
    if limits.line.name not in stages.design.worn():
        return "off"
    if limits.present is None:
        return "as it is set no balance is found"
    beyond = f"; already {' and '.join(limits.beyond)}" if limits.beyond else ""
    return f"set to {_inline(limits.present, limits.line.rest_length)}{beyond}"


def _beginning(limits: Limits, sign: str) -> str:
    begins = limits.begins[sign]
    if begins is None:
        least = RATIO_LIMITS[0] if limits.last is None else limits.last.ratio
        return f"not down to {100.0 * least:.1f} %"
    return "at rest: by the other lines" if begins.ratio >= 1.0 else _length(begins, limits.line.rest_length)


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
            }
            for limits in found
        },
        "notes": still_lines(stages),
        "definition": "each line, and a linked partner, made shorter from 100 % on, others as set; % of "
        "rest_mm. On the control mesh: "
        + "; ".join(f"{sign}: {meaning}" for sign, meaning in MEANING.items()),
    }


def _figures(length: Length | None, limits: Limits) -> dict[str, float] | None:
    if length is None:
        return None
    return {
        "set_percent": 100.0 * length.ratio,
        "reached_mm": length.reached,
        "reached_percent": 100.0 * length.reached / limits.line.rest_length,
    }
