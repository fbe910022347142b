"""Fuzz Busk: `python benchmarks/fuzz.py [--seconds N] [--kind KIND] [--seed N] [--case KIND:SEED:NUMBER]`.

Damaged scan files, mutated projects, hostile names, and bodies that were bent, cropped and torn on their way
to a fitted control mesh, each in a worker with limits: ten seconds of processor time, 1 GB of memory. Only an
answer or a refusal in a sentence may come out. First the corpus of past failures is run again. A failure is
made simpler and kept as one line; mended, it goes into the corpus.
"""

from __future__ import annotations

import argparse
import importlib
import json
import random
import re
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent), str(HERE.parent / "tests" / "helpers")]

from fuzzing.limited import Ending, Worker  # noqa: E402

SHARES = {"readers": 3.0, "projects": 1.0, "names": 1.0, "bodies": 10.0}
"""The kinds of cases, and for which part of the time each is run."""

CORPUS = HERE / "fuzzing" / "corpus.jsonl"
MOST_TRIES = 150


def recipe_of(kind: str, seed: int, number: int) -> Any:
    """Return a case by its name: the same each time."""
    return importlib.import_module(f"fuzzing.{kind}").make(random.Random(f"{kind}:{seed}:{number}"))


def corpus() -> list[dict[str, Any]]:
    """Return past failures: their ``kind`` and ``recipe``."""
    return [json.loads(line) for line in CORPUS.read_text(encoding="utf-8").splitlines() if line.strip()]


def simplest(worker: Worker, kind: str, recipe: Any, ending: Ending) -> Any:
    """Return a recipe that fails in the same way and from which nothing can be left out."""
    module, tries = importlib.import_module(f"fuzzing.{kind}"), 0
    found = True
    while found and tries < MOST_TRIES:
        found = False
        for simpler in module.simpler(recipe):
            tries += 1
            if worker.run(kind, simpler).signature == ending.signature:
                recipe, found = simpler, True
                break
            if tries >= MOST_TRIES:
                break
    return recipe


class Tally:
    """Counts how cases ended, kind by kind, and keeps failures, each cause once."""

    def __init__(self, worker: Worker, keep: Path | None) -> None:
        self._worker, self._keep = worker, keep
        self.endings: dict[str, Counter[str]] = {}
        self.slowest, self.largest = Counter[str](), Counter[str]()
        self.known = set[tuple[str, str]]()
        self.failures = 0

    def run(self, name: str, kind: str, recipe: Any) -> None:
        ending = self._worker.run(kind, recipe)
        words = ending.words if ending.outcome in ("ok", "refused") else ""
        plain = re.sub(r"\S*\.\w+(\.gz)?\b|-?[\d,.]+", "..", words)[:90]
        self.endings.setdefault(kind, Counter())[
            f"{ending.outcome}: {plain}" if plain else ending.outcome
        ] += 1
        self.slowest[kind] = max(self.slowest[kind], ending.seconds)
        self.largest[kind] = max(self.largest[kind], ending.megabytes)
        if ending.failed:
            self.failures += 1
            self._report(name, kind, recipe, ending)

    def _report(self, name: str, kind: str, recipe: Any, ending: Ending) -> None:
        print(f"{name}: {ending.outcome}, {ending.seconds:.1f} s, {ending.megabytes:.0f} MB", flush=True)
        if ending.signature in self.known:
            return
        self.known.add(ending.signature)
        small = simplest(self._worker, kind, recipe, ending)
        line = json.dumps({"kind": kind, "recipe": small})
        print(f"{ending.words}\n  {line[:2000]}", flush=True)
        if self._keep:
            with self._keep.open("a", encoding="utf-8") as kept:
                kept.write(line + "\n")

    def show(self, longest: int) -> None:
        for kind, endings in self.endings.items():
            failed = sum(count for words, count in endings.items() if not words.startswith(("ok", "refused")))
            print(
                f"\n{kind}: {endings.total():,} cases, {failed} failures, "
                f"slowest {self.slowest[kind]:.1f} s, most {self.largest[kind]:,.0f} MB"
            )
            for words, count in endings.most_common(longest):
                print(f"{count:8,}  {words.encode('utf-8', 'backslashreplace').decode()}")


def cases(options: argparse.Namespace) -> Iterator[tuple[str, str, Any]]:
    """Give cases, kind after kind for its share of the time."""
    kinds = options.kind or list(SHARES)
    whole = sum(SHARES[kind] for kind in kinds)
    for kind in kinds:
        end, number = time.monotonic() + options.seconds * SHARES[kind] / whole, 0
        while time.monotonic() < end:
            yield f"{kind}:{options.seed}:{number}", kind, recipe_of(kind, options.seed, number)
            number += 1


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=300.0, help="how long; the corpus comes before that")
    parser.add_argument("--kind", action="append", choices=SHARES, help="only this kind; may be repeated")
    parser.add_argument("--seed", type=int, default=int(time.time()), help="other cases; else by the clock")
    parser.add_argument("--case", metavar="KIND:SEED:NUMBER", help="run one case again")
    parser.add_argument("--keep", type=Path, help="a file that failures are added to, one a line")
    options = parser.parse_args()
    worker = Worker()
    tally = Tally(worker, options.keep)
    try:
        if options.case:
            kind, seed, number = options.case.split(":")
            tally.run(options.case, kind, recipe_of(kind, int(seed), int(number)))
        else:
            for number, past in enumerate(corpus()):
                tally.run(f"corpus:{number}", past["kind"], past["recipe"])
            for case in cases(options):
                tally.run(*case)
    finally:
        worker.close()
    print(f"\nseed {options.seed}")
    tally.show(12)
    return 1 if tally.failures else 0


if __name__ == "__main__":
    sys.exit(main())
