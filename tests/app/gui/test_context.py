"""Controllers work on a context alone, without a main window; values of frames are computed once."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtGui import QUndoGroup
from PySide6.QtWidgets import QVBoxLayout, QWidget
from pytestqt.qtbot import QtBot

from app.gui.actions import Actions
from app.gui.context import AppContext, Navigation, Selection
from app.gui.features.uncertainty import controller as uncertainty
from app.gui.features.uncertainty.controller import UncertaintyController
from app.gui.session.frame_cache import FrameCache
from app.gui.session.jobs import Jobs
from app.gui.session.notifications import Notifications
from app.gui.session.session import Session
from app.gui.viewport.view_area import ViewArea
from app.gui.widgets.notification_bar import NotificationBar
from core.errors import UserError
from core.pipeline.live_solver import Frame
from core.progress import Progress

pytestmark = pytest.mark.usefixtures("landmarks_known", "light_theme")


@pytest.fixture
def host(qtbot: QtBot) -> QWidget:
    """What holds the widgets of the context, and shows the card of a controller."""
    host = QWidget()
    qtbot.addWidget(host)
    host.setLayout(QVBoxLayout())
    return host


@pytest.fixture
def context(qtbot: QtBot, host: QWidget, mannequin: Path) -> Iterator[AppContext]:
    """A context with a document that has converged."""
    session, jobs = Session(host), Jobs(host)
    view, bar = ViewArea(jobs), NotificationBar()
    for widget in (view, bar):
        widget.setParent(host)
        widget.hide()
    group = QUndoGroup(host)
    group.addStack(session.undo_stack)
    yield AppContext(
        session,
        jobs,
        Actions(host, group, view.tool_actions),
        Notifications(session, bar),
        Navigation(host),
        Selection("mid-bust", host),
        view,
    )
    jobs.close()
    session.close()
    view.close_view()


def open_body(context: AppContext, path: Path, qtbot: QtBot) -> Frame:
    session = context.session
    session.open(str(path))
    qtbot.waitUntil(lambda: session.is_converged)
    assert session.frame is not None
    return session.frame


def test_uncertainties_are_computed_and_explained_without_a_window(
    context: AppContext, host: QWidget, mannequin: Path, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(uncertainty, "PAUSE", 0)
    controller = UncertaintyController(context, host, lambda: False)
    host.layout().addWidget(controller.card)
    context.session.frame_ready.connect(lambda _: controller.follow())
    frame = open_body(context, mannequin, qtbot)
    assert not controller.is_computing, "nobody looks at it"
    lines: list[str] = []
    controller.summarized.connect(lines.append)
    host.show()
    controller.follow()
    qtbot.waitUntil(lambda: controller.of(frame) is not None)
    assert controller.shown == (controller.of(frame), False)
    assert lines[-1]
    assert controller.card.meaning.text()


def cache_of(
    context: AppContext, work: object, *, by_design: bool = False
) -> tuple[FrameCache[object], list[Exception]]:
    failed: list[Exception] = []

    def compute(frame: Frame, progress: Progress) -> object:
        return work(progress)  # type: ignore[operator]

    cache = FrameCache(
        context.session, context.jobs, "work", compute, failed=failed.append, by_design=by_design
    )
    return cache, failed


def test_a_value_is_computed_once_and_an_edit_cancels_that_of_the_former_design(
    context: AppContext, mannequin: Path, qtbot: QtBot
) -> None:
    gate, begun = threading.Event(), []

    def work(progress: Progress) -> int:
        begun.append(1)
        while not gate.wait(0.01):
            progress("", 0.0)
        return len(begun)

    cache, _ = cache_of(context, work, by_design=True)
    first = open_body(context, mannequin, qtbot)
    assert cache.request(first) is None
    assert cache.request(first) is None
    context.session.commit_line("mid-bust", "Mid-bust line", 0.97)
    qtbot.waitUntil(lambda: context.session.is_converged)
    assert not cache.is_running(first)
    frame = context.session.frame
    assert frame is not None
    cache.request(frame)
    gate.set()
    qtbot.waitUntil(lambda: cache.get(frame) is not None)
    assert begun == [1, 1]
    assert cache.get(first) is None
    assert cache.request(frame) == 2


def test_what_has_failed_is_not_computed_again_and_what_was_stopped_is_after_retry(
    context: AppContext, mannequin: Path, qtbot: QtBot
) -> None:
    frame = open_body(context, mannequin, qtbot)

    def refuse(progress: Progress) -> object:
        raise UserError("No.")

    cache, failed = cache_of(context, refuse)
    cache.request(frame)
    qtbot.waitUntil(lambda: cache.is_given_up(frame))
    assert cache.failure(frame) is failed[0]
    cache.retry()
    cache.request(frame)
    assert not cache.is_running(frame)
    gate = threading.Event()
    stopped, _ = cache_of(context, lambda progress: gate.wait(60) and 3)
    stopped.request(frame)
    context.jobs.leave(context.jobs.at_work()[0])
    assert stopped.is_given_up(frame)
    assert stopped.failure(frame) is None
    gate.set()
    stopped.retry()
    stopped.request(frame)
    qtbot.waitUntil(lambda: stopped.get(frame) == 3)


def test_navigation_and_selection_announce_what_is_shown(qtbot: QtBot) -> None:
    navigation, shown = Navigation(), []
    for signal in (navigation.step_shown, navigation.panel_shown, navigation.page_shown):
        signal.connect(shown.append)
    page = QWidget()
    qtbot.addWidget(page)
    navigation.show_page(page)
    navigation.show_step("lines")
    navigation.close_page(page)
    assert shown == [page, None, "lines", "lines"]
    assert (navigation.step, navigation.panel, navigation.page) == ("lines", "lines", None)
    selection, names = Selection("a"), []
    selection.line_selected.connect(names.append)
    selection.select_line("a")
    assert names == ["a"], "a list that was filled anew selects it again"
