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
    "solve": "solve a design and write body, control mesh, turns and report",
    "ask": "find the lengths of lines that bring the body to what is wished",
    "calibrate": "compare with a scan of the garment as worn, and find the numbers that predict it",
    "doctor": "tell what fights in a design that vibrates or strains, and the least that ends it",
    "even": "tell how left and right differ in mm and ml, and find the lengths that make them even",
    "limits": "tell how far each line can go, and why no further",
    "detect": "find the landmarks of a scan",
    "measure": "measure a scan, or a project before and after",
    "cut": "tell how long the elastic of each worn line is to be cut",
    "press": "tell what each worn line presses the skin with, in kPa and mmHg, and whether that is much",
    "spread": "tell how far the figures of a design may be off (±), and what they leave out",
    "report": "write a sheet to work from (PDF): sizes, lengths to cut, measures, pressures, pictures",
    "export": "write a body, its lines, strips, measures or a turntable for other programs",
    "picture": "render a scan or project to a PNG file",
    "demo": "do the sample session off-screen and write what comes out",
    "figures": "make the figures of the paper again, with their tables and a page",
    "sweep": "try every volume control on the samples and the sphere, with a table",
    "accuracy": "measure how well landmarks and girths are found, on a folder of bodies with known answers",
    "self-test": "check this installation, one line a part; --out keeps what was made for it",
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
        description="See how a foundation garment reshapes a body.",
        epilog=f"without a window:\n{commands}\n\n'busk COMMAND --help' tells more.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("file", nargs="?", metavar="FILE", help="a project (.busk) or a scan to open")
    parser.add_argument(
        "--safe-mode", action="store_true", help="paint the 3D view without the graphics driver"
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
            "--volume", choices=CONTROLS, help="what keeps the volume; else as the project says, or adaptive"
        )
    if command == "solve":
        parser.add_argument(
            "--turns", type=_turns, metavar="N", help="exactly N turns; else until settled, at most 300"
        )
    if command == "accuracy":
        parser.add_argument("folder", metavar="DIR", help="scans with a truth.json beside them")
    if command in (*_SOLVED, "ask", "calibrate", "doctor", "even", "limits", "detect", "measure", "accuracy"):
        _add_forms(parser, command)
    if command == "report":
        _add_sheet(parser)
    if command == "measure":
        parser.add_argument("--own", action="append", metavar="NAME=KIND:PLACES", help=MEASURE_HELP)
    if command == "picture":
        _add_picture(parser)
    if command == "sweep":
        parser.add_argument("--quick", action="store_true", help="a few cases only")
    if command == "figures":
        parser.add_argument("--only", action="append", metavar="N", help="this figure alone; may be repeated")
    if command in ("solve", "picture", "demo", "figures", "sweep", "accuracy", "self-test"):
        needed = command not in ("demo", "accuracy", "self-test")
        default = None if command in ("accuracy", "self-test") else "out"
        help_ = "the picture: .png" if command == "picture" else "the folder that is written to"
        parser.add_argument("--out", required=needed, default=default, metavar="PLACE", help=help_)
    return parser


def _add_picture(parser: argparse.ArgumentParser) -> None:
    what = parser.add_mutually_exclusive_group()
    what.add_argument(
        "--view", default="three-quarter", help="front, left, right, back, three-quarter, top, side"
    )
    what.add_argument("--window", action="store_true", help="the whole window, not just the body")
    parser.add_argument("--dark", action="store_true", help="a picture on dark ground")
    parser.add_argument("--language", choices=("en", "ja"), default="en", help="that of the window")
    parser.add_argument(
        "--size", type=_size, default=(1600, 1000), metavar="WIDTHxHEIGHT", help="of a picture"
    )


def _add_forms(parser: argparse.ArgumentParser, command: str) -> None:
    """Add in which form it is told, and a file for what is told as a table."""
    forms = parser.add_mutually_exclusive_group()
    forms.add_argument("--json", action="store_true", help="print JSON")
    if command in (*_SOLVED, "measure"):
        forms.add_argument("--csv", action="store_true", help="print a table of comma-separated values")
        out = "write to a file what is printed; a name that ends in .json or .csv asks for JSON or CSV"
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
            help="97%% of the rest length, -20mm shorter, 400mm absolute; of the front part, side to side",
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
        listed = "list all elastics for a line: what each does, and why it cannot be used"
        parser.add_argument("--elastics", metavar="LINE", help=listed)
        same = "let lines of elastic reach what they reach without it: lengths are then those on the body"
        parser.add_argument("--as-worn", action="store_true", help=same)


def _add_sheet(parser: argparse.ArgumentParser) -> None:
    """Add what can be said of a sheet."""
    parser.add_argument("--out", required=True, metavar="FILE", help="the sheet: .pdf")
    parser.add_argument("--json", default="", metavar="FILE", help="all of it as data: .json")
    parser.add_argument("--csv", default="", metavar="FILE", help="all its figures as one long table: .csv")
    parser.add_argument("--language", choices=("en", "ja"), default="en", help="that of the sheet")
    said = "that of lengths on the sheet, cut lengths to 1/16 in; --json and --csv keep mm"
    parser.add_argument("--length-unit", choices=("mm", "cm", "in"), default="mm", help=said)
    parser.add_argument("--customer", metavar="TEXT", help="whose it is, else as the project says")
    parser.add_argument(
        "--system", default="jp", metavar="KEY", help="the sizes that come first: jp, eu, uk, us, fr, it, au"
    )
    parser.add_argument(
        "--allowance",
        type=float,
        metavar="MM",
        help="taken off the under-bust for a tape that is worn tight, 0 to 20, an estimate; else as the "
        "project says",
    )
    spread = "tell beside figures and curves how far they may be off (±); takes half a minute"
    parser.add_argument("--spread", action="store_true", help=spread)


def _add_files(parser: argparse.ArgumentParser) -> None:
    """Add what can be written of a design."""
    parser.add_argument(
        "input", metavar="PROJECT", help=f"a project (.busk), or a scan ({KINDS}) with --line"
    )
    parser.add_argument(
        "--body", default="", metavar="FILE", help="the reshaped body: .glb, .obj, .ply, .stl"
    )
    parser.add_argument(
        "--control", default="", metavar="FILE", help="the control mesh: .glb, .obj, .ply, .stl, .csv"
    )
    parser.add_argument("--lines", default="", metavar="FILE", help="the worn lines on the body: .dxf, .obj")
    parser.add_argument(
        "--flat",
        default="",
        metavar="FILE",
        help="the worn lines as flat strips to cut, at their size: .svg, .dxf",
    )
    parser.add_argument(
        "--measures", default="", metavar="FILE", help="its measures: .smis, .vit, .csv, .json"
    )
    parser.add_argument(
        "--turntable", default="", metavar="FILE", help="one turn round: .gif, .webp, .png for a series"
    )
    _add_how(parser)


def _add_how(parser: argparse.ArgumentParser) -> None:
    """Add how files of a design are written."""
    parser.add_argument(
        "--unit",
        dest="file_unit",
        metavar="UNIT",
        help="mm, cm, m or in; else metres in .glb, cm in measures, mm",
    )
    parser.add_argument(
        "--axes", help="z-up (faces -y), y-up (faces z) or z-up-front-y (faces y); else y-up in .glb, z-up"
    )
    parser.add_argument(
        "--before",
        action="store_true",
        help="the body at rest in place of the reshaped one; strips stay as they are",
    )
    parser.add_argument("--frames", type=int, default=36, metavar="N", help="pictures of a turntable")
    parser.add_argument("--seconds", type=float, default=6.0, metavar="S", help="how long one turn takes")
    parser.add_argument(
        "--size", type=_size, default=(640, 720), metavar="WIDTHxHEIGHT", help="of a turntable"
    )
    parser.add_argument("--dark", action="store_true", help="a turntable on dark ground")
    parser.add_argument("--beside", action="store_true", help="before and after side by side in a turntable")


def _turns(text: str) -> int:
    if not (text.isdecimal() and 1 <= int(text) <= 100_000):
        raise argparse.ArgumentTypeError(f"'{text}' is no number of turns from 1 to 100000")
    return int(text)


def _size(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"([1-9]\d{1,3})x([1-9]\d{1,3})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' is no size like 1600x1000")
    return int(match[1]), int(match[2])
