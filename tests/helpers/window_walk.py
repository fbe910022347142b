"""A random walk through the real window, beside a model that says what the document must be."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np
from walk_looks import differences, differences_seen
from window_tools import Script

import app.gui.features.project.controller as project_files
from app.gui.main_window import MainWindow
from core.document.design import Design
from core.document.document import Document
from core.document.storage.project_file import open_project, with_scan
from core.document.storage.recovery import load_unsaved
from core.errors import UserError
from core.pipeline.build import build
from core.pipeline.converged import converged_frame
from core.pipeline.live_solver import Failure

Edit = Callable[[Design], Design]
Step = Iterable[Callable[[], bool]] | None


class WindowWalk:
    """The window, and beside it the list of all documents and which of them is present.

    ``far`` is how far what was shown at rest was at most from what its design alone leads to: the exact
    answer's marks [mm], and the control points [mm]. ``refused`` edits were so by the design, ``sent_back``
    ones by the solver.
    """

    def __init__(self, window: MainWindow, folder: Path, chance: random.Random) -> None:
        assert window.session.document is not None
        self.window, self.session, self.chance, self.folder = window, window.session, chance, folder
        self.entries, self.present = [window.session.document], 0
        self.saved: dict[Path, Document] = {}
        self.answers = {"path": "", "changes": "discard"}
        self.refusals: list[Failure] = []
        self.faults: list[Exception] = []
        self.done: list[str] = []
        self.far, self.refused, self.sent_back = (0.0, 0.0), 0, 0
        self.session._solving.refused.connect(self.refusals.append)
        self.session.failed.connect(self.faults.append)
        module: Any = project_files
        module.ask_save = module.ask_open = lambda *_: self.answers["path"]
        module.ask_about_changes = lambda *_: self.answers["changes"]
        module.ask_overwrite = lambda *_: "overwrite"

    @property
    def document(self) -> Document:
        """The document that the window must have."""
        return self.entries[self.present]

    @property
    def design(self) -> Design:
        """The design that it must show."""
        return self.document.design

    def whims(self) -> dict[Callable[[], Step], int]:
        """Return every step that can be made with how often it is."""
        raise NotImplementedError

    def walk(self, steps: int, every: int) -> Script:
        """Make so many steps; ``every`` so many let all come to rest and look at it closely."""
        whims = self.whims()
        for step in range(1, steps + 1):
            whim = self.chance.choices(list(whims), list(whims.values()))[0]
            self.done.append(whim.__name__)
            yield from whim() or ()
            self.check()
            yield lambda: True
            self.check()
            if step % every == 0:
                yield from self.rest()
        yield from self.back_to_the_beginning()

    # -- the model

    def note(self, after: Document) -> None:
        """Take an edit into the model: what was undone is gone, and one that changes nothing is none."""
        if after != self.document:
            self.entries[self.present + 1 :] = [after]
            self.present += 1

    def decide(self, edit: Edit) -> None:
        """Note an edit of the design, unless the design refuses it."""
        try:
            self.note(self.document.with_design(edit(self.design)))
        except UserError:
            self.refused += 1
            self.say("(refused)")

    def say(self, more: str) -> None:
        """Add to what the last step is called in a report."""
        self.done[-1] += f" {more}"

    # -- what must be so

    def check(self) -> None:
        """The document is the model's, and so is the history; the solver may send back the last edits."""
        now, stack = self.session.document, self.session.undo_stack
        assert now is not None
        while self.refusals and now != self.document and self.present:
            self.sent_back += 1
            self.say("(sent back)")
            del self.entries[self.present]
            self.present -= 1
        self.refusals.clear()
        self.must(now == self.document, differences(now, self.document))
        there, wanted = (stack.index(), stack.count()), (self.present, len(self.entries) - 1)
        self.must(there == wanted, f"history {there} for {wanted}")
        self.must(("*" in self.window.windowTitle()) != stack.isClean(), "the title is not marked as it is")
        saved = self.saved.get(self.session.path) if self.session.path is not None else None
        if saved is not None and stack.isClean() and not self.session._saving.at_work:
            self.must(with_scan(saved, "", "") == with_scan(now, "", ""), "it counts as saved, and is not")
        own = [fault for fault in self.faults if not isinstance(fault, UserError)]
        self.must(not own, own)

    def must(self, so: bool, otherwise: object) -> None:
        """Fail with the last steps, unless it is so."""
        if so:
            return
        stack, said = self.session.undo_stack, [str(fault) for fault in self.faults[-2:]]
        names = [stack.text(place) for place in range(stack.count())][-5:]
        raise AssertionError(f"{' > '.join(self.done[-15:])}: {otherwise}; {names}, {said}")

    def is_at_rest(self) -> bool:
        """Tell whether all is solved and shown, and what is not saved kept aside."""
        keeping, document = self.window.autosave_controller, self.session.document
        kept = keeping._kept is document or not self.session.unsaved
        return self.window.is_settled() and not self.window.landmarks_controller.carries and kept

    def rest(self) -> Script:
        """Let all come to rest, and compare what is seen with what the design alone leads to."""
        self.window.navigation.show_step("lines")
        yield self.is_at_rest
        self.check()
        self.window.throttled.flush()
        fault = differences_seen(self.window, self.document)
        self.must(not fault, fault)
        shown = self.session.frame
        assert shown is not None
        alone = converged_frame(self.design, build(self.design))
        exact = np.subtract(astuple(shown.exact_marks), astuple(alone.exact_marks))
        settled = shown.verdict.motion == alone.verdict.motion == "settled"  # others end at a chance place
        run = (shown.control_points - alone.control_points) * settled
        self.far = max(self.far[0], float(np.abs(exact).max())), max(self.far[1], float(np.abs(run).max()))
        recovery = self.window.autosave_controller._recovery
        if self.session.unsaved and recovery is not None:
            kept = load_unsaved(recovery.folder).document
            self.must(with_scan(kept, "", "") == with_scan(self.document, "", ""), "another one is kept")

    def back_to_the_beginning(self) -> Script:
        """Undo all and redo all: each document comes back to the last bit."""
        self.done.append("back to the beginning")
        stack = self.session.undo_stack
        for place in [*range(self.present, -1, -1), *range(len(self.entries))]:
            stack.setIndex(place)
            self.present = place
            self.check()
        yield from self.rest()
        self.check_files()

    def check_files(self) -> None:
        """Each file holds what was saved in it last."""
        self.session.finish_saving()
        for path, document in self.saved.items():
            self.must(with_scan(open_project(path), "", "") == with_scan(document, "", ""), path.name)
