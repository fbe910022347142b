"""Three hundred random edits, undone, redone, saved and opened again, beside a model that cannot be wrong."""

from __future__ import annotations

import random
from dataclasses import astuple, replace
from pathlib import Path

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

import app.asking.edit
from app.asking.session import Session
from core.document import Document
from core.project import with_scan
from core.settled import settled_frame

LINES = ("mid-bust", "full-bust", "under-bust")
STEPS, LOOKS = 300, 4


class Walk:
    """A session, and beside it the list of all its documents and which of them is present."""

    def __init__(self, session: Session, qtbot: QtBot, folder: Path, chance: random.Random) -> None:
        self.session, self.qtbot, self.folder, self.chance = session, qtbot, folder, chance
        self.documents = [session.document]
        self.present = 0

    def step(self) -> None:
        """Do one thing, in the session and in the model."""
        whims = (self.edit, self.drag, self.choose, self.undo, self.undo, self.redo, self.variant, self.leave)
        self.chance.choices(whims, (6, 3, 2, 3, 1, 3, 2, 2))[0]()

    def note(self, after: Document) -> None:
        """Take an edit into the model: what was undone is gone; an edit that changes nothing is none."""
        if after != self.documents[self.present]:
            self.documents[self.present + 1 :] = [after]
            self.present += 1

    def edit(self) -> None:
        name, ratio = self.chance.choice(LINES), self.ratio()
        before = self.documents[self.present]
        self.session.commit_line(name, name, ratio)
        self.note(before.with_design(before.design.with_line(name, None if ratio == 1.0 else ratio)))

    def drag(self) -> None:
        for _ in range(3):
            self.session.preview_line(self.chance.choice(LINES), self.ratio())
        if self.chance.random() < 0.5:
            self.session.cancel_preview()
        else:
            self.edit()

    def choose(self) -> None:
        before = self.documents[self.present]
        if self.chance.random() < 0.3:
            self.session.reset_lines()
            self.note(before.with_design(before.design.at_rest()))
            return
        stiff = self.chance.choice((0.5, 1.0, 2.0))
        self.session.change({"line_stiffness": stiff}, "stiffness")
        self.note(before.with_design(replace(before.design, line_stiffness=stiff)))

    def undo(self) -> None:
        self.session.undo_stack.undo()
        self.present = max(self.present - 1, 0)

    def redo(self) -> None:
        self.session.undo_stack.redo()
        self.present = min(self.present + 1, len(self.documents) - 1)

    def variant(self) -> None:
        name, before = self.chance.choice("ABC"), self.documents[self.present]
        if self.chance.random() < 0.3:
            self.session.remove_variant(name)
            self.note(before.without(name))
        elif name != before.shown:
            self.session.show_variant(name)
            self.note(before.showing(name))

    def leave(self) -> None:
        """Save, and now and then open what was saved."""
        path = self.folder / f"{self.chance.randrange(3)}.busk"
        assert self.session.save(str(path), None)
        assert self.session.finish_saving()
        assert self.session.path == path
        if self.chance.random() < 0.3:
            before = self.documents[self.present]
            with self.qtbot.waitSignal(self.session.opened, timeout=60_000):
                self.session.open(str(path))
            assert with_scan(self.session.document, "", "") == with_scan(before, "", "")
            self.documents, self.present = [self.session.document], 0

    def ratio(self) -> float:
        return self.chance.choice((1.0, round(0.85 + 0.15 * self.chance.random(), 3)))

    def check(self) -> None:
        """The document is the model's, and so is the history."""
        stack = self.session.undo_stack
        assert self.session.document == self.documents[self.present]
        assert (stack.index(), stack.count()) == (self.present, len(self.documents) - 1)

    def check_result(self) -> None:
        """What is shown at rest is what the design alone leads to, whatever way led there."""

        def rests() -> bool:
            frame = self.session.frame
            return frame.stages.design is self.session.design and not frame.at_work

        self.qtbot.waitUntil(rests, timeout=60_000)
        shown = self.session.frame
        alone = settled_frame(self.session.design, shown.stages)
        assert np.allclose(astuple(shown.exact_marks), astuple(alone.exact_marks), atol=1e-3)
        assert np.abs(shown.control_points - alone.control_points).max() < 0.3


def test_a_random_walk_ends_where_its_model_does(
    qtbot: QtBot, tmp_path: Path, mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(app.asking.edit, "PAUSE", -1.0)  # each edit is one entry, however quick this test is
    session = Session()
    faults: list[Exception] = []
    session.failed.connect(faults.append)
    try:
        with qtbot.waitSignal(session.opened, timeout=60_000):
            session.open(str(mannequin))
        walk = Walk(session, qtbot, tmp_path, random.Random(5))
        for step in range(1, STEPS + 1):
            walk.step()
            walk.check()
            if step % (STEPS // LOOKS) == 0:
                walk.check_result()
        assert not faults
    finally:
        session.close()
