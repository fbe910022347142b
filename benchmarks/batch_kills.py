"""Kill a batch run and its processes again and again: no body is lost, none is twice.

.venv/bin/python benchmarks/batch_kills.py --kills 200
"""

from __future__ import annotations

import argparse
import csv
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil
import pyarrow.parquet as pq

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "helpers")]

from batch_tools import start_batch  # noqa: E402
from coarse_bodies import coarse_body  # noqa: E402

LONGEST = 14.0  # seconds that a run lasts before a kill


def rows_of(out: Path) -> dict[tuple[str, str], dict[str, object]]:
    """Return the rows of both tables, which must be readable and hold each body once."""
    rows = [
        row for part in sorted(out.glob("results.parquet/part-*")) for row in pq.read_table(part).to_pylist()
    ]
    unique = {(row["scan"], row["variant"]): row for row in rows}
    assert len(unique) == len(rows), "a body is there twice"
    if (out / "results.csv").is_file():
        with open(out / "results.csv", newline="", encoding="utf-8-sig") as file:
            widths = {len(row) for row in csv.reader(file)}
        assert len(widths) == 1, "a line is not whole"
    return unique


def kill_once(process: subprocess.Popen[bytes], chance: random.Random) -> str:
    """Kill the command, a worker or the process of a body; return which."""
    try:
        family = psutil.Process(process.pid).children(recursive=True)
        kinds = {"body": "body_process", "worker": "spawn_main"}
        kind = chance.choice(("command", *kinds))
        some = [each for each in family if kind in kinds and kinds[kind] in " ".join(each.cmdline())]
        if kind == "command":
            process.kill()
        elif some:
            chance.choice(some).kill()
        return kind if kind == "command" or some else "none"
    except psutil.NoSuchProcess:
        return "none"


def main() -> None:
    """Make bodies, kill until there were so many kills, then finish the run."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--bodies", type=int, default=2000)
    options = parser.parse_args()
    chance, counts = random.Random(1), dict.fromkeys(("command", "worker", "body"), 0)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        data, scans, out = coarse_body("person", folder).read_bytes(), folder / "scans", folder / "out"
        scans.mkdir()
        for number in range(options.bodies):
            (scans / f"{number:05}.ply").write_bytes(data + number.to_bytes(3, "little"))
        words = (scans, "--line", "mid-bust=-20mm", "--workers", "2", "--out", out)
        process, before = start_batch(*words), dict[tuple[str, str], dict[str, object]]()
        while sum(counts.values()) < options.kills and process.poll() is None:
            time.sleep(chance.uniform(0.5, LONGEST))
            kind = kill_once(process, chance)
            if kind != "none":
                counts[kind] += 1
            if kind == "command":
                process.communicate()
                now = rows_of(out)
                assert before.items() <= now.items(), "a row was lost or computed again"
                before, process = now, start_batch(*words)
                print(f"{sum(counts.values())} kills, {len(now)} bodies", flush=True)
        process.communicate()
        start_batch(*words, "--retry").communicate()
        rows = rows_of(out)
        assert len(rows) == options.bodies, "a body is missing"
        assert {row["state"] for row in rows.values()} == {"done"}
        print(f"killed {counts}: {len(rows)} bodies, each once")


if __name__ == "__main__":
    main()
