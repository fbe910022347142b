"""Advice on a pattern for the command line: dart charts, and fixes for pieces over their limit."""

from __future__ import annotations

from collections.abc import Iterator

from app.cli.output import table_lines
from core.document.block import Block
from core.errors import PatternError
from core.geometry.mesh import Points
from core.messages import Message
from core.pattern.garment import Pattern
from core.pattern.piece_fixes import chart_of, piece_fixes
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pipeline.build import Stages


def check_piece(block: Block, piece: str) -> None:
    """Raise PatternError for a piece that a block does not have, named with its side."""
    names = block.panel_names
    if piece not in names:
        raise PatternError(
            Message("There is no piece '{name}'.", name=piece),
            Message("Choose one of: {choices}.", choices=", ".join(names)),
        )


def dart_lines(pattern: Pattern, stages: Stages, piece: str) -> Iterator[str]:
    """Yield a table of darts for a piece, named with its side. Raises PatternError where there is none."""
    check_piece(pattern.garment.block, piece)
    chart = chart_of(pattern, piece, SeamDrawing(BodyPlaces.of(stages)))
    yield f"Darts of the piece {piece}: {100.0 * chart.within:.1f} % without one."
    rows = [("from", "at %", "clock", "work left %", "strain %")]
    for dart in chart.darts:
        clock = "" if dart.clock is None else f"{dart.clock:.0f}"
        left = (f"{100.0 * dart.left:.0f}", f"{100.0 * dart.within:.1f}")
        rows.append((dart.seam, f"{100.0 * dart.share:.0f}", clock, *left))
    yield from table_lines(rows)


def fix_lines(pattern: Pattern, stages: Stages, worn: Points) -> Iterator[str]:
    """Yield verified fixes for each piece that exceeds the limit of its cloth."""
    drawing = SeamDrawing(BodyPlaces.of(stages))
    for flat in pattern.flats:
        if not pattern.fits(flat):
            for fix in piece_fixes(pattern, flat.panel.name, drawing, worn):
                fits = "fits" if fix.fits else "does not fit"
                yield f"{flat.panel.name}: {fix.message} ({fits})"
