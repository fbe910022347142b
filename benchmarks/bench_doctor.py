"""Ask the doctor about random designs that are no result, and see whether what it names ends it.

Run: python benchmarks/bench_doctor.py [FOLDER] [--cases N] [--put]; scans of a folder come to the samples.
In each case lines - of the template and of the presets - and their lengths, glued or sliding, springs or
held, the control and its gain are drawn by chance until the design vibrates, runs away, folds, strains or
cannot be held. What the doctor names is made and run anew by another path than its own: as the window does,
from rest and on from where the design stood, all controls in lockstep. Prints a line for each case, then what
was ended, how large the changes are and the processor time; --put puts the tables into RESULTS.md.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from bench_ask import bodies
from pages import put, table
from threadpoolctl import threadpool_limits

from core.analysis.diagnosis.diagnose import Diagnosis, diagnose
from core.analysis.diagnosis.trial_run import run_trial
from core.document.design import Design
from core.errors import UserError
from core.garment.presets import built_in, with_preset
from core.mechanics.solver_comparison import SolverComparison
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets

KINDS = ("vibrating", "diverging", "folded", "overstrained", "strained", "unreachable")
WANTED = {"vibrating": 0.5, "diverging": 0.05, "folded": 0.1, "overstrained": 0.15, "strained": 0.15}
"""What part of all cases each kind is at least; the rest cannot be held."""


@dataclass(frozen=True)
class Case:
    """One design: what was wrong, what was named, how it ended by another path, processor time [s]."""

    name: str
    found: Diagnosis
    after: str
    seconds: float

    @property
    def ended(self) -> bool:
        """Whether what was named ended it."""
        calm = ("settled",) if self.found.problem == "strained" else ("settled", "strained")
        return self.after in calm


def drawn(rng: np.random.Generator, stages: Stages) -> Stages:
    """Return a design by chance; most are no result."""
    presets = [*built_in(), None, None]
    preset = presets[rng.integers(len(presets))]
    hold = "held" if rng.random() < 0.2 else "spring"
    base = replace(stages.design, line_contact=str(rng.choice(["glued", "sliding"])), line_hold=hold)
    design = base if preset is None else with_preset(base, preset)
    if preset is None:
        moving = [line.name for line in stages.model.lines if line.constrains]
        for name in rng.choice(moving, rng.integers(1, len(moving) + 1), replace=False).tolist():
            design = design.with_line(name, 1.0)
    for names in dict.fromkeys(design.linked_lines(name) for name in sorted(design.active_lines())):
        ratio = round(float(rng.uniform(0.55, 1.12) if rng.random() < 0.6 else rng.uniform(0.85, 1.0)), 3)
        for name in names:
            design = design.with_line(name, ratio)
    design = replace(design, volume=str(rng.choice(["conventional", "conventional", "adaptive", "exact"])))
    if design.volume == "conventional" and rng.random() < 0.7:
        limit = build(design, stages).gain_limit
        design = replace(design, gain=round(float(rng.uniform(0.8, 1.35)) * limit, 2))
    if design.volume != "exact" and rng.random() < 0.1:
        design = replace(design, line_force="explicit")
    return build(design, stages)


def ends(stages: Stages, design: Design | None = None) -> str:
    """Return how the window's runs of ``stages`` end, or of another design that goes on from there."""
    with threadpool_limits(1):
        change = stages.body_change if stages.design.dense_volume else None
        comparison = SolverComparison(stages.model, line_targets(stages.design, stages), stages.watch, change)
        _to_rest(comparison)
        if design is not None:
            after = build(design, stages)
            comparison.retarget(after.model, line_targets(design, after), fresh=True)
            _to_rest(comparison)
            if comparison.verdict.motion == "settling":  # as the window does after a change of the doctor's
                comparison.retarget(after.model, line_targets(design, after))
                _to_rest(comparison)
            stages = after
    held = stages.design.line_hold == "held"
    if (held or comparison.main is None) and not comparison.exact.is_converged:
        return "unreachable"
    if held and comparison.main is not None and not comparison.main.sane:
        return "unreachable"
    return comparison.verdict.display_state


def _to_rest(comparison: SolverComparison) -> None:
    while not comparison.is_finished:
        comparison.advance()


def case(stages: Stages) -> Case:
    """Return what the doctor says of one design, and whether it is so."""
    begun = time.process_time()
    found = diagnose(stages)
    seconds = time.process_time() - begun
    after = "nothing found"
    if found.best_fix is not None:
        cured = found.best_fix.change.design
        after = ends(build(cured, stages))
        if after in ("settled", "strained") and found.problem != "unreachable":
            after = ends(stages, cured)
    design = stages.design
    lines = ", ".join(f"{line.name} {100.0 * line.ratio:.1f}" for line in design.lines)
    gain = f" {stages.gain:.2f}" if design.volume == "conventional" else ""
    how = f"{design.line_contact}, {design.line_hold}, {design.line_force}, {design.volume}{gain}"
    return Case(f"{design.scan.name}: {lines}; {how}", found, after, seconds)


def cases(rng: np.random.Generator, on: list[Stages], count: int) -> Iterator[Case]:
    """Yield cases until there are ``count``, of each kind as many as are wanted."""
    room = {kind: round(share * count) for kind, share in WANTED.items()}
    room["unreachable"] = count - sum(room.values())
    tries = 0
    while any(room.values()):
        tries += 1
        try:
            stages = drawn(rng, on[tries % len(on)])
            with threadpool_limits(1):
                complaint = run_trial(stages).problem
        except UserError:
            continue
        if room.get(complaint, 0):
            room[complaint] -= 1
            yield case(stages)


def said(one: Case) -> str:
    """Return what was named, in a few words."""
    cure = one.found.best_fix
    if cure is None:
        return "nothing"
    change = cure.change
    words = " ".join(f"{line.name} {100.0 * line.ratio:.1f}" for line in change.design.lines)
    setting = f" {change.setting[0]}={change.setting[1]}" if change.setting[0] else ""
    gain = f" gain {change.design.gain:.2f}" if change.kind == "gain" else ""
    return f"{change.kind}{setting}{gain} ({words}), {change.size:.1f} %"


def rows(done: list[Case]) -> Iterator[tuple[str, ...]]:
    """Yield what holds for all cases and for each kind."""
    groups = {"all": done} | {kind: [each for each in done if each.found.problem == kind] for kind in KINDS}
    groups |= {how: [each for each in done if f" {how}," in each.name] for how in ("glued", "sliding")}
    for name, chosen in groups.items():
        if chosen:
            seconds = [each.seconds for each in chosen]
            named = sum(each.found.forces.worst is not None for each in chosen)
            yield (
                name,
                str(len(chosen)),
                str(sum(each.ended for each in chosen)),
                f"{100.0 * sum(each.ended for each in chosen) / len(chosen):.1f} %",
                str(named),
                f"{statistics.median(seconds):.2f} s",
                f"{np.quantile(seconds, 0.95):.2f} s",
                f"{max(seconds):.2f} s",
            )


def changes(done: list[Case]) -> Iterator[tuple[str, ...]]:
    """Yield what kinds of change were named, and how large they are."""
    kinds = Counter(_kind(each) for each in done)
    for kind, count in kinds.most_common():
        sizes = [
            each.found.best_fix.change.size for each in done if _kind(each) == kind and each.found.best_fix
        ]
        figures = [f"{of(sizes):.1f}" for of in (min, statistics.median, max)] if any(sizes) else [""] * 3
        yield (kind, str(count), *figures)


def _kind(one: Case) -> str:
    cure = one.found.best_fix
    if cure is None:
        return "nothing found"
    kind = {
        "length": "one line longer or shorter",
        "gain": "the gain lower",
        "setting": "another choice of the model",
        "together": "all lines nearer to rest",
        "off": "a line off",
    }[cure.change.kind]
    return f"{kind}, and another choice" if cure.change.setting[0] and cure.change.kind != "setting" else kind


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--seed", type=int, default=2030)
    parser.add_argument("--put", action="store_true", help="put the tables into RESULTS.md")
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    done = []
    for one in cases(rng, list(bodies(options.folder)), options.cases):
        done.append(one)
        mark = "     " if one.ended else "MISS "
        told = f"{one.found.problem} -> {said(one)} -> {one.after}"
        print(f"{mark}{one.seconds:5.2f} s {one.name}: {told}", flush=True)
    heads = ("", "cases", "ended", "of them", "a pair named", "in the middle", "at 95 %", "at most")
    ended = table(heads, rows(done))
    sizes = table(("what ends it", "cases", "least %", "in the middle %", "largest %"), changes(done))
    print(ended, sizes, sep="\n\n")
    if options.put:
        put("ended", ended)
        put("changes", sizes)


if __name__ == "__main__":
    main()
