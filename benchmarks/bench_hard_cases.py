"""Over-constrained cases at random: how each of them ends with the exact answer and with adaptive turns.

Run: python benchmarks/bench_hard_cases.py [COUNT [FIRST]]; 200 cases if none is named. Prints how many end in
what, medians of the time, and each case that does not end as it should: with a figure that is no number, with
a warning, or vibrating although there is a balance.
"""

from __future__ import annotations

import statistics
import sys
import time
import warnings
from collections import Counter
from math import isnan
from pathlib import Path

from threadpoolctl import threadpool_limits

sys.path[:0] = [str(Path(__file__).parent.parent), str(Path(__file__).parent.parent / "tests" / "helpers")]

from hard_cases import HardCase, hard_case  # noqa: E402

from core.mechanics.convergence import Convergence  # noqa: E402


def ending(case: HardCase, control: str) -> tuple[float, Convergence, float]:
    """Residual [mm], verdict and seconds."""
    start = time.perf_counter()
    residual, verdict = case.exact() if control == "exact" else case.turns(control)
    return residual, verdict, time.perf_counter() - start


def troubles(case: HardCase, counts: Counter[tuple[str, str]], seconds: dict[str, list[float]]) -> list[str]:
    """What is wrong with how a case ends; adds to the counts and seconds."""
    found, wrong = False, []
    for control, times in seconds.items():
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            residual, verdict, spent = ending(case, control)
        words = "no balance" if control == "exact" and verdict.motion != "settled" else verdict.words
        found = found or (control == "exact" and words != "no balance")
        counts[(control, words)] += 1
        times.append(spent)
        if isnan(residual) or isnan(verdict.error) or caught:
            wrong.append(f"{control}: residual {residual}, error {verdict.error}, {len(caught)} warnings")
        promised = found and case.mechanics.line_force == "implicit"
        if promised and verdict.motion in ("vibrating", "diverging"):
            wrong.append(f"{control}: {words} although there is a balance")
    return wrong


def main() -> None:
    words = sys.argv[1:]
    count, first = int(words[0]) if words else 200, int(words[1]) if len(words) > 1 else 0
    counts: Counter[tuple[str, str]] = Counter()
    seconds: dict[str, list[float]] = {"exact": [], "adaptive": []}
    for seed in range(first, first + count):
        case = hard_case(seed)
        for trouble in troubles(case, counts, seconds):
            print(f"{trouble}\n  {case}", flush=True)
    for control, spent in seconds.items():
        print(f"{control}: median {1000.0 * statistics.median(spent):.0f} ms, longest {max(spent):.1f} s")
        for (of_it, words), times in counts.most_common():
            if of_it == control:
                print(f"{times:6} {words}")


if __name__ == "__main__":
    with threadpool_limits(1):
        main()
