"""Leeways of lines against a brute-force scan of their sliders.

Run: python benchmarks/bench_limits.py [FOLDER] [--seed N] [--only SCAN...] [--put]; scans of a folder come to
the two samples.
For each body, glued and sliding, the other lines stand in several ways: all off, by chance, a preset by
chance, lines of elastic by chance. Then each length of a line is solved from rest by itself, half a percent
apart, and what changes between two of them is halved to 0.05 %: strain, folds and lengths without balance
off the control mesh; pressure by laying the bands; slack off the line's own pull. Whether the conventional
force vibrates is found by making its turns, 2 % apart and halved to 0.13 %: up to 4000 from rest, until no
point moves by more than 0.0005 mm a turn (calm), or the swing of the volume error keeps nine tenths of its
size over 200 turns (it vibrates); one that still fades after 4000 turns counts as calm, for it would end.
Prints a line for each boundary that is off by more than 0.5 %, and a table; --put puts that into
RESULTS.md.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import numpy as np
from bench_ask import bodies
from pages import put, table
from threadpoolctl import threadpool_limits

from core.analysis.length_limits.limits import Limits, limits_of
from core.document.design import Design
from core.document.lines import ActiveLine
from core.errors import UserError
from core.garment.cut_list import is_strap
from core.garment.elastic_library import find_elastic
from core.garment.presets import built_in, with_preset
from core.garment.pressure import pressure_limits, pressures
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.mechanics.exact_solution import solve_exact
from core.mechanics.iteration import LineTargets, initial_state, step
from core.mechanics.solver_comparison import shape_of
from core.pipeline.active_lines import free_lines
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets

NEAR = 0.005
STEP, FINE = 0.005, 0.0005
TURNING_STEP, TURNING_FINE = 0.02, 0.00125
BEYOND = 0.02  # how much further than the way led is scanned
TURNS, BLOCK, STILL, KEPT = 4000, 100, 5e-4, 0.9
HEADS = ("boundary", "cases", "off at 95 %", "off at most", "beyond 0.5 %")
ELASTICS = ("plush 12", "picot 10", "picot 12", "strap 15")
KINDS = {
    "strained": "strained",
    "overstrained": "overstrained",
    "folded": "folded",
    "inverted": "inside out",
    "vibrating": "vibrating",
    "pressing": "pressing",
    "slack": "slack",
    "stretched": "end of an elastic",
    "unreachable": "no balance",
}


@dataclass(frozen=True)
class Boundary:
    """Where a sign begins or ends: as told and as scanned [1], None where the one or other has none there."""

    case: str
    sign: str
    told: float | None
    scanned: float | None

    @property
    def off(self) -> float:
        """How far they are apart [1]."""
        return abs(self.told - self.scanned) if self.told and self.scanned else np.inf


class Slider:
    """A line, and its linked partner, at any length, each by itself."""

    def __init__(self, stages: Stages, names: tuple[str, ...]) -> None:
        self._stages, self._names = stages, names
        self.signs = lru_cache(None)(self._signs)
        self.vibrates = lru_cache(None)(self._vibrates)
        self.built = lru_cache(None)(self._built)

    def _built(self, ratio: float) -> Stages | UserError:
        design = self._stages.design
        others = tuple(line for line in design.lines if line.name not in self._names)
        tried = replace(design, lines=(*others, *(ActiveLine(name, ratio) for name in self._names)))
        try:
            return build(tried, self._stages)
        except UserError as refused:
            return refused

    def _signs(self, ratio: float) -> frozenset[str]:
        stages = self.built(ratio)
        if isinstance(stages, UserError):
            return frozenset({"stretched" if "table ends" in str(stages.message) else "unreachable"})
        model, ratios = stages.model, line_targets(stages.design, stages).ratios
        balance = solve_exact(model, ratios)
        if not balance.is_converged:
            return frozenset({"unreachable"})
        points = model.tensegric.expand(balance.state.moved)
        condition = shape_of(model).quality(points)
        shown = {sign for sign in list(KINDS)[:4] if getattr(condition, sign)}
        lines = [line for line in model.lines if line.name in self._names]
        if min(line.length(points) / line.rest_length - ratio for line in lines) < -1e-9:
            shown.add("slack")
        made = {line.name for line in lines if not is_strap(stages, line)} & {
            *stages.design.active_elastics()
        }
        worn = pressures(stages, points) if made else {}
        if any(worn[name].largest > pressure_limits().red_kpa for name in made):
            shown.add("pressing")
        return frozenset(shown)

    def _vibrates(self, ratio: float) -> bool:
        """Make the turns of the conventional control from rest, and see."""
        stages = self.built(ratio)
        if isinstance(stages, UserError):
            return False
        targets = LineTargets(line_targets(stages.design, stages).ratios, "conventional", stages.gain)
        state, errors = initial_state(stages.model), []
        for made in range(1, TURNS + 1):
            state, measured = step(stages.model, targets, state)
            errors.append(measured.error)
            if measured.step < STILL:
                return False
            if not np.isfinite(measured.error) or abs(measured.error) > 1.0:
                return True
            if made % BLOCK == 0 and made >= 3 * BLOCK:
                flips = np.abs(np.diff(errors, 2))
                if flips[-20:].mean() > KEPT * flips[-2 * BLOCK - 20 : -2 * BLOCK].mean() > 1e-7:
                    return True
        return False


def scanned(
    test: Callable[[float], bool], low: float, high: float, step: float, fine: float
) -> Iterator[float]:
    """Yield where ``test`` changes between two lengths, every ``step`` and then halved to ``fine``."""
    grid = np.round(np.arange(np.ceil(low / step), np.floor(high / step) + 1) * step, 6).tolist()
    for short, long in pairwise(grid):
        if test(short) != test(long):
            ends = [short, long]
            while ends[1] - ends[0] > fine:
                middle = round(0.5 * sum(ends), 6)
                ends[test(middle) != test(short)] = middle
            yield 0.5 * sum(ends)


def told(limits: Limits, sign: str) -> list[float]:
    """Return where a sign begins or ends within the way that was looked at."""
    assert limits.evaluated is not None
    if sign == "unreachable":
        return [end.ratio for end in (limits.last, limits.longest) if end is not None]
    first, last = limits.evaluated.short.ratio, limits.evaluated.long.ratio
    if sign != "slack" and limits.shows["slack"] and limits.shows["slack"][-1].short.ratio > first:
        last = limits.shows["slack"][-1].short.ratio
    ends = [(span.short.ratio, span.long.ratio) for span in limits.shows.get(sign, ())]
    begins = [short for short, _ in ends if sign == "slack" and short == last]  # slack from rest on
    return [end for short, long in ends for end in (short, long) if first < end < last] or begins


def compared(case: str, stages: Stages, names: tuple[str, ...]) -> Iterator[Boundary]:
    """Yield the boundaries of a slider, as they are told and as a scan finds them."""
    limits = limits_of(stages, names[0], through=False)
    slider = Slider(stages, names)
    if limits.evaluated is None:
        found = [r for r in np.arange(0.5, 1.3, 0.02) if "unreachable" not in slider.signs(round(r, 3))]
        yield from (Boundary(case, "unreachable", None, ratio) for ratio in found[:1])
        return
    first, last = limits.evaluated.short.ratio, limits.evaluated.long.ratio
    low, high = max(first - BEYOND, RATIO_LIMITS[0]), min(last + BEYOND, RATIO_LIMITS[1])
    slack = limits.shows["slack"]
    if slack and slack[-1].short.ratio > first:
        last = slack[-1].short.ratio + FINE  # longer ones are told to be slack, and nothing else of them
    refused: list[float] = []
    for sign in reversed(KINDS):  # first where nothing is told of anything else
        if sign == "vibrating":
            inside = (first + 1e-9, last - 1e-9, TURNING_STEP, TURNING_FINE)
            changes = list(scanned(slider.vibrates, *inside))
        else:
            changes = list(
                scanned(lambda ratio, sign=sign: sign in slider.signs(ratio), low, high, STEP, FINE)
            )
        if sign in ("stretched", "unreachable"):
            refused += changes
        else:
            changes = [each for each in changes if all(abs(each - end) > FINE for end in refused)]
        yield from paired(case, sign, told(limits, sign), changes, first, last)


def paired(
    case: str, sign: str, said: list[float], seen: list[float], first: float, last: float
) -> Iterator[Boundary]:
    """Yield each boundary with the nearest of the other kind; those seen beyond the way count for nothing."""
    free = list(seen)
    for end in sorted(said):
        near = min(free, key=lambda each, end=end: abs(each - end), default=None)
        if near is not None and abs(near - end) < 5.0 * NEAR:
            free.remove(near)
        else:
            near = None
        yield Boundary(case, sign, end, near)
    # What stands on the last stop of a way was not closed in on: it is red there already.
    yield from (Boundary(case, sign, None, each) for each in free if first + FINE < each < last - FINE)


def states(rng: np.random.Generator, stages: Stages, contact: str) -> Iterator[tuple[str, Design]]:
    """Yield ways in which the lines of a body may stand."""
    off = replace(stages.design, line_contact=contact, lines=())
    free = [line.name for line in stages.model.lines if line.constrains]
    yield "all off", off
    chance = off
    for name in free:
        chance = chance.with_line(name, round(float(rng.uniform(0.86, 1.0)), 3))
    yield "by chance", chance
    preset = built_in()[int(rng.integers(len(built_in())))]
    dressed = with_preset(off, preset)
    for group in free_lines(build(dressed, stages)):
        dressed = dressed.with_linked(group[0], round(float(rng.uniform(0.9, 1.0)), 3))
    yield preset.title, dressed
    elastic = off
    for name in free:
        elastic = elastic.with_line(name, round(float(rng.uniform(0.75, 0.97)), 3))
        elastic = elastic.with_elastic(name, find_elastic(str(rng.choice(ELASTICS))))
    yield "elastics", elastic


def groups(stages: Stages) -> Iterator[tuple[str, ...]]:
    """Yield the sliders: lines that move anything, linked ones together."""
    seen: set[str] = set()
    for line in stages.model.lines:
        group = stages.design.linked_lines(line.name)
        if line.constrains and not seen & set(group):
            seen |= set(group)
            yield group


def rows(boundaries: list[Boundary]) -> Iterator[list[str]]:
    """Yield a row of the table for each kind, then one for all."""
    for sign, title in (*KINDS.items(), ("", "all")):
        these = [each for each in boundaries if sign in ("", each.sign)]
        offs = np.array([each.off for each in these if np.isfinite(each.off)])
        if these:
            most = f"{100.0 * offs.max():.2f} %" if len(offs) else "-"
            usual = f"{100.0 * np.quantile(offs, 0.95):.2f} %" if len(offs) else "-"
            beyond = sum(each.off > NEAR for each in these)
            yield [title, str(len(these)), usual, most, str(beyond)]


def main() -> None:
    """Compare the sliders of all bodies and print what comes out."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, nargs="?")
    parser.add_argument("--seed", type=int, default=8)
    parser.add_argument("--only", nargs="+", help="scans to compare; of the others only the chance is drawn")
    parser.add_argument("--put", action="store_true", help="put the table into RESULTS.md")
    options = parser.parse_args()
    rng, boundaries, seconds = np.random.default_rng(options.seed), [], {}
    sliders = 0
    for body in bodies(options.folder):
        left_out = options.only and body.scan.name not in options.only
        for contact in ("glued", "sliding"):
            for state, design in states(rng, body, contact):
                if left_out:
                    continue
                try:
                    stages = build(design, body)
                except UserError as refused:
                    print(f"left out: {body.scan.name}, {contact}, {state}: {refused}")
                    continue
                for group in groups(stages):
                    case = f"{body.scan.name}, {contact}, {state}, {group[0]}"
                    begun = time.process_time()
                    limits_of(stages, group[0], through=False)
                    seconds.setdefault(f"{contact}", []).append(time.process_time() - begun)
                    sliders += 1
                    for each in compared(case, stages, group):
                        boundaries.append(each)
                        if each.off > NEAR:
                            print(
                                f"{case}: {each.sign}: told {each.told}, scanned {each.scanned}", flush=True
                            )
                print(f"{body.scan.name}, {contact}, {state}: {len(boundaries)} boundaries", flush=True)
        measured = table(HEADS, rows(boundaries))
        print(f"so far {sliders} sliders\n{measured}", flush=True)
    for kind, each in seconds.items():
        print(f"{kind}: {1e3 * np.median(each):.0f} ms, 95 % {1e3 * np.quantile(each, 0.95):.0f} ms")
    if options.put:
        put("limits", f"{sliders} sliders:\n\n{measured}")


if __name__ == "__main__":
    with threadpool_limits(1):
        main()
