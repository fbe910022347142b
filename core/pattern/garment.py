"""A block cut on a body: its panels, laid flat so that they can be sewn, and the pieces that they become."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from core.document.block import RING, ROOT, Block, Seam, without_side
from core.document.cloth import Cloth, Pair
from core.document.garment_pattern import ALLOWANCE, GarmentPattern
from core.errors import PatternError
from core.geometry.mesh import Points
from core.geometry.plane_sections import arc_length
from core.landmarks.types import SIDES
from core.messages import ClothName, Length, Message, PieceName, SeamName
from core.pattern.bridging import bridged_cut
from core.pattern.cloth_library import cloths_of
from core.pattern.flattening import FlatPanel, StrainSummary, strain_summary
from core.pattern.mirroring import SAME, MirrorPair, merge_mirrored, mirror_pairs
from core.pattern.notches import notched, seam_share
from core.pattern.panel import Bridge, Panel, PanelSeed, cut_panels
from core.pattern.piece import NO_ELASTICS, EdgeElastic, Piece, Side, SideKey
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamCurve, SeamDrawing
from core.pattern.seam_matching import Matched, SeamFit, match, seams_of
from core.pattern.seam_matching import Seam as SewnSeam
from core.pattern.surface_cut import cut_surface
from core.pattern.surface_trace import SurfaceCurve
from core.pipeline.build import Stages

SEWN = 0.05
"""By how much the sides of a seam may differ when all pieces are matched [mm]."""

MISFIT = 0.03
"""What a seam may differ by when its pieces are flattened alone, before it is told [1]. Source: ours."""

LOOSE, LOOSE_AREA = -0.02, 0.05
"""Cloth bags where its stretch with ease is below the first on more of a piece than the second [1]: ours."""


@dataclass(frozen=True, eq=False)
class CutGarment:
    """A ``block`` on the skin of a body at rest: its ``curves``, and ``panels`` that ride on the skin.

    Where it ``is_bridged``, panels are taut over the hollows of the skin.
    """

    block: Block
    curves: tuple[SeamCurve, ...]
    panels: tuple[Panel, ...]
    is_bridged: bool = True

    def flat(self, vertices: Points, cloths: Mapping[str, Cloth], former: Matched | None = None) -> Pattern:
        """Return the pattern on a skin with these ``vertices`` (n, 3) [mm], from ``cloths`` by their names.

        Left and right panels that are mirror images get sides of the same lengths, so that they can be one
        piece. ``former`` is the match of a pattern before, from which it starts and of which it takes these.
        """
        places = tuple(panel.places(vertices) for panel in self.panels)
        own = [cloths[panel.cloth] for panel in self.panels]
        seams = seams_of(self.panels)

        def laid(former: Matched | None, mirrors: Sequence[MirrorPair]) -> Pattern:
            return Pattern(self, match(self.panels, places, own, seams, former, mirrors), places, cloths)

        known = () if former is None else former.mirrors
        pattern = laid(former, tuple(pair for pair in known if self._is_even(pair, places)))
        if former is None and pattern.mirrors:
            pattern = laid(pattern.matched, pattern.mirrors)
        # Pieces that are not the same after all keep their own lengths.
        while (same := pattern.kept_mirrors) != pattern.matched.mirrors:
            pattern = laid(pattern.matched, same)
        return pattern

    def _is_even(self, pair: MirrorPair, places: Sequence[Points]) -> bool:
        """Return whether sides of mirrored panels, whose points are at ``places``, may be equally long."""
        number = {panel.name: at for at, panel in enumerate(self.panels)}
        left, right = number[pair.left], number[pair.right]
        lengths = (
            [arc_length(places[at][self.panels[at].sides[side].points])[-1] for at, side in both]
            for both in (((left, k), (right, other)) for k, other in enumerate(pair.sides))
        )
        return all(abs(one - two) < SAME for one, two in lengths)

    def seam_of(self, name: str) -> Seam | None:
        """Return the seam of the block of this name, with or without its side; None if there is none."""
        try:
            return self.block.seam(name)
        except KeyError:
            return None


def cut_garment(drawing: SeamDrawing, block: Block, is_bridged: bool = True) -> CutGarment:
    """Cut a block on a body, its cloth over hollows where it ``is_bridged``, but not along wires.

    Raises PatternError, LineError for a body that it does not fit.
    """
    if not block.seams:
        raise PatternError(
            Message("The block {name} cannot be used: {why}.", name=block.name, why="it has no seam"),
            Message("Correct the file or choose another block."),
        )
    curves = drawing.curves(block)
    cut = cut_surface(drawing.places.skin, surface_curves(curves))
    panels = cut_panels(
        cut, panel_seeds(drawing, block, curves), bridge=bridge_of(curves) if is_bridged else None
    )
    return CutGarment(block, curves, panels, is_bridged)


def bridge_of(curves: Sequence[SeamCurve]) -> Bridge:
    """Return what moves the skin to where cloth spans its hollows: it lies along wires and bands."""
    wires, bands = ([at for at, each in enumerate(curves) if each.seam.kind == kind] for kind in (ROOT, RING))
    return partial(bridged_cut, wires=wires, bands=bands)


def surface_curves(curves: Iterable[SeamCurve]) -> tuple[SurfaceCurve, ...]:
    """Return seams as curves that cut the skin."""
    return tuple(SurfaceCurve(each.name, each.points, each.seam.slit, each.seam.edge) for each in curves)


def panel_seeds(drawing: SeamDrawing, block: Block, curves: Sequence[SeamCurve]) -> tuple[PanelSeed, ...]:
    """Return the seed of each panel of a block whose seams are ``curves``. Raises PatternError."""
    levels, drawn = drawing.levels(block), {each.name: each.points for each in curves}
    return tuple(
        PanelSeed(
            f"{plan.name} {side}".rstrip(),
            drawing.places.place(plan.seed, side, levels, drawn),
            plan.cloth,
            -plan.turn if side == "right" else plan.turn,
        )
        for plan in block.panels
        for side in (SIDES if plan.each else ("",))
    )


def pattern_of(stages: Stages, worn_vertices: Points, plan: GarmentPattern) -> Pattern:
    """Return the pattern of a design on its reshaped body, whose vertices (n, 3) [mm] are given.

    Raises PatternError, LineError for a body or cloths that the block does not fit.
    """
    cloths = cloths_of(plan)
    garment = cut_garment(SeamDrawing(BodyPlaces.of(stages)), plan.block, plan.bridged)
    return garment.flat(worn_skin(stages, worn_vertices), cloths)


def worn_skin(stages: Stages, worn_vertices: Points) -> Points:
    """Return the vertices of a reshaped body without the noise of the scanner, (n, 3) [mm]."""
    body = stages.body
    return np.asarray(body.smoothed.vertices + worn_vertices - body.mesh.vertices)


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

    def problem(self, flat: FlatPanel) -> Message | None:
        """Return why a piece cannot be cut and sewn as it is, None if it can.

        It must lie flat, its cloth take up its strain on 95 % of its area, and its seams agree.
        """
        return self._problems[flat.panel.name]

    @cached_property
    def _problems(self) -> Mapping[str, Message | None]:
        return {flat.panel.name: self._problem_of(flat) for flat in self.flats}

    def _problem_of(self, flat: FlatPanel) -> Message | None:
        if flat.is_folded:
            return Message("Cannot be flattened without folds.")
        if flat.overlaps:
            return Message("Overlaps itself when flattened.")
        if strained := self.strain_problem(flat):
            return strained
        sewn = [seam for seam in self.matched.seams if self.flats.index(flat) in seam.panels]
        return next(filter(None, map(self.seam_problem, sewn)), None)

    def strain_problem(self, flat: FlatPanel) -> Message | None:
        """Return by how much the strain of a piece exceeds the limit of its cloth, None if it does not."""
        cloth, within = self.cloths[flat.panel.cloth], self.strains[flat.panel.name].within
        if within <= cloth.limit:
            return None
        return Message(
            "Strain of {strain} % on 95 % of the area exceeds {limit} %, the limit of {cloth}.",
            strain=f"{100.0 * within:.1f}",
            cloth=ClothName(cloth.title),
            limit=f"{100.0 * cloth.limit:g}",
        )

    def seam_problem(self, seam: SewnSeam) -> Message | None:
        """Return why a seam cannot be sewn: its sides still differ when all pieces are matched. Else None."""
        first, second = (
            self.flats[panel].side_length(side) for panel, side in zip(seam.panels, seam.sides, strict=True)
        )
        apart = abs(first - seam.ratio * second)
        if apart <= SEWN:
            return None
        return Message(
            "The sides of the {seam} differ by {difference}.",
            seam=SeamName(seam.name),
            difference=Length(apart, 2),
        )

    def seam_note(self, fit: SeamFit) -> Message | None:
        """Return which piece is longer at a seam before all are matched, None if it matters little."""
        if abs(fit.misfit) <= MISFIT:
            return None
        longer, other = fit.seam.panels if fit.misfit > 0.0 else fit.seam.panels[::-1]
        return Message(
            "The {piece} is {difference} longer than the {other} before matching: ease it in, or add a seam.",
            piece=PieceName(self.flats[longer].panel.name),
            difference=Length(abs(fit.alone[0] - fit.seam.ratio * fit.alone[1]), 1),
            other=PieceName(self.flats[other].panel.name),
        )

    def worn_stretch(self, flat: FlatPanel) -> Pair:
        """Return how far a piece is stretched when worn, with its ease, in the mean across and down [1]."""
        across, down = flat.areas @ flat.totals / flat.areas.sum()
        return float(across), float(down)

    def note(self, flat: FlatPanel) -> Message | None:
        """Return where a piece that fits bags when worn, as its cloth is not stretched, else None."""
        loose = flat.areas @ (flat.totals < LOOSE) / flat.areas.sum()  # across and down
        if loose.max() <= LOOSE_AREA or not self.fits(flat):
            return None
        texts = (
            Message("Bags across on {share} % of the area: choose a cloth with more ease."),
            Message("Bags down on {share} % of the area: choose a cloth with more ease."),
        )
        return texts[int(loose.argmax())].fill(share=f"{100.0 * loose.max():.0f}")

    def fits(self, flat: FlatPanel) -> bool:
        """Return whether a piece can be cut and sewn as it is, see ``problem``."""
        return self.problem(flat) is None

    @property
    def fits_cloths(self) -> bool:
        """Return whether all pieces and seams can be cut and sewn as they are."""
        return all(map(self.fits, self.flats))

    def seam_length(self, fit: SeamFit) -> float:
        """Return the length of a seam on the body [mm]."""
        panel, points = fit.seam.panels[0], fit.seam.points[0]
        return float(np.linalg.norm(np.diff(self.places[panel][points], axis=0), axis=1).sum())

    def pieces(
        self, allowance: float = ALLOWANCE, elastics: Mapping[SideKey, EdgeElastic] = NO_ELASTICS
    ) -> tuple[Piece, ...]:
        """Return the pieces to cut, with notches and an ``allowance`` [mm]; equal left and right as one.

        Seams that have an allowance of their own keep it. ``elastics`` are those of edges, see
        ``core.pattern.edge_elastics``.
        """
        sewn = [self._piece(flat, allowance, elastics) for flat in self.flats]
        return merge_mirrored(notched(sewn, self._own_notches))

    @cached_property
    def mirrors(self) -> tuple[MirrorPair, ...]:
        """Return the panels of which left and right are the same."""
        return mirror_pairs(self._bare)

    @property
    def kept_mirrors(self) -> tuple[MirrorPair, ...]:
        """Return those panels that were matched with sides of the same lengths and are the same."""
        return tuple(pair for pair in self.matched.mirrors if pair in self.mirrors)

    @cached_property
    def _own_notches(self) -> Mapping[str, tuple[float, ...]]:
        seams = self.garment.block.seams
        return {seam.name: seam.notches for seam in seams if seam.notches is not None}

    @cached_property
    def notches(self) -> Mapping[SideKey, tuple[float, ...]]:
        """Return the notches of sides that are sewn, as shares of their lengths, by panel and number."""
        pieces = notched(self._bare, self._own_notches)
        return {(piece.key, at): side.notches for piece in pieces for at, side in enumerate(piece.sides)}

    def notch_share(self, seam: SewnSeam, share: float) -> float:
        """Return what a block keeps of a notch of a seam at a share of its first side [1]."""
        key = self.flats[seam.panels[0]].panel.name, seam.sides[0]
        return seam_share(self._bare, key, share)

    @cached_property
    def _bare(self) -> tuple[Piece, ...]:
        """Return the pieces one by one, without allowance, elastics and notches."""
        return tuple(self._piece(flat, 0.0, NO_ELASTICS) for flat in self.flats)

    def _piece(self, flat: FlatPanel, allowance: float, elastics: Mapping[SideKey, EdgeElastic]) -> Piece:
        panel = flat.panel
        name, side = without_side(panel.name)
        sides = []
        for number, own in enumerate(panel.sides):
            elastic = elastics.get((panel.name, number))
            seam = self.garment.seam_of(own.name)
            width = allowance if seam is None or seam.allowance is None else seam.allowance
            notches = elastic.marks if elastic else ()
            kind, points = without_side(own.name)[0], flat.points[own.points]
            sides.append(Side(kind, points, width, notches, own.partner, elastic))
        cloth = self.cloths[panel.cloth]
        stretch = (0.0, 1.0) if cloth.stretches_down else (1.0, 0.0)
        return Piece(name, side, cloth.title, 1, tuple(sides), stretch=stretch)
