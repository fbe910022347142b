"""What a session promises while a file is opened, another is written, and edits are refused."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.gui.session.session import Session
from core.document.storage.project_file import save_project
from core.document.storage.recovery import Recovery, find_unsaved
from core.errors import LineError
from core.messages import Message
from core.pipeline.live_solver import Failure


@pytest.fixture
def session(qtbot: QtBot, mannequin: Path) -> Iterator[Session]:
    session = Session()
    with qtbot.waitSignal(session.opened):
        session.open(str(mannequin))
    yield session
    session.close()


@pytest.fixture
def other(tmp_path: Path, session: Session) -> Path:
    """Another customer's project."""
    path = tmp_path / "berta.busk"
    save_project(path, session.document, session.frame.stages.scan, None)
    return path


def test_a_file_that_is_written_while_another_opens_is_not_the_others(
    session: Session, other: Path, tmp_path: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk, sync = threading.Event(), os.fsync
    monkeypatch.setattr(os, "fsync", lambda file: (disk.wait(60), sync(file)))
    session.open(str(other))
    assert session.save(str(tmp_path / "anna.busk"), None)
    wait = session._saving.wait
    monkeypatch.setattr(session._saving, "wait", lambda: (disk.set(), wait()))
    with qtbot.waitSignal(session.opened):
        pass
    session.finish_saving()
    assert (tmp_path / "anna.busk").exists()
    assert session.path == other
    assert not session.changed_elsewhere


@pytest.mark.parametrize("way", ["edit", "undo"])
def test_who_goes_on_working_while_a_file_opens_loses_nothing(
    way: str, session: Session, other: Path, qtbot: QtBot
) -> None:
    told: list[Exception] = []
    session.failed.connect(told.append)
    session.commit_line("mid-bust", "Mid-bust line", 0.97)
    session.open(str(other))
    if way == "edit":
        session.commit_line("full-bust", "Full-bust line", 0.98)
    else:
        session.undo_stack.undo()
    kept = session.document
    qtbot.waitUntil(lambda: session.frame.stages.design is kept.design)
    assert session.document is kept
    assert session.path is None
    assert session.undo_stack.count() == (2 if way == "edit" else 1)
    assert [str(each).split(" because")[0] for each in told] == ["berta.busk was not opened"]


def test_what_a_drag_was_refused_late_is_no_news_of_the_length_it_ended_at(session: Session) -> None:
    before, told, designs = session.design, [], []
    session.failed.connect(lambda error: (told.append(str(error)), designs.append(session.design)))
    session.preview_line("mid-bust", 0.76)
    first = session._revision + 1
    session._fail(Failure(first, LineError(Message("It cannot be held at 76."))))
    session.preview_line("mid-bust", 0.75)
    session.commit_line("mid-bust", "Mid-bust line", 0.75)
    session._fail(Failure(first + 1, LineError(Message("It cannot be held at 75."))))
    session._fail(Failure(session._revision, LineError(Message("It cannot be held at 75."))))
    # One notice, told while the design was what it is again: a frame of that does not take it away.
    assert [each.split(" at ")[1] for each in told] == ["76."]
    assert designs == [before]
    assert session.design == before


def test_a_restored_document_does_not_pass_over_a_project_that_was_saved_since(
    session: Session, other: Path, qtbot: QtBot
) -> None:
    def restored(saved_since: bool) -> bool:
        with qtbot.waitSignal(session.opened):
            session.open(str(other))
        recovery = Recovery.new()
        scan = session.frame.stages.scan
        recovery.save(session.document, scan, "berta", session.path, stamp=session.stamp)
        recovery.leave()
        if saved_since:
            save_project(other, session.document, scan, b"another picture")
        (kept, found), *_ = find_unsaved()[0]
        with qtbot.waitSignal(session.opened):
            session.restore(kept)
        found.remove()
        assert session.path == other
        assert session.unsaved
        return session.changed_elsewhere

    assert not restored(saved_since=False)
    assert restored(saved_since=True)
