"""Exact answers, iterations and shapes of the lower trunk on bodies with known landmarks.

    python benchmarks/lower_trunk.py FOLDER [fit|routes|control|shapes|limits ...]

``FOLDER`` holds NAME.ply of whole trunks in mm, upright. ``fit``: how well the control mesh lies on them;
``routes``: 14 routes at four lengths, Newton steps;
``control``: adaptive and conventional runs of the routes; ``limits``: where the conventional control begins
to swing against the computed limit; ``shapes``: what lines and presets do to girths, fold and seat.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from core.control_mesh.lower_template import HIP_ROW, SEAT, read_lower_template
from core.document.design import Design, ScanSource
from core.document.lower_trunk import LowerTrunk, lower_lines_of
from core.garment.presets import built_in, with_preset
from core.measurements.lower_trunk import lower_before_after
from core.mechanics.solver_comparison import SolverComparison
from core.pipeline.build import Stages, build
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import Solution, solve

BANDS = ("above-waist", "waist", "below-waist", "belly", "high-hip", "hip", "under-hip")
PAIRS = ("belly-cross", "sling", "high-sling", "buttock-lift", "leg-opening", "high-leg")
ROUTES: tuple[tuple[str, ...], ...] = (
    *((band,) for band in BANDS),
    ("belly-panel", "low-belly-panel"),
    *((pair,) for pair in PAIRS),
)
"""Lines that are shortened together; a pair is worn on both sides."""

ROWS = ("waist", "belly", "hip")
"""Rows of the control mesh whose lengths are shown, besides the tape at a height."""

RATIOS = (0.97, 0.90, 0.80, 0.70)

SHAPES: Mapping[str, Mapping[str, float]] = {
    "waist .90": {"waist": 0.9},
    "belly panels .90 / .95": {"belly-panel": 0.9, "low-belly-panel": 0.95},
    "sling .90": {"sling": 0.9},
    "sling .90, lift .95": {"sling": 0.9, "buttock-lift": 0.95},
}


def bodies(folder: Path) -> Iterator[tuple[str, Stages]]:
    """Yield the bodies that show a lower trunk, with their stages; the others are printed."""
    for path in sorted(folder.glob("*.ply")):
        told = {"unit": "mm", "up": "+z", "front": "-y"}
        stages = build(
            Design(ScanSource(str(path), **told), tissue="net", volume="exact", lower=LowerTrunk())
        )
        if stages.lower_problem is not None:
            print(f"{path.stem}: {stages.lower_problem}")
            continue
        yield path.stem, stages


def wearing(stages: Stages, lines: Mapping[str, float], **settings: object) -> Stages:
    """Return the stages with lines at ratios [1], both sides by one name."""
    design = replace(stages.design, **settings)  # type: ignore[arg-type]
    for name, ratio in lines.items():
        for each in lower_lines_of(name):
            design = design.with_line(each, ratio)
    return build(design, stages)


def fit(folder: Path) -> None:
    """Print how well the control mesh lies on each body: angles, edges, distances, normals."""
    print("| body | smallest angle | shortest edge mm | distance mean / 95 % / max mm | normals |")
    print("|---|---|---|---|---|")
    for name, stages in bodies(folder):
        assert stages.lower is not None
        of = stages.lower.control.quality
        assert of is not None
        far = " / ".join(f"{each:.1f}" for each in (of.deviation_mean, of.deviation_95, of.deviation_max))
        print(f"| {name} | {of.smallest_angle:.1f} | {of.shortest_edge:.0f} | {far} | {of.same_way:.2f} |")


def routes(folder: Path) -> None:
    """Print how many of the exact answers are found, in how many steps, and what one costs."""
    print("| body | found | steps median, max | processor ms median |\n|---|---|---|---|")
    for name, stages in bodies(folder):
        steps, cost, found = [], [], 0
        for route in ROUTES:
            for ratio in RATIOS:
                worn = wearing(stages, dict.fromkeys(route, ratio))
                begun = time.process_time()
                lower = solve(worn).lower
                cost.append(1000.0 * (time.process_time() - begun))
                assert lower is not None
                found += lower.verdict.motion == "settled"
                steps.append(lower.verdict.iterations)
        count = len(ROUTES) * len(RATIOS)
        print(
            f"| {name} | {found} of {count} | {np.median(steps):.0f}, {max(steps)} | {np.median(cost):.1f} |"
        )


def control(folder: Path) -> None:
    """Print how many adaptive runs settle, how far off the exact answer, and how many conventional ones."""
    print("| body | adaptive settled | off exact mm, max | ripple, max | conventional calm |")
    print("|---|---|---|---|---|")
    for name, stages in bodies(folder):
        settled, calm, off, ripple = 0, 0, 0.0, 0.0
        for route in ROUTES:
            for ratio in RATIOS[:3]:
                exact = solve(wearing(stages, dict.fromkeys(route, ratio))).lower
                runs = [
                    solve(wearing(stages, dict.fromkeys(route, ratio), volume=volume)).lower
                    for volume in ("adaptive", "conventional")
                ]
                assert exact is not None
                adaptive, conventional = runs
                assert adaptive is not None
                assert conventional is not None
                settled += adaptive.verdict.motion == "settled"
                calm += conventional.verdict.motion == "settled"
                off = max(off, float(np.abs(adaptive.control_points - exact.control_points).max()))
                last = np.array([record.zones for record in adaptive.records[-10:]])
                ripple = max(ripple, float(np.ptp(last, axis=0).max()))
        count = 3 * len(ROUTES)
        print(f"| {name} | {settled} of {count} | {off:.3f} | {ripple:.1e} | {calm} of {count} |")


def limits(folder: Path) -> None:
    """Print the computed limit of the conventional gain, and the least gain at which a run swings."""
    print("| body | lines | computed | swings from |\n|---|---|---|---|")
    for name, stages in bodies(folder):
        for route in (
            ("waist",),
            ("hip",),
            ("sling",),
            ("above-waist", "waist", "below-waist", "belly", "hip"),
        ):
            lower = wearing(stages, dict.fromkeys(route, 0.97), volume="conventional").lower
            assert lower is not None
            factors = (0.97, 0.99, 1.01, 1.03, 1.05)
            seen = next((each for each in factors if not _calm(lower, each)), float("nan"))
            print(f"| {name} | {', '.join(route)} | {lower.gain_limit:.3f} | {seen:.2f} of it |")


def _calm(lower: object, factor: float) -> bool:
    """Return whether the swing of a conventional run at a part of its limit dies away."""
    targets = replace(line_targets(lower.design, lower), gain=factor * lower.gain_limit)  # type: ignore[attr-defined, arg-type]
    comparison = SolverComparison(lower.model, targets)  # type: ignore[attr-defined]
    for _ in range(300):
        comparison.advance()
    zones = np.array([record.zones for record in comparison.runs["conventional"].records])
    swing = np.abs(np.diff(zones, axis=0)).max(axis=1)
    return bool(swing[-1] < max(swing[len(swing) // 2], 1e-9))


def shapes(folder: Path) -> None:
    """Print what lines and presets do: rows of the mesh, girths, belly, seat, fold, zones, edges."""
    heading = (
        *(f"{each} row" for each in ROWS),
        "waist",
        "belly",
        "hip",
        "belly back",
        "seat up",
        "seat back",
        "fold up",
        "inside ml",
        "edges",
        "steps",
    )
    print(f"| body | lines | {' | '.join(heading)} |\n|{'---|' * (len(heading) + 2)}")
    for name, stages in bodies(folder):
        for title, lines in SHAPES.items():
            _row(name, title, solve(wearing(stages, lines)))
        for preset in built_in():
            if preset.is_for_lower_trunk:
                below = replace(with_preset(stages.design, preset), lines=(), tissue="net", cup=None)
                _row(name, preset.title, solve(build(below, stages)))


def _row(name: str, title: str, solution: Solution) -> None:
    stages, lower = solution.stages.lower, solution.lower
    assert stages is not None
    assert lower is not None
    template = read_lower_template()
    moves = lower.control_points - stages.control.mesh.vertices
    seat = moves[[template.point(HIP_ROW, column) for column in (SEAT, -SEAT)]].mean(axis=0)
    fold = moves[[template.point(9, column) for column in (SEAT, -SEAT)]].mean(axis=0)
    belly = moves[template.point(5, 0), 1]
    girths = lower_before_after(stages, lower.control_points)
    change = [
        f"{girths[each][1].tape_mm - girths[each][0].tape_mm:+.0f}" for each in ("waist", "belly", "hip")
    ]
    zones = lower.stages.model.volume.zone_volumes(lower.control_points) - lower.stages.model.rest_zones
    condition = lower.verdict.condition
    assert condition is not None
    lines = {line.name: at for at, line in enumerate(lower.stages.model.lines)}
    rows = [lower.last.lengths[lines[each]] - lower.rest.lengths[lines[each]] for each in ROWS]
    figures = [
        *(f"{value:+.0f}" for value in rows),
        *change,
        *(f"{value:+.1f}" for value in (belly, seat[2], seat[1], fold[2])),
        f"{-zones.sum() / 1000.0:.0f}",
        f"{condition.shortest:.2f}-{condition.longest:.2f}",
        f"{lower.verdict.iterations}",
    ]
    print(f"| {name} | {title} | {' | '.join(figures)} |")


def main() -> None:
    """Print the tables that are asked for, or all."""
    folder, *asked = sys.argv[1:]
    for table in (fit, routes, control, limits, shapes):
        if not asked or table.__name__ in asked:
            print(f"\n{table.__name__}\n")
            table(Path(folder))


if __name__ == "__main__":
    main()
