"""Compare two designs body by body, from the results of one or two batch runs."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from app.batch.compare_files import write_comparison
from app.batch.compare_page import compare_page, sentences
from app.batch.compared_designs import compared_designs
from app.batch.results import Results, chosen_variants, read_results
from app.cli.output import DONE, make_folder
from core.errors import UserError
from core.files.atomic_write import write_text
from core.messages import Message

PAGE = "compare.html"
VARIANTS_HELP = "first and second design, by the names of the variants; needed where there are more than two"


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk compare``."""
    parser.add_argument("results", metavar="RESULTS", help="output folder of busk batch")
    second = "output folder of another run on the same scans, for the second design"
    parser.add_argument("second", metavar="RESULTS2", nargs="?", help=second)
    parser.add_argument("--variants", nargs=2, metavar="NAME", help=VARIANTS_HELP)
    out = "output folder (default: compare in the first results)"
    parser.add_argument("--out", metavar="PLACE", help=out)


def run(options: Namespace) -> int:
    """Compare two designs and write tables and page. Raises UserError."""
    found = compared_designs(*_designs(options))
    folder = make_folder(options.out if options.out is not None else str(Path(options.results) / "compare"))
    write_comparison(folder, found)
    write_text(folder / PAGE, compare_page(found))
    print("\n".join([*sentences(found), f"written to {folder}"]), flush=True)
    return DONE


def _designs(options: Namespace) -> tuple[Results, Results]:
    """Return the results of both designs. Raises UserError if it is not clear which are compared."""
    first = read_results(Path(options.results))
    second = first if options.second is None else read_results(Path(options.second))
    if options.variants is not None:
        one, other = options.variants
        return chosen_variants(first, [one])[0], chosen_variants(second, [other])[0]
    if options.second is None and len(first) == 2:
        return first[0], first[1]
    if options.second is not None and len(first) == len(second) == 1:
        return first[0], second[0]
    names = ", ".join(dict.fromkeys(each.variant for each in (*first, *second)))
    raise UserError(
        Message("It is not clear which two designs are compared. Variants: {names}.", names=names),
        Message("Choose them with --variants FIRST SECOND."),
    )
