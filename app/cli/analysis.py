"""The commands that advise: how far lines can go, what to change, which lengths lead to what is wished."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace

from app.cli.exit_code import SETTLED, told
from app.cli.input import design_of
from app.cli.options import dressed, made_of


def ask(options: argparse.Namespace) -> int:
    """Find the lengths of lines that bring the body to what is wished, and print them."""
    from app.cli.commands.ask import AskWishes, asked_text, run_ask

    bounds = options.lock or [], options.shortest or [], options.pressure, options.optional or []
    wishes = AskWishes(options.want or [], options.profile or [], *bounds, options.out)
    design = design_of(options.input, options)
    asked = run_ask(options.input, design, options.line or [], options.elastic or [], wishes)
    return told(asked_text(asked, options.json), asked.reply.reachable, [])


def calibrate(options: argparse.Namespace) -> int:
    """Compare a design with a scan of the garment as worn, and find the numbers that predict it."""
    from app.cli.commands.calibrate import WornScan, calibrated_text, run_calibrate
    from core.document.design import ScanSource

    axes = {"unit": options.worn_unit, "up": options.worn_up, "front": options.worn_front}
    how = {"lengths": options.lengths, "one_roll": options.one_roll, "out": options.out}
    worn = WornScan(ScanSource(options.worn, **axes), options.thickness, **how)
    design, lengths, elastics = design_of(options.input, options), options.line or [], options.elastic or []
    done = run_calibrate(options.input, design, lengths, elastics, worn)
    return told(calibrated_text(done, options.json), done.found.helped, [])


def doctor(options: argparse.Namespace) -> int:
    """Tell what is wrong with a design, what fights in it, and the smallest change that ends it."""
    from app.cli.commands.diagnose import examined_text, run_doctor

    design = design_of(options.input, options)
    design = replace(design, volume=options.volume or design.volume)
    examined = run_doctor(options.input, design, options.line or [], options.elastic or [], options.out)
    return told(examined_text(examined, options.json), examined.helped, [])


def even(options: argparse.Namespace) -> int:
    """Tell how left and right differ, and find the lengths that make them alike."""
    from app.cli.commands.symmetry import even_text, run_even

    design, lengths, elastics = design_of(options.input, options), options.line or [], options.elastic or []
    found = run_even(options.input, design, lengths, elastics, make=options.make, out=options.out)
    well = found.settled and (found.enough or not options.make)
    return told(even_text(found, options.json, made=options.make), well, found.warnings)


def limits(options: argparse.Namespace) -> int:
    """Print how far each line can go: where it strains, folds, vibrates, presses too much or is slack."""
    from app.cli.commands.limits import limits_text
    from core.analysis.length_limits.limits import all_limits
    from core.garment.assessment import assessed
    from core.pipeline.build import build
    from core.pipeline.solve import run

    design = design_of(options.input, options)
    stages = build(design)
    worn = dressed(design, stages.model.lines, options.line or [])
    stages = build(made_of(worn, options.elastic or []), stages)
    print(limits_text(list(all_limits(stages)), stages, assessed(run(stages)), options.json))
    return SETTLED


def spread(options: argparse.Namespace) -> int:
    """Tell how far the figures of a design may be off, from which sources, and what is left out."""
    from app.cli.commands.uncertainty import run_spread, spread_text

    design, lengths, elastics = design_of(options.input, options), options.line or [], options.elastic or []
    found = run_spread(design, lengths, elastics, options.assume or [])
    kind = "json" if options.json else "csv" if options.csv else ""
    return told(spread_text(found, kind, options.out), found.worn.settled, found.worn.warnings)


ADVICE: dict[str, Callable[[argparse.Namespace], int]] = {
    "ask": ask,
    "calibrate": calibrate,
    "doctor": doctor,
    "even": even,
    "limits": limits,
    "spread": spread,
}
"""Each command that advises, with what does it."""
