"""Changes that leave less to be checked: of lines that press too much or are slack, of strain (ours)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain

from core.analysis.diagnosis.candidate_changes import (
    SEVERITIES,
    Change,
    ChangePath,
    Fix,
    common_paths,
    deactivations,
    line_paths,
    severity,
    wider_bands,
    with_option,
)
from core.analysis.diagnosis.search import Search
from core.document.design import Design
from core.garment.assessment import Finding
from core.garment.curve_smoothing import USUAL_WIDTH
from core.garment.pressure import pressure_limits
from core.pipeline.active_lines import LineGroup, all_free_lines
from core.pipeline.build import Stages

MOST = 3
"""Fixes that are named."""

NUMERICAL = (("volume", "adaptive"), ("line_force", "implicit"))
"""Choices of the model that change the calculation, and nothing of the garment."""

WIDEST = 80.0
"""The widest band that is offered [mm]; ours."""

_WIDTH_STEP, _ROOMY = 5.0, 1.1  # mm; a wider band takes another course on the skin
_FIRST = {"length": 10, "together": 25}  # steps that are tried first: 1 %, and a quarter of the way to rest


def rank_fixes(fixes: Iterable[Fix]) -> tuple[Fix, ...]:
    """Return the best of some fixes, the best first; of those that set the same design one is enough.

    Another way to compute the same garment comes before all others.
    """
    by_design = {cure.change.design: cure for cure in fixes}
    return tuple(sorted(by_design.values(), key=lambda cure: (not _is_control(cure), cure.rank))[:MOST])


def _is_control(cure: Fix) -> bool:
    return cure.change.kind == "setting" and cure.change.setting in NUMERICAL


def pressure_changes(search: Search, findings: tuple[Finding, ...]) -> tuple[Fix, ...]:
    """Return changes that end the findings on a design whose run is well, the best first.

    Those that end all of them come first, then those that end the worst.
    """
    stages, worst = search.stages, severity(findings)
    known = chain(_offs(stages, findings), _widths(stages, findings))
    fixes = [
        cure
        for cure in search.run_changes(known)
        if cure.severity < worst or (cure.severity == worst and len(cure.remains) < len(findings))
    ]
    for way in _ways(stages.design, all_free_lines(stages), findings):
        cure = _mildest(search, [way], worst)
        fixes += [] if cure is None else [cure]
    return rank_fixes(fixes)


def complete_fix(search: Search, fix: Fix) -> list[Fix]:
    """Return what ends a complaint like ``fix`` and leaves less behind, if a few runs find it."""
    change, stages = fix.change, search.stages
    chosen = bool(change.setting[0])
    base = replace(stages.design, **dict([change.setting])) if chosen else stages.design
    ways = _ways(base, all_free_lines(stages), fix.remains)
    if chosen:
        ways = with_option(replace(change, design=base), ways)
    found = _mildest(search, list(ways), fix.severity)
    return [] if found is None else [search.simplify(found)]


def _mildest(search: Search, ways: list[ChangePath], worst: int) -> Fix | None:
    """Return the fix on any of some ways that leaves the least, None if none is milder than ``worst``."""
    for most in (each for each in SEVERITIES if each < worst):
        found = (search.fewest_steps(way, _FIRST[way.at(1).kind], most) for way in ways)
        if (cure := next((each for each in found if each is not None), None)) is not None:
            return cure
    return None


def _ways(design: Design, groups: Sequence[LineGroup], findings: tuple[Finding, ...]) -> Iterator[ChangePath]:
    """Yield ways that may end findings: a tight line longer, a slack one shorter, all nearer to rest."""
    tight = {name for each in findings if each.topic == "pressure" or _is_far(each) for name in each.lines}
    slack = _slack(findings)
    for way in line_paths(design, groups):
        (name, *_), longer = way.at(1).lines, _is_longer(design, way.at(1))
        if (longer and name in tight) or (not longer and name in slack):
            yield way
    if any(each.topic in ("shape", "pressure") for each in findings):
        yield from common_paths(design, groups)


def _widths(stages: Stages, findings: tuple[Finding, ...]) -> Iterator[Change]:
    """Yield wider bands for lines of no elastic: as wide as the limits of pressure require."""
    design, limits = stages.design, pressure_limits()
    for each in findings:
        if each.topic != "pressure" or each.lines[0] in design.region_of(each.lines[0]).active_elastics():
            continue
        width = design.line_settings(each.lines[0]).width or USUAL_WIDTH
        for kpa in (limits.amber_kpa, limits.red_kpa):
            needed = math.ceil(_ROOMY * width * each.value / kpa / _WIDTH_STEP) * _WIDTH_STEP
            if width < needed <= WIDEST:
                yield wider_bands(design, tuple(sorted(design.linked_lines(each.lines[0]))), needed)


def _is_longer(design: Design, change: Change) -> bool:
    return change.design.ratio(change.lines[0]) > design.ratio(change.lines[0])


def _offs(stages: Stages, findings: tuple[Finding, ...]) -> Iterator[Change]:
    """Yield the changes that take slack lines off."""
    slack = _slack(findings)
    offs = deactivations(stages.design, all_free_lines(stages))
    return (change for change in offs if slack & set(change.lines))


def _slack(findings: tuple[Finding, ...]) -> set[str]:
    """Return the lines that would have to push."""
    return {name for each in findings if each.topic == "band" and not _is_far(each) for name in each.lines}


def _is_far(finding: Finding) -> bool:
    """Return whether an elastic is stretched far."""
    return finding.topic == "band" and finding.value > 0.0
