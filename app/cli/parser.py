"""The words that the command line takes, and the help that it gives."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from typing import NoReturn

from app.cli.options import ELASTIC_HELP, help_text
from app.cli.parser_analysis import add_assumptions, add_cure, add_evening, add_wishes, add_worn_scan
from app.cli.scan_summary import add_scan
from app.presenters.scan import KINDS
from core import __version__
from core.document.custom_measures import HELP as MEASURE_HELP
from core.document.line_notation import HELP as LINE_HELP
from core.errors import UserError
from core.mechanics.volume import CONTROLS

COMMANDS = {
    "solve": "solve a design and write body, control mesh, iterations and report",
    "ask": "compute line lengths for target positions and measurements",
    "calibrate": "compare with a fitting scan and fit tissue and line stiffness",
    "doctor": "find conflicting lines and suggest the smallest fix",
    "even": "compare left and right in mm and ml, and balance them",
    "limits": "compute the length limits of each line and their reasons",
    "detect": "detect the landmarks of a scan",
    "measure": "measure a scan, or a project before and after",
    "cut": "compute the cut length of each active line",
    "press": "compute the contact pressure of each active line in kPa and mmHg, and rate it",
    "spread": "compute the uncertainty (±) of the results and list the model limitations",
    "report": "write a report (PDF): sizes, cut lengths, measurements, contact pressures, pictures",
    "export": "export the body, lines, pattern strips, measurements or a turntable",
    "picture": "render a scan or project to a PNG file",
    "demo": "run the sample session off-screen and write the results",
    "figures": "reproduce the figures and tables of the paper",
    "sweep": "compare all volume controls on the samples and the sphere",
    "accuracy": "measure the accuracy of landmarks and girths on a folder of bodies with known values",
    "self-test": "check this installation; --out keeps the test files",
}
"""Every command with what it does, in a few words."""

_OF_A_SCAN = (
    "solve",
    "ask",
    "doctor",
    "even",
    "limits",
    "detect",
    "measure",
    "cut",
    "press",
    "spread",
    "report",
    "picture",
)

_SOLVED = ("cut", "press", "spread")
"""Commands that print a table of a design as it is solved."""

_OF_LINES = ("solve", "ask", "calibrate", "doctor", "even")
"""Others that take lines, and what these are made of."""


def command_options(command: str, words: Sequence[str]) -> argparse.Namespace:
    """Read the words after a command. Raises UserError."""
    return command_parser(command).parse_args(_joined(words))


def window_options(words: Sequence[str]) -> argparse.Namespace:
    """Read the words where there is no command. Raises UserError."""
    return window_parser().parse_args(words)


def _joined(words: Sequence[str]) -> list[str]:
    """Join an axis to its option: in '--front -y' the parser takes -y for another option."""
    joined: list[str] = []
    for word in words:
        if joined and joined[-1] in ("--up", "--front"):
            joined[-1] = f"{joined[-1]}={word}"
        else:
            joined.append(word)
    return joined


class _Parser(argparse.ArgumentParser):
    """Says what is wrong with the words of a command as all other bad input is said."""

    def error(self, message: str) -> NoReturn:
        raise UserError(f"{message[:1].upper()}{message[1:]}.", f"See '{self.prog} --help'.")


def window_parser() -> argparse.ArgumentParser:
    """Return what reads the words where there is no command."""
    commands = "\n".join(f"  busk {name:10} {help_}" for name, help_ in COMMANDS.items())
    parser = _Parser(
        prog="busk",
        description="Simulate how a foundation garment reshapes a body.",
        epilog=f"without a window:\n{commands}\n\n'busk COMMAND --help' tells more.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", nargs="?", metavar="FILE", help="a project (.busk) or a scan to open")
    parser.add_argument(
        "--safe-mode", action="store_true", help=("render the 3D view without the graphics driver")
    )
    parser.add_argument("--version", action="version", version=f"busk {__version__}")
    return parser


def command_parser(command: str) -> argparse.ArgumentParser:
    """Return what reads the words after a command."""
    parser = _Parser(prog=f"busk {command}", description=COMMANDS[command])
    if command in _OF_A_SCAN:
        add_scan(parser)
    if command == "export":
        _add_files(parser)
    _add_design(parser, command)
    if command in ("solve", "doctor"):
        parser.add_argument(
            "--volume", choices=CONTROLS, help=("volume control (default: as in the project, or adaptive)")
        )
    if command == "solve":
        parser.add_argument(
            "--turns",
            type=_turns,
            metavar="N",
            help=("run exactly N iterations (default: until converged, at most 300)"),
        )
    if command == "accuracy":
        parser.add_argument("folder", metavar="DIR", help="folder of scans with a truth.json")
    if command in (*_SOLVED, "ask", "calibrate", "doctor", "even", "limits", "detect", "measure", "accuracy"):
        _add_forms(parser, command)
    if command == "report":
        _add_sheet(parser)
    if command == "measure":
        parser.add_argument("--own", action="append", metavar="NAME=KIND:PLACES", help=MEASURE_HELP)
    if command == "picture":
        _add_picture(parser)
    if command == "sweep":
        parser.add_argument("--quick", action="store_true", help="run a few cases only")
    if command == "figures":
        parser.add_argument(
            "--only", action="append", metavar="N", help=("only this figure; may be repeated")
        )
    if command in ("solve", "picture", "demo", "figures", "sweep", "accuracy", "self-test"):
        needed = command not in ("demo", "accuracy", "self-test")
        default = None if command in ("accuracy", "self-test") else "out"
        help_ = "output picture (.png)" if command == "picture" else "output folder"
        parser.add_argument("--out", required=needed, default=default, metavar="PLACE", help=help_)
    return parser


def _add_picture(parser: argparse.ArgumentParser) -> None:
    what = parser.add_mutually_exclusive_group()
    what.add_argument(
        "--view", default="three-quarter", help="front, left, right, back, three-quarter, top, side"
    )
    what.add_argument("--window", action="store_true", help="render the whole window")
    parser.add_argument("--dark", action="store_true", help="use the dark theme")
    parser.add_argument("--language", choices=("en", "ja"), default="en", help=("language of the window"))
    parser.add_argument(
        "--size",
        type=_size,
        default=(1600, 1000),
        metavar="WIDTHxHEIGHT",
        help=("size of the picture in pixels"),
    )


def _add_forms(parser: argparse.ArgumentParser, command: str) -> None:
    """Add in which form it is told, and a file for what is told as a table."""
    forms = parser.add_mutually_exclusive_group()
    forms.add_argument("--json", action="store_true", help="print JSON")
    if command in (*_SOLVED, "measure"):
        forms.add_argument("--csv", action="store_true", help="print CSV")
        out = "write the output to a file; the ending .json or .csv selects the format"
        parser.add_argument("--out", metavar="FILE", help=out)


def _add_design(parser: argparse.ArgumentParser, command: str) -> None:
    """Add what can be said of a design: its settings, its lines and what they are made of."""
    if command in (*_SOLVED, *_OF_LINES, "limits", "report", "export", "picture"):
        parser.add_argument("--settings", action="append", metavar="KEY=VALUE", help=help_text())
        parser.add_argument("--path", action="append", metavar="NAME=POINTS", help=LINE_HELP)
    if command in (*_SOLVED, *_OF_LINES, "limits", "report", "export"):
        parser.add_argument(
            "--line",
            action="append",
            metavar="NAME=LENGTH",
            help=(
                "length as 97%% of the original length, -20mm (change) or 400mm (absolute); front "
                "length, side to side"
            ),
        )
    if command in (*_SOLVED, *_OF_LINES, "limits", "report", "export"):
        parser.add_argument("--elastic", action="append", metavar="LINE=ELASTIC", help=ELASTIC_HELP)
    if command == "ask":
        add_wishes(parser)
    if command == "calibrate":
        add_worn_scan(parser)
    if command == "doctor":
        add_cure(parser)
    if command == "spread":
        add_assumptions(parser)
    if command == "even":
        add_evening(parser)
    if command == "cut":
        listed = (
            "list all elastics for a line with their results, or the reason why an elastic cannot be used"
        )
        parser.add_argument("--elastics", metavar="LINE", help=listed)
        same = (
            "choose cut lengths so that lines with an elastic reach the same length on the body as without it"
        )
        parser.add_argument("--as-worn", action="store_true", help=same)


def _add_sheet(parser: argparse.ArgumentParser) -> None:
    """Add what can be said of a sheet."""
    parser.add_argument("--out", required=True, metavar="FILE", help="output report (.pdf)")
    parser.add_argument("--json", default="", metavar="FILE", help="output data (.json)")
    parser.add_argument("--csv", default="", metavar="FILE", help=("output table of all values (.csv)"))
    parser.add_argument("--language", choices=("en", "ja"), default="en", help=("language of the report"))
    said = "unit of lengths in the report, cut lengths to 1/16 in; --json and --csv use mm"
    parser.add_argument("--length-unit", choices=("mm", "cm", "in"), default="mm", help=said)
    parser.add_argument(
        "--customer", metavar="TEXT", help=("customer name or number (default: as in the project)")
    )
    parser.add_argument(
        "--system", default="jp", metavar="KEY", help=("size system listed first: jp, eu, uk, us, fr, it, au")
    )
    parser.add_argument(
        "--allowance",
        type=float,
        metavar="MM",
        help=(
            "tape tension allowance, subtracted from the under-bust girth: 0 to 20 mm, an estimate "
            "(default: as in the project)"
        ),
    )
    spread = "add the uncertainty (±) of values and curves; takes half a minute"
    parser.add_argument("--spread", action="store_true", help=spread)


def _add_files(parser: argparse.ArgumentParser) -> None:
    """Add what can be written of a design."""
    parser.add_argument(
        "input", metavar="PROJECT", help=f"a project (.busk), or a scan ({KINDS}) with --line"
    )
    parser.add_argument(
        "--body", default="", metavar="FILE", help=("output reshaped body (.glb, .obj, .ply, .stl)")
    )
    parser.add_argument(
        "--control", default="", metavar="FILE", help=("output control mesh (.glb, .obj, .ply, .stl, .csv)")
    )
    parser.add_argument(
        "--lines", default="", metavar="FILE", help=("output active lines on the body (.dxf, .obj)")
    )
    parser.add_argument(
        "--flat",
        default="",
        metavar="FILE",
        help="output active lines as flat pattern strips at full scale (.svg, .dxf)",
    )
    parser.add_argument(
        "--measures", default="", metavar="FILE", help=("output measurements (.smis, .vit, .csv, .json)")
    )
    parser.add_argument(
        "--turntable",
        default="",
        metavar="FILE",
        help=("output turntable (.gif, .webp, or .png for a series)"),
    )
    _add_how(parser)


def _add_how(parser: argparse.ArgumentParser) -> None:
    """Add how files of a design are written."""
    parser.add_argument(
        "--unit",
        dest="file_unit",
        metavar="UNIT",
        help="mm, cm, m or in (default: m in .glb, cm in measurements, otherwise mm)",
    )
    parser.add_argument(
        "--axes",
        help=(
            "z-up (front -y), y-up (front z) or z-up-front-y (front y); default: y-up in .glb, otherwise z-up"
        ),
    )
    parser.add_argument(
        "--before",
        action="store_true",
        help="export the original body in place of the reshaped one; strips do not change",
    )
    parser.add_argument("--frames", type=int, default=36, metavar="N", help=("number of turntable frames"))
    parser.add_argument(
        "--seconds", type=float, default=6.0, metavar="S", help=("duration of one rotation in seconds")
    )
    parser.add_argument(
        "--size",
        type=_size,
        default=(640, 720),
        metavar="WIDTHxHEIGHT",
        help=("size of the turntable in pixels"),
    )
    parser.add_argument("--dark", action="store_true", help=("render the turntable in the dark theme"))
    parser.add_argument(
        "--beside", action="store_true", help=("show before and after side by side in the turntable")
    )


def _turns(text: str) -> int:
    if not (text.isdecimal() and 1 <= int(text) <= 100_000):
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of iterations from 1 to 100000")
    return int(text)


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"([1-9]\d{1,3})x([1-9]\d{1,3})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' is not a size such as 1600x1000")
    return int(match[1]), int(match[2])
