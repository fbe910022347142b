"""Kill the real window at random moments while it is edited and saved, and look what the next start has.

``python benchmarks/kill_window_test.py --kills 100`` needs a display; it prints what was lost and broken, and
how often the view came up in safe mode. ``--body`` names another scan than the sample.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "helpers")]

from PySide6.QtCore import QSettings, Qt, QTimer  # noqa: E402
from PySide6.QtTest import QTest  # noqa: E402
from window_tools import Script, run_main, settled  # noqa: E402

import app.gui.features.project.controller as project_files  # noqa: E402
from app.gui.application import application  # noqa: E402
from app.gui.main_window import MainWindow  # noqa: E402
from app.gui.viewport.opengl import is_safe_mode  # noqa: E402
from core.document.document import Document  # noqa: E402
from core.document.serialization import to_texts  # noqa: E402
from core.document.storage.project_file import open_project, with_scan  # noqa: E402

SAMPLE = ROOT / "resources" / "samples" / "mannequin.ply"
INTERVAL = 0.5
"""Seconds after an edit until it is kept aside, in this test."""


def digest(document: Document) -> str:
    """Return what tells a document from others, wherever its scan lies."""
    return hashlib.sha256(json.dumps(to_texts(with_scan(document, "", ""))).encode()).hexdigest()[:16]


class Hand:
    """Works in the window as a user does, and writes down each state of the document with its time."""

    def __init__(self, window: MainWindow, folder: Path) -> None:
        self.window, self.session, self.folder = window, window.session, folder
        self.chance = random.Random()
        self.journal = os.open(folder / "journal", os.O_WRONLY | os.O_APPEND | os.O_CREAT)
        self.session.design_changed.connect(lambda _: self.tell("now", digest(self.session.document)))
        self.clock = QTimer(window, interval=60)
        self.clock.timeout.connect(self.move)

    def tell(self, what: str, value: object) -> None:
        """Write a line into the journal, which outlives the program."""
        os.write(self.journal, (json.dumps([what, value, time.time()]) + "\n").encode())

    def move(self) -> None:
        """Move a slider, take something back, show another variant or save."""
        do, what = self.window.actions_, self.chance.random()
        if what < 0.1:
            do.undo.trigger()
        elif what < 0.14:
            do.redo.trigger()
        elif what < 0.18:
            self.window.variants_controller.segment.button(self.chance.choice("ABC")).click()
        elif what < 0.20:
            do.save.trigger()
        else:
            slider = self.window.lines.rows[self.chance.choice(("mid-bust", "full-bust"))].slider
            keys = (Qt.Key.Key_Right,) if slider.ratio() < 0.93 else (Qt.Key.Key_Left, Qt.Key.Key_Right)
            QTest.keyClick(slider, self.chance.choice(keys))


def work(folder: Path, body: Path) -> None:
    """Start, have back what is offered, and work until killed."""
    project = folder / "anna.busk"
    project_files.ask_save = lambda *_: str(project)  # type: ignore[assignment]
    project_files.ask_about_changes = lambda *_: "discard"  # type: ignore[assignment]
    application()
    QSettings().setValue("autosave", INTERVAL)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        hand, recovery = Hand(window, folder), window.recovery_controller
        notice = window.notices.notice()
        hand.tell("safe", is_safe_mode())
        hand.tell("said", notice.sentence if notice is not None else "")
        hand.tell("offers", [digest(kept.document) for kept, _ in recovery._offers])
        while recovery._offers:
            recovery.card.take.click()
            yield partial(_are, recovery._offers, len(recovery._offers) - 1)
            yield settled(window)
        hand.tell("now", digest(window.session.document))
        hand.clock.start()
        yield lambda: False

    run_main([str(project if project.exists() else body)], script)


def _are(some: list, count: int) -> bool:
    return len(some) == count


@dataclass(frozen=True)
class Outcome:
    """What a kill did: seconds of work that were lost of those done, the numbers of the newest states that
    were offered and saved, of so many, and what was wrong at the next start.
    """

    lost: float
    worked: float
    offered: int
    saved: int
    states: int
    safe: bool
    wrong: tuple[str, ...]


def lines(folder: Path) -> list[tuple[str, object, float]]:
    """Return the journal of all programs so far."""
    path = folder / "journal"
    return [tuple(json.loads(line)) for line in path.read_text().split("\n")[:-1]] if path.exists() else []


def kill(folder: Path, body: Path, moments: Iterator[float]) -> Iterator[Outcome]:
    """Kill one program after the other, each after so many seconds of work; the next tells what it found."""
    former: list[tuple[str, object, float]] = []
    killed = 0.0
    for after in moments:
        begun = len(lines(folder))
        words = ["--work", str(folder), "--body", str(body)]
        with (
            (folder / "errors").open("a") as errors,
            subprocess.Popen([sys.executable, __file__, *words], stderr=errors) as program,
        ):
            while "now" not in [what for what, *_ in lines(folder)[begun:]]:
                time.sleep(0.02)
                if program.poll() is not None:
                    ended = f"the program ended by itself: {program.returncode}"
                    yield Outcome(0.0, 0.0, -1, -1, 0, False, (ended,))
                    return
            if former:
                found = {what: value for what, value, _ in lines(folder)[begun:]}
                yield _judge(folder, former, killed, found)
            time.sleep(after)
            killed = time.time()
            program.kill()
        former = [each for each in lines(folder)[begun:] if each[0] == "now"]


def _judge(folder: Path, former: list, killed: float, found: dict) -> Outcome:
    wrong, states, saved = [], [str(value) for _, value, _ in former], ""
    project, offers = folder / "anna.busk", list(found["offers"])
    try:
        saved = digest(open_project(project)) if project.exists() else states[0]
    except Exception as problem:
        wrong.append(f"the project: {problem}")
    offered = max((_last(states, each) for each in offers), default=-1)
    newest = max(offered, _last(states, saved))
    if "cannot be read" in found["said"]:
        wrong.append(found["said"])
    if len(offers) > 1:
        wrong.append(f"{len(offers)} offers")
    if newest < 0:
        wrong.append("no state of the last program was found")
    lost = killed - former[newest + 1][2] if newest + 1 < len(former) else 0.0
    worked = killed - former[0][2]
    figures = offered, _last(states, saved), len(states)
    return Outcome(lost, worked, *figures, bool(found["safe"]), tuple(wrong))


def _last(states: list[str], state: str) -> int:
    return max((place for place, each in enumerate(states) if each == state), default=-1)


def main() -> None:
    """Kill as often as asked for, and print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=5.0, help="the longest that a program may work")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--body", type=Path, default=SAMPLE)
    parser.add_argument("--work", type=Path, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.work:
        work(asked.work, asked.body)
        return
    chance = random.Random(asked.seed)
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("STATE", "DATA", "CONFIG", "CACHE"):
            os.environ[f"XDG_{kind}_HOME"] = str(Path(folder) / kind)
        moments = (asked.seconds * chance.random() for _ in range(asked.kills + 1))
        outcomes = []
        for outcome in kill(Path(folder), asked.body, moments):
            outcomes.append(outcome)
            print(outcome, flush=True)
            if outcome.wrong:
                print((Path(folder) / "errors").read_text()[-3000:])
    lost = sorted(each.lost for each in outcomes)
    print(f"{len(outcomes)} kills, kept aside {INTERVAL} s after an edit")
    print(f"lost: {lost[len(lost) // 2]:.2f} s in the middle, {lost[-1]:.2f} s at most")
    print(f"had back from the recovery folder: {sum(each.offered > each.saved for each in outcomes)}")
    print(f"in safe mode: {sum(each.safe for each in outcomes)}")
    print("wrong:", *(sentence for each in outcomes for sentence in each.wrong), sep="\n")


if __name__ == "__main__":
    main()
