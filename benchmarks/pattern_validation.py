"""Pattern pieces of all blocks on bodies: faults, strain, bridged hollows, darts, and sewn together again.

    python benchmarks/pattern_validation.py FOLDER... [pieces] [bridges] [darts] [sewn] [blocks=NAME,NAME]

``FOLDER`` holds scans in mm, z up, facing -y, or is one scan; each is reshaped by its mid-bust line at 97 %.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from core.document.block import Block
from core.document.design import Design, ScanSource
from core.document.lines import ActiveLine
from core.document.lower_trunk import LowerTrunk
from core.errors import UserError
from core.geometry.mesh import Faces, Points, area_vectors, boundary_loops
from core.landmarks.types import SIDES
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

    @property
    def rest(self) -> Points:
        """Return the vertices of the body at rest, (n, 3) [mm]."""
        return self.drawing.places.skin.vertices

    def shows(self, block: Block) -> bool:
        """Return whether the body shows what the block is told from."""
        return self.stages.lower is not None or not block.needs_lower_trunk


def _built(design: Design) -> Stages:
    try:
        return build(replace(design, lower=LowerTrunk()))
    except UserError:  # a scan without legs
        return build(design)


def pieces(scan: Scan, block: Block) -> Iterator[str]:
    """Tell faults, the area lost to chords, seams, and the strain of pieces against the limits of cloths."""
    found = scan.pattern(block)
    worst: dict[str, float] = {}
    for flat in found.flats:
        name = _kind(flat.panel.name)
        worst[name] = max(worst.get(name, 0.0), 100.0 * found.strains[flat.panel.name].within)
    limits = {plan.name: 100.0 * CLOTHS[plan.cloth].limit for plan in block.panels}
    over = {name: "!" if worst[name] > limits[name] else "" for name in worst}
    strains = ", ".join(f"{name} {worst[name]:.1f} of {limits[name]:g}{over[name]}" for name in worst)
    fits = found.matched.fits
    sewn = max((abs(fit.together[0] - fit.together[1]) for fit in fits), default=0.0)
    off = max(fits, key=lambda fit: abs(fit.misfit), default=None)
    rest = scan.rest
    lost = [1.0 - _area(panel.places(rest), panel.faces) / panel.covers for panel in found.garment.panels]
    faults = ", ".join(_faults(found)) or "none"
    alone = "no seam" if off is None else f"{off.seam.name} {100.0 * off.misfit:.1f} %"
    yield f"{faults} | {100.0 * max(lost):.2f} % | {sewn:.5f} mm | {alone}"
    yield f"  {'fits' if found.fits_cloths else 'refused'}: {strains}"


def _kind(name: str) -> str:
    return name.removesuffix(" left").removesuffix(" right")


def _area(places: Points, faces: Faces) -> float:
    return float(np.linalg.norm(area_vectors(places, faces), axis=1).sum())


def _faults(found: Pattern) -> Iterator[str]:
    for flat in found.flats:
        if flat.is_folded:
            yield f"fold in {flat.panel.name}"
        if flat.overlaps:
            yield f"overlap in {flat.panel.name}"
        if len(boundary_loops(flat.panel.faces)) != 1:
            yield f"hole in {flat.panel.name}"


def bridges(scan: Scan, block: Block) -> Iterator[str]:
    """Tell how far the cloth leaves the skin, and what that changes of each kind of piece."""
    taut, lying = scan.pattern(block), scan.pattern(block, False)
    for one, two in zip(taut.flats, lying.flats, strict=True):
        areas = [flat.areas.sum() / 100.0 for flat in (two, one)]
        within = [100.0 * each.strains[one.panel.name].within for each in (lying, taut)]
        width, height = ([float(np.ptp(flat.points[:, axis])) for flat in (two, one)] for axis in (0, 1))
        if abs(areas[1] / areas[0] - 1.0) > 0.005 or abs(within[1] - within[0]) > 0.3:
            pairs = zip(
                ("area cm2", "width mm", "height mm", "strain %"), (areas, width, height, within), strict=True
            )
            told = ", ".join(f"{what} {before:.1f} -> {after:.1f}" for what, (before, after) in pairs)
            yield f"{one.panel.name}: {told}"
    names = [panel.name for panel in taut.garment.panels]
    if "front" in names and block.needs_bust:
        row = names.index("front")
        ends = [scan.drawing.places.breasts[side].apex for side in SIDES]
        for what, found in (("on the skin", lying), ("taut", taut)):
            points, places = found.flats[row].worn, found.garment.panels[row].places(scan.rest)
            at = [int(np.linalg.norm(places - end, axis=1).argmin()) for end in ends]
            yield f"bust point to bust point {what}: {np.linalg.norm(points[at[0]] - points[at[1]]):.1f} mm"
        yield f"straight: {np.linalg.norm(ends[0] - ends[1]):.1f} mm"


def darts(scan: Scan, block: Block) -> Iterator[str]:
    """Tell what darts to the bust point leave of the work and the strain of cups in one piece."""
    found = scan.pattern(block)
    for panel, places in zip(found.garment.panels, found.places, strict=True):
        if block.name != "one-part-cup" or not panel.name.endswith(" left"):
            continue
        cloth = CLOTHS[panel.cloth]
        chart = dart_chart(panel, places, cloth, breast=scan.drawing.places.breasts["left"])
        least = min(chart.darts, key=lambda dart: dart.left)
        most = max(chart.darts, key=lambda dart: dart.left)
        yield f"{panel.name}: deficit {chart.deficit:.0f} degrees, {100.0 * chart.within:.1f} % without"
        for what, dart in (("least", least), ("most", most)):
            yield (
                f"  {what}: {dart.seam} {dart.clock:.0f} degrees, {100.0 * dart.left:.0f} % of the work, "
                f"{100.0 * dart.within:.1f} %"
            )


def sewn(scan: Scan, block: Block) -> Iterator[str]:
    """Tell how near the pieces come to the body when they are sewn together again in space."""
    again = sewn_again(scan.pattern(block))
    yield f"rms {again.rms:.1f} mm, worst {again.worst:.1f} mm"


def main(arguments: list[str]) -> None:
    """Print the tables that are asked for."""
    parts = {each.__name__: each for each in (pieces, bridges, darts, sewn)}
    asked = [each for each in arguments if each in parts] or list(parts)
    chosen = [each.removeprefix("blocks=").split(",") for each in arguments if each.startswith("blocks=")]
    blocks = [block for block in built_in_blocks() if not chosen or block.name in chosen[0]]
    folders = [Path(each) for each in arguments if each not in parts and not each.startswith("blocks=")]
    paths = [path for each in folders for path in ([each] if each.is_file() else sorted(each.glob("*.ply")))]
    for path in paths:
        try:
            scan = Scan(path)
        except UserError as error:
            print(f"{path.stem}: {error}")
            continue
        for block in filter(scan.shows, blocks):
            for part in asked:
                try:
                    lines = list(parts[part](scan, block))
                except UserError as error:
                    lines = [f"refused: {error}"]
                for line in lines:
                    print(f"{scan.name} | {block.name} | {part} | {line}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
