"""Make pairs of scans with known numbers of tissue and lines, and find these again: how well, how long.

Run: python benchmarks/bench_calibrate.py [FOLDER] [--cases N]; scans of a folder come to the two samples.
In each case a garment, its lengths and the true numbers are drawn by chance. The second scan is what they
predict, with 1 mm of noise at each vertex along each axis, on another mesh, elsewhere, turned, with a hole in
the front and without arms; it goes through a file. It has a point to each square of --spacing, 2 mm if
nothing is said, or with 0 about as many as the sample bodies. The design begins with the usual numbers.
--before tells what the first scan is: clean, noisy as the second with the garment lying alike on both, or
apart: noisy, and the garment lies where it would on the clean body, while Busk finds its places on the other.
--bent bends the second scan smoothly, waves of 150 to 300 mm, as breath or posture would.
Prints a line for each case, then how far alignment and numbers are off; --put puts that into
RESULTS.md.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from bench_ask import bodies
from pages import put, table
from worn_pairs import bent, rough, scanned, worn_mesh, written

from core.analysis.calibration.api import calibrate, read_fitting_scan
from core.analysis.calibration.parameters import (
    FIRM_CHEST,
    LINE_STIFFNESS,
    PRESTRESS,
    STIFFNESS,
    TISSUE,
    Parameter,
    candidate_parameters,
)
from core.analysis.calibration.registration import transform_points
from core.document.design import Design, ScanSource
from core.errors import UserError
from core.garment.elastic_library import find_elastic
from core.pipeline.build import Stages, build

GARMENTS = ("glued", "sliding", "prestressed", "one line", "elastic", "one roll")
GOOD = 0.05
MARKS = {"clean": "calibrated", "noisy": "calibrated from noise", "apart": "calibrated apart"}


@dataclass(frozen=True)
class Off:
    """One number of one case: how far off in parts of it, its ± in parts; ``found``, and ``told`` well."""

    kind: str
    off: float
    plus_minus: float
    found: bool
    told: bool


@dataclass(frozen=True)
class Case:
    """One pair: ``points`` on the moving skin, errors of alignment and numbers, rms [mm], time [s]."""

    garment: str
    points: int
    degrees: float
    mm: float
    numbers: tuple[Off, ...]
    before: float
    after: float
    seconds: float


def garment(rng: np.random.Generator, base: Design, kind: str) -> Design:
    """Return a design of a kind of garment, with the usual numbers."""
    design = replace(base, lines=(), firm_chest=0.05).with_line("mid-bust", float(rng.uniform(0.82, 0.9)))
    if kind != "one line":
        design = design.with_line("full-bust", float(rng.uniform(0.86, 0.92)))
    if kind in ("sliding", "prestressed"):
        design = replace(design, line_contact="sliding")
    if kind == "prestressed":
        design = replace(design, member_law="prestressed")
    if kind == "elastic":
        design = design.with_elastic("mid-bust", find_elastic("plush 12"))
        design = design.with_line("mid-bust", float(rng.uniform(0.7, 0.8)))
    return design


def truth_of(rng: np.random.Generator, stages: Stages, *, each: bool = True) -> Design:
    """Return the design with true numbers by chance; ``each`` line has a stiffness of its own."""
    design = stages.design
    for number in candidate_parameters(stages, lengths=False, each=each):
        if number.kind == FIRM_CHEST:
            value = float(rng.uniform(0.03, 0.15))
        elif number.kind == PRESTRESS:
            value = float(rng.uniform(0.35, 0.75))
        elif number.kind == TISSUE:
            value = float(rng.uniform(300.0, 900.0))
        else:
            value = float(np.exp(rng.uniform(np.log(4.0), np.log(20.0))))
        design = number.with_value(design, value)
    return design


def case(
    rng: np.random.Generator,
    base: Stages,
    kind: str,
    folder: Path,
    spacing: float,
    before: str = "clean",
    height: float = 0.0,
) -> Case:
    """Make a pair, its scans with a ``spacing`` [mm], and find its numbers; see the head for the rest."""
    stages = real = build(garment(rng, base.design, kind), base)
    truth, finer = truth_of(rng, stages, each=kind != "one roll"), 2 if spacing else 0
    if before != "clean":
        first = written(rough(real.body.mesh, rng, spacing), folder / "first.ply")
        stages = build(replace(stages.design, scan=ScanSource(first, unit="mm")))
    here = stages.body.pose.file_to_mm if stages is not real else np.eye(4)
    if before == "noisy":
        skin = real.body.mesh.moved(transform_points(here, real.body.mesh.vertices))
        worn_skin = worn_mesh(stages, replace(truth, scan=stages.design.scan), finer, skin)
    else:
        worn_skin = worn_mesh(real, truth, finer)
        worn_skin = worn_skin.moved(transform_points(here, worn_skin.vertices))
    if height:
        worn_skin = bent(worn_skin, rng, height)
    mesh, matrix = scanned(worn_skin, stages, rng, spacing=spacing)
    path = written(mesh, folder / "worn.ply")
    begun = time.process_time()
    worn = read_fitting_scan(stages, ScanSource(path, unit="mm"))
    found = calibrate(stages, worn)
    seconds = time.process_time() - begun
    # Reading sets it upright: its frame is not that of the file.
    back = worn.alignment.matrix @ worn.body.pose.file_to_mm @ matrix
    turn = float(np.degrees(np.linalg.norm([back[2, 1], back[0, 2], back[1, 0]])))
    middle = np.append(stages.control.mesh.vertices.mean(axis=0), 1.0)
    shift = float(np.linalg.norm((back @ middle - middle)[:3]))
    rms = found.before.total.rms, found.after.total.rms
    return Case(kind, found.met, turn, shift, tuple(offs(stages, truth, found)), *rms, seconds)


def offs(stages, truth, found):
    """Yield how far off each number is."""
    every = [
        *candidate_parameters(stages, lengths=False, each=True),
        *candidate_parameters(stages, lengths=False, each=False),
    ]
    by_name: dict[str, Parameter] = {number.name: number for number in every}
    for one in found.calibration.numbers:
        number = by_name[one.name]
        stiffness = number.kind in (STIFFNESS, LINE_STIFFNESS)
        kind = "line stiffness" if stiffness else number.kind.replace("_", " ")
        # One that was found for all lines is held against that of each.
        of = [Parameter(STIFFNESS, (line,)) for line in number.lines] if stiffness else [number]
        for each in of:
            yield Off(
                kind,
                one.after / each.value_in(truth) - 1.0,
                one.plus_minus / one.after,
                not one.kept,
                one.is_well_determined,
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--cases", type=int, default=36)
    parser.add_argument("--spacing", type=float, default=2.0, help="of the worn scan's points [mm]")
    parser.add_argument("--before", choices=MARKS, default="clean", help="what the first scan is")
    parser.add_argument("--bent", type=float, default=0.0, help="how far the second scan is bent [mm]")
    parser.add_argument("--put", action="store_true", help="put the table into RESULTS.md")
    options = parser.parse_args()
    on, cases = list(bodies(options.folder)), []
    with tempfile.TemporaryDirectory() as folder:
        for at in range(options.cases):
            base, kind = on[at % len(on)], GARMENTS[at % len(GARMENTS)]
            rng = np.random.default_rng([606, at])  # each pair by itself: the same at each spacing
            how = options.spacing, options.before, options.bent
            try:
                done = case(rng, base, kind, Path(folder), *how)
            except UserError as why:
                print(f"no pair: {base.design.scan.name}, {kind}: {why}", flush=True)
                continue
            cases.append(done)
            print(f"{base.design.scan.name}, {line_of(done)}", flush=True)
    told = summary(cases)
    print(told)
    if options.put:
        put(MARKS[options.before] if options.spacing else "calibrated coarsely", told)


def line_of(done: Case) -> str:
    """Return what is printed of a case."""
    numbers = ", ".join(
        f"{each.kind} {100.0 * each.off:+.1f} ±{100.0 * each.plus_minus:.1f} %"
        if each.found
        else f"{each.kind} not told"
        for each in done.numbers
    )
    return (
        f"{done.garment}: {done.points} points, {done.degrees:.3f} deg, {done.mm:.3f} mm, "
        f"{done.before:.2f} -> {done.after:.2f} mm, {done.seconds:.1f} s: {numbers}"
    )


def summary(cases: list[Case]) -> str:
    """Return the tables of all cases."""
    points, turns, shifts, seconds = (
        np.array([getattr(each, key) for each in cases]) for key in ("points", "degrees", "mm", "seconds")
    )
    head = (
        f"{len(cases)} pairs, {np.median(points):,.0f} points on the moving skin in the middle "
        f"({points.min():,} to {points.max():,}). The alignment is off by {turns.mean():.3f} degrees in the "
        f"mean, {turns.max():.3f} at most, and {shifts.mean():.2f} mm in the mean, {shifts.max():.2f} at "
        f"most; reading, aligning and fitting took {np.median(seconds):.1f} s of processor time in the "
        f"middle."
    )
    numbers = [number for case in cases for number in case.numbers]
    kinds = [
        (kind, [number for number in numbers if number.kind == kind])
        for kind in dict.fromkeys(number.kind for number in numbers)
    ]
    rows = [row(kind, every) for kind, every in (*kinds, ("all", numbers))]
    heads = (
        *("number", "all", "told to 5 %", "of these within 5 %", "in the middle", "at most"),
        *("told less surely", "in the middle", "at most", "not told", "found within ±"),
    )
    return f"{head}\n\n{table(heads, rows)}"


def row(kind: str, numbers: list[Off]) -> tuple[str, ...]:
    """Return what holds for some numbers."""
    found = [number for number in numbers if number.found]
    sharp, weak = ([each for each in found if each.told is told] for told in (True, False))
    good = sum(abs(each.off) <= GOOD for each in sharp)
    within = sum(abs(each.off) <= each.plus_minus for each in found)
    told = (str(len(sharp)), str(good), *sizes(sharp), str(len(weak)), *sizes(weak))
    return (kind, str(len(numbers)), *told, str(len(numbers) - len(found)), f"{within} of {len(found)}")


def sizes(numbers: list[Off]) -> tuple[str, str]:
    """Return how far off some numbers are in the middle and at most."""
    off = np.abs([number.off for number in numbers])
    return (f"{100.0 * np.median(off):.1f} %", f"{100.0 * off.max():.1f} %") if numbers else ("", "")


if __name__ == "__main__":
    main()
