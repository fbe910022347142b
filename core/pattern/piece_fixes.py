"""Fixes for a piece whose strain exceeds the limit of its cloth: a dart, another cloth, one more seam.

Each is verified: the changed block is cut again on the body, and all its pieces are matched.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from core.document.block import WAY, Block, PanelPlan, Seam, without_side
from core.errors import PatternError, UserError
from core.geometry.mesh import Points
from core.landmarks.types import SIDES
from core.messages import ClothName, Message, PieceName, SeamName
from core.pattern.breast_map import BreastMap
from core.pattern.dart_chart import CLEAR, Dart, DartChart, dart_chart
from core.pattern.garment import CutGarment, Pattern, cut_garment
from core.pattern.panel import Panel
from core.pattern.place_words import word_at
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pattern.seam_edits import new_name, with_dividing_seam
from core.progress import Progress, quiet

DART, CLOTH, SEAM = "dart", "cloth", "seam"

MOST_CLOTHS, MOST_DARTS = 2, 2
"""Cloths and darts that are suggested for a piece."""

_APART = 40.0  # darts start at least so far from each other [degrees]
_ORDER = (DART, CLOTH, SEAM)  # of suggestions where both fit


@dataclass(frozen=True)
class PieceFix:
    """A changed ``block`` in which a piece has less strain: ``left`` on 95 % of its area [1], measured.

    ``kind`` is DART, CLOTH or SEAM. ``limit`` [1] is that of its cloth, ``fits`` whether all that the piece
    has become fit, ``others`` how many other pieces do not.
    """

    kind: str
    message: Message
    block: Block
    left: float
    limit: float
    fits: bool
    others: int


@dataclass(frozen=True, eq=False)
class _Change:
    kind: str
    message: Callable[[str, str], Message]
    block: Block
    plans: tuple[str, ...]


def piece_fixes(
    pattern: Pattern, piece: str, drawing: SeamDrawing, vertices: Points, progress: Progress = quiet
) -> tuple[PieceFix, ...]:
    """Return fixes for the piece of this name, with its side: those that fit first, then the least change.

    ``drawing`` is of the body on which the pattern was cut, ``vertices`` (n, 3) [mm] where it is laid flat.
    A dart or seam is suggested near a breast alone, and none that leaves more strain. Raises Cancelled.
    """
    panel = next(each for each in pattern.garment.panels if each.name == piece)
    before = pattern.strains[piece].within
    changes = [*_cloths(pattern, panel), *_cuts(pattern, panel, drawing, progress)]
    found = []
    for number, change in enumerate(changes):
        progress("fixes", 0.3 + 0.7 * number / len(changes))
        fix = _tried(change, pattern, drawing, vertices)
        if fix is not None and (fix.fits or fix.left < before):
            found.append(fix)
    progress("fixes", 1.0)
    found.sort(key=_rank)
    cloths = [each for each in found if each.kind == CLOTH][:MOST_CLOTHS]
    return tuple(each for each in found if each.kind != CLOTH or each in cloths)


def _rank(fix: PieceFix) -> tuple[bool, int, int, float]:
    """Order what fits before what does not, and cloths by how little they stretch further."""
    last = fix.limit if fix.kind == CLOTH else fix.left
    return not fix.fits, fix.others, _ORDER.index(fix.kind), last


def _tried(change: _Change, pattern: Pattern, drawing: SeamDrawing, vertices: Points) -> PieceFix | None:
    """Return a change with its measured strain; None where it cannot be cut."""
    try:
        if change.kind == CLOTH:
            garment = _with_cloths(pattern.garment, change.block)
        else:
            garment = cut_garment(drawing, change.block, pattern.garment.is_bridged)
        tried = garment.flat(vertices, pattern.cloths)
    except UserError:
        return None
    own = [flat for flat in tried.flats if without_side(flat.panel.name)[0] in change.plans]
    left = max(tried.strains[flat.panel.name].within for flat in own)
    limit = min(tried.cloths[flat.panel.cloth].limit for flat in own)
    others = sum(not tried.fits(flat) for flat in tried.flats if flat not in own)
    message = change.message(f"{100.0 * left:.1f}", f"{100.0 * limit:g}")
    return PieceFix(change.kind, message, change.block, left, limit, all(map(tried.fits, own)), others)


def _with_cloths(garment: CutGarment, block: Block) -> CutGarment:
    """Return the same panels of the cloths of a block."""
    cloths = {plan.name: plan.cloth for plan in block.panels}
    panels = tuple(replace(each, cloth=cloths[without_side(each.name)[0]]) for each in garment.panels)
    return replace(garment, block=block, panels=panels)


def _cloths(pattern: Pattern, panel: Panel) -> Iterator[_Change]:
    """Yield the cloths that take up more than that of a panel, and could take up its strain."""
    block, name = pattern.garment.block, without_side(panel.name)[0]
    own, needed = pattern.cloths[panel.cloth].limit, pattern.strains[panel.name].within
    for cloth in sorted(pattern.cloths.values(), key=lambda each: each.limit):
        if cloth.limit > max(own, 0.8 * needed):
            plans = tuple(replace(p, cloth=cloth.name) if p.name == name else p for p in block.panels)
            message = partial(_cloth_message, cloth.title)
            yield _Change(CLOTH, message, replace(block, panels=plans), (name,))


def _cuts(pattern: Pattern, panel: Panel, drawing: SeamDrawing, progress: Progress) -> list[_Change]:
    """Return darts and one more seam, for a piece that a breast shapes."""
    number = pattern.garment.panels.index(panel)
    breast = _breast_of(panel, pattern.places[number], drawing)
    if breast is None:
        return []
    cloth = pattern.cloths[panel.cloth]
    chart = dart_chart(
        panel, pattern.places[number], cloth, breast=breast, progress=lambda _, s: progress("darts", 0.3 * s)
    )
    chosen: list[Dart] = []
    for dart in sorted(chart.darts, key=lambda each: each.within):
        if all(abs((_clock(dart) - _clock(other) + 180.0) % 360.0 - 180.0) >= _APART for other in chosen):
            chosen.append(dart)
    plan = next(p for p in pattern.garment.block.panels if p.name == without_side(panel.name)[0])
    side = without_side(panel.name)[1] or SIDES[0]
    block, places = pattern.garment.block, drawing.places
    changes = [_with_dart(block, plan, dart, places, side) for dart in chosen[:MOST_DARTS]]
    if chosen:
        changes += _with_seam(pattern, plan, panel, chart, chosen[0], drawing)
    return changes


def _clock(dart: Dart) -> float:
    assert dart.clock is not None
    return dart.clock


def _breast_of(panel: Panel, places: Points, drawing: SeamDrawing) -> BreastMap | None:
    """Return the breast that shapes a panel, that of its side or the left one; None away from breasts."""
    side = next((each for each in SIDES if panel.name.endswith(f" {each}")), SIDES[0])
    if not drawing.places.landmarks.points.keys() >= {f"bust_point_{side}"}:
        return None
    breast = drawing.places.breasts[side]
    nearest = float(np.linalg.norm(places - breast.apex, axis=1).min())
    return breast if nearest < 0.5 * float(breast.root.mean()) else None


def _start_word(dart: Dart) -> str:
    return f"root {_clock(dart):.0f} > {without_side(dart.seam)[0]}"


def _with_dart(block: Block, plan: PanelPlan, dart: Dart, places: BodyPlaces, side: str) -> _Change:
    """Return a block with one more slit on each side."""
    name = new_name(f"{plan.name} dart", [seam.name for seam in block.seams])
    end = word_at(places, side, dart.end)
    seam = Seam(name, WAY, each=True, places=(_start_word(dart), end), slit=True)
    message = partial(_dart_message, dart)
    return _Change(DART, message, replace(block, seams=(*block.seams, seam)), (plan.name,))


def _with_seam(
    pattern: Pattern, plan: PanelPlan, panel: Panel, chart: DartChart, dart: Dart, drawing: SeamDrawing
) -> Iterator[_Change]:
    """Yield the block in which the place of a dart is a seam right through a panel, over the bust point."""
    garment, places = pattern.garment, pattern.places[pattern.garment.panels.index(panel)]
    side = without_side(panel.name)[1]
    if not plan.each:
        return
    apex = drawing.places.breasts[side].apex
    away = {each.name: _distance(places[each.points], apex) for each in panel.sides}
    nearest = min(away, key=lambda name: away[name])
    if away[nearest] < CLEAR:
        stops = [_start_word(dart), f"apex > {without_side(nearest)[0]}"]
    else:
        other = min(chart.darts, key=lambda each: abs((_clock(each) - _clock(dart)) % 360.0 - 180.0))
        stops = [_start_word(dart), "apex", _start_word(other)]
    name = new_name(f"{plan.name} seam", [seam.name for seam in garment.block.seams])
    try:
        block = with_dividing_seam(drawing, garment, Seam(name, WAY, each=True, places=tuple(stops)), side)
    except UserError:
        return
    names = {each.name for each in block.panels} - {each.name for each in garment.block.panels}
    yield _Change(SEAM, partial(_seam_message, plan.name, dart), block, tuple(names))


def _cloth_message(cloth: str, left: str, limit: str) -> Message:
    return Message("{cloth}: {left} % of {limit} %.", cloth=ClothName(cloth), left=left, limit=limit)


def _dart_message(dart: Dart, left: str, limit: str) -> Message:
    return Message(
        "A dart from the {seam} at {clock}\N{DEGREE SIGN}: {left} % of {limit} %.",
        seam=SeamName(without_side(dart.seam)[0]),
        clock=f"{_clock(dart):.0f}",
        left=left,
        limit=limit,
    )


def _seam_message(piece: str, dart: Dart, left: str, limit: str) -> Message:
    return Message(
        "A seam through the {piece} from the {seam} at {clock}\N{DEGREE SIGN}: {left} % of {limit} %.",
        piece=PieceName(piece),
        seam=SeamName(without_side(dart.seam)[0]),
        clock=f"{_clock(dart):.0f}",
        left=left,
        limit=limit,
    )


def _distance(curve: Points, place: Points) -> float:
    return float(np.linalg.norm(curve - place, axis=1).min())


def with_dart(pattern: Pattern, piece: str, dart: Dart, drawing: SeamDrawing) -> Block:
    """Return the block of a pattern with a dart of the chart of a piece, on both sides.

    Raises PatternError for a piece that no breast shapes.
    """
    number = [panel.name for panel in pattern.garment.panels].index(piece)
    panel, block = pattern.garment.panels[number], pattern.garment.block
    breast = _breast_of(panel, pattern.places[number], drawing)
    if breast is None or dart.clock is None:
        raise PatternError(
            Message("A dart can be added near a breast only."), Message("Draw the dart on the body instead.")
        )
    plan = next(each for each in block.panels if each.name == without_side(piece)[0])
    return _with_dart(block, plan, dart, drawing.places, without_side(piece)[1] or SIDES[0]).block


def chart_of(pattern: Pattern, piece: str, drawing: SeamDrawing, progress: Progress = quiet) -> DartChart:
    """Return what darts do for a piece of a pattern, by the clock where a breast shapes it.

    Raises Cancelled.
    """
    number = [panel.name for panel in pattern.garment.panels].index(piece)
    panel, places = pattern.garment.panels[number], pattern.places[number]
    breast = _breast_of(panel, places, drawing)
    return dart_chart(panel, places, pattern.cloths[panel.cloth], breast=breast, progress=progress)
