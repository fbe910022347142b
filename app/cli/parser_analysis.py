"""The words that the commands which advise take besides those of a scan and its design."""

from __future__ import annotations

import argparse
import math

from app.cli.options import OPTIONAL_HELP, PRESSURE_HELP, PROFILE_HELP, WANT_HELP
from core.scan.orientation.unit_detection import MILLIMETRES


def add_cure(parser: argparse.ArgumentParser) -> None:
    """Add where to a design goes with what ends its trouble."""
    out = "save the corrected design as a project (.busk)"
    parser.add_argument("--out", default="", metavar="FILE", help=out)


def add_evening(parser: argparse.ArgumentParser) -> None:
    """Add that left and right are to be made even, and where to."""
    make = "compute line lengths that balance left and right; lines across both sides are split"
    parser.add_argument("--make", action="store_true", help=make)
    parser.add_argument("--out", default="", metavar="FILE", help=("save the result as a project (.busk)"))


def add_assumptions(parser: argparse.ArgumentParser) -> None:
    """Add what figures may be off by."""
    from core.analysis.uncertainty.input_uncertainty import NUMBERS  # noqa: PLC0415 (a command that needs it reads it)

    help_ = f"set a standard deviation; may be repeated. Names: {', '.join(NUMBERS)}"
    parser.add_argument("--assume", action="append", metavar="NAME=NUMBER", help=help_)


def add_worn_scan(parser: argparse.ArgumentParser) -> None:
    """Add a second scan, with the garment on, and what can be said about it."""
    parser.add_argument("input", metavar="PROJECT", help="a project (.busk), or a scan with --line")
    parser.add_argument(
        "worn", metavar="WORN_SCAN", help=("a scan of the same person wearing the garment (fitting scan)")
    )
    units = tuple(MILLIMETRES)
    parser.add_argument(
        "--unit",
        dest="worn_unit",
        type=str.lower,
        choices=units,
        help=("unit of the fitting scan (default: detected)"),
    )
    for key, what in (("up", "up axis of the fitting scan"), ("front", "front axis of the fitting scan")):
        parser.add_argument(
            f"--{key}", dest=f"worn_{key}", metavar="AXIS", help=(f"{what} (default: detected)")
        )
    thick = "fabric thickness, subtracted from the fitting scan: 0 to 20 mm (default: 0)"
    parser.add_argument("--thickness", type=float, default=0.0, metavar="MM", help=thick)
    lengths = "also fit the line lengths, if lines may have been cut to other lengths than designed"
    parser.add_argument("--lengths", action="store_true", help=lengths)
    one = "fit one common stiffness for all lines without their own stiffness or elastic"
    parser.add_argument("--one-roll", action="store_true", help=one)
    parser.add_argument("--out", default="", metavar="FILE", help=("save the result as a project (.busk)"))


def _limit(text: str) -> float:
    return math.inf if text.strip().lower() == "off" else float(text)


def add_wishes(parser: argparse.ArgumentParser) -> None:
    """Add what can be asked for, and what lines may do for it."""
    parser.add_argument("--want", action="append", metavar="NAME=VALUE", help=WANT_HELP)
    parser.add_argument("--profile", action="append", metavar="[SECTION=]FILE.csv", help=PROFILE_HELP)
    parser.add_argument("--pressure", type=_limit, metavar="KPA", help=PRESSURE_HELP)
    parser.add_argument("--optional", action="append", metavar="LINE", help=OPTIONAL_HELP)
    parser.add_argument(
        "--lock", action="append", metavar="LINE", help="an active line that keeps its length"
    )
    shortest = "minimum length of an active line, in the format of --line"
    parser.add_argument("--shortest", action="append", metavar="LINE=LENGTH", help=shortest)
    parser.add_argument("--out", default="", metavar="FILE", help=("save the result as a project (.busk)"))
