"""Pattern pieces while a designer works: laid flat, matched, cut at first, and cut again.

Run: python benchmarks/bench_pattern.py [SCAN ...]; without a scan the two sample bodies are taken. Prints
medians of processor time [ms] on one thread, the gate of each, and their ratio. A garment of nine pieces is

- laid flat and matched over a drag of the mid-bust from 100 % to 95 % in 12 moves, each from the one before;
- cut at first, with the maps of both breasts, and once more with nothing else kept than these;
- cut again while a seam's point is dragged in 8 moves: one of a seam within the band, one of the cup seam.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from threadpoolctl import threadpool_limits

from core.document.block import Block
from core.document.design import Design, ScanSource
from core.geometry.mesh import Points
from core.mechanics.exact_solution import solve_exact
from core.pattern.block_library import find_block
from core.pattern.cloth_library import built_in
from core.pattern.flattening import flatten_all
from core.pattern.garment import CutGarment, cut_garment
from core.pattern.places import BodyPlaces
from core.pattern.recut import recut
from core.pattern.seam_curves import SeamDrawing
from core.pipeline.build import Stages, build

SAMPLES = Path(__file__).parent.parent / "resources" / "samples"
BLOCK = "two-part-cup"
GATES = {
    "flat": 40.0,
    "matched": 60.0,
    "first cut": 400.0,
    "whole cut": 400.0,
    "cut again: side seam": 80.0,
    "cut again: cup seam": 80.0,
}
DRAGS = {
    "side seam": [(f"ring band {0.5 + 0.004 * step:.3f}", "ring band 0.50") for step in range(1, 9)],
    "cup seam": [(f"root {72.0 + 0.5 * step:.1f}", "root 72") for step in range(1, 9)],
}
Result = TypeVar("Result")


def timed(times: list[float], work: Callable[[], Result]) -> Result:
    start = time.process_time()
    result = work()
    times.append(1e3 * (time.process_time() - start))
    return result


def skins(stages: Stages) -> list[Points]:
    """Return the skin without noise over the drag of a length."""
    model, balance, found = stages.model, None, []
    names = [line.name for line in model.lines]
    smooth = stages.body.smoothed.vertices - stages.body.mesh.vertices
    for ratio in np.linspace(1.0, 0.95, 13):
        ratios = tuple(float(ratio) if name == "mid-bust" else 1.0 for name in names)
        balance = solve_exact(model, ratios, near=balance)
        points = model.tensegric.expand(balance.state.moved)
        found.append(stages.skin.body([points]).vertices + smooth)
    return found


def with_place(block: Block, seam: str, place: str, instead: str) -> Block:
    """Return a block one of whose seams goes through another place."""
    seams = tuple(
        replace(each, places=tuple(place if word == instead else word for word in each.places))
        if each.name == seam
        else each
        for each in block.seams
    )
    return replace(block, seams=seams)


def slide(garment: CutGarment, bodies: list[Points], times: dict[str, list[float]]) -> None:
    """Lay the pieces flat and match them while a length moves."""
    cloths = {cloth.name: cloth for cloth in built_in()}
    own = [cloths[panel.cloth] for panel in garment.panels]
    pattern = garment.flat(bodies[0], cloths)
    flats = pattern.flats
    for vertices in bodies[1:]:
        places = [panel.places(vertices) for panel in garment.panels]
        flats = timed(
            times["flat"],
            lambda p=places, f=flats: flatten_all(garment.panels, p, own, [each.worn for each in f]),
        )
        pattern = timed(times["matched"], lambda v=vertices, f=pattern: garment.flat(v, cloths, f.matched))


def measured(stages: Stages, bodies: list[Points]) -> dict[str, float]:
    """Return the medians of all parts on one body."""
    times: dict[str, list[float]] = {name: [] for name in GATES}
    block = find_block(BLOCK)
    for _ in range(3):
        drawing = SeamDrawing(BodyPlaces.of(stages))
        garment = timed(times["first cut"], lambda d=drawing: cut_garment(d, block))
        other = SeamDrawing(drawing.places)
        timed(times["whole cut"], lambda d=other: cut_garment(d, block))
    slide(garment, bodies, times)
    for seam, moves in DRAGS.items():
        former = garment
        for place, instead in moves:
            changed = with_place(block, seam, place, instead)
            work = times[f"cut again: {seam}"]
            former = timed(work, lambda f=former, b=changed: recut(f, drawing, b))
    return {name: statistics.median(each) for name, each in times.items()}


def main() -> None:
    scans = sys.argv[1:] or [str(SAMPLES / f"{name}.ply") for name in ("person", "mannequin")]
    with threadpool_limits(1):
        for scan in scans:
            stages = build(Design(ScanSource(str(Path(scan).absolute()))).with_line("mid-bust", 0.99))
            print(f"{Path(scan).name:24}{'ms':>10}{'gate':>10}{'ratio':>10}")
            for name, value in measured(stages, skins(stages)).items():
                print(f"  {name:22}{value:10.1f}{GATES[name]:10.0f}{value / GATES[name]:10.2f}")


if __name__ == "__main__":
    main()
