"""Straps and bands of the cut list as pieces: strips to be cut beside those of the garment."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace

import numpy as np

from core.document.block import without_side
from core.errors import LineError
from core.export.band_geometry import Strip, strips, worn_regions
from core.garment.cut_list import CutList
from core.pattern.piece import Piece, Side
from core.pipeline.warnings import ShownState

_AT_END = 1.0  # a mark that is nearer to an end is the end [mm]


def strip_pieces(
    shown: ShownState,
    cuts: CutList,
    on_edges: Collection[str],
    titles: Mapping[str, str],
    widths: Mapping[str, float],
    taken: Collection[str] = (),
) -> tuple[Piece, ...]:
    """Return a strip for each row of a cut list that can be cut and is not the elastic of an edge.

    ``on_edges`` names the lines of those, ``titles`` are by line and by elastic, ``widths`` [mm] by line.
    A strip is named after its line, and as a strip where a piece has that name, one of ``taken``.
    Raises LineError for control points that are not a valid shape.
    """
    rows = {row.line: row for row in cuts.rows}
    pieces = []
    for strip in _strips(shown, titles, widths):
        row = rows.get(strip.name)
        if row is None or row.line in on_edges or row.cut_mm is None or row.front_only:
            continue
        # Of a band over both regions the marks are those of its parts, which do not belong to the whole.
        whole = replace(strip, length=row.cut_mm, marks=()) if row.parts else strip
        name = f"{row.line} strip" if row.line in taken else row.line
        pieces.append(piece_of_strip(whole, name, row.elastic, titles.get(row.elastic, "")))
    return tuple(pieces)


def uncut_strips(cuts: CutList, on_edges: Collection[str]) -> tuple[str, ...]:
    """Return the names of the lines of which no strip can be cut."""
    return tuple(
        row.line for row in cuts.rows if row.line not in on_edges and (row.cut_mm is None or row.front_only)
    )


def piece_of_strip(strip: Strip, name: str, elastic: str, elastic_title: str = "") -> Piece:
    """Return a strip as a piece that begins at the left; its length includes its seam allowances.

    ``name`` and ``elastic`` are the same in every language, the titles are written on it.
    """
    length, width = strip.length, strip.width
    corners = np.array([[0.0, 0.0], [length, 0.0], [length, width], [0.0, width], [0.0, 0.0]])
    marks = [(at, str(what)) for at, what in strip.marks if _AT_END < at < length - _AT_END]
    shares = tuple(at / length for at, _ in marks)
    notches = (shares, (), tuple(1.0 - each for each in shares[::-1]), ())
    sides = tuple(
        Side(name, corners[k : k + 2], 0.0, notches[k])
        for k, name in enumerate(("lower edge", "end", "upper edge", "beginning"))
    )
    across = tuple((what, np.array([[at, 0.0], [at, width]])) for at, what in marks)
    titles = strip.title, elastic_title
    return Piece(*without_side(name), elastic, 1, sides, across, (1.0, 0.0), (1.0, 0.0), *titles)


def _strips(shown: ShownState, titles: Mapping[str, str], widths: Mapping[str, float]) -> Iterator[Strip]:
    try:
        worn = worn_regions(shown.stages, shown.region_points)
    except LineError:  # none is worn
        return
    for region, points in worn:
        yield from strips(region, points, titles, widths)
