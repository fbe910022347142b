"""Make pairs of scans with known numbers of tissue and lines, and find these again: how well, how long.

Run: python benchmarks/bench_calibrate.py [FOLDER] [--cases N]; scans of a folder come to the two samples.
In each case a garment, its lengths and the true numbers are drawn by chance. The second scan is what they
predict, with 1 mm of noise at each vertex along each axis, on another mesh, elsewhere, turned, with a hole in
the front and without arms; it goes through a file. The design begins with the usual numbers.
Prints a line for each case, then how far alignment and numbers are off; --put puts that into
docs/calibrate.md.
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
from worn_pairs import scanned, worn_mesh, written

from core.calibration import calibrate, read_worn
from core.design import Design, ScanSource
from core.elastics import find_elastic
from core.errors import UserError
from core.pipeline import Stages, build
from core.worn_scan.numbers import (
    FIRM_CHEST,
    LINE_STIFFNESS,
    PRESTRESS,
    STIFFNESS,
    TISSUE,
    Number,
    candidates,
)

GARMENTS = ("glued", "sliding", "prestressed", "one line", "elastic", "one roll")
GOOD = 0.05


@dataclass(frozen=True)
class Off:
    """One number of one case: how far off in parts of it, its ± in parts, whether it was told at all."""

    kind: str
    off: float
    plus_minus: float
    told: bool


@dataclass(frozen=True)
class Case:
    """One pair: errors of the alignment, of the numbers, rms [mm] before and after, processor time [s]."""

    garment: str
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
    for number in candidates(stages, lengths=False, each=each):
        if number.kind == FIRM_CHEST:
            value = float(rng.uniform(0.03, 0.15))
        elif number.kind == PRESTRESS:
            value = float(rng.uniform(0.35, 0.75))
        elif number.kind == TISSUE:
            value = float(rng.uniform(300.0, 900.0))
        else:
            value = float(np.exp(rng.uniform(np.log(4.0), np.log(20.0))))
        design = number.put(design, value)
    return design


def case(rng: np.random.Generator, base: Stages, kind: str, folder: Path) -> Case:
    """Make a pair and find its numbers."""
    stages = build(garment(rng, base.design, kind), base)
    truth = truth_of(rng, stages, each=kind != "one roll")
    mesh, matrix = scanned(worn_mesh(stages, truth), stages, rng)
    path = written(mesh, folder / "worn.ply")
    begun = time.process_time()
    worn = read_worn(stages, ScanSource(path, unit="mm"))
    found = calibrate(stages, worn)
    seconds = time.process_time() - begun
    # Reading sets it upright: its frame is not that of the file.
    back = worn.alignment.matrix @ worn.body.pose.file_to_mm @ matrix
    turn = float(np.degrees(np.linalg.norm([back[2, 1], back[0, 2], back[1, 0]])))
    middle = np.append(stages.control.mesh.vertices.mean(axis=0), 1.0)
    shift = float(np.linalg.norm((back @ middle - middle)[:3]))
    before, after = found.before.all_of_it.rms, found.after.all_of_it.rms
    return Case(kind, turn, shift, tuple(offs(stages, truth, found)), before, after, seconds)


def offs(stages, truth, found):
    """Yield how far off each number is."""
    every = [*candidates(stages, lengths=False, each=True), *candidates(stages, lengths=False, each=False)]
    by_name: dict[str, Number] = {number.name: number for number in every}
    for one in found.calibration.numbers:
        number = by_name[one.name]
        stiffness = number.kind in (STIFFNESS, LINE_STIFFNESS)
        kind = "stiffness of lines" if stiffness else number.kind.replace("_", " ")
        # One that was found for all lines is held against that of each.
        of = [Number(STIFFNESS, (line,)) for line in number.lines] if stiffness else [number]
        for each in of:
            yield Off(kind, one.after / each.of(truth) - 1.0, one.plus_minus / one.after, not one.kept)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--cases", type=int, default=33)
    parser.add_argument("--put", action="store_true", help="put the table into docs/calibrate.md")
    options = parser.parse_args()
    rng = np.random.default_rng(606)
    on, cases = list(bodies(options.folder)), []
    with tempfile.TemporaryDirectory() as folder:
        for at in range(options.cases):
            base, kind = on[at % len(on)], GARMENTS[at % len(GARMENTS)]
            try:
                done = case(rng, base, kind, Path(folder))
            except UserError as why:
                print(f"no pair: {base.design.scan.name}, {kind}: {why}", flush=True)
                continue
            cases.append(done)
            numbers = ", ".join(
                f"{each.kind} {100.0 * each.off:+.1f} ±{100.0 * each.plus_minus:.1f} %"
                if each.told
                else f"{each.kind} not told"
                for each in done.numbers
            )
            print(
                f"{base.design.scan.name}, {kind}: {done.degrees:.3f} deg, {done.mm:.3f} mm, "
                f"{done.before:.2f} -> {done.after:.2f} mm, {done.seconds:.1f} s: {numbers}",
                flush=True,
            )
    told = summary(cases)
    print(told)
    if options.put:
        put("calibrate.md", "calibrated", told)


def summary(cases: list[Case]) -> str:
    """Return the tables of all cases."""
    turns, shifts, seconds = (
        np.array([getattr(each, key) for each in cases]) for key in ("degrees", "mm", "seconds")
    )
    head = (
        f"Of {len(cases)} pairs the alignment is off by {turns.mean():.3f} degrees in the mean, "
        f"{turns.max():.3f} at most, and {shifts.mean():.2f} mm in the mean, {shifts.max():.2f} at most; "
        f"reading, aligning and fitting took {np.median(seconds):.1f} s of processor time in the middle."
    )
    rows = []
    numbers = [(case, number) for case in cases for number in case.numbers]
    for kind in dict.fromkeys(number.kind for _, number in numbers):
        rows.append(row(kind, [number for _, number in numbers if number.kind == kind]))
    rows.append(row("all", [number for _, number in numbers]))
    sharp = [number for _, number in numbers if number.told and number.plus_minus <= GOOD]
    rows.append(row("of these with ± of 5 % or less", sharp))
    heads = ("number", "pairs", "told", "within 5 %", "in the middle", "at 95 %", "at most", "within its ±")
    return f"{head}\n\n{table(heads, rows)}"


def row(kind: str, numbers: list[Off]) -> tuple[str, ...]:
    """Return what holds for some numbers."""
    told = [number for number in numbers if number.told]
    off = np.abs([number.off for number in told])
    if not told:
        return (kind, str(len(numbers)), "0", "", "", "", "", "")
    within = sum(abs(number.off) <= number.plus_minus for number in told)
    figures = (np.median(off), np.quantile(off, 0.95), off.max())
    return (
        kind,
        str(len(numbers)),
        str(len(told)),
        f"{(off <= GOOD).sum()}",
        *(f"{100.0 * each:.1f} %" for each in figures),
        f"{within}",
    )


if __name__ == "__main__":
    main()
