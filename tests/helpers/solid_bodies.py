"""Designs on solid tissue: slings over the breasts and a mid-bust line, of which any are worn."""

from __future__ import annotations

from dataclasses import replace

from core.control_mesh.template import read_template
from core.document.line_notation import ready_made_lines
from core.document.lines import ActiveLine
from core.pipeline.build import Stages, build

SLINGS = ready_made_lines(read_template("168"))["slings"]
SLING = tuple(line.name for line in SLINGS)
BOTH = (*SLING, "mid-bust")


def worn(stages: Stages, ratio: float, *lines: str, **settings: object) -> Stages:
    """Build a design with ``lines`` worn at one ratio, and other settings."""
    active = tuple(ActiveLine(name, ratio) for name in sorted(lines))
    return build(replace(stages.design, lines=active, **settings), stages)  # type: ignore[arg-type]
