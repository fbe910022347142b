"""Elastics on the edges of a pattern: which part of a worn line's elastic each carries, and its quarters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.garment.cut_list import CutList, CutRow
from core.geometry.mesh import Floats, Points
from core.geometry.plane_sections import arc_length
from core.pattern.garment import Pattern, without_side
from core.pattern.piece import EdgeElastic, SideKey

QUARTERS = (0.25, 0.5, 0.75)
"""Where an elastic is marked, and the edges that carry it: shares of both that meet."""

AT_CORNER = 3.0
"""A mark that is nearer to the end of an edge is left out: the seam there is one [mm]."""

_SAME_PLACE = 1.0
"""Ends of edges that are nearer to each other are one place of the body [mm]."""


@dataclass(frozen=True, eq=False)
class _Edge:
    """An edge: its key, its places on the body (k, 3), and along the piece (k,) [mm]."""

    key: SideKey
    places: Points
    along: Floats

    @property
    def worn(self) -> Floats:
        """Return how far each point is along the edge on the body, (k,) [mm]."""
        return arc_length(self.places)


def edge_elastics(pattern: Pattern, cuts: CutList) -> dict[SideKey, EdgeElastic]:
    """Return what each edge carries of the elastic of its line, where that line is worn.

    An elastic is shared out by lengths on the body. It begins where its edges do; all round, at the back.
    """
    found: dict[SideKey, EdgeElastic] = {}
    rows = {row.line: row for row in cuts.rows}
    edges: dict[str, list[_Edge]] = {}
    kinds: dict[str, str] = {}
    for kind, name, edge in _edges(pattern, rows):
        edges.setdefault(name, []).append(edge)
        kinds[name] = kind
    for name, own in edges.items():
        found |= dict(_shared_out(kinds[name], rows[name], _in_order(own)))
    return found


def lines_on_edges(pattern: Pattern, cuts: CutList) -> set[str]:
    """Return the names of the worn lines whose elastics edges carry."""
    return {name for _, name, _ in _edges(pattern, {row.line: row for row in cuts.rows})}


def _edges(pattern: Pattern, rows: Mapping[str, CutRow]) -> Iterator[tuple[str, str, _Edge]]:
    """Yield the edges that carry a worn line, with its name without and with its side."""
    for flat, places in zip(pattern.flats, pattern.places, strict=True):
        for number, side in enumerate(flat.panel.sides):
            seam = pattern.garment.seam_of(side.name)
            if seam is None or not seam.line or side.partner is not None:
                continue
            body_side = without_side(side.name)[1]
            names = (seam.line, f"{seam.line}-{body_side}", f"{seam.line} {body_side}")
            name = next((each for each in names if each in rows), None)
            if name is not None:
                along = arc_length(flat.points[side.points])
                yield seam.line, name, _Edge((flat.panel.name, number), places[side.points], along)


def _in_order(edges: Sequence[_Edge]) -> list[_Edge]:
    """Return edges one after the other: from an end on, or, all round, from where they are furthest back."""
    starts, ends = (np.array([each.places[at] for each in edges]) for at in (0, -1))
    gaps = np.linalg.norm(ends[:, None] - starts[None], axis=2)  # from the end of a row to a start
    first = np.flatnonzero(gaps.min(axis=0) > _SAME_PLACE)
    left = list(range(len(edges)))
    able = first.tolist() or left
    at = able[int(starts[able, 1].argmax())]
    order = []
    while True:
        order.append(edges[at])
        left.remove(at)
        if not left:
            return order
        at = left[int(gaps[at, left].argmin())]


def _shared_out(line: str, row: CutRow, edges: Sequence[_Edge]) -> Iterator[tuple[SideKey, EdgeElastic]]:
    """Yield what each of the ``edges`` of one elastic, in their order, carries of it."""
    bounds = np.cumsum([0.0, *(each.worn[-1] for each in edges)])
    whole = None if row.cut_mm is None or row.front_only else row.cut_mm
    set_on = None if whole is None else whole - (row.allowance_mm or 0.0)
    for edge, low, high in zip(edges, bounds[:-1], bounds[1:], strict=True):
        start, end = float(low / bounds[-1]), float(high / bounds[-1])
        part = None if set_on is None else (end - start) * set_on
        on_piece = [
            float(np.interp(share * bounds[-1] - low, edge.worn, edge.along))
            for share in QUARTERS
            if low < share * bounds[-1] < high
        ]
        length = float(edge.along[-1])
        marks = tuple(at / length for at in on_piece if AT_CORNER <= at <= length - AT_CORNER)
        yield edge.key, EdgeElastic(line, row.elastic, row.width_mm, whole, part, start, end, marks)
