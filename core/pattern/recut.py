"""A garment cut again after its block has changed: only panels that a changed seam touches (ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from core.document.block import Block
from core.errors import PatternError
from core.geometry.mesh import Flags, Mesh, Points
from core.geometry.plane_sections import arc_length
from core.pattern.garment import CutGarment, bridge_of, cut_garment, panel_seeds, surface_curves
from core.pattern.panel import Panel, PanelSeed, cut_panels
from core.pattern.seam_curves import SeamCurve, SeamDrawing
from core.pattern.surface_cut import cut_surface

NEAR = 10.0
"""Curves nearer than this to the outline of a panel may end on it [mm]: more than steps of both, and SNAP."""


SAME = 0.01
"""An end of a curve that moved less is where it was [mm]."""

CLEAR = 25.0
"""Within this of an end that is where it was, a curve touches no panel beyond the seam that it meets [mm]."""


def recut(former: CutGarment, drawing: SeamDrawing, block: Block) -> CutGarment:
    """Return the garment of a changed ``block`` on the body of ``former``.

    Panels that no changed seam touches are the same objects. It is what ``cut_garment`` returns, but for two
    things: on the seams of those panels there are as many points as there were, and cloth over a hollow is
    taut within the panels that are cut again alone. Where seams, panels or levels are others all is cut.
    Raises PatternError, LineError for a body that the block does not fit.
    """
    curves = drawing.curves(block)
    if not _is_alike(former, block, curves):
        return cut_garment(drawing, block, former.is_bridged)
    seeds = {seed.name: seed for seed in panel_seeds(drawing, block, curves)}
    skin = drawing.places.skin
    touched = _touched(former, block, curves, skin)
    if not touched:
        return replace(former, block=block, curves=curves)
    kept = tuple(panel for panel in former.panels if panel.name not in touched)
    again = [panel for panel in former.panels if panel.name in touched]
    try:
        own = [seeds[panel.name] for panel in again]
        cut = _cut_again(again, kept, curves, own, skin, former.is_bridged)
    except PatternError:  # all seams are needed to say what is wrong
        return cut_garment(drawing, block, former.is_bridged)
    panels = {panel.name: panel for panel in (*kept, *cut)}
    sewn = _sewn(panels, touched)
    if sewn is None:
        return cut_garment(drawing, block, former.is_bridged)
    panels_ = tuple(sewn[panel.name] for panel in former.panels)
    return CutGarment(block, curves, panels_, former.is_bridged)


def _is_alike(former: CutGarment, block: Block, curves: Sequence[SeamCurve]) -> bool:
    """Return whether levels, and the names of seams and panels, are those of the garment before."""
    names = [curve.name for curve in curves] == [curve.name for curve in former.curves]
    plans = [(each.name, each.each) for each in block.panels]
    return (
        names
        and block.levels == former.block.levels
        and plans == [(each.name, each.each) for each in former.block.panels]
    )


def _touched(former: CutGarment, block: Block, curves: Sequence[SeamCurve], skin: Mesh) -> set[str]:
    """Return the names of the panels that are other ones, or that a changed seam may touch."""
    pairs = zip(former.block.panels, block.panels, strict=True)
    others = {new.name for old, new in pairs if old != new}
    names = {panel.name for panel in former.panels if _plan_of(panel.name) in others}
    moved, places = set(), [np.zeros((0, 3))]
    for old, new in zip(former.curves, curves, strict=True):
        alike = (old.seam.slit, old.seam.edge) == (new.seam.slit, new.seam.edge)
        if alike and np.array_equal(old.points, new.points):
            continue
        moved.add(new.name)
        ends = np.linalg.norm(old.points[[0, -1]] - new.points[[0, -1]], axis=1) < SAME
        places += [_between(each.points, ends) for each in (old, new)]
    names |= {panel.name for panel in former.panels if any(side.name in moved for side in panel.sides)}
    whole = np.concatenate(places)
    if len(whole):
        tree = cKDTree(whole)
        names |= {panel.name for panel in former.panels if _is_near(tree, _outline(panel, skin))}
    return names


def _between(points: Points, kept: Flags) -> Points:
    """Return the points of a curve without those near its ends that are ``kept`` (2,).

    There it meets other seams in the same places as before, and the panels beyond them stay as they are.
    """
    along = arc_length(points)
    inner = (along >= CLEAR * kept[0]) & (along <= along[-1] - CLEAR * kept[1])
    return np.asarray(points[inner])


def _plan_of(name: str) -> str:
    return name.removesuffix(" left").removesuffix(" right")


def _outline(panel: Panel, skin: Mesh) -> Points:
    points = np.concatenate([side.points for side in panel.sides])
    return np.asarray(panel.places(skin.vertices)[points])


def _is_near(tree: cKDTree, places: Points) -> bool:
    return bool(np.min(tree.query(places, distance_upper_bound=NEAR)[0]) < NEAR)


def _cut_again(
    again: Sequence[Panel],
    kept: tuple[Panel, ...],
    curves: Sequence[SeamCurve],
    seeds: Sequence[PanelSeed],
    skin: Mesh,
    is_bridged: bool,
) -> tuple[Panel, ...]:
    """Cut panels ``again``, on their part of the skin and along the curves near it."""
    within: Flags = np.zeros(len(skin.faces), dtype=bool)
    for panel in again:
        within[panel.origin] = True
    tree = cKDTree(skin.vertices[np.unique(skin.faces[within])])
    near = [curve for curve in curves if _is_near(tree, curve.points)]
    cut = cut_surface(skin, surface_curves(near), within)
    bridge = bridge_of(near) if is_bridged else None
    return cut_panels(cut, tuple(seeds), bridge=bridge, kept=kept)


def _sewn(panels: dict[str, Panel], again: set[str]) -> dict[str, Panel] | None:
    """Sew kept panels to those that were cut again; None where a side has lost its partner."""
    partner = {
        side.partner: (panel.name, number)
        for panel in panels.values()
        if panel.name in again
        for number, side in enumerate(panel.sides)
        if side.partner is not None
    }
    found = dict(panels)
    for panel in panels.values():
        if panel.name in again:
            continue
        sides = []
        for number, side in enumerate(panel.sides):
            other = partner.get((panel.name, number))
            if (other is None) != (side.partner is None or side.partner[0] not in again):
                return None
            sides.append(side if other in (None, side.partner) else replace(side, partner=other))
        if any(new is not old for new, old in zip(sides, panel.sides, strict=True)):
            found[panel.name] = replace(panel, sides=tuple(sides))
    return found
