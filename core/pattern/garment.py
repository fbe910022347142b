"""A block cut on a body: its panels, laid flat so that they can be sewn, and the pieces that they become."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.document.block import Block
from core.document.cloth import Cloth
from core.document.garment_pattern import ALLOWANCE
from core.geometry.mesh import Points
from core.landmarks.types import SIDES
from core.pattern.flattening import FlatPanel, StrainSummary, strain_summary
from core.pattern.notches import notched
from core.pattern.panel import Panel, PanelSeed, cut_panels
from core.pattern.piece import Piece, Side, merge_mirrored
from core.pattern.seam_curves import SeamCurve, SeamDrawing
from core.pattern.seam_matching import Matched, SeamFit, match, seams_of
from core.pattern.surface_cut import cut_surface
from core.pattern.surface_trace import SurfaceCurve


@dataclass(frozen=True, eq=False)
class CutGarment:
    """A ``block`` on the skin of a body at rest: its ``curves``, and ``panels`` that ride on the skin."""

    block: Block
    curves: tuple[SeamCurve, ...]
    panels: tuple[Panel, ...]

    def flat(self, vertices: Points, cloths: Mapping[str, Cloth], former: Matched | None = None) -> Pattern:
        """Return the pattern on a skin with these ``vertices`` (n, 3) [mm], from ``cloths`` by their names.

        ``former`` is the match of a pattern before, from which it starts.
        """
        places = [panel.places(vertices) for panel in self.panels]
        own = [cloths[panel.cloth] for panel in self.panels]
        return Pattern(
            self, match(self.panels, places, own, seams_of(self.panels), former), tuple(places), cloths
        )


def cut_garment(drawing: SeamDrawing, block: Block) -> CutGarment:
    """Cut a block on a body. Raises PatternError, LineError for a body that it does not fit."""
    curves = drawing.curves(block)
    cut = cut_surface(drawing.places.skin, surface_curves(curves))
    return CutGarment(block, curves, cut_panels(cut, panel_seeds(drawing, block, curves)))


def surface_curves(curves: Iterable[SeamCurve]) -> tuple[SurfaceCurve, ...]:
    """Return seams as curves that cut the skin."""
    return tuple(SurfaceCurve(each.name, each.points, each.seam.slit, each.seam.edge) for each in curves)


def panel_seeds(drawing: SeamDrawing, block: Block, curves: Sequence[SeamCurve]) -> tuple[PanelSeed, ...]:
    """Return a place in each panel of a block whose seams are ``curves``. Raises PatternError."""
    levels, drawn = drawing.levels(block), {each.name: each.points for each in curves}
    return tuple(
        PanelSeed(
            f"{plan.name} {side}".rstrip(),
            drawing.places.place(plan.seed, side, levels, drawn),
            plan.cloth,
            plan.turn,
        )
        for plan in block.panels
        for side in (SIDES if plan.each else ("",))
    )


@dataclass(frozen=True, eq=False)
class Pattern:
    """The panels of a garment laid flat together; ``places`` are those of their points on the body [mm]."""

    garment: CutGarment
    matched: Matched
    places: tuple[Points, ...]
    cloths: Mapping[str, Cloth]

    @property
    def flats(self) -> tuple[FlatPanel, ...]:
        """Return the panels laid flat."""
        return self.matched.flats

    @cached_property
    def strains(self) -> Mapping[str, StrainSummary]:
        """Return the strain of each panel, by its name."""
        return {
            flat.panel.name: strain_summary(flat, self.cloths[flat.panel.cloth].limit) for flat in self.flats
        }

    def fits(self, flat: FlatPanel) -> bool:
        """Return whether a piece lies flat, and its cloth takes up its strain on 95 % of its area."""
        cloth = self.cloths[flat.panel.cloth]
        return not (flat.is_folded or flat.overlaps) and self.strains[flat.panel.name].within <= cloth.limit

    @property
    def fits_cloths(self) -> bool:
        """Return whether all pieces lie flat and fit their cloths."""
        return all(map(self.fits, self.flats))

    def seam_length(self, fit: SeamFit) -> float:
        """Return the length of a seam on the body [mm]."""
        panel, points = fit.seam.panels[0], fit.seam.points[0]
        return float(np.linalg.norm(np.diff(self.places[panel][points], axis=0), axis=1).sum())

    def pieces(self, allowance: float = ALLOWANCE) -> tuple[Piece, ...]:
        """Return the pieces to cut, with notches and an ``allowance`` [mm]; equal left and right as one."""
        return merge_mirrored(notched([self._piece(flat, allowance) for flat in self.flats]))

    def _piece(self, flat: FlatPanel, allowance: float) -> Piece:
        name, side = flat.panel.name, ""
        for each in SIDES:
            if name.endswith(f" {each}"):
                name, side = name.removesuffix(f" {each}"), each
        sides = tuple(
            Side(_kind(own.name), flat.points[own.points], allowance, partner=own.partner)
            for own in flat.panel.sides
        )
        return Piece(name, side, self.cloths[flat.panel.cloth].title, 1, sides)


def _kind(name: str) -> str:
    """Return the name of a seam without its side."""
    return name.removesuffix(" left").removesuffix(" right")
