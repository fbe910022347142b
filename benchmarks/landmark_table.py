"""One row for each set of bodies: how far off landmarks are, and how sure they claim to be.

Run: python benchmarks/landmark_table.py DIR [--only clean bra] [--part 0/2] [--worst 10] [--json FILE]. DIR
holds a folder for each set (see make_people.py), or is one set. Bust points are measured to the segment from
the nipple to the foremost point of that breast, folds and under-bust level in height; a file that was refused
or read the wrong way round counts as not accepted and enters no distance.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).parent.parent)]

from app.research.accuracy import OFF, TRUSTED, Case, judged  # noqa: E402
from app.research.ground_truth import read_truths  # noqa: E402

HEADS = (
    *("set", "files", "accepted", "bust within 5", "beyond 8", "beyond 10", "median", "p95", "worst"),
    *("fold median", "p95", "bias", "lowest p95", "level within 6", "level bias"),
    *("sure bust", "sure all", "sure & wrong", "s/file"),
)
JUDGED = ("bust_point", "fold", "lowest")


def misses(case: Case) -> Iterator[tuple[str, float, float]]:
    """Yield name, distance [mm] and confidence of each judged landmark of a file."""
    for mark in case.marks:
        if mark.name.startswith(JUDGED):
            yield mark.name, mark.off, mark.confidence


def row(name: str, cases: Sequence[Case]) -> list[str]:
    """Return the cells of one set."""
    right = [case for case in cases if case.right]
    marks = [each for case in right for each in misses(case)]
    bust, fold, low = (np.array([d for n, d, _ in marks if n.startswith(kind)]) for kind in JUDGED)
    bias = [e for c in right for key, e in c.errors.items() if key.startswith("fold") and "height" in key]
    level = np.array([c.errors["underbust level"] for c in right if "underbust level" in c.errors])
    sure = [(d, n) for n, d, confidence in marks if confidence >= TRUSTED]
    wrong = sum(d > OFF for d, _ in sure)
    points = sum(n.startswith("bust") for _, n in sure)
    return [
        name,
        str(len(cases)),
        _share(len(right), len(cases)),
        _share(int((bust <= 5.0).sum()), len(bust)),
        str(int((bust > 8.0).sum())),
        str(int((bust > 10.0).sum())),
        *_spread(bust),
        f"{max(bust, default=0.0):.1f}",
        *_spread(fold),
        f"{np.median(bias) if bias else 0.0:+.1f}",
        _spread(low)[1],
        _share(int((np.abs(level) <= 6.0).sum()), len(level)),
        f"{np.median(level) if len(level) else 0.0:+.1f}",
        _share(points, len(bust)),
        _share(len(sure), len(marks)),
        f"{wrong} ({100.0 * wrong / max(len(sure), 1):.1f} %)",
        f"{np.median([case.seconds for case in cases]):.1f}",
    ]


def _share(part: int, whole: int) -> str:
    return f"{100.0 * part / whole:.0f} %" if whole else "-"


def _spread(values: np.ndarray) -> tuple[str, str]:
    if not len(values):
        return "-", "-"
    return f"{np.median(values):.1f}", f"{np.percentile(values, 95):.1f}"


def table(rows: Sequence[Sequence[str]]) -> str:
    widths = [max(len(cells[k]) for cells in rows) for k in range(len(rows[0]))]
    lines = [
        "| " + " | ".join(cell.ljust(w) for cell, w in zip(cells, widths, strict=True)) + " |"
        for cells in rows
    ]
    lines.insert(1, "|" + "|".join("-" * (w + 2) for w in widths) + "|")
    return "\n".join(lines)


def worst(cases: Sequence[Case], count: int) -> Iterator[str]:
    """Yield what was refused or read wrongly, and the landmarks that are furthest off."""
    for case in cases:
        if not case.right:
            yield f"  {case.truth.name} {' '.join(case.truth.kinds)}: {case.failed or 'the wrong way round'}"
    marks = [(d, n, conf, c.truth) for c in cases if c.right for n, d, conf in misses(c)]
    for d, name, confidence, truth in sorted(marks, key=lambda m: -m[0])[:count]:
        yield f"  {truth.name} {' '.join(truth.kinds)}: {name} {d:.1f} mm off, confidence {confidence:.2f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--part", default="0/1", help="every n-th file, beginning with k: k/n")
    parser.add_argument("--worst", type=int, default=0)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    own = options.folder / "truth.json"
    folders = (
        [options.folder] if own.exists() else sorted(p.parent for p in options.folder.glob("*/truth.json"))
    )
    first, step = map(int, options.part.split("/"))
    rows, listed, everything = [list(HEADS)], [], {}
    for folder in folders:
        if options.only and folder.name not in options.only:
            continue
        cases = list(judged(folder, read_truths(folder)[0][first::step]))
        rows.append(row(folder.name, cases))
        listed += [folder.name, *worst(cases, options.worst)]
        everything[folder.name] = {
            case.truth.name: {
                "failed": case.failed,
                "right": case.right,
                "marks": [*misses(case)],
                "errors": dict(case.errors),
            }
            for case in cases
        }
        print("  ".join(f"{h}: {c}" for h, c in zip(HEADS, rows[-1], strict=True)), file=sys.stderr)
    print(table(rows))
    if options.worst:
        print("\n".join(listed))
    if options.json:
        options.json.write_text(json.dumps(everything, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
