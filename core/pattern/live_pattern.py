"""Patterns of a body while it is reshaped and edited: unchanged stages are reused (ours)."""

from __future__ import annotations

import operator

from core.document.garment_pattern import GarmentPattern
from core.geometry.mesh import Points
from core.pattern.cloth_library import cloths_of
from core.pattern.garment import CutGarment, Pattern, cut_garment, worn_skin
from core.pattern.places import BodyPlaces
from core.pattern.recut import recut
from core.pattern.seam_curves import SeamDrawing
from core.pattern.seam_matching import Matched
from core.pipeline.build import Stages


class LivePattern:
    """Computes patterns one after the other; seams, panels and the last solution are kept between them.

    ``drawing`` draws seams on the original body of the last pattern. Used by one thread at a time.
    """

    def __init__(self) -> None:
        self.drawing: SeamDrawing | None = None
        self._inputs: tuple[object, ...] = ()  # of the drawing
        self._garment: CutGarment | None = None
        self._partly_cut = False
        self._matched: Matched | None = None

    def pattern(self, stages: Stages, worn_vertices: Points, plan: GarmentPattern, *, final: bool) -> Pattern:
        """Return the pattern of a reshaped body whose vertices (n, 3) [mm] are given.

        A ``final`` one is that of ``pattern_of``; others are for the screen: where the block has changed only
        the panels concerned are cut again, and matching starts from the last solution. Raises PatternError,
        LineError for a body or cloths that the block does not fit.
        """
        cloths = cloths_of(plan)
        garment = self._cut(self._drawing_on(stages), plan, final)
        former = None if final else self._matched
        pattern = garment.flat(worn_skin(stages, worn_vertices), cloths, former)
        self._matched = pattern.matched
        return pattern

    def _drawing_on(self, stages: Stages) -> SeamDrawing:
        lower = () if stages.lower is None else (stages.lower.landmarks,)
        inputs = (stages.body, stages.landmarks, *(each.fitted for each in stages.regions), *lower)
        same = len(inputs) == len(self._inputs) and all(map(operator.is_, inputs, self._inputs))
        if self.drawing is None or not same:
            self.drawing, self._inputs = SeamDrawing(BodyPlaces.of(stages)), inputs
            self._garment = self._matched = None
        return self.drawing

    def _cut(self, drawing: SeamDrawing, plan: GarmentPattern, final: bool) -> CutGarment:
        former = self._garment
        if former is not None and former.is_bridged != plan.bridged:
            former = None
        if former is not None and former.block == plan.block and not (final and self._partly_cut):
            return former
        whole = former is None or final
        if former is None or final:
            self._garment = cut_garment(drawing, plan.block, plan.bridged)
        else:
            self._garment = recut(former, drawing, plan.block)
        self._partly_cut, self._matched = not whole, None
        return self._garment
