"""Damage small scan files in any way, and read them: `python benchmarks/fuzz_readers.py [RUNS] [SEED]`.

Each run takes a file of some format, flips bits, cuts, swaps numbers, heads and names, and reads what is
left; every two hundredth run brings a damaged cloud of a real body through repair and pose too. Only a
UserError may come out, within ten seconds of work, in bounded memory. 10,000 runs take two minutes.
"""

from __future__ import annotations

import random
import re
import resource
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from damaged_files import damaged_file  # noqa: E402
from scan_files import CLOUDS, HOUSES  # noqa: E402

from core.body import body_of  # noqa: E402
from core.errors import UserError  # noqa: E402
from core.reading.scan_file import read_raw  # noqa: E402

MEMORY, SECONDS, BODY_EVERY = 3 << 30, 10, 200

FILES = HOUSES | CLOUDS


class TooSlow(BaseException):
    """A reader took too long."""


def small_body() -> bytes:
    """Return a sample body as a cloud of 2,500 points, as a binary PLY file."""
    data = (ROOT / "resources" / "samples" / "mannequin.ply").read_bytes()
    points = read_raw("mannequin.ply", data).vertices[::13].astype("<f4")
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    return (
        head + "".join(f"property float {axis}\n" for axis in "xyz") + "end_header\n"
    ).encode() + points.tobytes()


def _too_slow(*_: object) -> None:
    raise TooSlow


def main() -> int:
    runs, seed = (int(word) for word in [*sys.argv[1:], *("10000", "0")[len(sys.argv) - 1 :]])
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    signal.signal(signal.SIGPROF, _too_slow)
    bodies = {"body.ply": small_body()}
    outcomes, slowest, failures = Counter[str](), 0.0, 0
    for run in range(runs):
        chance = random.Random(1_000_003 * seed + run)
        whole = run % BODY_EVERY == BODY_EVERY - 1
        name, data = damaged_file(chance, bodies if whole else FILES)
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        start = time.process_time()
        try:
            (body_of if whole else read_raw)(name, data)
            outcomes["read"] += 1
        except UserError as problem:
            outcomes[re.sub(r"^\S+|[\d,]+", "...", problem.message)] += 1
            failed = isinstance(problem.__cause__, MemoryError)
        except BaseException as problem:
            failed = True
            print(f"run {run}, {name}: {problem!r}")
        else:
            failed = False
        signal.setitimer(signal.ITIMER_PROF, 0)
        slowest = max(slowest, time.process_time() - start)
        if failed:
            failures += 1
            kept = Path(tempfile.gettempdir()) / f"fuzz-{seed}-{run}-{name}"
            kept.write_bytes(data)
            print(f"run {run} is kept as {kept}")
    for words, count in outcomes.most_common():
        print(f"{count:7,}  {words}")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000.0
    print(f"{runs:,} runs, {failures} failures, slowest {slowest:.1f} s, at most {peak:,.0f} MB")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
