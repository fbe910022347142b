"""Solves the same designs with the frozen program and from source, and holds every number to the other.

    python packaging/compare_numbers.py [--program dist/busk/busk] [--keep DIR]

Body, control mesh, every turn and the report may differ by 1e-9 (of 1, or of the larger figure) and no more.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import trimesh

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "packaging" / "linux")]

from same_answer import CLOSE, answer, is_same  # noqa: E402

from core.scan.readers.registry import read_triangles  # noqa: E402

CASES = {
    "adaptive": ["mannequin.ply", "--line", "mid-bust=93%"],
    "conventional": [
        "mannequin.ply",
        "--line",
        "mid-bust=60%",
        "--volume",
        "conventional",
        "--iterations",
        "300",
    ],
    "exact": ["mannequin.ply", "--line", "mid-bust=90%", "--line", "full-bust=95%", "--volume", "exact"],
    "sliding": ["person.ply", "--line", "mid-bust=92%", "--settings", "line_contact=sliding"],
    "co-rotated": ["person.ply", "--line", "mid-bust=-20mm", "--settings", "member_law=co-rotated"],
    "large": ["{large}", "--line", "mid-bust=93%"],
}


def solved(program: list[str], words: list[str], out: Path) -> None:
    """Solve one case; how it ends (settled, vibrating) is part of its report."""
    command = [*program, "solve", *words, "--out", str(out)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode not in (0, 3):
        raise SystemExit(f"{program[0]} could not solve {words}:\n{run.stderr}")


def large_scan(folder: Path) -> Path:
    """Write the mannequin with each triangle split in four, 263,000 in all, and return where."""
    path = folder / "large.ply"
    trimesh.load_mesh(ROOT / "resources" / "samples" / "mannequin.ply").subdivide().export(path)
    return path


def furthest(one: Path, other: Path) -> float:
    """Return how far the points of two bodies lie apart at most [of 1 or of the larger coordinate]."""
    first, second = (read_triangles(path.name, path.read_bytes())[0] for path in (one, other))
    return float(np.max(np.abs(first - second) / np.maximum(1.0, np.abs(first))))


def apart(one: Path, other: Path) -> tuple[int, list[str]]:
    """Return how many figures two answers hold, and what is different in them, a line each."""
    first, second = answer(one), answer(other)
    names = sorted(first.keys() | second.keys())
    found = [
        f"{name}: {first.get(name)} and {second.get(name)}"
        for name in names
        if not is_same(first.get(name), second.get(name))
    ]
    for path in sorted(one.glob("*.ply")):
        if (gap := furthest(path, other / path.name)) > CLOSE:
            found.append(f"{path.name}: points up to {gap:.2g} apart")
    return len(names), found


def main() -> int:
    """Run all cases; the exit code is 1 if a number differs."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--program", type=Path, default=ROOT / "dist" / "busk" / "busk")
    parser.add_argument("--keep", type=Path, help="a folder to leave the answers in")
    chosen = parser.parse_args()
    source = [sys.executable, "-c", "import sys; from app.cli.main import main; sys.exit(main())"]
    os.environ["PYTHONPATH"] = str(ROOT)
    code = 0
    with tempfile.TemporaryDirectory() as folder:
        place = chosen.keep or Path(folder)
        for name, words in CASES.items():
            scan = ROOT / "resources" / "samples" / words[0]
            if words[0] == "{large}":
                scan = large_scan(place)
            solved(source, [str(scan), *words[1:]], place / name / "source")
            solved([str(chosen.program)], [str(scan), *words[1:]], place / name / "frozen")
            count, found = apart(place / name / "source", place / name / "frozen")
            print(f"{name}: {count} figures and the bodies, {len(found)} apart", *found[:10], sep="\n    ")
            code = code or int(bool(found))
    return code


if __name__ == "__main__":
    sys.exit(main())
