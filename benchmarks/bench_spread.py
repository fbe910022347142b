"""How far the two ways to a spread differ at its real sizes: propagated by derivatives, and sampled.

    python benchmarks/bench_spread.py [FOLDER_OR_SCAN ...] [--draws 60] [--quick]

Both samples, or the scans given. Each is worn with three lines, two of them made of an elastic, glued and
sliding; ``--quick`` is the first design alone. Every figure is told twice, and what one draws out of so many
draws is sure to about 1 / sqrt(2 draws) of it. Of each kind of figure it is told too what part of the draws
lies within what is told of it, be it a ± or a range: 95 % if errors are normal. The table of RESULTS.md
comes last.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from core.analysis.uncertainty.estimate import UncertaintyEstimator
from core.analysis.uncertainty.input_uncertainty import default_uncertainty
from core.analysis.uncertainty.model_error import model_errors
from core.analysis.uncertainty.monte_carlo import Samples, sample
from core.analysis.uncertainty.parameters import perturb, uncertain_parameters
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.document.design import Design, ScanSource
from core.errors import UserError
from core.garment.elastic_library import find_elastic
from core.measurements.uncertain_value import (
    AFTER,
    BEFORE,
    CHANGE,
    CUT,
    FORCES,
    LIFT,
    MAX_KPA,
    MEAN_KPA,
    OUT,
    ROOT,
    TENSION,
    OutputUncertainties,
)
from core.pipeline.build import Stages, build

SAMPLES = Path(__file__).resolve().parents[1] / "resources" / "samples"
SCANS = (".ply", ".obj", ".stl", ".off")
SHOWN = (
    *("before:bust_girth", "after:bust_girth", "change:bust_girth", "after:underbust_girth", "lift", "out"),
    *("change:cup_depth_left", "after:apex_lift", "cut:full-bust", "tension:mid-bust", "tension:full-bust"),
    "max_kpa:mid-bust",
)
KINDS = (BEFORE, AFTER, CHANGE, LIFT, OUT, CUT, TENSION, MEAN_KPA, MAX_KPA)


def designs(scan: Path) -> Iterator[tuple[str, Design]]:
    """Yield what each body wears: lines of tissue alone, and lines of an elastic, both contacts."""
    elastic = find_elastic("plush 12")
    plain = Design(ScanSource(str(scan))).with_line("mid-bust", 0.95)
    worn = plain.with_line("full-bust", 0.9).with_line("under-bust", 0.85)
    made = worn.with_elastic("full-bust", elastic).with_elastic("under-bust", elastic)
    for contact in ("glued", "sliding"):
        yield f"one line, {contact}", _touching(plain, contact)
        yield f"three lines, {contact}", _touching(made, contact)


def _touching(design: Design, contact: str) -> Design:
    return replace(design, line_contact=contact)


def measure(name: str, stages: Stages, draws: int) -> str:
    """Print how both ways spread one design; returns its row of the table."""
    trials = PerturbedSolutions(stages)
    begun = time.process_time()
    spread = UncertaintyEstimator(trials).estimate()
    told = time.process_time() - begun
    begun = time.process_time()
    sizes = default_uncertainty()
    turning = [*uncertain_parameters(stages, sizes), *model_errors(trials, sizes)]
    found = sample(trials, turning, draws)
    drawn = time.process_time() - begun
    sds = found.deviations()
    print(f"\n{name}: propagated in {told:.1f} s of a processor, {draws} draws in {drawn:.0f} s")
    print(
        f"  no answer: {spread.failed} knobs, {found.failed} draws; "
        f"skin ± {spread.sds * spread.skin.max():.2f} mm at most"
    )
    for key in SHOWN:
        if key in sds and key in spread.by_output:
            off = spread.sds * spread.by_output[key].sd  # of forces too, which are told as a range
            print(f"  {key:24} ± {off:7.2f}   sampled {spread.sds * sds[key]:7.2f}")
    cells = {}
    # As in the draws all landmarks are placed: a fold that is placed leads the root another way by itself.
    base = trials(perturb(stages, dict.fromkeys(turning, 0.0))).values
    for kind in KINDS:
        of_kind = [(key, ratio) for key, ratio in _ratios(spread, sds) if _kind(key) == kind]
        if of_kind:
            low, middle, high = np.percentile([ratio for _, ratio in of_kind], [5, 50, 95])
            within = [_within(spread, found, key, base[key]) for key, _ in of_kind]
            share = f"{100.0 * np.median(within):.0f} % (least {100.0 * min(within):.0f} %)"
            least = of_kind[int(np.argmin(within))][0]
            print(
                f"  {kind:9} {len(of_kind):3} figures, propagated over sampled: "
                f"{middle:.2f} ({low:.2f} to {high:.2f}); within what is told: {share}, {least}"
            )
            cells[kind] = f"{middle:.2f}; {100.0 * np.median(within):.0f} / {100.0 * min(within):.0f} %"
    row = [cells.get(kind, "") for kind in (BEFORE, AFTER, CHANGE, LIFT, CUT, TENSION, MAX_KPA)]
    return f"| {name} | " + " | ".join((*row, str(found.failed))) + " |"


def _kind(key: str) -> str:
    return key.partition(":")[0].partition(" ")[0]


def _within(spread: OutputUncertainties, found: Samples, key: str, base: float) -> float:
    """Return what part of the draws lies where the figure is told to lie; roots are not sampled."""
    values, kind = found.values(key), _kind(key)
    if kind in FORCES:
        low, high = spread.between(key, base) or (0.0, 0.0)
    else:
        parts = [each for source, each in spread.by_output[key].by_source.items() if source != ROOT]
        off = spread.sds * float(np.hypot.reduce(parts))
        low, high = base - off, base + off
    return float(((values >= low) & (values <= high)).mean())


def _ratios(spread: OutputUncertainties, sds: dict[str, float]) -> Iterator[tuple[str, float]]:
    """Yield propagated over sampled of each figure that is off by more than a hair; roots are not sampled."""
    for key, sd in sds.items():
        doubt = spread.by_output.get(key)
        if doubt is not None and sd > 1e-3:
            parts = [each for source, each in doubt.by_source.items() if source != "root"]
            yield key, float(np.hypot.reduce(parts)) / sd


def main() -> None:
    """Measure all bodies."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scans", nargs="*", type=Path, default=[SAMPLES])
    parser.add_argument("--draws", type=int, default=60)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    files = [
        file
        for place in options.scans
        for file in (sorted(place.iterdir()) if place.is_dir() else [place])
        if file.suffix in SCANS
    ]
    rows = []
    for scan in files:
        for name, design in designs(scan):
            try:
                rows.append(measure(f"{scan.stem}, {name}", build(design), options.draws))
            except UserError as problem:
                print(f"\n{scan.stem}, {name}: {problem}")
            if options.quick:
                break
            sys.stdout.flush()
    heads = (
        "",
        "before",
        "after",
        "change",
        "lift",
        "cut length",
        "tension",
        "largest pressure",
        "failed",
    )
    print("\n| " + " | ".join(heads) + " |\n|" + "---|" * len(heads))
    print("\n".join(rows))


if __name__ == "__main__":
    main()
