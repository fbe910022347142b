"""What ``busk ask`` does: lengths of lines are found that bring the body to what is wished, and told."""

from __future__ import annotations

import json
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from app.cli.options import dressed, made_of
from app.presenters.assessment import assessment_lines
from core import __version__
from core.analysis.inverse_design.conflicts import Conflict
from core.analysis.inverse_design.line_selection import LineSelection, optional_lines, switched_on
from core.analysis.inverse_design.profile_csv import profile_goals, read_profile
from core.analysis.inverse_design.quantities import GIRTH, NAMES, Goal, profiles_off, section_of
from core.analysis.inverse_design.search import Bounds
from core.analysis.inverse_design.solve import Reply
from core.document.design import Design
from core.document.document import Document
from core.document.storage.backups import backed_up
from core.document.storage.project_file import SUFFIX, is_project, open_project, save_project
from core.errors import LineError, UserError
from core.garment.assessment import Assessment, assessed
from core.geometry.mesh import Floats
from core.mechanics.constraint_lines import Line, length_ratio
from core.pipeline.build import Stages, build
from core.pipeline.solve import run

_WANT = re.compile(
    r"\s*([a-z ]+?)\s*=\s*([+-]?\d+(?:[.,]\d+)?)\s*(mm|cm|in)?\s*(?:@\s*(high|normal|low)\s*)?"
)
_MM = {None: 1.0, "mm": 1.0, "cm": 10.0, "in": 25.4}
_SECTION = re.compile(r"\s*(left|right|[+-]?\d+(?:\.\d+)?)\s*(?:@\s*(high|normal|low)\s*)?=", re.IGNORECASE)
_LARGEST = 10_000.0  # mm
_HARDEST = 50.0  # kPa


@dataclass(frozen=True)
class AskWishes:
    """What is asked as it is written: NAME=VALUE, SECTION=FILE, LINE, LINE=LENGTH, LINE each.

    ``pressure`` [kPa] is the most that elastics may press with, infinite for no limit; ``optional`` are lines
    that are off and may be switched on; ``out`` is a project, or empty.
    """

    want: Sequence[str]
    profile: Sequence[str] = ()
    lock: Sequence[str] = ()
    shortest: Sequence[str] = ()
    pressure: float | None = None
    optional: Sequence[str] = ()
    out: str = ""


@dataclass(frozen=True, eq=False)
class Asked:
    """The ``reply`` to ``goals`` for a design as it was before, ``stages``; ``out`` is where it was saved.

    ``assessment`` is the overall verdict on the design found, ``conflicts`` are those of goals that are not
    all met.
    """

    stages: Stages
    goals: tuple[Goal, ...]
    reply: Reply
    out: str
    assessment: Assessment
    conflicts: tuple[Conflict, ...] = ()


def run_ask(
    source: str, design: Design, lengths: Sequence[str], elastics: Sequence[str], wishes: AskWishes
) -> Asked:
    """Ask of a design with ``lengths``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC, what is wished.

    ``source`` is the file it came from. Raises UserError, before anything is worked out if a wish cannot be.
    """
    goals, curves = goals_of(wishes.want), [_curve(each) for each in wishes.profile]
    if not goals and not curves:
        raise UserError("No target specified.", "Specify a target: --want lift=5mm.")
    if wishes.pressure is not None and not (0.0 < wishes.pressure < _HARDEST or wishes.pressure == np.inf):
        raise UserError("That is no pressure to keep to.", f"Enter kPa between 0 and {_HARDEST:g}.")
    if wishes.out and not is_project(wishes.out):
        raise UserError(
            f"{wishes.out} is not a project file name.", f"Specify a project file: --out design{SUFFIX}."
        )
    stages = build(design)
    design = made_of(dressed(design, stages.model.lines, lengths), elastics)
    if not design.lines and not wishes.optional:
        raise LineError("No line is worn.", "Activate the lines to use: --line mid-bust=100%.")
    stages = build(design, stages)
    worn = {line.name.lower(): line for line in stages.model.lines if line.name in design.worn()}
    kept = [_worn(worn, name, name).name for name in wishes.lock]
    for section, priority, curve in curves:
        goals += tuple(replace(goal, priority=priority) for goal in profile_goals(stages, section, curve))
    shortest = dict(_shortest(worn, each) for each in wishes.shortest)
    bounds = Bounds(shortest, kept)
    solver = LineSelection(stages, _optional(stages, wishes.optional), bounds, wishes.pressure)
    reply = solver.reply(goals)
    conflicts = solver.conflicts(reply, goals)
    if wishes.out:
        document = open_project(source) if is_project(source) else Document.of(reply.design)
        with backed_up(Path(wishes.out)):
            save_project(wishes.out, document.with_design(reply.design), stages.scan, None)
    assessment = assessed(run(build(reply.design, stages)))
    return Asked(stages, goals, reply, wishes.out, assessment, conflicts)


def goals_of(wants: Sequence[str]) -> tuple[Goal, ...]:
    """Return what is wanted: NAME=VALUE each. Raises UserError with the right names."""
    goals: dict[str, Goal] = {}
    for want in wants:
        match = _WANT.fullmatch(unicodedata.normalize("NFKC", want).replace("\N{MINUS SIGN}", "-").lower())
        name = " ".join(match[1].split()) if match else ""
        if match is None or name not in NAMES:
            names = ", ".join(NAMES)
            raise UserError(f"'{want}' is not a target.", f"Enter NAME=12mm. Names: {names}.")
        value = float(match[2].replace(",", ".")) * _MM[match[3]]
        if abs(value) > _LARGEST:
            raise UserError(f"'{want}' is not a valid body length.", "Enter millimetres, or append cm or in.")
        if name in goals:
            raise UserError(f"{name} is specified twice.", "Specify it once.")
        goals[name] = Goal(name, value, match[4] or "normal")
    return tuple(goals.values())


def _curve(request: str) -> tuple[str, str, Floats]:
    """Return the section, the priority and the curve, (k, 2) [mm], of one request. Raises UserError."""
    match = _SECTION.match(request)
    section = match[1].lower() if match else "left"
    named, equals, _ = request.partition("=")
    if match is None and equals and not Path(request).exists():
        hint = "Specify left, right, or x in mm: 60=FILE.csv."
        raise UserError(f"There is no section '{named.strip()}'.", hint)
    priority = (match[2] or "normal").lower() if match else "normal"
    return section, priority, read_profile(request[match.end() :] if match else request)


def _optional(stages: Stages, requests: Sequence[str]) -> tuple[str, ...]:
    """Return the names of inactive lines that may be switched on. Raises LineError."""
    groups = optional_lines(stages)
    if any(request.strip().lower() == "all" for request in requests):
        return tuple(name for group in groups for name in group)
    known = {name.lower(): group for group in groups for name in group}
    chosen: list[str] = []
    for request in requests:
        if request.strip().lower() not in known:
            names = ", ".join(known) or "none"
            raise LineError(
                f"'{request}' is not an inactive line that moves the body.", f"Inactive lines: {names}."
            )
        chosen += known[request.strip().lower()]
    return tuple(dict.fromkeys(chosen))


def _worn(worn: Mapping[str, Line], name: str, request: str) -> Line:
    if name.strip().lower() not in worn:
        names = ", ".join(line.name for line in worn.values())
        raise LineError(f"'{request}' is not an active line.", f"Active lines: {names}.")
    return worn[name.strip().lower()]


def _shortest(worn: Mapping[str, Line], request: str) -> tuple[str, float]:
    name, _, text = request.partition("=")
    line = _worn(worn, name, request)
    return line.name, length_ratio(text, line.name, line.rest_length, line.whole_length)


def asked_text(asked: Asked, as_json: bool) -> str:
    """Return what is to be printed: sentences for people, or the same figures as JSON."""
    return json.dumps(_figures(asked), indent=1) if as_json else "\n".join(_plain(asked))


def _plain(asked: Asked) -> Iterator[str]:
    reply, added = asked.reply, switched_on(asked.stages.design, asked.reply.design)
    single = [goal for goal in asked.goals if not section_of(goal.name)]
    wide = max([12, *(len(goal.name) + 1 for goal in single)])
    yield from (*assessment_lines(asked.assessment, reply.design), "")
    if single:
        yield f"{'':{wide}}{'target':>12}{'reached':>12}"
    for goal in single:
        sign = "" if goal.name == GIRTH else "+"
        wanted, got = (f"{value:{sign}.1f} mm" for value in (goal.value, reply.reached[goal.name]))
        yield f"{goal.name:{wide}}{wanted:>12}{got:>12}"
    for section, off in profiles_off(asked.goals, reply.reached).items():
        mean, most = np.abs(off).mean(), np.abs(off).max()
        yield f"{section}: {len(off)} heights, error {mean:.1f} mm on average, {most:.1f} mm maximum."
    for line in asked.stages.model.lines:
        if line.name in reply.design.worn():
            ratio, before = (design.ratio(line.name) for design in (reply.design, asked.stages.design))
            length = f"{100.0 * ratio:.1f} %, {ratio * line.rest_length:.1f} mm front length"
            same = abs(ratio - before) < 5e-4
            change = "unchanged" if same else f"before {100.0 * before:.1f} %"
            yield f"{line.name}: {length}; {'switched on' if line.name in added else change}"
    yield _verdict(reply)
    yield from map(conflict_text, asked.conflicts)
    estimate = "" if not reply.unseen else ", an estimate"
    yield f"Total tension of all lines: {reply.tension:.1f} N{estimate}."
    yield from _pressures(reply)
    if asked.out:
        yield f"written to {asked.out}"


def _verdict(reply: Reply) -> str:
    if reply.reachable:
        return "All targets reached."
    if not reply.agreed:
        return (
            "Not converged: the iteration over lengths, elastics and contact pressures stopped, so a "
            "better result may exist."
        )
    return f"Not reachable. Closest result, because {' and '.join(reasons(reply))}."


def conflict_text(conflict: Conflict) -> str:
    """Return in one sentence what a target that is missed reaches alone, and what another loses by it."""
    name, profile = conflict.name, bool(section_of(conflict.name))
    alone = f"{'off by ' if profile else ''}{conflict.alone:.1f} mm"
    if not conflict.against:
        return f"{name}: {alone} is the closest result even as the only target."
    off = "error " if section_of(conflict.against) else ""
    return (
        f"{name} conflicts with {conflict.against}: {alone} as the only target, and {conflict.against} "
        f"is then {off}{conflict.lost:.1f} mm instead of {conflict.kept:.1f} mm "
        f"({conflict.price:.2f} mm for each millimetre)."
    )


def reasons(reply: Reply) -> list[str]:
    """Return why what was asked for is not reached, as parts of a sentence."""
    reasons = []
    for name in reply.at_end:
        long = reply.may_not_be_longer(name)
        reasons.append(f"{name} is as {'long' if long else 'short'} as it may be")
    if reply.strained:
        reasons.append("the skin strain would exceed its limit")
    reasons += [f"{name} is at its contact pressure limit" for name in reply.pressing]
    reasons += [f"{name} would carry compression" for name in reply.slack if name not in reply.at_end]
    return reasons or ["the active lines cannot produce this movement"]


def _pressures(reply: Reply) -> Iterator[str]:
    limit = f"limit {reply.limit:g} kPa" if np.isfinite(reply.limit) else "no limit"
    for name, kpa in reply.pressure.items():
        yield f"{name}: contact pressure up to {kpa:.2f} kPa; {limit}."
    if reply.unseen:
        yield f"Contact pressure not checked (no elastic selected): {', '.join(reply.unseen)}."


def _figures(asked: Asked) -> dict[str, Any]:
    reply, before = asked.reply, asked.stages.design
    lines = {line.name: line for line in asked.stages.model.lines if line.name in reply.design.worn()}
    return {
        "assessment": asked.assessment.as_data(),
        "figures": {
            goal.name: {
                "wanted_mm": goal.value,
                "reached_mm": reply.reached[goal.name],
                "priority": goal.priority,
            }
            for goal in asked.goals
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
        "switched_on": list(switched_on(before, reply.design)),
        "conflicts": [_conflict_figures(conflict) for conflict in asked.conflicts],
        "because": [] if reply.reachable else reasons(reply),
        "tension_n": reply.tension,
        "max_kpa": dict(reply.pressure),
        "limit_kpa": reply.limit if np.isfinite(reply.limit) else None,
        "not_looked_at_for_pressure": list(reply.unseen),
        "written_to": asked.out or None,
        "versions": {"busk": __version__},
    }


def _conflict_figures(conflict: Conflict) -> dict[str, Any]:
    figures = {"name": conflict.name, "reached_mm": conflict.reached, "alone_mm": conflict.alone}
    if not conflict.against:
        return figures | {"against": None}
    lost = {"against_mm": conflict.kept, "against_alone_mm": conflict.lost, "mm_per_mm": conflict.price}
    return figures | {"against": conflict.against} | lost
