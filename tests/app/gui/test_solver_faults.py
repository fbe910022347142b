"""A fault of the solver changes neither document nor history; a refusal takes back one step at most."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

import app.gui.session.document_editor
from app.gui.session.jobs import Jobs
from app.gui.session.session import Session
from core.document.storage.project_file import open_project
from core.errors import LineError
from core.mechanics.solver_comparison import SolverComparison
from core.messages import Message
from core.pipeline.live_solver import Failure

LINES = ("mid-bust", "full-bust")
FAULTS = [RuntimeError("a fault"), MemoryError("no room"), SystemExit(1), KeyboardInterrupt()]


class Faults:
    """Let the solver fail at its next iterations: at so many of them, or until ``end``."""

    def __init__(self, patch: pytest.MonkeyPatch, error: BaseException, count: float = float("inf")) -> None:
        self.error, self.left, self.hits = error, count, 0
        advance = SolverComparison.advance

        def hit(comparison: SolverComparison) -> None:
            if self.left <= 0:
                return advance(comparison)
            self.left, self.hits = self.left - 1, self.hits + 1
            raise self.error

        patch.setattr(SolverComparison, "advance", hit)

    def end(self) -> None:
        """Let the solver work again."""
        self.left = 0


def edit(session: Session, count: int) -> None:
    """Set lengths of two lines in turn, each as a step of its own."""
    for step in range(count):
        name = LINES[step % 2]
        session.commit_line(name, name, 0.99 - 0.002 * step)


def is_solved(session: Session) -> bool:
    """The frame is that of the document, solved to the end."""
    frame = session.frame
    return frame is not None and frame.stages.design is session.design and not frame.is_running


def refuse(session: Session) -> None:
    """Refuse what was submitted last, as the solver does."""
    session._fail(Failure(session._revision, LineError(Message("It cannot be held."))))


@pytest.fixture
def session(qtbot: QtBot, mannequin: Path) -> Iterator[Session]:
    session = Session()
    with qtbot.waitSignal(session.opened):
        session.open(str(mannequin))
    qtbot.waitUntil(lambda: is_solved(session))
    yield session
    session.close()


@pytest.mark.parametrize("error", FAULTS, ids=lambda each: type(each).__name__)
def test_a_lasting_fault_takes_nothing_back(
    error: BaseException, session: Session, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    reported: list[Exception] = []
    edit(session, 20)
    qtbot.waitUntil(lambda: is_solved(session))
    stack, good = session.undo_stack, session.design
    session.failed.connect(reported.append)
    faults = Faults(monkeypatch, error)
    session.commit_line("mid-bust", "mid-bust", 0.9)
    document = session.document
    qtbot.waitUntil(lambda: bool(reported))
    qtbot.wait(200)
    assert session.document is document
    assert (stack.count(), stack.index(), session.unsaved) == (21, 21, True)
    assert session.frame.stages.design.lines in (good.lines, document.design.lines)
    assert session.failure is not None
    assert faults.hits == len(reported) == 1, "a fault that lasts is not run into again and again"
    for _ in range(21):
        stack.undo()
    assert session.design.lines == ()
    for _ in range(21):
        stack.redo()
    assert session.document is document
    assert session.save(str(tmp_path / "anna.busk"), None)
    assert session.finish_saving()
    assert open_project(tmp_path / "anna.busk").design.lines == document.design.lines
    faults.end()
    session.go_on()
    qtbot.waitUntil(lambda: is_solved(session))
    assert session.failure is None
    assert session.document is document


def test_a_passing_fault_takes_nothing_back_and_the_next_edit_is_solved(
    session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    faults, reported = Faults(monkeypatch, RuntimeError("a fault"), 3), []
    session.failed.connect(reported.append)
    for step in range(3):
        session.commit_line(LINES[step % 2], "a line", 0.97 - 0.01 * step)
        qtbot.waitUntil(lambda step=step: len(reported) > step)
    session.commit_line("full-bust", "a line", 0.93)
    qtbot.waitUntil(lambda: is_solved(session))
    stack, design = session.undo_stack, session.design
    assert (faults.hits, len(reported)) == (3, 3)
    assert (stack.index(), stack.count()) == (4, 4)
    assert (design.ratio("mid-bust"), design.ratio("full-bust")) == (0.95, 0.93)
    assert session.failure is None


def test_a_fault_while_another_file_opens_leaves_the_document_alone(
    session: Session, person: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    edit(session, 3)
    qtbot.waitUntil(lambda: is_solved(session))
    document, reported = session.document, []
    session.failed.connect(reported.append)
    monkeypatch.setattr(
        "core.pipeline.build.detect_landmarks", lambda *_, **__: (_ for _ in ()).throw(MemoryError())
    )
    session.open(str(person))
    qtbot.waitUntil(lambda: bool(reported))
    assert isinstance(reported[0], MemoryError)
    assert session.document is document
    assert session.undo_stack.index() == 3


def test_a_refused_step_is_taken_back_once_and_can_be_made_again(session: Session, qtbot: QtBot) -> None:
    edit(session, 2)
    qtbot.waitUntil(lambda: is_solved(session))
    before, stack = session.document, session.undo_stack
    session.commit_line("mid-bust", "mid-bust", 0.7)
    refused = session.document
    for _ in range(3):
        refuse(session)
        assert session.document is before, "nothing innocent goes with it, however often it is refused"
    assert (stack.index(), stack.count()) == (2, 3)
    stack.redo()
    assert session.document is refused


def test_an_undo_that_is_refused_takes_nothing_else_back(session: Session, qtbot: QtBot) -> None:
    edit(session, 3)
    qtbot.waitUntil(lambda: is_solved(session))
    session.undo_stack.undo()
    refuse(session)
    assert (session.undo_stack.index(), session.undo_stack.count()) == (2, 3)
    assert session.failure is not None
    session.commit_line("mid-bust", "mid-bust", 0.93)
    refuse(session)
    assert session.undo_stack.index() == 3, "it stands on what cannot be solved, and is not to blame"
    qtbot.waitUntil(lambda: is_solved(session))
    assert session.failure is None


def test_quick_steps_that_are_refused_go_back_to_the_last_that_was_solved(
    session: Session, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(app.gui.session.document_editor, "PAUSE", 600.0)
    for ratio in (0.98, 0.97):
        session.commit_line("mid-bust", "Mid-bust line", ratio)
        qtbot.waitUntil(lambda: is_solved(session))
    for ratio in (0.96, 0.95):
        session.commit_line("mid-bust", "Mid-bust line", ratio)
    assert session.save(str(tmp_path / "anna.busk"), None)
    assert session.finish_saving()
    stack = session.undo_stack
    refuse(session)
    assert session.design.ratio("mid-bust") == 0.97
    assert (stack.undoText(), stack.redoText()) == ("Mid-bust line 97.0 %", "Mid-bust line 95.0 %")
    assert session.unsaved, "the file holds the refused length"
    stack.redo()
    assert session.design.ratio("mid-bust") == 0.95
    stack.undo()
    stack.undo()
    assert not session.design.lines


def test_a_step_that_is_refused_when_made_again_leaves_the_steps_after_it(
    session: Session, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(app.gui.session.document_editor, "PAUSE", 600.0)
    session.commit_line("mid-bust", "Mid-bust line", 0.98)
    qtbot.waitUntil(lambda: is_solved(session))
    session.commit_line("mid-bust", "Mid-bust line", 0.97)
    session.commit_line("full-bust", "Full-bust line", 0.96)
    last, stack = session.document, session.undo_stack
    stack.undo()
    stack.undo()
    stack.redo()
    refuse(session)
    assert (stack.index(), stack.count()) == (0, 2)
    stack.redo()
    stack.redo()
    assert session.document is last


@pytest.mark.parametrize("error", FAULTS[2:], ids=lambda each: type(each).__name__)
def test_a_thread_that_is_ended_from_within_is_reported(
    error: BaseException, session: Session, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def end(*_: object) -> None:
        raise error

    jobs, reported = Jobs(), []
    jobs.run("Work", end, print, reported.append)
    qtbot.waitUntil(lambda: bool(reported))
    jobs.close()
    monkeypatch.setattr("app.gui.session.session.save_project", end)
    session.not_saved.connect(reported.append)
    edit(session, 1)
    assert session.save(str(tmp_path / "anna.busk"), None)
    assert not session.finish_saving()
    assert [type(error).__name__ in str(each) for each in reported] == [True, True]


def test_without_a_thread_a_file_is_written_all_the_same(
    session: Session, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where memory is short the system refuses threads."""
    edit(session, 1)
    refused = RuntimeError("can't start new thread")
    monkeypatch.setattr("threading.Thread.start", lambda _: (_ for _ in ()).throw(refused))
    assert session.save(str(tmp_path / "anna.busk"), None)
    assert session.finish_saving()
    assert open_project(tmp_path / "anna.busk").design.lines == session.design.lines
    jobs, reported = Jobs(), []
    jobs.run("Work", print, print, reported.append)
    assert reported == [refused]
    assert jobs.at_work() == []
