"""The worker: runs one case after the other and reports how each ended. Cases come as lines of JSON."""

from __future__ import annotations

import importlib
import json
import resource
import sys
import time
import traceback
from contextlib import suppress
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "helpers"), str(ROOT / "benchmarks")]

from core.errors import UserError  # noqa: E402

MOST_ADDRESSES = 6 << 30
"""What the worker may reserve [bytes]: the last resort, the parent watches what it really uses."""


def peak_megabytes() -> float:
    """Return the most memory used since the last reset [MB]."""
    try:
        words = Path("/proc/self/status").read_text().partition("VmHWM:")[2].split()
        return int(words[0]) / 1000.0
    except (OSError, IndexError):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1000.0


def reset_peak() -> None:
    """Begin to watch the memory anew, where the system can."""
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def run(kind: str, recipe: Any) -> tuple[str, str]:
    """Run a case; return "ok", "refused", "memory" or "traceback", and what there is to say about it."""
    module = importlib.import_module(f"fuzzing.{kind}")
    try:
        return "ok", module.run(recipe)
    except UserError as problem:
        lacking = isinstance(problem.__cause__, MemoryError) or "not enough memory" in str(problem.message)
        return ("memory" if lacking else "refused"), str(problem.message)
    except MemoryError:
        return "memory", "out of memory"
    except Exception:
        return "traceback", traceback.format_exc(limit=-8)


def main() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))
    answers, sys.stdout = sys.stdout, sys.stderr
    for line in sys.stdin:
        case = json.loads(line)
        reset_peak()
        start = time.process_time()
        outcome, words = run(case["kind"], case["recipe"])
        seconds = time.process_time() - start
        answer = {"outcome": outcome, "words": words, "seconds": seconds, "megabytes": peak_megabytes()}
        answers.write(json.dumps(answer) + "\n")
        answers.flush()


if __name__ == "__main__":
    main()
