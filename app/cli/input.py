"""The design that a command is about: that of a project or a scan, with what its options overrule."""

from __future__ import annotations

import argparse
from dataclasses import replace

from app.cli.options import settings_of
from core.control_mesh.template import read_template
from core.document.design import Design, ScanSource
from core.document.line_notation import own_line
from core.document.storage.project_file import is_project, open_project
from core.landmarks.manual import placed_mark
from core.scan.edits import ScanEdits, hole_centre


def design_of(path: str, options: argparse.Namespace) -> Design:
    """Return the design of a project, or a new one for a scan, with what the options overrule."""
    design = open_project(path).design if is_project(path) else Design(ScanSource(path))
    axes = {key: getattr(options, key) for key in ("unit", "up", "front") if getattr(options, key, None)}
    scan = design.scan.set_up(**axes)
    design = replace(design, scan=replace(scan, edits=_edits_of(scan.edits, options)))
    settings = settings_of(getattr(options, "settings", None) or [])
    design = replace(design.with_template(settings.pop("template", design.template)), **settings)
    for text in getattr(options, "path", None) or []:
        design = design.with_own_line(own_line(text, read_template(design.template)))
    for mark in map(placed_mark, getattr(options, "landmark", None) or []):
        design = design.with_placed(mark.name, mark.position)
    return design


def _edits_of(edits: ScanEdits, options: argparse.Namespace) -> ScanEdits:
    """Return the edits of a scan with what the options overrule. Raises UserError."""
    named = {"low": "keep_from", "high": "keep_to", "kept": "mirror"}
    told = {key: getattr(options, option, None) for key, option in named.items()}
    edits = replace(edits, **{key: value for key, value in told.items() if value is not None})
    for text in getattr(options, "fill", None) or []:
        edits = replace(edits, fill_all=True) if text == "all" else edits.with_filled(hole_centre(text))
    return edits
