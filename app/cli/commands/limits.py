"""Compute the length limits of each line: where it strains, folds, oscillates, presses or is slack."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Sequence
from typing import Any

from app.cli.design import stages_of
from app.cli.options import add_forms, add_lines, add_scan
from app.cli.output import finish
from app.presenters.assessment import assessment_lines
from app.presenters.length_limits import legend_entries
from app.presenters.messages import line_title
from core.analysis.length_limits.limits import Length, Limits, all_limits
from core.analysis.length_limits.zones import LengthLimits, to_length_limits
from core.garment.assessment import Assessment, assess
from core.garment.pressure import pressure_limits
from core.messages import plain
from core.pipeline.build import Stages
from core.pipeline.solve import solve
from core.pipeline.warnings import immovable_lines

MEANING = {
    "strained": "edges outside 80 to 120 %",
    "overstrained": "edges outside 70 to 130 %",
    "folded": "a triangle rotated by 78 degrees",
    "inverted": "a triangle is inverted",
}
"""Criteria of the control mesh, in JSON."""

OTHERS = {
    "vibrating": "iterations with conventional volume control",
    "restless": "iterations with any volume control: explicit line forces",
    "pressing": "contact pressure above {kpa:g} kPa along the band",
    "slack": "the line would carry compression, which is impossible for a band",
}
"""Other criteria, in JSON."""

_NO_ELASTIC = "Contact pressure is checked for lines made of an elastic (--elastic), not for straps."

_NO_BREAK = "\N{NO-BREAK SPACE}"


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk limits``."""
    add_scan(parser)
    add_lines(parser)
    add_forms(parser)


def run(options: Namespace) -> int:
    """Print the verdict on the design as it is set, and the length limits of each line."""
    stages = stages_of(options)
    assessment, found = assess(solve(stages)), list(all_limits(stages))
    if options.json:
        data = {"assessment": assessment.as_data(), **limits_data(found, stages)}
        return finish(json.dumps(data, indent=1), True)
    return finish("\n".join(_text(found, stages, assessment)), True)


def _text(found: Sequence[Limits], stages: Stages, assessment: Assessment) -> Iterator[str]:
    yield from (*assessment_lines(assessment, stages.design), "")
    for limits in found:
        title = line_title(limits.line.name, stages.design)
        yield f"{title}, original length {limits.line.rest_length:.1f} mm; {_present(limits, stages)}"
        zones = to_length_limits(limits)
        if zones is None:
            yield "  no equilibrium at any length: the other lines are too short"
            continue
        yield from (
            f"  {tone}: {words.replace(_NO_BREAK, ' ')}" for tone, words in legend_entries(zones).items()
        )
    if not all(limits.pressure_known for limits in found if limits.found):
        yield _NO_ELASTIC
    yield from map(str, immovable_lines(stages))


def _present(limits: Limits, stages: Stages) -> str:
    if limits.line.name not in stages.region_of(limits.line.name).design.active_lines():
        return "inactive"
    if limits.present is None:
        return "no equilibrium found at the set length"
    ratio, reached = limits.present.ratio, limits.present.reached
    share = reached / limits.line.rest_length
    return f"set to {100.0 * ratio:.1f} %, reached {reached:.1f} mm = {100.0 * share:.1f} %"


def limits_data(found: Sequence[Limits], stages: Stages) -> dict[str, Any]:
    """Return length limits as plain values, ready for JSON."""
    criteria = [f"{sign}: {meaning}" for sign, meaning in MEANING.items()]
    others = [f"{sign}: {meaning.format(kpa=pressure_limits().red_kpa)}" for sign, meaning in OTHERS.items()]
    return {
        "lines": {
            limits.line.name: {
                "worn": limits.line.name in stages.region_of(limits.line.name).design.active_lines(),
                "rest_mm": limits.line.rest_length,
                "present": _length(limits.present, limits),
                "beyond": list(limits.beyond),
                "begins": {sign: _length(limits.onsets[sign], limits) for sign in MEANING},
                "found": limits.found,
                "no_balance_below": _length(limits.last, limits),
                "elastic_ends": _length(limits.stretched, limits),
                "pressure_known": limits.pressure_known,
                "zones": _zones(to_length_limits(limits)),
            }
            for limits in found
        },
        "notes": plain(immovable_lines(stages)),
        "definition": "each line and its linked partner, shorter and longer than 100 %, other lines as set; "
        f"% of rest_mm. On the control mesh: {'; '.join(criteria)}. Further limits: {'; '.join(others)}. "
        "Limits caused by other lines also apply at 100 %",
    }


def _zones(found: LengthLimits | None) -> list[dict[str, Any]] | None:
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


def _length(length: Length | None, limits: Limits) -> dict[str, float] | None:
    if length is None:
        return None
    return {
        "set_percent": 100.0 * length.ratio,
        "reached_mm": length.reached,
        "reached_percent": 100.0 * length.reached / limits.line.rest_length,
    }
