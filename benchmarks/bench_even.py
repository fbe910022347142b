"""Make bodies uneven by known amounts and read them back; make uneven designs even and see what remains.

Run: python benchmarks/bench_even.py [FOLDER] [--cases N]; scans of a folder come to the two samples.
Read back: on each body the left breast, or the right one, is moved up or out, or swollen, by a smooth field
whose height at the bust point is known, its volume too, from the mesh itself. The altered body is written as
a scan and goes the whole way: reading, landmarks, control mesh. What is told of it, less what is told of the
body as it was, is compared with what was done.
Halves: what a split line does at equal lengths, against the whole one.
Made even: straps and split lines of other lengths on the left than on the right, by chance; then, on each
body, with what hinders parted first.
Prints all of it; --put puts the tables into RESULTS.md.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from bench_ask import bodies
from pages import put, table

from core.analysis.symmetry.balance import ENOUGH, BalanceResult, balance_sides
from core.analysis.symmetry.compare import SideDifference, compare_sides
from core.control_mesh.template import read_template
from core.deformation.incremental_normals import volume_change
from core.document.design import ScanSource
from core.document.line_notation import ready_made_lines
from core.document.split_lines import split
from core.errors import UserError
from core.export.mesh import write_mesh
from core.geometry.mesh import Mesh
from core.measurements.table import measures
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve

ALTERATIONS = (("up", 5.0), ("up", -12.0), ("out", 4.0), ("swollen", 3.0), ("swollen", 8.0))
"""What is done to one breast, and by how much at its bust point [mm]."""

REACH = 42.0
"""How wide the field is [mm]."""

WORN = ("mid-bust", "full-bust")
CONTACTS = ("glued", "sliding")


@dataclass(frozen=True)
class Altered:
    """A body made uneven: what was done [mm, ml] and what is told of it, left more than right."""

    name: str
    kind: str
    higher: float
    out: float
    volume: float
    told: SideDifference
    was: SideDifference
    breasts: float
    breasts_were: float

    def misses(self) -> tuple[float, float, float, float]:
        """Return by how much height, way out, ml of the skin and ml of the breasts are read wrong."""
        return (
            self.told.higher - self.was.higher - self.higher,
            self.told.further_out - self.was.further_out - self.out,
            _ml(self.told) - _ml(self.was) - self.volume,
            self.breasts - self.breasts_were - self.volume,
        )


def _ml(told: SideDifference) -> float:
    assert told.skin is not None
    return told.skin.total


def _breasts(stages: Stages) -> float:
    """Return by how much the left breast is larger within its root [ml], if that is known."""
    found = measures(stages.body.smoothed, stages.landmarks)
    left, right = (found[f"breast_volume_{side}"].value for side in ("left", "right"))
    return np.nan if left is None or right is None else left - right


def at_rest(stages: Stages) -> SideDifference:
    """Return how left and right of a body differ at rest."""
    return compare_sides(stages, stages.control.mesh.vertices).before


def altered(stages: Stages, kind: str, amount: float, side: str, folder: Path) -> Altered:
    """Return a body with one breast moved or swollen, read again as a scan."""
    mesh, sign = stages.body.mesh, 1.0 if side == "left" else -1.0
    bust = stages.landmarks.position(f"bust_point_{side}")
    share = np.exp(-((np.linalg.norm(mesh.vertices - bust, axis=1) / REACH) ** 4))
    ways = {"up": [0.0, 0.0, 1.0], "out": [0.0, -1.0, 0.0]}
    way = mesh.vertex_normals if kind == "swollen" else np.array(ways[kind])
    places = mesh.vertices + amount * share[:, None] * way
    path = folder / "altered.ply"
    write_mesh(path, Mesh(places, mesh.faces))
    scan = ScanSource(str(path), unit="mm", up="+z", front="-y")
    again = build(replace(stages.design, scan=scan))
    nearest = int(np.argmin(((mesh.vertices - bust) ** 2).sum(axis=1)))
    moved = places[nearest] - mesh.vertices[nearest]
    volume = volume_change(mesh, places) / 1000.0
    name = f"{stages.design.scan.name}, {side} {kind} {amount:+g} mm"
    higher, out = sign * float(moved[2]), -sign * float(moved[1])
    both = again, stages
    return Altered(name, kind, higher, out, sign * volume, *map(at_rest, both), *map(_breasts, both))


def read_back(on: list[Stages]) -> list[Altered]:
    """Return all alterations on all bodies."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for stages in on:
            for number, (kind, amount) in enumerate(ALTERATIONS):
                try:
                    found.append(altered(stages, kind, amount, ("left", "right")[number % 2], Path(folder)))
                except UserError as why:
                    print(f"left out: {stages.design.scan.name} {kind}: {why}")
                    continue
                misses = ", ".join(f"{miss:+.2f}" for miss in found[-1].misses())
                print(f"{found[-1].name}: {misses} (mm, mm, ml, ml)", flush=True)
    return found


def halves(on: list[Stages]) -> Iterator[tuple[str, float, float]]:
    """Yield the kind of model, how far a split line leads elsewhere than a whole one, how far that goes."""
    ways = {"glued, springs": {}, "glued, held": {"line_hold": "held"}}
    ways["sliding, springs"] = {"line_contact": "sliding"}
    for stages in on:
        template = read_template(stages.design.template)
        for name, choice in ways.items():
            whole = build(replace(stages.design, **choice).with_line("mid-bust", 0.95), stages)
            parts = build(split(whole.design, template, "mid-bust"), whole)
            rest = stages.control.mesh.vertices
            moves = [solve(each).control_points - rest for each in (whole, parts)]
            off = float(np.linalg.norm(moves[1] - moves[0], axis=1).max())
            yield name, off, float(np.linalg.norm(moves[0], axis=1).max())


def uneven(rng: np.random.Generator, stages: Stages) -> Stages:
    """Return a design whose lines are of other lengths on the left than on the right, by chance."""
    template = read_template(stages.design.template)
    design = replace(stages.design, line_contact=str(rng.choice(CONTACTS)))
    for name in WORN[: int(rng.integers(1, 3))]:
        design = split(design.with_line(name, 1.0), template, name)
    for line in ready_made_lines(template)["straps"]:
        design = design.with_custom_line(line).with_line(line.name, 1.0)
    for name in sorted(design.active_lines()):
        design = design.with_line(name, round(float(rng.uniform(0.9, 1.0)), 3))
    return build(design, stages)


def even_again(rng: np.random.Generator, on: list[Stages], cases: int) -> list[tuple[BalanceResult, float]]:
    """Return what makes uneven designs on even bodies even, with processor time [s]."""
    found: list[tuple[BalanceResult, float]] = []
    number = 0
    while len(found) < cases:
        stages = uneven(rng, on[number % len(on)])
        number += 1
        solution = solve(stages)
        condition = solution.verdict.condition
        if solution.verdict.motion != "settled" or condition is None or condition.strained:
            continue
        if compare_sides(stages, solution.control_points).after.largest_difference < 2.0 * ENOUGH:
            continue
        found.append(_timed(stages))
    return found


def _timed(stages: Stages) -> tuple[BalanceResult, float]:
    begun = time.process_time()
    made = balance_sides(stages)
    seconds = time.process_time() - begun
    words = f"({made.before.higher:+.2f}, {made.before.further_out:+.2f}) mm"
    after = f"({made.after.higher:+.2f}, {made.after.further_out:+.2f}) mm"
    lines = ", ".join(f"{line.name} {100.0 * line.ratio:.1f}" for line in made.result.design.lines)
    name = f"{stages.design.scan.name}, {stages.design.line_contact}"
    wishes = f"{1e3 * seconds:.0f} ms, {len(made.goals)} wishes"
    print(f"{name}: {words} -> {after}, {wishes}; {lines}", flush=True)
    return made, seconds


def as_they_are(on: list[Stages]) -> Iterator[tuple[str, BalanceResult, float]]:
    """Yield what makes uneven bodies even, with whole lines and a linked pair of straps, parted first."""
    for stages in on:
        if at_rest(stages).largest_difference < 2.0 * ENOUGH:
            continue
        template = read_template(stages.design.template)
        for contact in CONTACTS:
            design = replace(stages.design, line_contact=contact)
            for name in WORN:
                design = design.with_line(name, 0.97)
            for line in ready_made_lines(template)["straps"]:
                design = design.with_custom_line(line).with_line(line.name, 0.97)
            yield f"{stages.design.scan.name}, {contact}", *_timed(build(design, stages))


def _row(name: str, cases: list[Altered]) -> tuple[str, ...]:
    misses = np.abs([each.misses() for each in cases])
    columns = [column[np.isfinite(column)] for column in misses.T]
    told = [f"{column.mean():.1f} / {column.max():.1f}" if len(column) else "-" for column in columns]
    ml = np.abs([each.volume for each in cases])
    return name, str(len(cases)), f"{ml.min():.0f} to {ml.max():.0f}", *told


def _even_row(name: str, made: list[tuple[BalanceResult, float]]) -> tuple[str, ...]:
    before = [each.before.largest_difference for each, _ in made]
    after = [each.after.largest_difference for each, _ in made]
    seconds = [taken for _, taken in made]
    kept = [len(each.goals) == 4 and each.result.reachable for each, _ in made]
    return (
        name,
        str(len(made)),
        f"{statistics.median(before):.1f} / {max(before):.1f} mm",
        f"{statistics.median(after):.2f} / {max(after):.2f} mm",
        str(sum(each.is_balanced for each, _ in made)),
        str(sum(kept)),
        f"{1e3 * statistics.median(seconds):.0f} / {1e3 * max(seconds):.0f} ms",
    )


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--cases", type=int, default=60)
    parser.add_argument("--put", action="store_true", help="put the tables into RESULTS.md")
    options = parser.parse_args()
    on = list(bodies(options.folder))
    tables = {"read": _read_table(read_back(on)), "halves": _halves_table(list(halves(on)))}
    rng = np.random.default_rng(2028)
    even = [stages for stages in on if at_rest(stages).largest_difference < ENOUGH]
    made = even_again(rng, even, options.cases)
    groups = {
        "all": made,
        **{
            contact: [each for each in made if each[0].result.design.line_contact == contact]
            for contact in CONTACTS
        },
    }
    heads = ("", "designs", "uneven before", "after", f"within {ENOUGH} mm", "all kept", "time")
    tables["made"] = table(heads, [_even_row(*each) for each in groups.items() if each[1]])
    tables["bodies"] = table(
        ("body", "at rest", "as worn", "made even", "because"),
        [_body_row(name, each) for name, each, _ in as_they_are(on)],
    )
    for name, told in tables.items():
        print(told)
        if options.put:
            put(name, told)


def _read_table(found: list[Altered]) -> str:
    kinds = list(dict.fromkeys(each.kind for each in found))
    rows = [("all", found), *((kind, [each for each in found if each.kind == kind]) for kind in kinds)]
    heads = ("what was done", "bodies", "ml", "height [mm]", "out [mm]", "skin apart [ml]", "breasts [ml]")
    return table(heads, [_row(*each) for each in rows])


def _halves_table(found: list[tuple[str, float, float]]) -> str:
    kinds = dict.fromkeys(kind for kind, _, _ in found)
    rows = []
    for kind in kinds:
        off, far = ([each[at] for each in found if each[0] == kind] for at in (1, 2))
        rows.append(
            (kind, str(len(off)), f"{statistics.median(off):.3f} / {max(off):.3f} mm", f"{max(far):.1f} mm")
        )
    return table(("lines", "bodies", "control points elsewhere", "of moves up to"), rows)


def _body_row(name: str, made: BalanceResult) -> tuple[str, ...]:
    told = (
        f"{each.higher:+.1f}, {each.further_out:+.1f} mm" for each in (made.rest, made.before, made.after)
    )
    reply = made.result
    why = [*(f"{line} at its end" for line in reply.at_limit), *(["strain"] if reply.strained else [])]
    return name, *told, "" if made.is_balanced else ", ".join(why)


if __name__ == "__main__":
    main()
