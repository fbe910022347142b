"""Detect the landmarks of a scan."""

from __future__ import annotations

import json
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from typing import Any

import numpy as np

from app.cli.design import design_of
from app.cli.options import add_forms, add_scan
from app.cli.output import finish, table_lines
from core.errors import UserError
from core.landmarks.as_dict import detection
from core.landmarks.types import LOWER_NAMES
from core.pipeline.build import detect_landmarks, read_body
from core.pipeline.lower_region import detect_lower_landmarks


def add_options(parser: ArgumentParser) -> None:
    """Add the options of ``busk detect``."""
    add_scan(parser)
    add_forms(parser)


def run(options: Namespace) -> int:
    """Detect the landmarks and print them."""
    design = design_of(options)
    _, body = read_body(design.scan)
    bust = detect_landmarks(body, design.placed)
    lower = detect_lower_landmarks(body, bust, design.placed)
    # A scan of the bust alone is nothing to be told of, a landmark that was placed in vain is.
    if isinstance(lower, UserError) and any(mark.name in LOWER_NAMES for mark in design.placed):
        raise lower
    found = detection(body, bust, None if isinstance(lower, UserError) else lower)
    text = json.dumps(found, indent=1) if options.json else landmarks_text(found)
    return finish(text, True, found["warnings"])


def landmarks_text(found: Mapping[str, Any]) -> str:
    """Return the result of ``core.landmarks.as_dict.detection`` as text.

    Positions are in the canonical frame [mm], and in that of the file where it is another.
    """
    own = not np.allclose(found["file_to_mm"], np.eye(4))
    lines = [f"unit {found['unit']}, up {found['up']}, front {found['front']}"]
    if found["upright"]:
        lines.append(f"set upright with --up={found['upright']}")
    rows = [["landmark", "x mm", "y mm", "z mm", "confidence %", *(["in the file"] if own else []), "rule"]]
    for name, mark in found["landmarks"].items():
        in_file = [",".join(f"{value:.6g}" for value in mark["file"])] if own else []
        position = [f"{value:.1f}" for value in mark["mm"]]
        rows.append([name, *position, f"{100 * mark['confidence']:.0f}", *in_file, mark["rule"]])
    girths = [["girth", "tape mm", "height mm"]]
    girths += [
        [name, f"{girth['tape_mm']:.1f}", f"{girth['level_mm']:.1f}"]
        for name, girth in found["girths"].items()
    ]
    return "\n".join([*lines, *table_lines(rows), *(table_lines(girths) if len(girths) > 1 else [])])
