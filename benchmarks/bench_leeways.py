"""How long the zones of a slider take to follow an edit, in the window.

Run: python benchmarks/bench_leeways.py [SCAN].

The mid-bust line is selected and the full-bust line set to other lengths, some twenty times, while the window
runs as always: the time from the edit to the new zones of the selected line, and to those of all lines, by
the clock and in processor time of the whole program. Needs a display, or a virtual one.
"""

from __future__ import annotations

import sys
import time
from functools import partial
from pathlib import Path

import numpy as np

sys.path[:0] = [str(Path(__file__).parents[1]), str(Path(__file__).parents[1] / "tests" / "helpers")]

from window_tools import Script, run_main, settled  # noqa: E402

from app.gui.main_window import MainWindow  # noqa: E402
from core.garment.elastic_library import find_elastic  # noqa: E402

EDITS = 20
USUAL = {"line_contact": "glued", "member_law": "force-density", "line_hold": "spring"}
WAYS = {
    "glued": {},
    "sliding": {"line_contact": "sliding"},
    "co-rotated": {"member_law": "co-rotated"},
    "held": {"line_hold": "held"},
}


def main() -> None:
    """Edit, wait and print."""
    run_main(sys.argv[1:], script)


def script(window: MainWindow) -> Script:
    yield settled(window)
    window.selection.select_line("mid-bust")
    for way, changes in WAYS.items():
        window.session.change({**USUAL, **changes}, way)
        yield settled(window)
        yield from edits(window, way)
    window.session.change(USUAL, "usual")
    window.session.edit(lambda design: design.with_elastic("mid-bust", find_elastic("strap 15")), "elastic")
    yield settled(window)
    yield from edits(window, "mid-bust made of elastic")


def edits(window: MainWindow, way: str) -> Script:
    """Set the full-bust line to lengths that were not there before, and wait for the zones."""
    seconds: list[tuple[float, float, float, float]] = []
    for edit in range(EDITS):
        clock, spent = time.perf_counter(), time.process_time()
        window.lines_controller.commit_length("full-bust", 0.90 + 0.002 * edit)
        times = []
        for names in (("mid-bust",), ("mid-bust", "full-bust")):
            yield partial(fresh, window, names)
            times += [time.perf_counter() - clock, time.process_time() - spent]
        seconds.append((times[0], times[1], times[2], times[3]))
        if edit % 2:
            yield settled(window)  # every other edit comes while the model still settles
    told = [f"{np.median(each):.3f} ({np.quantile(each, 0.95):.3f})" for each in np.array(seconds).T]
    print(
        f"{way}: selected {told[0]} s by the clock, {told[1]} s processor; all {told[2]}, {told[3]}",
        flush=True,
    )


def fresh(window: MainWindow, names: tuple[str, ...]) -> bool:
    """Tell whether the zones of these lines are those of the design that is edited."""
    frame, rows = window.session.frame, window.lines.rows
    design = window.session.design
    if frame is None or frame.stages.design is not design:
        return False
    return all(rows[name].view.leeway is not None and not rows[name].view.stale for name in names)


if __name__ == "__main__":
    main()
