"""The words that a scan takes on the command line: how it stands, its landmarks and its edits."""

from __future__ import annotations

import argparse

from app.presenters.scan import KINDS, PACKED
from core.landmarks.manual import HELP as LANDMARK_HELP
from core.scan.edits import SIDES
from core.scan.orientation.pose import MILLIMETRES

_AXIS = "such as {axis}, or a direction x,y,z of the file for a tilted body"


def add_scan(parser: argparse.ArgumentParser) -> None:
    """Add a scan and all that can be said about it."""
    kinds = f"a scan ({KINDS}, each also compressed as {PACKED}) or a project (.busk)"
    parser.add_argument("input", metavar="SCAN_OR_PROJECT", help=kinds)
    parser.add_argument(
        "--unit", type=str.lower, choices=tuple(MILLIMETRES), help=("unit of the scan (default: detected)")
    )
    parser.add_argument("--up", metavar="AXIS", help=(f"up axis of the scan: {_AXIS.format(axis='+z')}"))
    parser.add_argument("--front", metavar="AXIS", help=f"front axis of the scan: {_AXIS.format(axis='-y')}")
    parser.add_argument("--landmark", action="append", metavar="NAME=x,y,z", help=LANDMARK_HELP)
    parser.add_argument(
        "--keep-from", type=float, metavar="MM", help="crop the scan below this height above its lowest point"
    )
    parser.add_argument(
        "--keep-to", type=float, metavar="MM", help="crop the scan above this height above its lowest point"
    )
    parser.add_argument("--mirror", choices=SIDES, help=("mirror this half of the scan to the other side"))
    fill = "fill the hole at this centre in mm on the upright body, or 'all'; may be repeated"
    parser.add_argument("--fill", action="append", metavar="x,y,z", help=fill)
