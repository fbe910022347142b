"""Define options that several commands share: the scan, the design, the form of the output."""

from __future__ import annotations

import argparse
import re
from argparse import ArgumentParser

from app.presenters.scan import KINDS as SCAN_KINDS
from app.presenters.scan import PACKED
from core.document.cup import COVERAGES, CUP_RANGES, KINDS
from core.document.design import TEMPLATES, WEIGHTS
from core.document.line_notation import HELP as LINE_HELP
from core.document.lower_trunk import LOWER_SETTINGS
from core.landmarks.manual import HELP as LANDMARK_HELP
from core.mechanics.options import CHOICES, RANGES
from core.mechanics.volume import CONTROLS
from core.scan.orientation.pose import MILLIMETRES
from core.scan.source import SIDES

WORDS = {**CHOICES, "weights": WEIGHTS, "template": TEMPLATES}
"""Settings that are a word, and the words that each allows."""

NUMBERS = (*RANGES, "gain", "line_height", "tissue_stiffness", *LOWER_SETTINGS)
"""Settings that are a number."""

SWITCHES = ("scaled_normals", "dense_volume")
"""Settings that are on or off."""

STORED = {"bonded": "glued", "elastic": "spring", "fixed": "held", "integral": "accumulating"}
"""Values that project files and code name by another word than command line and window; both are accepted."""

_SHOWN = {stored: shown for shown, stored in STORED.items()}
LINE_LENGTH_HELP = (
    "length as 97%% of the original length, -20mm (change) or 400mm (absolute); front length, side to side"
)
ELASTIC_HELP = (
    "elastic of an active line: an elastic of the library, by name or unique words ('mid-bust=plush 12'), or "
    "a measured table ('mid-bust=roll.csv'). The line length is then the unstretched length of the elastic. "
    "An unknown name prints all names"
)
PRESET_HELP = (
    "garment preset, by title or unique words ('soft-bra'), or a preset file (.json): its lines, elastics "
    "and cups replace those of the design; --line, --elastic and --cup then change them. An unknown name "
    "prints all names"
)
_AXIS = "such as {axis}, or a direction x,y,z of the file for a tilted body"


def add_scan(parser: ArgumentParser, *, required: bool = True) -> None:
    """Add the input file, and the options that orient, edit and mark a scan."""
    kinds = f"a scan ({SCAN_KINDS}, each also compressed as {PACKED}) or a project (.busk)"
    parser.add_argument("input", metavar="SCAN_OR_PROJECT", nargs=None if required else "?", help=kinds)
    add_orientation(parser)
    parser.add_argument("--landmark", action="append", metavar="NAME=x,y,z", help=LANDMARK_HELP)
    for end, where in (("from", "below"), ("to", "above")):
        crop = f"crop the scan {where} this height above its lowest point"
        parser.add_argument(f"--keep-{end}", type=float, metavar="MM", help=crop)
    parser.add_argument("--mirror", choices=SIDES, help="mirror this half of the scan to the other side")
    fill = "fill the hole at this centre in mm on the upright body, or 'all'; may be repeated"
    parser.add_argument("--fill", action="append", metavar="x,y,z", help=fill)


def add_orientation(parser: ArgumentParser) -> None:
    """Add the unit and the axes of a scan."""
    units = tuple(MILLIMETRES)
    parser.add_argument("--unit", type=str.lower, choices=units, help="unit of the scan (default: detected)")
    parser.add_argument("--up", metavar="AXIS", help=f"up axis of the scan: {_AXIS.format(axis='+z')}")
    parser.add_argument("--front", metavar="AXIS", help=f"front axis of the scan: {_AXIS.format(axis='-y')}")


def add_settings(parser: ArgumentParser) -> None:
    """Add the model options and the custom lines of a design."""
    add_model_settings(parser)
    parser.add_argument("--preset", metavar="NAME", help=PRESET_HELP)
    parser.add_argument("--cup", metavar="KEY=VALUE,...", help=cup_help())
    parser.add_argument("--path", action="append", metavar="NAME=POINTS", help=LINE_HELP)


def add_model_settings(parser: ArgumentParser) -> None:
    """Add the model options of a design."""
    parser.add_argument("--settings", action="append", metavar="KEY=VALUE", help=settings_help())


def add_lines(parser: ArgumentParser) -> None:
    """Add the settings of a design, the lengths of its lines and their elastics."""
    add_settings(parser)
    parser.add_argument("--line", action="append", metavar="NAME=LENGTH", help=LINE_LENGTH_HELP)
    parser.add_argument("--elastic", action="append", metavar="LINE=ELASTIC", help=ELASTIC_HELP)


def add_volume(parser: ArgumentParser) -> None:
    """Add the choice of the volume control."""
    volume = "volume control (default: as in the project, or adaptive)"
    shown = f"{{{','.join(_SHOWN.get(control, control) for control in CONTROLS)}}}"
    parser.add_argument("--volume", type=stored_word, choices=CONTROLS, metavar=shown, help=volume)


def add_forms(parser: ArgumentParser, *, table: bool = False) -> None:
    """Add JSON as the form of the output; for a ``table`` also CSV and a file."""
    forms = parser.add_mutually_exclusive_group()
    forms.add_argument("--json", action="store_true", help="print JSON")
    if table:
        forms.add_argument("--csv", action="store_true", help="print CSV")
        out = "write the output to a file; the ending .json or .csv selects the format"
        parser.add_argument("--out", metavar="FILE", help=out)


def add_project_output(parser: ArgumentParser, what: str = "the result") -> None:
    """Add the project file that a design is saved to."""
    parser.add_argument("--out", default="", metavar="FILE", help=f"save {what} as a project (.busk)")


def add_folder_output(parser: ArgumentParser, *, required: bool = True, default: str | None = None) -> None:
    """Add the folder that files are written to."""
    parser.add_argument("--out", required=required, default=default, metavar="PLACE", help="output folder")


def form_of(options: argparse.Namespace) -> str:
    """Return the form of the output: "csv", "json" or, as text, ""."""
    return "csv" if options.csv else "json" if options.json else ""


def stored_word(word: str) -> str:
    """Return the word that project files store for a value."""
    return STORED.get(word, word)


def picture_size(text: str) -> tuple[int, int]:
    """Read a size in pixels, such as 1600x1000. Raises ArgumentTypeError."""
    match = re.fullmatch(r"([1-9]\d{1,3})x([1-9]\d{1,3})", text)
    if match is None:
        raise argparse.ArgumentTypeError(f"'{text}' is not a size such as 1600x1000")
    return int(match[1]), int(match[2])


def shown_text(key: str) -> list[str]:
    """Return the values of a setting as they are shown."""
    return [_SHOWN.get(word, word) for word in WORDS[key]]


def settings_help() -> str:
    """Return the keys of ``--settings`` with the values that each takes."""
    numbers = f"{', '.join(NUMBERS)} (a number; firm_chest also on, off; gain also auto)"
    words = [f"{key} ({', '.join(shown_text(key))})" for key in WORDS]
    return ", ".join([numbers, *words, *(f"{key} (yes, no)" for key in SWITCHES)])


def cup_help() -> str:
    """Return the keys of ``--cup`` with the values that each takes."""
    ranges = [f"{key} ({low:g} to {high:g})" for key, (low, high) in CUP_RANGES.items()]
    return (
        f"cups of both breasts, on solid tissue: kind ({', '.join(KINDS)}), coverage "
        f"({', '.join(COVERAGES)}), {', '.join(ranges)}, wire (yes, no); lift, forward and gather in mm, "
        "across, upright and wire_width as ratios, cloth in N/m, as in kind=moulded,lift=20,wire=yes; 'none' "
        "removes cups"
    )
