"""Pieces for plotters and cutters: HPGL, 40 units a millimetre, a pen a kind of line."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from core.export.ascii_text import ascii_text
from core.files.atomic_write import write_text
from core.pattern.annotation import STRETCH, STRETCH_LETTERS, annotate, arrow_heads, english_words, text_width
from core.pattern.layout import Layout
from core.pattern.piece import Points2

UNITS = 40
"""Units of a plotter in a millimetre."""

CUT, SEW, MARKS = 1, 2, 3
"""Pens: cut lines, sew lines, and what is only marked: notches, arrows, lines inside, words."""

_END = "\x03"  # of a label


def write_pattern_plt(path: Path, layout: Layout) -> None:
    """Write the pieces of a layout, whole or not at all; the origin is its lower left corner.

    Raises ProjectError.
    """
    shift = np.array([0.0, layout.height])
    strokes: dict[int, list[str]] = {pen: [] for pen in (MARKS, SEW, CUT)}
    for each in layout.pieces:
        note = annotate(each, english_words(each.piece))
        inside = [points for _, points in each.piece.internal]
        arrows = (note.grain, note.stretch, *arrow_heads(note.stretch))
        strokes[MARKS] += [_stroke(points + shift) for points in (*each.notches, *arrows, *inside)]
        strokes[MARKS] += _words(note.lines, note.bases + shift, note.size)
        strokes[MARKS] += _words([str(STRETCH)], note.stretch_word[None] + shift, STRETCH_LETTERS)
        strokes[SEW].append(_stroke(_closed(each.piece.outline) + shift))
        strokes[CUT].append(_stroke(_closed(each.cut) + shift))
    # What is cut comes last: paper or cloth that is cut lies still no more.
    write_text(path, "\n".join(_commands(strokes)) + "\n", "ascii")


def _commands(strokes: dict[int, list[str]]) -> Iterator[str]:
    yield "IN;PA;"
    for pen, lines in strokes.items():
        yield f"SP{pen};"
        yield from lines
    yield "PU0,0;SP0;"


def _closed(outline: Points2) -> Points2:
    return np.concatenate([outline, outline[:1]])


def _words(lines: Sequence[str], bases: Points2, size: float) -> Iterator[str]:
    """Yield the commands that write lines of letters of a ``size`` above ``bases``, in their middles [mm]."""
    wide = text_width("x") * size
    for line, (x, y) in zip(map(ascii_text, lines), bases, strict=True):
        start = x - 0.5 * wide * len(line)
        place = f"PU{round(start * UNITS)},{round(y * UNITS)};"
        # Widths and heights are those of the letter itself, in cm; the next one follows after 1.5 widths.
        yield f"{place}SI{wide / 15.0:.3f},{0.07 * size:.3f};LB{line}{_END}"


def _stroke(points: Points2) -> str:
    """Return the commands that draw a line through places (k, 2) [mm]."""
    units = np.rint(points * UNITS).astype(int)
    (x, y), rest = units[0], units[1:]
    return f"PU{x},{y};PD{','.join(f'{a},{b}' for a, b in rest)};"
