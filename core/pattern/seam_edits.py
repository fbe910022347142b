"""Seams of a block edited by hand: points added and removed, seams and darts drawn and removed (ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from core.document.block import WAY, Block, PanelPlan, Seam, without_side
from core.errors import PatternError
from core.geometry.mesh import Floats, Indices, Points
from core.messages import Message, SeamName
from core.pattern.garment import CutGarment, surface_curves
from core.pattern.panel import Panel
from core.pattern.panel_border import face_regions, seam_net
from core.pattern.place_words import word_at
from core.pattern.seam_curves import SeamCurve, SeamDrawing
from core.pattern.seam_moves import side_of
from core.pattern.surface_cut import cut_surface

SNAP = 6.0
"""The end of a drawn seam that is nearer to another seam ends on it [mm]."""

ACROSS = 10.0
"""A seam that extends further to both sides of the front centre is drawn once, else on both sides [mm]."""

_CLEAR = 3.0  # points of a panel nearer to a new seam are not counted to either part [mm]
_PART = 3  # points that a part of a panel has at least


def with_point(
    drawing: SeamDrawing, block: Block, curve: str, curves: Sequence[SeamCurve], place: Points | None = None
) -> Block:
    """Return the block in which a seam has one more point, nearest to ``place`` (3,) [mm].

    Without a place it is in the middle of the longest stretch between two points. ``curves`` are those of the
    block on the original body. Raises PatternError for a root or ring, KeyError for an unknown curve.
    """
    seam, side = block.seam(curve), side_of(block, curve)
    if seam.kind != WAY:
        raise PatternError(
            Message("Points can be added only to seams that are drawn through points."),
            Message("Move the ends of this seam instead."),
        )
    drawn = {each.name: each.points for each in curves}
    points, levels, words = drawn[curve], drawing.levels(block), list(seam.places_of(side))
    nearest = [_nearest(points, drawing.places.place(word, side, levels, drawn)) for word in words]
    longest = int(np.argmax(np.diff(nearest)))
    at = sum(nearest[longest : longest + 2]) // 2 if place is None else _nearest(points, place)
    number = int(np.searchsorted(nearest[:-1], at, side="right"))
    words.insert(max(number, 1), word_at(drawing.places, side, points[at]))
    return _with_words(block, seam, side, words)


def without_point(block: Block, curve: str, number: int) -> Block:
    """Return the block without a point of a seam, counted from its start. Raises PatternError for an end."""
    seam, side = block.seam(curve), side_of(block, curve)
    words = list(seam.places_of(side))
    if not 0 < number < len(words) - 1:
        raise PatternError(
            Message("The ends of a seam cannot be removed."), Message("Select a point between them.")
        )
    del words[number]
    return _with_words(block, seam, side, words)


def _with_words(block: Block, seam: Seam, side: str, words: Sequence[str]) -> Block:
    if seam.right and side == "right":
        return block.with_seam(replace(seam, right=tuple(words)))
    return block.with_seam(replace(seam, places=tuple(words)))


def _nearest(points: Points, place: Points) -> int:
    return int(np.linalg.norm(points - place, axis=1).argmin())


def snapped(curves: Sequence[SeamCurve], place: Points) -> tuple[Points, SeamCurve | None]:
    """Return the point of a seam within ``SNAP`` of a ``place`` (3,) [mm], and that seam or None."""
    best, found, near = SNAP, None, place
    for curve in curves:
        point = curve.points[_nearest(curve.points, place)]
        away = float(np.linalg.norm(point - place))
        if away < best:
            best, found, near = away, curve, point
    return near, found


def with_drawn_seam(drawing: SeamDrawing, garment: CutGarment, places: Points) -> Block:
    """Return the block with a seam drawn through ``places`` (k, 3) [mm] of the original body.

    It divides the panels that it runs through; with one end within a panel it is a dart. On one side of the
    body it is drawn for both. Raises PatternError where it does not start on a seam or divides no panel.
    """
    starts, ends = (snapped(garment.curves, place)[1] for place in places[[0, -1]])
    if starts is None and ends is None:
        raise PatternError(
            Message("The drawn line does not start on a seam or edge."),
            Message("Start it on a seam; end it on another one, or within a piece for a dart."),
        )
    if starts is None:
        places, starts, ends = places[::-1], ends, None
    off = places[:, 0] - drawing.places.middle
    each = not (off.min() < -ACROSS and off.max() > ACROSS)
    side = "" if not each else "left" if off.mean() > 0.0 else "right"
    words = [word_at(drawing.places, side, place) for place in places]
    for at, curve in ((0, starts), (-1, ends)):
        if curve is not None:
            words[at] = f"{words[at]} > {curve.seam.name}"
    panel = _panel_at(drawing, garment, places[len(places) // 2])
    slit = ends is None
    name = new_name(
        f"{without_side(panel.name)[0]} {'dart' if slit else 'seam'}",
        [own.name for own in garment.block.seams],
    )
    seam = Seam(name, WAY, each=each, places=tuple(words), slit=slit)
    if slit:
        return replace(garment.block, seams=(*garment.block.seams, seam))
    return with_dividing_seam(drawing, garment, seam, side)


def _panel_at(drawing: SeamDrawing, garment: CutGarment, place: Points) -> Panel:
    """Return the panel that is nearest to a place."""
    skin = drawing.places.skin
    away = [
        float(np.linalg.norm(panel.places(skin.vertices) - place, axis=1).min()) for panel in garment.panels
    ]
    return garment.panels[int(np.argmin(away))]


def with_dividing_seam(drawing: SeamDrawing, garment: CutGarment, seam: Seam, side: str = "left") -> Block:
    """Return the block with one more seam, and with a plan for each part of the panels that it divides.

    ``side`` is the one on which parts are determined, "" for a seam over the middle. Raises PatternError
    where no panel is divided.
    """
    block = replace(garment.block, seams=(*garment.block.seams, seam))
    curves = drawing.curves(block)
    regions = _Regions.of(drawing, curves, np.concatenate([c.points for c in curves if c.seam is seam]))
    plans: list[PanelPlan] = []
    for plan in garment.block.panels:
        name = f"{plan.name} {side or 'left'}" if plan.each else plan.name
        panel = next(each for each in garment.panels if each.name == name)
        middles = regions.middles(_inside(panel, drawing.places.skin.vertices))
        if len(middles) < 2:
            plans.append(plan)
        else:
            taken = [each.name for each in (*garment.block.panels, *plans)]
            plans += _plans(drawing, plan, middles, side, taken)
    if len(plans) == len(garment.block.panels):
        raise PatternError(
            Message("The drawn line does not divide a piece."),
            Message("Draw it from seam to seam across a piece, or end it within the piece for a dart."),
        )
    return replace(block, panels=tuple(plans))


@dataclass(frozen=True, eq=False)
class _Regions:
    """Regions of the skin between all seams: ``label`` (m,) of triangles by their ``centroids``."""

    label: Indices
    centroids: cKDTree
    seam: cKDTree

    @classmethod
    def of(cls, drawing: SeamDrawing, curves: Sequence[SeamCurve], seam: Points) -> _Regions:
        cut = cut_surface(drawing.places.skin, surface_curves(curves))
        centroids = cKDTree(cut.vertices[cut.faces].mean(axis=1))
        return cls(face_regions(seam_net(cut)), centroids, cKDTree(seam))

    def middles(self, places: Points) -> list[Points]:
        """Return a place in the middle of each region that ``places`` (k, 3) are in, each (3,) [mm]."""
        places = places[self.seam.query(places)[0] > _CLEAR]
        if not len(places):
            return []
        regions = self.label[self.centroids.query(places)[1]]
        numbers, counts = np.unique(regions, return_counts=True)
        parts = (places[regions == number] for number in numbers[counts >= _PART])
        return [part[_nearest(part, part.mean(axis=0))] for part in parts]


def _inside(panel: Panel, vertices: Points) -> Points:
    """Return the points of a panel that are not on its outline, (k, 3) [mm]."""
    inner = np.ones(len(panel.start), dtype=bool)
    inner[np.concatenate([side.points for side in panel.sides])] = False
    return np.asarray(panel.places(vertices)[inner])


def _plans(
    drawing: SeamDrawing, plan: PanelPlan, middles: Sequence[Points], side: str, taken: Sequence[str]
) -> list[PanelPlan]:
    """Return a plan for each part of a panel with these ``middles``, each (3,) [mm].

    A panel over the middle that is divided on both sides has parts of both; they are one plan.
    """
    centre = drawing.places.middle
    sided = [plan.each] * len(middles)
    if side and not plan.each:
        off = [(1.0 if side == "left" else -1.0) * float(place[0] - centre) for place in middles]
        middles = [place for place, x in zip(middles, off, strict=True) if x > -ACROSS]
        sided = [x > ACROSS for x in off if x > -ACROSS]
    found: list[PanelPlan] = []
    for name, place, each in zip(_part_names(plan.name, middles, centre), middles, sided, strict=True):
        own = new_name(name, [*taken, *(other.name for other in found)])
        seed = word_at(drawing.places, side if each else "", place)
        found.append(replace(plan, name=own, seed=seed, each=each))
    return found


def _part_names(name: str, middles: Sequence[Points], centre: float) -> list[str]:
    """Name the parts of a panel by where they are to each other."""
    places = np.array(middles)
    apart = np.ptp(places, axis=0)
    if len(middles) == 2 and apart[2] >= np.hypot(apart[0], apart[1]):
        return [f"{'upper' if z == places[:, 2].max() else 'lower'} {name}" for z in places[:, 2]]
    off: Floats = np.abs(places[:, 0] - centre)
    if len(middles) == 2:
        return [f"{'outer' if x == off.max() else 'inner'} {name}" for x in off]
    return [f"{name} {number}" for number in range(1, len(middles) + 1)]


def new_name(name: str, known: Sequence[str]) -> str:
    """Return the name, with a number where it is ``known`` already."""
    numbered = [name, *(f"{name} {number}" for number in range(2, len(known) + 3))]
    return next(each for each in numbered if each not in known)


def without_seam(garment: CutGarment, curve: str) -> Block:
    """Return the block without a seam; the pieces on both sides of it become one.

    Raises PatternError for an edge, for a seam that another one ends on, and where it joins more than two
    pieces; KeyError for an unknown curve.
    """
    block, seam = garment.block, garment.block.seam(curve)
    ending = [each.name for each in block.seams if _ends_on(each, seam)]
    if ending:
        raise _kept(Message("The {seam} ends on this seam.", seam=SeamName(ending[0])))
    rest = replace(block, seams=tuple(each for each in block.seams if each is not seam))
    if seam.slit:
        return rest
    names = {name for name, _ in seam.named()}
    pairs = {
        frozenset(without_side(each)[0] for each in (panel.name, side.partner[0]))
        for panel in garment.panels
        for side in panel.sides
        if side.name in names and side.partner is not None
    }
    if len(pairs) != 1 or len(next(iter(pairs))) != 2:
        raise _kept(Message("This seam does not join exactly two pieces."))
    first, second = (plan for plan in block.panels if plan.name in next(iter(pairs)))
    if first.each != second.each:
        first, second = sorted((first, second), key=lambda plan: plan.each)
    one = replace(first, name=_joined_name(first.name, second.name, block))
    plans = (one if plan is first else plan for plan in block.panels if plan is not second)
    return replace(rest, panels=tuple(plans))


def _joined_name(first: str, second: str, block: Block) -> str:
    """Return the name of two pieces in one: "cup" of "upper cup" and "lower cup", else the first name."""
    common, other = (name.partition(" ")[2] for name in (first, second))
    known = common in {plan.name for plan in block.panels}
    return common if common and common == other and not known else first


def _ends_on(seam: Seam, other: Seam) -> bool:
    words = (*seam.places, *seam.right)
    return any(word.partition(">")[2].strip() == other.name for word in words)


def _kept(why: Message) -> PatternError:
    return PatternError(why, Message("Remove or move the other seams first."))
