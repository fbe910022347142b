"""Walk at random through the real window, and look after each step whether all is as it must be.

``python benchmarks/walk_test.py --seeds 10 --steps 300`` prints a line for each walk; it needs a display.
"""

from __future__ import annotations

import argparse
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "helpers")]

from PySide6.QtCore import QSettings  # noqa: E402
from walk_steps import Walker  # noqa: E402
from window_tools import Script, run_main, settled, undrawn  # noqa: E402

import app.gui.session.document_editor  # noqa: E402
from app.gui.application import application  # noqa: E402
from app.gui.main_window import MainWindow  # noqa: E402


def walk(seed: int, steps: int, body: str) -> None:
    """Walk in a window of this process, and print how far off was what was shown at rest."""
    app.gui.session.document_editor.PAUSE = -1.0  # every edit is one step, however quick
    application()
    QSettings().setValue("autosave", 0.05)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        undrawn(window)
        with tempfile.TemporaryDirectory() as folder:
            walker = Walker(window, Path(folder), random.Random(seed))
            yield from walker.walk(steps, every=50)
            said = f"{walker.refused} edits refused, {walker.sent_back} sent back by the solver"
            print(f"  {said}; exact answer off by {walker.far[0]:.1e} mm, turns by {walker.far[1]:.2f} mm")

    run_main([str(ROOT / "resources" / "samples" / f"{body}.ply")], script)


def main() -> None:
    """Walk as often as asked for, each time in a fresh program, on the samples in turn."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--steps", type=int, default=300)
    parser.add_argument("--walk", metavar="SAMPLE", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.walk:
        walk(asked.first, asked.steps, asked.walk)
        return
    failed = 0
    for seed in range(asked.first, asked.first + asked.seeds):
        body = ("mannequin", "person")[seed % 2]
        words = ["--walk", body, "--first", str(seed), "--steps", str(asked.steps)]
        began = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            homes = {f"XDG_{kind}_HOME": f"{folder}/{kind}" for kind in ("STATE", "DATA", "CONFIG", "CACHE")}
            code = subprocess.call([sys.executable, __file__, *words], env=os.environ | homes)
        failed += code != 0
        print(
            f"seed {seed}, {body}: {'ended' if code == 0 else 'FAILED'} in {time.monotonic() - began:.0f} s"
        )
    print(f"{asked.seeds} walks of {asked.steps} steps, {failed} failed")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
