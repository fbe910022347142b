"""The start of the window: processor seconds until something is seen of it, and until all of it is.

Run: QT_QPA_PLATFORM=xcb xvfb-run -a -s "-screen 0 2600x1500x24" python benchmarks/bench_start.py [ROUNDS]
on a display of your own without xvfb-run. Each start is a process of its own, with the settings of the user;
the first one fills the caches and is not counted. Seconds are those of the processor, of all its threads.
"""

from __future__ import annotations

import statistics
import subprocess
import sys

STARTED = """
import sys, time
from PySide6.QtCore import QEvent, QObject, QTimer
from PySide6.QtWidgets import QApplication
from app.cli import main

told = {}

def tell(what):
    told.setdefault(what, time.process_time())

class Watch(QObject):
    def eventFilter(self, watched, event):
        if event.type() == QEvent.Type.Paint and watched.isWindow():
            tell("window" if type(watched).__name__ == "MainWindow" else "place")
        return False

def look():
    window = next((w for w in QApplication.topLevelWidgets() if type(w).__name__ == "MainWindow"), None)
    if window is None or not window.is_settled():
        return
    tell("settled")
    print(*(told.get(what, float("nan")) for what in ("place", "window", "settled")), flush=True)
    window.session.undo_stack.setClean()
    window.close()

import app.window
real = app.window.application
def application(*asked):
    qt = real(*asked)
    qt.watch, qt.clock = Watch(), QTimer(interval=5)
    qt.installEventFilter(qt.watch)
    qt.clock.timeout.connect(look)
    qt.clock.start()
    return qt
app.window.application = application
main(["resources/samples/mannequin.ply"])
"""


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    starts = [_start() for _ in range(rounds + 1)][1:]
    names = ("its place is painted", "the window is painted", "the body is solved and shown")
    for name, seconds in zip(names, zip(*starts, strict=True), strict=True):
        print(f"{name}: {statistics.median(seconds):.2f} s ({min(seconds):.2f} to {max(seconds):.2f})")


def _start() -> list[float]:
    told = subprocess.run([sys.executable, "-c", STARTED], capture_output=True, text=True, check=True)
    return [float(each) for each in told.stdout.split()]


if __name__ == "__main__":
    main()
