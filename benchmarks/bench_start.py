"""The start of the window: how long until it is painted, and until the body is seen in it.

Run: QT_QPA_PLATFORM=xcb xvfb-run -a -s "-screen 0 2600x1500x24" python benchmarks/bench_start.py [ROUNDS]
         [--first] [--program COMMAND ...]
on a display of your own without xvfb-run, with nothing else on it. The program is only looked at from
outside, so that an installed one can be timed as well: --program /usr/bin/busk. Each start is a process
of its own with fresh settings, on the mannequin or, with --first, on what a new user sees; the first one
fills the caches and is not counted. Three times are told of each moment: seconds on the clock, seconds of
the processor in the window's thread, and in all threads.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from PySide6.QtCore import QRect
from PySide6.QtGui import QGuiApplication, QImage

ROOT = Path(__file__).parent.parent
BODY = ROOT / "resources" / "samples" / "mannequin.ply"
MOMENTS = {"the window is painted": 8, "the body is seen": 90}
"""Each moment by how many colours there are then in two rows across the screen; shading has many."""

AT = (0.30, 0.55)
"""Where these rows are, as parts of the height."""

PATIENCE = 60.0
"""Seconds after which a start has failed."""


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("rounds", nargs="?", type=int, default=5)
    parser.add_argument("--program", nargs="+", default=[sys.executable, "-m", "app"], metavar="COMMAND")
    parser.add_argument("--first", action="store_true", help="name no file: what a new user sees")
    asked = parser.parse_args()
    app = QGuiApplication(sys.argv[:1])
    files = [] if asked.first else [str(BODY)]
    starts = [_start([*asked.program, *files]) for _ in range(asked.rounds + 1)][1:]
    print(f"{'':24}{'clock':>18}{'window thread':>18}{'all threads':>18}")
    for moment in MOMENTS:
        cells = []
        for seconds in zip(*(start[moment] for start in starts), strict=True):
            cells.append(f"{statistics.median(seconds):.2f} ({min(seconds):.2f}-{max(seconds):.2f})")
        print(f"{moment:24}" + "".join(f"{cell:>18}" for cell in cells))
    app.quit()


def _start(program: list[str]) -> dict[str, tuple[float, float, float]]:
    """Return what each moment of one start has taken: on the clock, in the first thread, in all."""
    told: dict[str, tuple[float, float, float]] = {}
    with tempfile.TemporaryDirectory() as house:
        # A start that is ended from outside leaves traces, which the next one would speak of.
        own = {f"XDG_{kind}_HOME": f"{house}/{kind.lower()}" for kind in ("CONFIG", "DATA", "STATE")}
        begun = time.monotonic()
        process = subprocess.Popen(program, cwd=ROOT, env={**os.environ, **own}, stderr=subprocess.DEVNULL)
        try:
            while len(told) < len(MOMENTS):
                if process.poll() is not None or time.monotonic() > begun + PATIENCE:
                    raise SystemExit(f"{program[0]} has not shown a body")
                colours, now = _colours(), time.monotonic() - begun
                for moment, least in MOMENTS.items():
                    if colours >= least and moment not in told:
                        told[moment] = (now, *_processor(process.pid))
                time.sleep(0.02)
        finally:
            process.kill()
            process.wait()
        while _colours() > 1:
            time.sleep(0.02)
    return told


def _colours() -> int:
    """Return how many colours there are in rows across the screen."""
    screen = QGuiApplication.primaryScreen()
    whole, seen = screen.geometry(), set()
    for part in AT:
        row = QRect(whole.x(), whole.y() + round(part * whole.height()), whole.width(), 1)
        image = screen.grabWindow(0, row.x(), row.y(), row.width(), 1).toImage()
        image = image.convertToFormat(QImage.Format.Format_RGB32)
        seen |= set(memoryview(image.constBits()).cast("I"))
    return len(seen)


def _processor(process: int) -> tuple[float, float]:
    """Return the seconds of the processor that a process has had so far: its first thread, all of them."""
    return _spent(f"/proc/{process}/task/{process}/stat"), _spent(f"/proc/{process}/stat")


def _spent(file: str) -> float:
    fields = Path(file).read_text("utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


if __name__ == "__main__":
    main()
