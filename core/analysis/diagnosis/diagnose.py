"""The doctor: what fights in a design that does not rest or strains, and the least that ends it (ours).

A change is named only after the design was run with it as the window runs it, and ended well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import chain

from threadpoolctl import threadpool_limits

from core.analysis.diagnosis.candidate_changes import (
    Change,
    Way,
    line_ways,
    lower_gains,
    off_changes,
    settings,
    single_ways,
    together_ways,
    with_setting,
)
from core.analysis.diagnosis.fix import Cure, findings
from core.analysis.diagnosis.opposing_constraints import Fight, fight_of
from core.analysis.diagnosis.pressure_fixes import cleaner, eased, ranked
from core.analysis.diagnosis.search import Search
from core.analysis.diagnosis.stability import Outlook, outlook
from core.analysis.diagnosis.trial_run import Standing, rank_of, standing
from core.garment.assessment import Finding
from core.mechanics.constraint_lines import Line
from core.mechanics.convergence import Verdict
from core.pipeline.active_lines import free_lines
from core.pipeline.build import Stages
from core.progress import Progress, quiet

__all__ = ["Change", "Cure", "Diagnosis", "diagnose"]

_OTHERS = 2  # changes of other lines that look good, and are run too
_MOST_GAIN = 10.0
_GAIN_PRECISION = 0.005


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """What is wrong with a design, and what ends it.

    ``findings`` are those of the overall verdict that a change can end.

    ``complaint`` is one of ``standing.COMPLAINTS``, empty if the design is well. ``fight`` tells what pulls
    against what. ``bears`` is the conventional gain at which the shape that the lines make begins to vibrate
    (probe units [1]), and ``onset`` the growth per turn with which a small swing begins, None where that is
    not asked or not known. ``fixes`` were run and end it, the best first. If there are none, ``nearest`` is
    the mildest of what was run, and ``locked`` names worn lines that may not be changed.
    """

    standing: Standing
    fight: Fight
    bears: float | None = None
    onset: float | None = None
    fixes: tuple[Cure, ...] = ()
    findings: tuple[Finding, ...] = ()
    nearest: Cure | None = None
    locked: tuple[str, ...] = ()

    @property
    def stages(self) -> Stages:
        """What was looked at."""
        return self.standing.stages

    @property
    def cure(self) -> Cure | None:
        """The best of the fixes, if there is any."""
        return self.fixes[0] if self.fixes else None

    @property
    def complaint(self) -> str:
        """What is wrong, or nothing."""
        return self.standing.complaint

    @property
    def verdict(self) -> Verdict:
        """How its run ended, with period and growth if it swings."""
        return self.standing.verdict

    def seen(self, verdict: Verdict) -> Diagnosis:
        """Return the same as told of a run that ended by ``verdict``: one that did not begin at rest."""
        if self.complaint == "unreachable" or verdict.told == "settled":
            return self
        ran = replace(self.standing.ran, verdict=verdict)
        return replace(self, standing=replace(self.standing, ran=ran, complaint=verdict.told))

    def line(self, name: str) -> Line:
        """Return a line of the design by name."""
        return next(line for line in self.stages.model.lines if line.name == name)

    def longer_mm(self, change: Change) -> float:
        """Return by how much the first line of a change is set longer, negative if shorter [mm]."""
        name, before = change.lines[0], self.stages.design
        return (change.design.ratio(name) - before.ratio(name)) * self.line(name).rest_length

    def moves_mm(self, change: Change) -> float:
        """Return how far a change moves the length of any line at most [mm]."""
        before, after = self.stages.design, change.design
        return max(abs(after.ratio(n) - before.ratio(n)) * self.line(n).rest_length for n in change.lines)


def diagnose(stages: Stages, progress: Progress = quiet) -> Diagnosis:
    """Return what is wrong with the design of ``stages``, and the smallest change that ends it.

    First the adaptive control where the conventional one vibrates, a single line, and the gain; if none does,
    a choice of the model, then that and a line; then all lines nearer to rest, alone or with such a choice;
    last a line taken off. Where all of these leave something to be checked, more is tried. A design whose run
    is well may press too much, or have slack lines. ``progress`` hears each step; raises Cancelled.
    """
    # Two BLAS threads make these small products many times slower.
    with threadpool_limits(1):
        progress("diagnosing", 0.0)
        found = Diagnosis(standing(stages, progress), fight_of(stages, progress))
        if found.complaint != "unreachable":
            found = replace(found, findings=findings(found.standing))
        if not found.complaint:
            search = Search(found.standing, progress)
            return replace(found, fixes=eased(search, found.findings)) if found.findings else found
        if found.complaint in ("vibrating", "diverging"):
            seen = outlook(stages)
            bears = borne_gain(stages, progress) if stages.design.volume == "conventional" else None
            found = replace(found, bears=bears, onset=None if seen is None else seen.growth)
        return _treated(found, Search(found.standing, progress))


def _treated(found: Diagnosis, search: Search) -> Diagnosis:
    """Return the diagnosis with the changes that end its complaint, each run, the best first."""
    fixes = _ending(found, search)
    if fixes and found.complaint != "unreachable" and all(fix.remains for fix in fixes):
        fixes += cleaner(search, ranked(fixes)[0])
    if fixes:
        return replace(found, fixes=ranked(fixes))
    stages = found.stages
    if not search.tried:
        list(search.tried_all(settings(stages.design, found.complaint)))  # to know the nearest
    worn = (line.name for line in stages.model.lines if line.constrains)
    free = set(chain.from_iterable(free_lines(stages)))
    locked = tuple(name for name in worn if name in stages.design.worn() and name not in free)
    milder = [each for each in search.tried if rank_of(each.left) < found.standing.rank]
    nearest = min(milder, key=lambda each: (rank_of(each.left), each.change.size), default=None)
    return replace(found, nearest=nearest, locked=locked)


def _ending(found: Diagnosis, search: Search) -> list[Cure]:
    """Return changes that end a complaint: another control if this one vibrates, and the smallest others."""
    stages, swings = found.stages, found.complaint in ("vibrating", "diverging")
    tame = swings and stages.design.volume == "conventional"
    gains = list(lower_gains(stages, found.bears)) if tame else []
    choices = list(settings(stages.design, found.complaint))
    adaptive = [each for each in choices if tame and each.setting == ("volume", "adaptive")]
    calmed = search.first_of(iter(adaptive))
    cure, others = search.smallest(single_ways(stages, found.complaint))
    fixes = [each for each in (calmed, cure) if each is not None]
    fixes += [each for each in search.tried_all(others[:_OTHERS]) if each.ends]
    if fixes:
        return fixes
    cure = search.smallest(_chosen(stages, gains, line_ways))[0]
    cure = cure or search.first_of(iter(choices))
    cure = cure or search.smallest(_chosen(stages, choices, line_ways))[0]
    cure = cure or search.smallest(together_ways(stages))[0]
    cure = cure or search.smallest(_chosen(stages, gains, together_ways))[0]
    cure = cure or search.smallest(_chosen(stages, choices, together_ways))[0]
    cure = cure or search.first_of(off_changes(stages))
    return [] if cure is None else [search.plainer(cure)]


def _chosen(stages: Stages, choices: list[Change], ways: Callable[[Stages], Iterator[Way]]) -> Iterator[Way]:
    """Yield the ways to change lines with each of other choices of the model."""
    for choice in choices:
        yield from with_setting(choice, ways(replace(stages, design=choice.design)))


def borne_gain(stages: Stages, progress: Progress = quiet) -> float | None:
    """Return the conventional gain at which the shape that the lines make begins to vibrate, None if unknown.

    Where the turns of a gain come to rest is worked out anew for each that is tried.
    """

    seen: Outlook | None = None

    def grows(gain: float) -> bool:
        nonlocal seen
        progress("diagnosing", 0.0)
        seen = outlook(replace(stages, design=replace(stages.design, gain=gain)), seen)
        return seen is None or seen.growth > 1.0

    low, high = 0.0, min(2.0 * stages.gain_limit, _MOST_GAIN)
    if grows(low) or not grows(high):
        return None
    while high - low > _GAIN_PRECISION:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grows(middle) else (middle, high)
    return low
