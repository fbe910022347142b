"""Three hundred random edits, undone, redone, saved and opened again, beside a model that cannot be wrong."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import astuple, dataclass, field, replace
from functools import reduce
from pathlib import Path

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

import app.gui.session.document_editor
from app.gui.session.session import Session
from core.control_mesh.template import read_template
from core.document.design import Design
from core.document.document import Document
from core.document.line_notation import ready_made_lines
from core.document.storage.project_file import open_project, with_scan
from core.errors import LineError, UserError
from core.garment.presets import built_in, with_preset
from core.messages import Message
from core.pipeline.converged import converged_frame
from core.pipeline.live_solver import Failure, Frame

LINES = ("mid-bust", "full-bust", "under-bust")
STRAPS = ("strap left", "strap right")
STEPS, LOOKS = 300, 2


@dataclass
class Entry:
    """One step of the history: what it was made to, the documents that were taken in one by one, and which of
    them were solved.
    """

    what: str
    documents: list[Document]
    solved: set[int] = field(default_factory=set)


class Walk:
    """A session, and beside it the list of all its documents and which of them is present."""

    def __init__(self, session: Session, qtbot: QtBot, folder: Path, chance: random.Random) -> None:
        self.session, self.qtbot, self.folder, self.chance = session, qtbot, folder, chance
        self.entries, self.present = [Entry("", [session.document])], 0
        self.files: dict[Path, Document] = {}
        self.refused, self.clean = 0, True
        session.frame_ready.connect(self.note_frame)

    @property
    def document(self) -> Document:
        return self.entries[self.present].documents[-1]

    def step(self) -> None:
        """Do one thing, in the session and in the model."""
        whims = {self.turn: 6, self.drag: 3, self.choose: 2, self.undo: 4, self.redo: 3, self.variant: 2}
        whims |= {self.leave: 2, self.hurry: 1, self.refuse: 2, self.treat: 2, self.draw: 2, self.dress: 1}
        self.clean = self.session.undo_stack.isClean()
        app.gui.session.document_editor.PAUSE = self.chance.choice((-1.0, 1e9))
        self.chance.choices(list(whims), list(whims.values()))[0]()

    def note(self, after: Document, what: str = "") -> bool:
        """Take an edit into the model; returns whether it stands as the last one.

        What was undone is gone, an edit that changes nothing is none, quick edits of one thing are one.
        """
        if after == self.document:
            return False
        del self.entries[self.present + 1 :]
        top = self.entries[-1]
        if not what or what != top.what or self.clean or app.gui.session.document_editor.PAUSE < 0.0:
            self.entries.append(Entry(what, [after]))
        else:
            top.documents.append(after)
            if after == self.entries[-2].documents[-1]:
                self.entries.pop()
        self.present, before = len(self.entries) - 1, self.present
        return self.present >= before

    def decide(self, edit: Callable[[Design], Design], what: str = "") -> bool:
        """Note an edit of the design, unless the design refuses it."""
        try:
            return self.note(self.document.with_design(edit(self.document.design)), what)
        except UserError:
            self.refused += 1
            return False

    def edit(self, edit: Callable[[Design], Design]) -> None:
        self.session.edit(edit, "edit")
        self.decide(edit)

    def turn(self, name: str = "") -> bool:
        name, ratio = name or self.chance.choice((*LINES, *STRAPS)), self.ratio()
        self.clean = self.session.undo_stack.isClean()
        what = "" if self.session._preview is not None else f"length of {name}"
        if name in STRAPS and name not in {line.name for line in self.document.design.own_lines}:
            return False
        self.session.commit_line(name, name, ratio)
        return self.decide(lambda design: design.with_linked(name, None if ratio == 1.0 else ratio), what)

    def drag(self) -> None:
        for _ in range(3):
            self.session.preview_line(self.chance.choice(LINES), self.ratio())
        if self.chance.random() < 0.5 or not self.turn():
            self.session.cancel_preview()

    def note_frame(self, frame: Frame) -> None:
        """Note that the present document is solved."""
        if frame.revision == self.session._revision:
            present = self.entries[self.present]
            present.solved.add(len(present.documents) - 1)

    def refuse(self) -> None:
        """Turn a wheel and let the solver refuse where it ends: the last length that was solved stands.

        The refused length can be made again.
        """
        app.gui.session.document_editor.PAUSE, name = 1e9, self.chance.choice(LINES)
        if not [self.turn(name) for _ in range(4)][-1] or self.chance.random() < 0.25:
            return
        self.session._fail(Failure(self.session._revision, LineError(Message("It cannot be held."))))
        self.refused += 1
        entry = self.entries[self.present]
        last = max((each for each in entry.solved if each < len(entry.documents) - 1), default=None)
        if last is None:
            self.present -= 1
        else:
            self.entries.append(Entry("", [entry.documents[-1]]))
            del entry.documents[last + 1 :]

    def treat(self) -> None:
        """Lock a line or link it, or let it be free."""
        name, kind = self.chance.choice((*LINES, *STRAPS)), self.chance.choice(("locked", "linked"))
        free = self.chance.random() < 0.5
        self.edit(
            lambda design: design.with_line_settings(replace(design.line_settings(name), **{kind: free}))
        )

    def draw(self) -> None:
        """Add a pair of own lines, or remove one of them."""
        if self.chance.random() < 0.7:
            pair = ready_made_lines(read_template("168"))["straps"]
            self.session.add_own_lines(pair, "straps")
            self.decide(lambda design: reduce(Design.with_custom_line, pair, design))
        else:
            self.edit(lambda design: design.without_custom_line("strap left"))

    def dress(self) -> None:
        preset = self.chance.choice([each for each in built_in() if not each.tissue])
        self.edit(lambda design: with_preset(design, preset))

    def choose(self) -> None:
        if self.chance.random() < 0.3:
            self.session.reset_lines()
            self.decide(Design.with_lines_reset)
            return
        stiff = self.chance.choice((0.5, 1.0, 2.0))
        self.session.change({"line_stiffness": stiff}, "stiffness")
        self.decide(lambda design: replace(design, line_stiffness=stiff), "values of ['line_stiffness']")

    def undo(self) -> None:
        self.session.undo_stack.undo()
        self.present = max(self.present - 1, 0)

    def redo(self) -> None:
        self.session.undo_stack.redo()
        self.present = min(self.present + 1, len(self.entries) - 1)

    def variant(self) -> None:
        name, before = self.chance.choice("ABC"), self.document
        if self.chance.random() < 0.3:
            self.session.remove_variant(name)
            self.note(before.without(name))
        elif name != before.shown:
            self.session.show_variant(name)
            self.note(before.with_shown(name))

    def hurry(self) -> Path:
        """Save, and wait for no disk."""
        path = self.folder / f"{self.chance.randrange(3)}.busk"
        assert self.session.save(str(path), None)
        self.files[path] = self.document
        return path

    def leave(self) -> None:
        """Save, and now and then open what was saved."""
        path = self.hurry()
        assert self.session.finish_saving()
        assert self.session.path == path
        if self.chance.random() < 0.3:
            with self.qtbot.waitSignal(self.session.opened):
                self.session.open(str(path))
            self.check_files()
            self.entries, self.present = [Entry("", [self.session.document])], 0

    def check_files(self) -> None:
        """Each file holds the document that was saved in it last."""
        for path, document in self.files.items():
            assert with_scan(open_project(path), "", "") == with_scan(document, "", "")

    def ratio(self) -> float:
        return self.chance.choice((1.0, round(0.85 + 0.15 * self.chance.random(), 3)))

    def check(self) -> None:
        """The document is the model's, and so is the history."""
        stack = self.session.undo_stack
        assert self.session.document == self.document
        assert (stack.index(), stack.count()) == (self.present, len(self.entries) - 1)

    def check_result(self) -> None:
        """What is shown at rest is what the design alone leads to, whatever way led there."""

        def rests() -> bool:
            frame = self.session.frame
            return frame.stages.design is self.session.design and not frame.is_running

        self.qtbot.waitUntil(rests)
        shown = self.session.frame
        alone = converged_frame(self.session.design, shown.stages)
        assert np.allclose(astuple(shown.exact_marks), astuple(alone.exact_marks), atol=1e-3)
        assert np.abs(shown.control_points - alone.control_points).max() < 0.3


def test_a_random_walk_ends_where_its_model_does(
    qtbot: QtBot, tmp_path: Path, mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        app.gui.session.document_editor, "PAUSE", -1.0
    )  # the walk says how quick its edits are
    session = Session()
    faults: list[Exception] = []
    session.failed.connect(faults.append)
    try:
        with qtbot.waitSignal(session.opened):
            session.open(str(mannequin))
        walk = Walk(session, qtbot, tmp_path, random.Random(5))
        for step in range(1, STEPS + 1):
            walk.step()
            walk.check()
            if step % (STEPS // LOOKS) == 0:
                walk.check_result()
        session.finish_saving()
        walk.check_files()
        assert len(faults) == walk.refused > 0
    finally:
        session.close()
