"""How near to the truth measures are, on bodies with known answers and on shapes with formulas.

``python benchmarks/measures_accuracy.py FOLDER`` takes the folder of the bodies, with its truth.json.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).parent.parent), str(Path(__file__).parent.parent / "tests" / "helpers")]

from breast_shapes import cap  # noqa: E402 - the shapes of the tests

from app.research.ground_truth import Truth, read_truths  # noqa: E402
from core.geometry.geodesic import shortest_path  # noqa: E402
from core.geometry.mesh import Mesh  # noqa: E402
from core.landmarks.torso.cross_sections import trunk_levels  # noqa: E402
from core.measurements.breast_volume import breast_of  # noqa: E402
from core.scan.body import read_scan  # noqa: E402
from tests.core.geometry.test_geodesic import BALL, between, cone, length, ring, sheet, tube  # noqa: E402


def girths(folder: Path, truth: Truth) -> Iterator[tuple[str, float, float]]:
    """Yield what a tape reads on a file at each known plane: which, how much, how far that is off [%]."""
    body = read_scan(str(folder / truth.file))
    # The planes are level in the true frame; ours may stand a little otherwise, so the skin is moved there.
    move = truth.to_mm @ np.linalg.inv(body.pose.file_to_mm)
    places = body.smoothed.vertices @ move[:3, :3].T + move[:3, 3]
    skin = Mesh(places, body.smoothed.faces)
    for name, known in truth.girths.items():
        planes = dict(zip(known.offsets, known.tapes, strict=True)) or {0.0: known.tape}
        levels = trunk_levels(skin, [known.level + offset for offset in planes])
        for (offset, tape), level in zip(planes.items(), levels, strict=True):
            yield f"{name} {offset:+.0f} mm", tape, 100.0 * (level.tape / tape - 1.0)


def caps() -> Iterator[tuple[str, float]]:
    """Yield volumes of caps of balls on chests, and how far they are off [%]."""
    for chest in ("flat", "round", "oval"):
        for height, radius in ((60.0, 60.0), (30.0, 60.0), (25.0, 80.0), (90.0, 60.0)):
            side, root, volume = cap(height, radius, chest=chest)
            breast = breast_of(side, root)
            assert breast is not None
            yield f"{height:.0f} mm high on a {chest} chest", 100.0 * (breast.volume / volume - 1.0)


def ways() -> Iterator[tuple[str, float]]:
    """Yield ways over surfaces on which the shortest one is known, and how far they are off [%]."""
    ball = Mesh(np.asarray(BALL.vertices), np.asarray(BALL.faces))
    around, up = np.linspace(-0.5, 2.6, 90), np.linspace(60.0, 400.0, 81)
    rolled, tip = sheet(tube, around, up), sheet(cone, around, up)
    tyre = sheet(ring, np.linspace(-0.6, 0.9, 60), np.linspace(-2.2, 2.2, 80))
    dice = np.random.default_rng(5)
    for _ in range(20):
        a, b = dice.normal(size=(2, 3))
        a, b = 100.0 * a / np.linalg.norm(a), 100.0 * b / np.linalg.norm(b)
        yield "ball", _off(length(shortest_path(ball, a, b)), 100.0 * float(np.arccos(a @ b / 1e4)))
        u, du, v, dv = dice.uniform((0.0, 0.1, 100.0, -40.0), (0.5, 1.7, 200.0, 150.0))
        ends = between(tube, (u, v), (u + du, v + dv))
        yield "cylinder", _off(length(shortest_path(rolled, *ends)), float(np.hypot(120.0 * du, dv)))
        ends = between(cone, (u, v), (u + du, v + dv))
        flat = np.sqrt(v**2 + (v + dv) ** 2 - 2.0 * v * (v + dv) * np.cos(0.5 * du))
        yield "cone", _off(length(shortest_path(tip, *ends)), float(flat))
        ends = between(ring, (u, -1.5), (u, -1.5 + du))
        yield "torus", _off(length(shortest_path(tyre, *ends)), 50.0 * float(du))


def _off(found: float, true: float) -> float:
    return 100.0 * (found / true - 1.0)


def main(folder: Path) -> None:
    """Print the worst of each kind."""
    for truth in read_truths(folder)[0]:
        found = [] if truth.refuse else list(girths(folder, truth))
        if found:
            where, tape, off = max(found, key=lambda each: abs(each[2]))
            print(f"{truth.file}: {len(found)} girths, {off:+.2f} % at most ({where}, {tape:.1f} mm)")
    for what, results in (("volumes of caps", list(caps())), ("ways over the skin", list(ways()))):
        name, off = max(results, key=lambda each: abs(each[1]))
        print(f"{what}: {len(results)}, {off:+.3f} % at most ({name})")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(Path(sys.argv[1]))
