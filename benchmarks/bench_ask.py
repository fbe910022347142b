"""Ask for what a known design does: how often it is met, how long that takes.

Run: python benchmarks/bench_ask.py [FOLDER] [--cases N] [--elastic N]; scans of a folder come
to the two samples.
In each of 200 cases glued or sliding lines, a set of them and their lengths are drawn by chance, such that
the body looks natural and no line pushes; one to three figures of what comes out are asked for, with all
lines at 100 %, in every fourth case the profile through a bust point.
Then 40 cases with two lines of elastic, from 97 %, that press no more than they may.
Beside each the same figures are asked for 8 mm further or less far, profiles with a bump of 5 mm: most of
that cannot be reached.
Prints a line for each case, then what is met, what is missed, and processor time; --put puts these tables
into RESULTS.md.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from pages import put, table

from app.presenters.samples import SAMPLES, sample_design
from core.analysis.inverse_design.bust_quantities import GIRTH
from core.analysis.inverse_design.objective import INSIDE
from core.analysis.inverse_design.profile_curve import profile_goals
from core.analysis.inverse_design.profile_quantities import profile_name
from core.analysis.inverse_design.quantities import NAMES, reading
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.solve import solve_targets
from core.document.design import Design, ScanSource
from core.errors import UserError
from core.garment.elastic_library import find_elastic
from core.garment.presets import built_in, with_preset
from core.garment.pressure import pressure_limits, pressures
from core.garment.tension import line_tensions
from core.mechanics.mesh_quality import STRAINED_RANGE, MeshQuality
from core.pipeline.active_lines import free_lines
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve
from core.scan.readers.registry import FORMATS

MET = 0.5  # mm
SHORTEST, SHORTEST_ELASTIC, LOOSE = 0.85, 0.75, 0.97
HEIGHTS = 5.0  # of a profile [mm]
ELASTICS = ("plush 12", "picot 10", "picot 12")
TOO_FAR, BUMP, WIDE = 8.0, 5.0, 25.0  # of wishes that can hardly be reached [mm]
SOON = 0.3  # an answer is to be there [s]
TIMES = ("in the middle", "at 95 %", "at most")


@dataclass(frozen=True)
class Case:
    """One question: the worst miss [mm], processor time [s], whether it was told to be reached."""

    name: str
    goals: tuple[Goal, ...]
    miss: float
    seconds: float
    answers: int
    told: bool


def bodies(folder: Path | None) -> Iterator[Stages]:
    """Yield the bodies, built; a scan on which no bust is found is left out."""
    found = (
        []
        if folder is None
        else sorted(path for path in folder.iterdir() if path.suffix.removeprefix(".") in FORMATS)
    )
    for design in (*map(sample_design, SAMPLES), *(Design(ScanSource(str(path))) for path in found)):
        try:
            yield build(replace(design, volume="exact", lines=()))
        except UserError as why:
            print(f"left out: {design.scan.name}: {why}")


def worn(rng: np.random.Generator, stages: Stages) -> Stages:
    """Return a design of two to four lines, or pairs of lines, that move anything, all at 100 %."""
    contact = str(rng.choice(["glued", "sliding"]))
    base = replace(stages.design, line_contact=contact)
    while True:
        presets = [*built_in(), None]
        preset = presets[rng.integers(len(presets))]
        design = base if preset is None else with_preset(base, preset)
        for line in stages.model.lines if preset is None else ():
            if line.constrains:
                design = design.with_line(line.name, 1.0)
        for name in sorted(design.active_lines()):
            design = design.with_line(name, 1.0)
        dressed = build(design, stages)
        if 2 <= len(free_lines(dressed)) <= 4:
            return dressed


def of_elastic(rng: np.random.Generator, stages: Stages) -> Stages:
    """Return a design of the two lines of the template that move, each of some elastic, at 97 %."""
    design = replace(stages.design, line_contact=str(rng.choice(["glued", "sliding"])))
    for line in stages.model.lines:
        if line.constrains:
            design = design.with_line(line.name, LOOSE)
            design = design.with_elastic(line.name, find_elastic(str(rng.choice(ELASTICS))))
    return build(design, stages)


def known(rng: np.random.Generator, start: Stages) -> tuple[Stages, np.ndarray]:
    """Return a design with lengths by chance, and its control points, where the body looks natural."""
    while True:
        design = start.design
        elastic = start.design.active_elastics()
        for group in free_lines(start):
            low, high = (SHORTEST_ELASTIC, LOOSE) if elastic else (SHORTEST, 1.0)
            ratio = round(float(rng.uniform(low, high)), 4)
            for name in group:
                design = design.with_line(name, ratio)
        stages = build(design, start)
        solution = solve(stages)
        condition = solution.verdict.condition
        if solution.verdict.motion != "settled" or condition is None or not _calm(condition):
            continue
        points = solution.control_points
        if any(tension.mean < 0.0 for tension in line_tensions(stages, points).values()):
            continue
        if (
            not elastic
            or max(each.largest for each in pressures(stages, points).values()) < pressure_limits().red_kpa
        ):
            return stages, points


def _calm(condition: MeshQuality) -> bool:
    """Tell whether a body looks natural, and does not only just do so: that is as far as is asked for."""
    low, high = STRAINED_RANGE
    return condition.shortest > low + INSIDE and condition.longest < high - INSIDE and not condition.strained


def figures(rng: np.random.Generator, start: Stages) -> list[str]:
    """Return one to three figures by chance, no more than lines are free."""
    count = int(rng.integers(1, 1 + min(3, len(free_lines(start)))))
    return [str(name) for name in rng.choice(NAMES, count, replace=False)]


def profile(rng: np.random.Generator, start: Stages) -> list[str]:
    """Return the figures of a profile of some side, where the body can be reshaped."""
    heights = start.control.mesh.vertices[~start.control.fixed, 2]
    section = str(rng.choice(["left", "right"]))
    return [profile_name(section, height) for height in np.arange(heights.min(), heights.max(), HEIGHTS)]


def case(rng: np.random.Generator, start: Stages, *, curve: bool = False) -> Case:
    """Return how one question by chance is answered."""
    truth, points = known(rng, start)
    names = profile(rng, start) if curve else figures(rng, start)
    goals = tuple(Goal(name, reading(truth, name)(points).value) for name in names)
    if curve:  # as it comes from a table
        section, rows = names[0].split()[1], [(float(goal.name.split()[2]), goal.value) for goal in goals]
        goals = profile_goals(start, section, np.array(rows))
    begun = time.process_time()
    reply = solve_targets(start, goals)
    seconds = time.process_time() - begun
    solved = build(reply.design, start)
    after = solve(solved).control_points
    miss = max(abs(reading(solved, goal.name)(after).value - goal.value) for goal in goals)
    lines = ", ".join(f"{line.name} {100.0 * line.ratio:.1f}" for line in truth.design.lines)
    name = f"{start.design.scan.name}, {start.design.line_contact}, {lines}"
    return Case(name, goals, miss, seconds, reply.answers, reply.reachable)


def too_far(number: int, start: Stages, wished: Case) -> Case:
    """Return how a wish is answered that lies far from one that is known to be reached."""
    rng, names = np.random.default_rng(number), [goal.name for goal in wished.goals]
    if asks(wished, "profile "):
        heights = np.array([float(name.split()[2]) for name in names])
        middle, high = rng.uniform(heights.min(), heights.max()), rng.choice([-BUMP, BUMP])
        more = high * np.exp(-(((heights - middle) / WIDE) ** 2))
    else:
        more = TOO_FAR * rng.choice([-1.0, 1.0], size=len(names))
    goals = tuple(Goal(goal.name, goal.value + off) for goal, off in zip(wished.goals, more, strict=True))
    begun = time.process_time()
    reply = solve_targets(start, goals)
    seconds = time.process_time() - begun
    return Case(wished.name, goals, reply.miss, seconds, reply.answers, reply.reachable)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--elastic", type=int, default=40, metavar="N", help="N more with lines of elastic")
    parser.add_argument("--put", action="store_true", help="put the table into RESULTS.md")
    options = parser.parse_args()
    rng = np.random.default_rng(2027)
    on, cases, made, far = list(bodies(options.folder)), [], [], []
    for number in range(options.cases + options.elastic):
        elastic = number >= options.cases
        dressed = (of_elastic if elastic else worn)(rng, on[number % len(on)])
        curve = not elastic and number % 4 == 3
        (made if elastic else cases).append(done := case(rng, dressed, curve=curve))
        far.append(missed := too_far(number, dressed, done))
        for each in (done, missed):
            show(each)
    girths = [each for each in cases if GIRTH in {goal.name for goal in each.goals}]
    groups = {
        "all": cases,
        "glued": [each for each in cases if ", glued, " in each.name],
        "sliding": [each for each in cases if ", sliding, " in each.name],
        "a girth and another figure": [each for each in girths if len(each.goals) == 2],
        "an apex, with or without others": [each for each in cases if asks(each, "apex ")],
        "a profile, every 5 mm": [each for each in cases if asks(each, "profile ")],
        "beside these: lines of elastic": made,
    }
    rows = [(name, *row(chosen)) for name, chosen in groups.items() if chosen]
    heads = ("", "cases", f"met within {MET} mm", "told to be reached", "largest miss", *TIMES, "answers")
    told, missed_told = table(heads, rows), unreached(far, options.cases)
    print(told, missed_told, sep="\n\n")
    if options.put:
        put("asked", told)
        put("unreached", missed_told)


def show(case: Case) -> None:
    """Print one question and how it was answered."""
    goals = ", ".join(f"{goal.name} {goal.value:.1f}" for goal in case.goals[:3])
    told = "" if case.told else ", told not to be reached"
    print(
        f"{case.miss:8.4f} mm {1e3 * case.seconds:6.0f} ms {case.answers:3} {case.name}: {goals}{told}",
        flush=True,
    )


def unreached(far: list[Case], rigid: int) -> str:
    """Return the table of wishes that cannot be reached; the first ``rigid`` are of lines of no elastic."""
    groups = {
        "figures": [each for each in far[:rigid] if not asks(each, "profile ")],
        "profiles": [each for each in far[:rigid] if asks(each, "profile ")],
        "figures, lines of elastic": far[rigid:],
    }
    rows = []
    for name, asked in groups.items():
        if chosen := [each for each in asked if not each.told]:
            late = sum(each.seconds > SOON for each in chosen)
            rows.append((name, str(len(chosen)), *times(chosen), str(late), answers(chosen)))
    heads = ("", "not to be reached", *TIMES, f"more than {1e3 * SOON:.0f} ms", "answers")
    return table(heads, rows)


def asks(case: Case, begins: str) -> bool:
    """Tell whether any figure of a case has a name that begins so."""
    return any(goal.name.startswith(begins) for goal in case.goals)


def row(cases: list[Case]) -> tuple[str, ...]:
    """Return what holds for some cases."""
    return (
        str(len(cases)),
        str(sum(each.miss <= MET for each in cases)),
        str(sum(each.told for each in cases)),
        f"{max(each.miss for each in cases):.3f} mm",
        *times(cases),
        answers(cases),
    )


def times(cases: list[Case]) -> tuple[str, ...]:
    """Return how long answers took, as ``TIMES`` name it."""
    ms = [1e3 * each.seconds for each in cases]
    return tuple(f"{each:.0f} ms" for each in (statistics.median(ms), np.quantile(ms, 0.95), max(ms)))


def answers(cases: list[Case]) -> str:
    """Return how many exact answers were worked out for one, in the middle."""
    return f"{statistics.median(each.answers for each in cases):.0f}"


if __name__ == "__main__":
    main()
