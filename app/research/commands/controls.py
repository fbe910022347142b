"""Compare all volume controls: a table with a row for each case, and a page that summarizes them."""

from __future__ import annotations

import csv
import sys
import time
from argparse import ArgumentParser, Namespace
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import astuple, fields
from itertools import product
from pathlib import Path
from statistics import median

from app.cli.options import add_folder_output
from app.cli.output import DONE, make_folder
from app.presenters.samples import SAMPLES, sample_design
from app.research.control_study import LONGEST, RIPPLE_TURNS, TRIED_CONTROLS, TURNS, Subject, Trial, trials
from app.research.sphere import sphere_control
from core import __version__
from core.files.atomic_write import atomic_path, write_text
from core.mechanics.options import LAWS, ModelOptions
from core.pipeline.build import build
from core.pipeline.stages import GAIN_SHARE

LENGTHS = (1.10, 1.03, 0.97, 0.9, 0.8, 0.7, 0.6, 0.5)
STIFFNESSES = (4.0, 16.0, 64.0)
EXPLICIT_STIFFNESS = 0.2
"""Stiffness of a line whose force is kept during the turn: much more of it diverges."""

RIPPLE_LIMIT = 1e-5
MODEST = (0.9, 1.05)
"""Lengths between which a line is not called excessive [1]: shorter ones strain both sample bodies."""

HEADS = (
    *("control", "cases", "vibrating", "diverging", "settling", "settled", "final error median / max"),
    *("ripple max", "peak error median", "below 0.1 %", "below 0.01 %", "to exact median / max"),
)

HOW_TO_READ = (
    "*Vibrating, diverging, settling* and *settled* are the states after the last iteration. "
    "*Error*: of the volume, in % of the original volume. *Ripple*: its peak-to-peak over "
    f"the last {RIPPLE_TURNS} iterations. *Below*: the iteration after which the error "
    "remains below, median, and the share of cases; *exact* is below from its first step. "
    "*To exact*: maximum distance of a control point from the exact solution; stiff lines "
    "converge slowly after the volume error. Diverging cases are excluded from errors, "
    "ripple and distance."
)

WHAT_IS_CALM = (
    "*Calm*: neither vibrating nor diverging. The last three columns count the exact "
    "solutions with this defect of the control mesh: they are in equilibrium but do not "
    "represent a real body."
)


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk controls``."""
    parser.add_argument("--quick", action="store_true", help="run a few cases only")
    add_folder_output(parser)


def run(options: Namespace) -> int:
    """Write the table and the page."""
    run_trials(make_folder(options.out), options.quick)
    print(f"written to {options.out}")
    return DONE


def run_trials(out: Path, quick: bool = False) -> list[Trial]:
    """Write sweep.csv and sweep.md to ``out`` and return the trials; ``quick`` makes only a few.

    Raises UserError if something cannot be written.
    """
    lengths = (0.97, 0.6) if quick else LENGTHS
    chosen = list(subjects(quick))
    count = len(chosen) * len(lengths) * len(TRIED_CONTROLS)
    made: list[Trial] = []
    start = time.perf_counter()
    for subject in chosen:
        for trial in trials(subject, lengths, TRIED_CONTROLS):
            made.append(trial)
            left = (time.perf_counter() - start) * (count / len(made) - 1.0)
            print(f"\r{len(made)} of {count} cases, {left:.0f} s left ", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    with atomic_path(out / "sweep.csv") as partial:
        _write_rows(partial, made)
    write_text(out / "sweep.md", "\n".join(page(made, quick)) + "\n")
    return made


def subjects(quick: bool) -> Iterator[Subject]:
    """Yield the bodies with each choice of the model that is tried on them."""
    names = list(SAMPLES)[: 1 if quick else 2]
    bodies = [(name, build(sample_design(name)).control, "mid-bust") for name in names]
    bodies += [] if quick else [("sphere", sphere_control(), "horizontal")]
    choices = [("force-density", "explicit", EXPLICIT_STIFFNESS)]
    choices += [(law, "implicit", k) for law, k in product(LAWS, STIFFNESSES[1:2] if quick else STIFFNESSES)]
    for body, (law, force, stiffness) in product(bodies, choices):
        mechanics = ModelOptions(law, line_stiffness=stiffness, line_force=force, volume_of="both")
        yield Subject(*body, mechanics)


def _write_rows(path: Path, made: Sequence[Trial]) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow([field.name for field in fields(Trial)])
        for trial in made:
            cells = ("" if value is None else value for value in astuple(trial))
            writer.writerow([f"{cell:.6g}" if isinstance(cell, float) else cell for cell in cells])


def page(made: Sequence[Trial], quick: bool = False) -> Iterator[str]:
    """Yield the lines of the page on the trials."""
    yield from ("# Comparison of volume controls", "", _what_was_run(made, quick))
    yield from ("", "## Results", "")
    rows = ((control, *_summary([t for t in made if t.control == control])) for control in TRIED_CONTROLS)
    yield from _table(HEADS, rows)
    yield from ("", HOW_TO_READ, "", "## Stability by length", "")
    turned = tuple(control for control in TRIED_CONTROLS if control != "exact")
    heads = ("set length", *(f"{control}: calm" for control in turned), "folded", "inverted", "overstrained")
    ratios = sorted({trial.ratio for trial in made}, reverse=True)
    yield from _table(heads, (_by_length([t for t in made if t.ratio == r], r, turned) for r in ratios))
    yield from ("", WHAT_IS_CALM, "", "## Requirements", "")
    yield from (f"* {'kept' if kept else '**not kept**'}: {what}" for what, kept in promises(made))


def _what_was_run(made: Sequence[Trial], quick: bool) -> str:
    models = {(t.subject, t.member_law, t.line_force, t.line_stiffness) for t in made}
    soft, stiff = (
        _listed(t.line_stiffness for t in made if t.line_force == force) for force in ("explicit", "implicit")
    )
    return (
        f"Written by `busk controls{' --quick' if quick else ''}`, Busk {__version__}: {len(made)} cases. "
        f"One line is worn on each of {len(models)} models: "
        f"{', '.join(dict.fromkeys(t.subject for t in made))}; the member laws {', '.join(LAWS)} with lines "
        f"of stiffness {stiff}, and force density with a line force that is kept during the turn at "
        f"stiffness {soft}. It is set to {_listed(100.0 * t.ratio for t in made)} % of its rest length and "
        f"solved from rest in {TURNS} turns. The volume is held as a whole. *Conventional* has "
        f"{GAIN_SHARE:g} of the gain limit that is computed at rest, or the gain that is named. All that "
        "follows is computed from the rows of `sweep.csv`, one a case."
    )


def promises(made: Sequence[Trial]) -> list[tuple[str, bool]]:
    """Return each promise of the method with the figures that it came to, and whether it is kept."""
    adaptive, exact, plain = (
        [t for t in made if t.control == c] for c in ("adaptive", "exact", "conventional")
    )
    sane = [t for t in adaptive if not t.folded]
    worst = max(t.ripple for t in adaptive)
    restless = [t for t in sane if t.rest_at is None]
    slowest = max((t.rest_at or 0 for t in adaptive), default=0)
    shaking = [t for t in plain if t.motion == "vibrating"]
    modest = [t for t in shaking if MODEST[0] <= t.ratio <= MODEST[1]]
    found = sum(t.motion == "settled" for t in exact)
    bare = [t for t in made if t.control == "none" and t.motion == "vibrating"]
    return [
        (
            f"adaptive comes to rest in every case that is not folded: {len(sane) - len(restless)} of "
            f"{len(sane)}, the slowest of all cases after {slowest} turns (followed for up to {LONGEST})",
            not restless,
        ),
        (
            f"no ripple of adaptive over {RIPPLE_LIMIT:g}, folded or not: the largest is {worst:.1e}",
            worst <= RIPPLE_LIMIT,
        ),
        (
            f"exact balances in every case, folded or not: {found} of {len(exact)} in at most "
            f"{max(t.turns for t in exact)} steps, largest volume error {max(t.error for t in exact):.0e}",
            found == len(exact),
        ),
        (
            f"conventional at {GAIN_SHARE:g} of its limit vibrates only when the line is excessive, outside "
            f"{100.0 * MODEST[0]:g} to {100.0 * MODEST[1]:g} %: {len(shaking)} of {len(plain)} cases do, "
            f"{len(modest)} of them within",
            not modest,
        ),
        (f"without volume control nothing vibrates: {len(bare)} cases do", not bare),
    ]


def _summary(made: Sequence[Trial]) -> Iterator[str]:
    yield str(len(made))
    for motion in ("vibrating", "diverging", "settling", "settled"):
        yield str(sum(trial.motion == motion for trial in made))
    whole = [trial for trial in made if trial.motion != "diverging"]
    yield _middle_and_most([100.0 * t.error for t in whole], " %")
    yield _text(100.0 * max((t.ripple for t in whole), default=0.0)) + " %"
    yield _text(100.0 * median([t.peak for t in whole] or [0.0])) + " %"
    yield _arrival([t.calm_at for t in made])
    yield _arrival([t.calmer_at for t in made])
    yield _middle_and_most([t.away for t in whole], " mm")


def _by_length(made: Sequence[Trial], ratio: float, controls: Iterable[str]) -> Iterator[str]:
    yield f"{100.0 * ratio:g} %"
    for control in controls:
        of_it = [t for t in made if t.control == control]
        yield f"{sum(t.motion not in ('vibrating', 'diverging') for t in of_it)} of {len(of_it)}"
    shapes = [t for t in made if t.control == "exact"]
    for sign in ("folded", "inverted", "overstrained"):
        yield f"{sum(getattr(t, sign) for t in shapes)} of {len(shapes)}"


def _arrival(turns: Sequence[int | None]) -> str:
    there = [turn for turn in turns if turn is not None]
    return f"{median(there):g}; {100.0 * len(there) / len(turns):.0f} %" if there else "never"


def _middle_and_most(values: Sequence[float], unit: str) -> str:
    return f"{_text(median(values))} / {_text(max(values))}{unit}" if values else "-"


def _text(value: float) -> str:
    return f"{value:.0e}" if 0.0 < abs(value) < 1e-3 else f"{value:.3g}"


def _listed(values: Iterable[float]) -> str:
    return ", ".join(f"{value:g}" for value in dict.fromkeys(values))


def _table(heads: Sequence[str], rows: Iterable[Iterable[str]]) -> Iterator[str]:
    yield f"| {' | '.join(heads)} |"
    yield f"|{'---|' * len(heads)}"
    for row in rows:
        yield f"| {' | '.join(row)} |"
