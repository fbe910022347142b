"""A million vertices opened in the real window: how long it stands still, how soon it lets go of them.

Run: QT_QPA_PLATFORM=xcb xvfb-run -a -s "-screen 0 2600x1500x24" python benchmarks/bench_opening.py [SCAN]
with [--cancel 0.1 0.3 0.5 0.7 0.9] [--noise 0.1]; on a display of your own without xvfb-run.

Without SCAN the mannequin is split until it has a million vertices, with noise [mm] like that of a scanner. A
timer of 5 ms beats in the window's thread; every pause of over 50 ms between two beats is printed, with how
long that thread was busy itself, and where all threads stood. What is not busy waits for the interpreter or
for another program: only busy pauses can be compared on a machine that does other work too.

First the scan is opened and the Cancel button pressed at some shares of the work: prints how long it takes
until the card has gone and the window beats again, until the solver's thread has ended the work, and what
memory the process still has from the system.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import threading
import time
import traceback
from pathlib import Path

import numpy as np
import trimesh
from PySide6.QtCore import QEventLoop, Qt, QTimer
from PySide6.QtWidgets import QApplication

from app.cli.commands.picture import wait_until
from app.gui.application import application
from app.gui.main_window import MainWindow
from app.gui.startup import open_window
from app.rendering.display import off_screen
from core.document.design import Design, ScanSource
from core.geometry.mesh import Faces, Points

SAMPLE = Path(__file__).parent.parent / "resources" / "samples" / "mannequin.ply"
WANTED, BEAT, LONG, DEEP = 1_000_000, 5, 0.05, 7


def large_scan(folder: Path, noise: float) -> Path:
    """Write the mannequin with a million vertices, each moved by noise [mm], and return its file."""
    mesh = trimesh.load(SAMPLE, process=False)
    points, faces = split(mesh.vertices, mesh.faces, round(np.sqrt(WANTED / len(mesh.vertices))))
    scale = 1.0 if np.ptp(points[:, 2]) > 50.0 else 1e-3
    points = points + np.random.default_rng(1).normal(0.0, noise * scale, points.shape)
    path = folder / "large.ply"
    trimesh.Trimesh(points, faces, process=False).export(path)
    print(f"{len(points):,} vertices, {len(faces):,} triangles")
    return path


def split(vertices: Points, faces: Faces, parts: int) -> tuple[Points, Faces]:
    """Return a mesh with each edge in so many parts, so that each triangle is ``parts**2`` of them."""
    grid = [(i, j) for i in range(parts + 1) for j in range(parts + 1 - i)]
    number = {place: at for at, place in enumerate(grid)}
    up = [[number[i, j], number[i + 1, j], number[i, j + 1]] for i, j in grid if i + j < parts]
    down = [[number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]] for i, j in grid if i + j < parts - 1]
    share = np.array([(parts - i - j, i, j) for i, j in grid]) / parts
    places = np.einsum("gk,mkx->mgx", share, vertices[faces]).reshape(-1, 3)
    step = 1e-7 * float(np.ptp(vertices))
    _, first, same = np.unique(np.round(places / step), axis=0, return_index=True, return_inverse=True)
    within = np.array(up + down)
    each = len(grid) * np.arange(len(faces))[:, None, None] + within
    return places[first], same.ravel()[each.reshape(-1, 3)]


class Heart:
    """Beats in the window's thread; another thread writes down what all are at when one is overdue."""

    def __init__(self) -> None:
        self.pauses: list[tuple[float, float, float, str]] = []
        self.last = self.begun = time.perf_counter()
        self._spent = time.thread_time()
        self._seen = ""
        self._ended = False
        self._clock = QTimer(interval=BEAT, timerType=Qt.TimerType.PreciseTimer)
        self._clock.timeout.connect(self._beat)
        self._clock.start()
        threading.Thread(target=self._watch, daemon=True).start()

    def _beat(self) -> None:
        now, spent = time.perf_counter(), time.thread_time()
        if now - self.last > LONG:
            self.pauses.append((self.last, now - self.last, spent - self._spent, self._seen))
        self._seen, self.last, self._spent = "", now, spent

    def _watch(self) -> None:
        while not self._ended:
            time.sleep(BEAT / 1000.0)
            if time.perf_counter() - self.last > LONG and not self._seen:
                self._seen = at_work()

    def begin(self) -> None:
        """Forget what was."""
        self.pauses.clear()
        self.begun = time.perf_counter()

    def end(self) -> None:
        """Beat no longer."""
        self._clock.stop()
        self._ended = True

    def report(self) -> None:
        """Print the pauses."""
        lengths = [1e3 * length for _, length, *_ in self.pauses]
        print(f"longest pause {max(lengths, default=0.0):.0f} ms, all over 50 ms {sum(lengths):.0f} ms")
        for at, length, own, stood in self.pauses:
            print(f"  at {at - self.begun:5.1f} s  {1e3 * length:5.0f} ms, {1e3 * own:.0f} busy {stood}")


def at_work() -> str:
    """Return the innermost places at which the threads stand."""
    frames, said = sys._current_frames(), []
    for thread in threading.enumerate():
        if thread is not threading.current_thread() and thread.ident in frames:
            stack = traceback.extract_stack(frames[thread.ident])[: -DEEP - 1 : -1]
            places = (f"{'/'.join(Path(at.filename).parts[-2:])}:{at.lineno} {at.name}" for at in stack)
            said.append(f"\n      {thread.name}: " + " < ".join(places))
    return "".join(said)


def solver_thread() -> int:
    """Return the number of the solver's thread."""
    return next(each.ident or 0 for each in threading.enumerate() if each.name == "busk-solver")


def solver_time() -> float:
    """Return the processor time that the solver's thread has taken [s]."""
    return time.clock_gettime(time.pthread_getcpuclockid(solver_thread()))


def building() -> bool:
    """Tell whether the solver's thread reads or builds."""
    frame = sys._current_frames().get(solver_thread())
    while frame is not None and frame.f_code.co_name != "_take":
        frame = frame.f_back
    return frame is not None


def memory() -> float:
    """Return what the process holds now [MB]."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 1e6


def opened(window: MainWindow, path: Path, heart: Heart) -> float:
    """Open a scan, wait until it is settled and shaded, and return how long that took [s]."""
    heart.begin()
    window.session.open(str(path))
    while not (window.session.name == path.stem and window.is_settled() and window.view.is_shaded):
        turn()
    return time.perf_counter() - heart.begun


def turn() -> None:
    """Let the event loop run as it does in use."""
    loop = QEventLoop()
    QTimer.singleShot(20, loop.quit)
    loop.exec()


def cancelled(window: MainWindow, path: Path, at: float, heart: Heart) -> None:
    """Open a scan, press Cancel once that share of the work is done, and print what follows."""
    share, solving = [0.0], window.session._solving
    window.session.working.connect(lambda what, done: share.__setitem__(0, done if what else share[0]))
    before, held = window.session.frame.stages, memory()
    window.session.open(str(path))
    heart.begin()
    while share[0] < at:
        turn()
    what = solving._work[0]
    pressed = time.perf_counter()
    window.actions_.cancel.trigger()
    gone = window.view.busy.isHidden() or None
    beaten = heart.last
    while heart.last <= max(beaten, pressed):
        QApplication.processEvents()
    answered = time.perf_counter() - pressed
    spent = solver_time()
    while building():
        turn()
    ended = time.perf_counter() - pressed
    stands = window.session.frame.stages.body is before.body
    print(
        f"cancel at {at:.0%} ({what}): {1e3 * answered:.0f} ms to an answer, card gone: {bool(gone)}, "
        f"old document stands: {stands}, solver still at it for {1e3 * ended:.0f} ms, "
        f"{1e3 * (solver_time() - spent):.0f} of the processor, "
        f"{memory() - held:+.0f} MB"
    )
    heart.report()


def main() -> None:
    off_screen()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scan", nargs="?")
    parser.add_argument("--cancel", type=float, nargs="*", default=[0.1, 0.3, 0.5, 0.7, 0.9])
    parser.add_argument("--noise", type=float, default=0.1)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(asked.scan) if asked.scan else large_scan(Path(folder), asked.noise)
        application(language="en", dark=False)
        window = open_window(Design(ScanSource(str(SAMPLE))))
        window.resize(1280, 800)
        window.show()
        heart = Heart()
        wait_until(lambda: window.is_settled() and window.view.is_shaded, turn)
        for at in asked.cancel:
            cancelled(window, path, at, heart)
        print(f"opened in {opened(window, path, heart):.1f} s")
        heart.report()
        heart.end()
        window.session.undo_stack.setClean()
        window.close()


if __name__ == "__main__":
    main()
