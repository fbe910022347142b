"""Elastics on the edges of a pattern: which part of a worn line's elastic each carries, and its quarters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from core.document.block import without_side
from core.garment.cut_list import CutList, CutRow
from core.geometry.mesh import Floats, Points
from core.geometry.plane_sections import arc_length
from core.pattern.garment import Pattern
from core.pattern.piece import EdgeElastic, SideKey

QUARTERS = (0.0, 0.25, 0.5, 0.75)
"""Where an elastic is marked, and the edges that carry it: shares of both that meet."""

AT_SEAM = 3.0
"""A mark that is nearer to a seam, or to an end of the elastic, is left out: that marks it already [mm]."""

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

    def mark(self, share: float, seams: Sequence[bool]) -> float | None:
        """Return where on the piece a share of the length on the body lies, as a share of the edge [1].

        ``seams`` tell whether it begins and ends at one, where no mark is needed: None for one there.
        """
        at = float(np.interp(share * self.worn[-1], self.worn, self.along))
        length = float(self.along[-1])
        if (seams[0] and at < AT_SEAM) or (seams[1] and length - at < AT_SEAM):
            return None
        return at / length


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
    along = np.cumsum([0.0, *(each.worn[-1] for each in edges)])
    bounds = (along / along[-1]).tolist()
    whole = None if row.cut_mm is None or row.front_only else row.cut_mm
    set_on = None if whole is None else whole - (row.allowance_mm or 0.0)
    seams = _seams(edges)
    for k, edge in enumerate(edges):
        start, end = bounds[k : k + 2]
        shares = [(share - start) / (end - start) for share in QUARTERS if start <= share < end]
        marks = tuple(at for each in shares if (at := edge.mark(each, seams[k : k + 2])) is not None)
        part = None if set_on is None else (end - start) * set_on
        yield edge.key, EdgeElastic(line, row.elastic, row.width_mm, whole, part, start, end, marks)


def _seams(edges: Sequence[_Edge]) -> list[bool]:
    """Return whether there is a seam, or an end of all, at the beginning of each edge and after the last."""
    panels = [each.key[0] for each in edges]
    is_open = float(np.linalg.norm(edges[-1].places[-1] - edges[0].places[0])) > _SAME_PLACE
    ends = is_open or panels[0] != panels[-1]
    return [ends, *(one != other for one, other in pairwise(panels)), ends]
