"""Compute line lengths for target positions and measurements."""

from __future__ import annotations

import json
import math
import re
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from app.cli.design import check_project_name, design_of, save_design
from app.cli.options import add_forms, add_lines, add_project_output, add_scan
from app.cli.output import finish, table_lines
from app.i18n.lengths import length
from app.presenters.assessment import assessment_lines
from app.presenters.target_shape import (
    activated_text,
    change_text,
    conflict_text,
    deviation_text,
    reasons,
    result_text,
    target_title,
)
from core import __version__
from core.analysis.inverse_design.conflicts import Conflict
from core.analysis.inverse_design.line_selection import LineSelection, activated, optional_lines
from core.analysis.inverse_design.profile_curve import profile_goals, read_profile
from core.analysis.inverse_design.profile_quantities import is_signed, section_of
from core.analysis.inverse_design.quantities import NAMES
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.search import Bounds
from core.analysis.inverse_design.solve import InverseResult
from core.analysis.inverse_design.target_requests import absolute, changes_of, goals_of
from core.errors import LineError, UserError
from core.garment.assessment import Assessment, assess
from core.garment.line_requests import with_lines_and_elastics
from core.geometry.mesh import Floats
from core.mechanics.constraint_lines import Line, length_ratio
from core.messages import Message
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve

TARGET_HELP = (
    "target value in mm (also cm, in); may be repeated. If targets conflict, append @high or @low "
    "(lift=12mm@high) for four times or a quarter of the weight. lift, out: upward and forward movement of "
    "the bust points from the original body; apex: the same for the foremost point of the breast; girth: "
    "girth at bust point height; left higher, left further out: difference of left and right. With lines of "
    "waist, hips or seat: girths there, belly out, movement of buttock points and gluteal folds. A girth "
    "with a sign is a change from the original body (waist girth=-4cm). Names: " + ", ".join(NAMES)
)
PROFILE_HELP = (
    "target profile of the skin in a section, fitted by least squares: a table with the columns height_mm "
    "and out_mm, or an exported section. SECTION is left (default) or right, through that bust point, or x "
    "in mm; may be repeated, with optional priority: left@high=FILE.csv"
)
PRESSURE_HELP = (
    "maximum contact pressure of lines with an elastic in kPa (default: the upper limit of the rating), or "
    "off"
)
OPTIONAL_HELP = (
    "an inactive line that may be activated if the active lines do not reach the targets, or all; may be "
    "repeated"
)
_SECTION = re.compile(r"\s*(left|right|[+-]?\d+(?:\.\d+)?)\s*(?:@\s*(high|normal|low)\s*)?=", re.IGNORECASE)
_HARDEST = 50.0  # kPa


@dataclass(frozen=True, eq=False)
class TargetResult:
    """The ``reply`` to ``goals`` for a design as it was, ``stages``.

    ``assessment`` is the overall verdict on the design found, ``conflicts`` are those of missed goals.
    """

    stages: Stages
    goals: tuple[Goal, ...]
    reply: InverseResult
    assessment: Assessment
    conflicts: tuple[Conflict, ...] = ()


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk target``."""
    add_scan(parser)
    add_lines(parser)
    parser.add_argument("--target", action="append", metavar="NAME=VALUE", help=TARGET_HELP)
    parser.add_argument("--profile", action="append", metavar="[SECTION=]FILE.csv", help=PROFILE_HELP)
    parser.add_argument("--pressure", type=_limit, metavar="KPA", help=PRESSURE_HELP)
    parser.add_argument("--optional", action="append", metavar="LINE", help=OPTIONAL_HELP)
    lock = "an active line that keeps its length"
    parser.add_argument("--lock", action="append", metavar="LINE", help=lock)
    shortest = "minimum length of an active line, in the format of --line"
    parser.add_argument("--shortest", action="append", metavar="LINE=LENGTH", help=shortest)
    add_project_output(parser)
    add_forms(parser)


def _limit(text: str) -> float:
    return math.inf if text.strip().lower() == "off" else float(text)


def run(options: Namespace) -> int:
    """Print the lengths that reach the targets, or come nearest, and save that design. Raises UserError."""
    found = find_lengths(options)
    save_design(options.input, options.out, found.reply.design, found.stages)
    data = target_data(found, options.out)
    text = json.dumps(data, indent=1) if options.json else "\n".join(_text(found, options.out))
    return finish(text, found.reply.reachable)


def find_lengths(options: Namespace) -> TargetResult:
    """Compute the lengths: requests that are not valid are refused before. Raises UserError."""
    goals, changes = goals_of(options.target or []), changes_of(options.target or [])
    curves = [_curve(each) for each in options.profile or []]
    if not goals and not curves:
        raise UserError(Message("No target specified."), Message("Specify a target: --target lift=5mm."))
    limit = options.pressure
    if limit is not None and not (0.0 < limit < _HARDEST or limit == np.inf):
        raise UserError(
            Message("The pressure limit is out of range."),
            Message("Enter kPa between 0 and {most}.", most=f"{_HARDEST:g}"),
        )
    check_project_name(options.out)
    stages = with_lines_and_elastics(build(design_of(options)), options.line or [], options.elastic or [])
    if not stages.design.all_active_lines() and not options.optional:
        raise LineError(
            Message("No active lines."), Message("Activate the lines to use: --line mid-bust=100%.")
        )
    chosen = stages.design.all_active_lines()
    active = {line.name.lower(): line for line in stages.lines if line.name in chosen}
    locked = [line.name for name in options.lock or [] for line in _active(active, name, name)]
    goals = tuple(absolute(stages, goal) if goal.name in changes else goal for goal in goals)
    for section, priority, curve in curves:
        goals += tuple(replace(goal, priority=priority) for goal in profile_goals(stages, section, curve))
    shortest = dict(pair for each in options.shortest or [] for pair in _shortest(active, each))
    solver = LineSelection(stages, _inactive(stages, options.optional or []), Bounds(shortest, locked), limit)
    reply = solver.solve(goals)
    assessment = assess(solve(build(reply.design, stages)))
    return TargetResult(stages, goals, reply, assessment, solver.conflicts(reply, goals))


def _curve(request: str) -> tuple[str, str, Floats]:
    """Return the section, the priority and the curve, (k, 2) [mm], of one request. Raises UserError."""
    match = _SECTION.match(request)
    section = match[1].lower() if match else "left"
    named, equals, _ = request.partition("=")
    if match is None and equals and not Path(request).exists():
        hint = Message("Specify left, right, or x in mm: 60=FILE.csv.")
        raise UserError(Message("There is no section '{name}'.", name=named.strip()), hint)
    priority = (match[2] or "normal").lower() if match else "normal"
    return section, priority, read_profile(request[match.end() :] if match else request)


def _inactive(stages: Stages, requests: Sequence[str]) -> tuple[str, ...]:
    """Return the names of inactive lines that may be activated. Raises LineError."""
    groups = optional_lines(stages)
    if any(request.strip().lower() == "all" for request in requests):
        return tuple(name for group in groups for name in group)
    known = {name.lower(): group for group in groups for name in group}
    chosen: list[str] = []
    for request in requests:
        if request.strip().lower() not in known:
            names = ", ".join(known) or "none"
            raise LineError(
                Message("'{request}' is not an inactive line that moves the body.", request=request),
                Message("Inactive lines: {names}.", names=names),
            )
        chosen += known[request.strip().lower()]
    return tuple(dict.fromkeys(chosen))


def _active(active: Mapping[str, Line], name: str, request: str) -> list[Line]:
    """Return the active line of a name, or those of both sides. Raises LineError."""
    name = name.strip().lower()
    found = [active[each] for each in (name, f"{name}-left", f"{name}-right") if each in active]
    if not found:
        names = ", ".join(line.name for line in active.values())
        raise LineError(
            Message("'{request}' is not an active line.", request=request),
            Message("Active lines: {names}.", names=names),
        )
    return found


def _shortest(active: Mapping[str, Line], request: str) -> Iterator[tuple[str, float]]:
    name, _, text = request.partition("=")
    for line in _active(active, name, request):
        yield line.name, length_ratio(text, line.name, line.rest_length, line.whole_length)


def _text(found: TargetResult, out: str) -> Iterator[str]:
    reply, before = found.reply, found.stages.design
    yield from (*assessment_lines(found.assessment, reply.design), "")
    rows = [
        (target_title(goal.name), _value(goal, goal.value), _value(goal, reply.reached[goal.name]))
        for goal in found.goals
        if not section_of(goal.name)
    ]
    yield from table_lines([("", "target", "reached"), *rows]) if rows else ()
    sections = dict.fromkeys(section_of(goal.name) for goal in found.goals)
    for section in filter(None, sections):
        yield f"{target_title(section)}: {deviation_text(found.goals, reply.reached, section)}"
    yield result_text(reply, found.goals)
    yield from filter(None, (*change_text(before, reply), activated_text(before, reply.design)))
    yield from conflict_text(found.conflicts)
    yield f"Total tension of all lines: {reply.tension:.1f} N{', an estimate' if reply.unchecked else ''}."
    if out:
        yield f"written to {out}"


def _value(goal: Goal, value: float) -> str:
    return length(value, 1, signed=is_signed(goal.name))


def target_data(found: TargetResult, out: str) -> dict[str, Any]:
    """Return the result as plain values, ready for JSON."""
    reply, before = found.reply, found.stages.design
    lines = {line.name: line for line in found.stages.lines if line.name in reply.design.all_active_lines()}
    return {
        "assessment": found.assessment.as_data(),
        "figures": {
            goal.name: {
                "wanted_mm": goal.value,
                "reached_mm": reply.reached[goal.name],
                "priority": goal.priority,
            }
            for goal in found.goals
        },
        "lines": {
            name: {
                "set_percent": 100.0 * reply.design.ratio(name),
                "set_mm": reply.design.ratio(name) * line.rest_length,
                "before_percent": 100.0 * before.ratio(name),
            }
            for name, line in lines.items()
        },
        "reached": reply.reachable,
        "agreed": reply.agreed,
        "switched_on": list(activated(before, reply.design)),
        "conflicts": [_conflict_data(conflict) for conflict in found.conflicts],
        "because": [] if reply.reachable else reasons(reply),
        "tension_n": reply.tension,
        "max_kpa": dict(reply.pressure),
        "limit_kpa": reply.limit if np.isfinite(reply.limit) else None,
        "not_looked_at_for_pressure": list(reply.unchecked),
        "written_to": out or None,
        "versions": {"busk": __version__},
    }


def _conflict_data(conflict: Conflict) -> dict[str, Any]:
    values = {"name": conflict.name, "reached_mm": conflict.reached, "alone_mm": conflict.alone}
    if not conflict.against:
        return values | {"against": None}
    lost = {"against_mm": conflict.kept, "against_alone_mm": conflict.lost, "mm_per_mm": conflict.price}
    return values | {"against": conflict.against} | lost
