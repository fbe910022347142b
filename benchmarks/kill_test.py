"""Kill a program that edits and saves, at random moments, and look what the next start finds.

``python benchmarks/kill_test.py --kills 100`` prints how much was lost at most and whether any file broke.
"""

from __future__ import annotations

import argparse
import os
import random
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT))

from PySide6.QtCore import QCoreApplication, QSettings, QTimer  # noqa: E402

from app.gui.features.project.autosave import AutosaveController  # noqa: E402
from app.gui.session.session import Session  # noqa: E402
from core.document.design import Design, ScanSource  # noqa: E402
from core.document.document import Document  # noqa: E402
from core.document.storage.backups import backups  # noqa: E402
from core.document.storage.project_file import ScanFile, open_project, read_scan_file  # noqa: E402
from core.document.storage.recovery import find_unsaved  # noqa: E402

INTERVAL = 0.2
"""Seconds after an edit until it is kept aside, in this test."""

SCAN = bytes(range(256)) * 40_000
"""Ten megabytes that stand for a scan: writing them takes long enough to be killed in."""


@dataclass(frozen=True)
class Outcome:
    """What one kill did: seconds of edits that were lost of those worked, whether edits were found that only
    the recovery folder held, and what was found that is not whole.
    """

    lost: float
    worked: float
    rescued: bool
    broken: tuple[str, ...]


def kill_once(folder: Path, after: float) -> Outcome:
    """Start a program, kill it ``after`` seconds of work, and look at what it left in ``folder``."""
    journal = folder / "journal"
    before = _last(journal)
    with subprocess.Popen([sys.executable, __file__, "--work", str(folder)]) as program:
        while _last(journal) == before and program.poll() is None:
            time.sleep(0.01)
        time.sleep(after)
        killed = time.time()
        program.kill()
    kept, saved, broken = look(folder)
    # What earlier programs had done was found after they were killed.
    done = [(number, when) for number, when in _entries(journal) if number > before]
    lost = [when for number, when in done if number > max(kept, saved)]
    worked = killed - min((when for _, when in done), default=killed)
    return Outcome(killed - min(lost, default=killed), worked, kept > max(saved, before), broken)


def _entries(journal: Path) -> list[tuple[int, float]]:
    text = journal.read_text() if journal.exists() else ""
    lines = (line.split() for line in text.split("\n")[:-1])
    return [(int(number), float(when)) for number, when in lines]


def _last(journal: Path) -> int:
    return max((number for number, _ in _entries(journal)), default=0)


def look(folder: Path) -> tuple[int, int, tuple[str, ...]]:
    """Do as the next start does: return the numbers of the newest edits that were kept aside and that were
    saved, and what is broken.
    """
    offers, aside = find_unsaved()
    broken = [str(path) for path in aside]
    kept = [each.document for each, _ in offers]
    files = [path for path in (folder / "anna.busk",) if path.exists()]
    saved = [open_project(path) for path in (*files, *(backup.path for backup in backups()))]
    for document in (*kept, *saved):
        scan = read_scan_file(document.design.scan)
        if scan.data != SCAN:
            broken.append(f"{document.design.scan} has not the bytes of the scan")
    for _, recovery in offers:
        # Restored and saved: the next program begins with nothing left behind.
        recovery.remove()
    return _newest(kept), _newest(saved), tuple(broken)


def _newest(documents: list[Document]) -> int:
    return max((int(each.design.unknown["n"]) for each in documents), default=0)


class Quiet(Session):
    """A session in which nothing is solved."""

    def _submit(self, design: Design, fresh: bool = False) -> None:
        pass


def work(folder: Path) -> None:
    """Edit, undo, redo and save without end, with session and autosave as in the window."""
    application = QCoreApplication([])
    application.setApplicationName("Busk")
    QSettings().setValue("autosave", INTERVAL)
    session = Quiet()
    notifications = SimpleNamespace(warn=print, show=print, withdraw=lambda topic: None)
    view = SimpleNamespace(isVisible=lambda: False)
    context = SimpleNamespace(session=session, view=view, notifications=notifications)
    session.frame = SimpleNamespace(stages=SimpleNamespace(scan=ScanFile("body.ply", SCAN)))
    chance, number = random.Random(), _last(folder / "journal")
    session.document = Document.single(Design(ScanSource("/scans/body.ply"), unknown={"n": number}))
    AutosaveController(context, SimpleNamespace(show_title=lambda: None))
    journal = os.open(folder / "journal", os.O_WRONLY | os.O_APPEND | os.O_CREAT)

    def edit() -> None:
        nonlocal number
        what = chance.random()
        if what < 0.1 and session.undo_stack.canUndo():
            session.undo_stack.undo()
            session.undo_stack.redo()
        elif what < 0.11:
            session.save(str(folder / "anna.busk"), None)
        elif what < 0.14:
            session.show_variant(chance.choice("ABC"))
        number += 1
        ratio = 0.8 + 0.3 * chance.random()
        session.edit(
            lambda design: replace(design.with_line("mid-bust", ratio), unknown={"n": number}), "edit"
        )
        os.write(journal, f"{number} {time.time()}\n".encode())

    clock = QTimer(interval=10)
    clock.timeout.connect(edit)
    clock.start()
    application.exec()


def main() -> None:
    """Kill as often as asked for, and print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", type=Path)
    asked = parser.parse_args()
    if asked.work:
        work(asked.work)
    else:
        chance = random.Random(asked.seed)
        with tempfile.TemporaryDirectory() as folder:
            for kind in ("STATE", "DATA", "CONFIG"):
                os.environ[f"XDG_{kind}_HOME"] = str(Path(folder) / kind)
            outcomes = [kill_once(Path(folder), 3.0 * chance.random()) for _ in range(asked.kills)]
        lost = sorted(each.lost for each in outcomes)
        broken = [sentence for each in outcomes for sentence in each.broken]
        print(f"{len(outcomes)} kills, kept aside {INTERVAL} s after an edit")
        print(f"lost: {lost[len(lost) // 2]:.2f} s in the middle, {lost[-1]:.2f} s at most")
        print(f"found in the recovery folder alone: {sum(each.rescued for each in outcomes)}")
        print(f"broken: {len(broken)}", *broken, sep="\n")


if __name__ == "__main__":
    main()
