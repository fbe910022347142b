"""Pattern pieces of all blocks on bodies: faults, strain, bridged hollows, darts, and sewn together again.

    python benchmarks/pattern_validation.py FOLDER... [pieces] [bridges] [darts] [sewn] [blocks=NAME,NAME]

``FOLDER`` holds scans in mm, z up, facing -y, or is one scan; each is reshaped by its mid-bust line at 97 %.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np

from core.document.block import Block
from core.document.design import Design, ScanSource
from core.document.lines import ActiveLine
from core.document.lower_trunk import LowerTrunk
from core.errors import UserError
from core.geometry.mesh import Points, area_vectors, boundary_loops
from core.pattern.block_library import built_in_blocks
from core.pattern.cloth_library import built_in
from core.pattern.dart_chart import dart_chart
from core.pattern.garment import Pattern, cut_garment
from core.pattern.places import BodyPlaces
from core.pattern.seam_curves import SeamDrawing
from core.pattern.sewn_again import sewn_again
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve

CLOTHS = {cloth.name: cloth for cloth in built_in()}
PARTS = ("pieces", "bridges", "darts", "sewn")


class Scan:
    """A reshaped body on which blocks are drawn."""

    def __init__(self, path: Path) -> None:
        source = ScanSource(str(path), unit="mm", up="+z", front="-y")
        design = Design(source, volume="exact", lines=(ActiveLine("mid-bust", 0.97),))
        self.name, self.stages = path.stem, _built(design)
        body = solve(self.stages).body.vertices
        self.worn = self.stages.body.smoothed.vertices + body - self.stages.body.mesh.vertices
        self.drawing = SeamDrawing(BodyPlaces.of(self.stages))
        self.pattern = cache(self._pattern)

    def _pattern(self, block: Block, is_bridged: bool = True) -> Pattern:
        return cut_garment(self.drawing, block, is_bridged).flat(self.worn, CLOTHS)

    def fits(self, block: Block) -> bool:
        """Return whether the body shows what the block is told from."""
        return self.stages.lower is not None or not block.needs_lower_trunk


def _built(design: Design) -> Stages:
    try:
        return build(replace(design, lower=LowerTrunk()))
    except UserError:  # a scan without legs
        return build(design)


def pieces(scan: Scan, block: Block) -> Iterator[str]:
    """Tell faults and the strain of each kind of piece against the limit of its cloth."""
    found = scan.pattern(block)
    worst: dict[str, float] = {}
    for flat in found.flats:
        name = flat.panel.name.removesuffix(" left").removesuffix(" right")
        worst[name] = max(worst.get(name, 0.0), 100.0 * found.strains[flat.panel.name].within)
    limits = {plan.name: 100.0 * CLOTHS[plan.cloth].limit for plan in block.panels}
    strains = ", ".join(
        f"{name} {worst[name]:.1f}/{limits[name]:g}{'!' if worst[name] > limits[name] else ''}" for name in worst
    )
    sewn = max((abs(fit.together[0] - fit.together[1]) for fit in found.matched.fits), default=0.0)
    alone = max((abs(fit.misfit) for fit in found.matched.fits), default=0.0)
    yield f"{_faults(found)} | {sewn:.5f} | {100.0 * alone:.1f} | {strains}"


def _faults(found: Pattern) -> str:
    faults = []
    for flat, places in zip(found.flats, found.places, strict=True):
        panel = flat.panel
        if flat.is_folded:
            faults.append(f"fold in {panel.name}")
        if flat.overlaps:
            faults.append(f"overlap in {panel.name}")
        if len(boundary_loops(panel.faces)) != 1:
            faults.append(f"hole in {panel.name}")
        rest = panel.places(found.garment_skin) if hasattr(found, "garment_skin") else places
        area = float(np.linalg.norm(area_vectors(rest, panel.faces), axis=1).sum())
        if not np.isfinite(area):
            faults.append(f"area of {panel.name}")
    return ", ".join(faults) or "none"


