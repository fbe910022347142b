"""Compute size groups, increments and grade rules from the results of a batch run."""

from __future__ import annotations

import argparse
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator, Sequence
from fnmatch import fnmatchcase
from pathlib import Path

from app.batch.compared_designs import VERDICTS
from app.batch.grade_files import write_gradings
from app.batch.grade_page import coverage_sentence, grade_page, headline, service_sentences, step_text
from app.batch.graded_bodies import (
    BAND,
    CUP,
    GRADED,
    GROUPINGS,
    SIZE,
    SYSTEMS,
    graded_bodies,
    grouping_of,
    measures_of,
)
from app.batch.grading import FitMeasure, Grading, ServiceOptions, grading_of
from app.batch.results import Results, chosen_variants, read_results, with_mean_sides
from app.cli.output import DONE, make_folder, table_lines, warn
from core.analysis.grading.service import GARMENTS, RULE
from core.analysis.grading.tolerance import USUAL
from core.files.atomic_write import write_text

PAGE = "grade.html"
BOTH_SIDES, MEAN_SIDES = "both", "mean"
MEASURE_HELP = (
    f"columns of the table to grade, with * for any text; may be repeated (default: {', '.join(GRADED)})"
)
TOLERANCE_HELP = (
    "deviation of a garment at which it still serves a body, of the body's own measure "
    f"(default: {100.0 * USUAL:g})"
)
FIT_HELP = (
    "measures that decide whom a size serves, if wanted with their own tolerance, such as 'seam_wire*=8'; "
    "may be repeated (default: cut lengths but those of straps, and seams)"
)
GARMENT_HELP = "garments of sizes: by the grade rule (default), or the mean of the bodies of the size"


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk grade``."""
    parser.add_argument("results", metavar="RESULTS", help="output folder of busk batch")
    by = "group bodies by band and cup (default), by band or by cup"
    parser.add_argument("--by", choices=GROUPINGS, default=SIZE, help=by)
    parser.add_argument("--system", choices=SYSTEMS, default="jp", help="size system (default: jp)")
    variant = "grade only this variant; may be repeated"
    parser.add_argument("--variant", action="append", metavar="NAME", help=variant)
    verdict = "grade only bodies with this verdict, such as good; may be repeated"
    parser.add_argument("--verdict", action="append", choices=VERDICTS, help=verdict)
    parser.add_argument("--measure", action="append", metavar="COLUMN", help=MEASURE_HELP)
    without = "columns to leave out, such as 'cut_length_strap*'; may be repeated"
    parser.add_argument("--without", action="append", metavar="COLUMN", help=without)
    sides = "grade left and right by themselves (default), or their mean, as garments are symmetric"
    parser.add_argument("--sides", choices=(BOTH_SIDES, MEAN_SIDES), default=BOTH_SIDES, help=sides)
    parser.add_argument(
        "--tolerance", type=_percent, metavar="PERCENT", default=100.0 * USUAL, help=TOLERANCE_HELP
    )
    parser.add_argument("--fit", type=_fit, action="append", metavar="COLUMN[=PERCENT]", help=FIT_HELP)
    parser.add_argument("--garments", choices=GARMENTS, default=RULE, help=GARMENT_HELP)
    serve = "share of bodies that new sizes are to serve (default: 90)"
    parser.add_argument("--serve", type=_percent, metavar="PERCENT", default=90.0, help=serve)
    parser.add_argument("--out", metavar="PLACE", help="output folder (default: grade in the results)")


def _percent(text: str) -> float:
    try:
        number = float(text.removesuffix("%"))
    except ValueError:
        number = 0.0
    if not 0.0 < number <= 100.0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number above 0 and up to 100")
    return number


def _fit(text: str) -> FitMeasure:
    pattern, equals, percent = text.rpartition("=")
    return FitMeasure(pattern, _percent(percent) / 100.0) if equals else FitMeasure(text)


def run(options: Namespace) -> int:
    """Grade the variants of a run and write tables and page. Raises UserError."""
    chosen = chosen_variants(read_results(Path(options.results)), options.variant)
    gradings = [_grading(each, options) for each in chosen]
    folder = make_folder(options.out if options.out is not None else str(Path(options.results) / "grade"))
    write_gradings(folder, gradings)
    write_text(folder / PAGE, grade_page(gradings))
    warn(_unused(gradings, options))
    for each in gradings:
        print("\n".join([*_text(each), ""]))
    print(f"written to {folder}", flush=True)
    return DONE


def _unused(gradings: Sequence[Grading], options: Namespace) -> Iterator[str]:
    """Yield a warning for each column that was requested and that no design has."""
    names = {measure.name for each in gradings for measure in each.graded.bodies.measures}
    requested = [("--measure", each) for each in options.measure or []]
    requested += [("--fit", each.pattern) for each in options.fit or []]
    for option, pattern in requested:
        if not any(fnmatchcase(name, pattern) for name in names):
            yield f"{option} {pattern} is none of the graded measures."


def _grading(results: Results, options: Namespace) -> Grading:
    results = with_mean_sides(results) if options.sides == MEAN_SIDES else results
    measures = measures_of(results, options.measure or [], options.without or [])
    graded = graded_bodies(results, grouping_of(options.by, options.system), measures, options.verdict or [])
    service = ServiceOptions(
        options.tolerance / 100.0, options.garments, options.serve / 100.0, tuple(options.fit or ())
    )
    return grading_of(graded, service)


def _text(grading: Grading) -> list[str]:
    by, label = grading.graded.grouping.by, grading.graded.grouping.label
    bands, cups = by != CUP, by != BAND
    heading = ["measure", f"at {label(grading.rules[0].base)}", *["per band"] * bands, *["per cup"] * cups]
    rows = [[*heading, "spread"]]
    for rule in grading.rules:
        steps = [*[step_text(rule.per_band)] * bands, *[step_text(rule.per_cup)] * cups]
        row = ["" if each is None else f"{each:.1f}" for each in (rule.at_base, rule.residual)]
        rows.append([rule.measure.name, row[0], *steps, row[1]])
    head = [f"{grading.graded.variant}: {headline(grading)}", *table_lines(rows)]
    return [*head, *service_sentences(grading), coverage_sentence(grading)]
