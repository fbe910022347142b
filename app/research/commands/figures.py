"""Reproduce the figures of the paper from the sample bodies and the sphere, with a page on them."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from collections.abc import Callable, Collection
from pathlib import Path

from app.cli.options import add_folder_output
from app.cli.output import DONE, make_folder
from app.research.cases import Study
from app.research.fig_1_to_5 import figure_1, figure_2, figure_3, figure_4, figure_5
from app.research.fig_6_to_10 import figure_6, figure_7, figure_8, figure_9, figure_10
from app.research.fig_11 import figure_11
from app.research.figure_style import Figure, print_style
from app.research.page import write_page
from core.errors import UserError
from core.messages import Message

FIGURES: dict[str, Callable[[Study], Figure]] = {
    "1": figure_1,
    "2": figure_2,
    "3": figure_3,
    "4": figure_4,
    "5": figure_5,
    "6": figure_6,
    "7": figure_7,
    "8": figure_8,
    "9": figure_9,
    "10": figure_10,
    "11": figure_11,
}
"""How each figure is drawn, by its number: 1 to 7 are the paper's, the others ours."""


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk figures``."""
    parser.add_argument("--only", action="append", metavar="N", help="only this figure; may be repeated")
    add_folder_output(parser)


def run(options: Namespace) -> int:
    """Write the figures, and the page on all of them."""
    out = make_folder(options.out)
    if options.only:
        make_some(options.only, out)
    else:
        make_figures(out)
    return DONE


def say(text: str) -> None:
    """Print a line at once, also into a pipe: who waits wants to see that something is done."""
    print(text, flush=True)


def make_figures(out: Path, tell: Callable[[str], None] = say) -> None:
    """Write all figures to ``out``, one picture and one CSV each, and the page REPRODUCTION.md on them.

    ``tell`` receives a line for every file. Raises UserError.
    """
    study = Study()
    drawn = [draw(number, study, out, tell) for number in FIGURES]
    write_page(out, drawn, study, tell)


def make_some(numbers: Collection[str], out: Path, tell: Callable[[str], None] = say) -> None:
    """Write the figures with these ``numbers`` to ``out``, without the page. Raises UserError."""
    unknown = sorted(set(numbers) - FIGURES.keys())
    if unknown:
        raise UserError(
            Message("Unknown figure {value}.", value=unknown[0]),
            Message("Choose among: {choices}.", choices=", ".join(FIGURES)),
        )
    study = Study()
    for number in FIGURES:
        if number in numbers:
            draw(number, study, out, tell)


def draw(number: str, study: Study, out: Path, tell: Callable[[str], None] = say) -> Figure:
    """Draw one figure and write its picture and table to ``out``. Raises UserError."""
    with print_style():
        figure = FIGURES[number](study)
        figure.save(out)
    tell(f"  {out / figure.name}.png and .csv: Fig. {number}, {figure.title}")
    return figure
