"""Notices in the window: they float on the view, and go with their cause."""

from __future__ import annotations

import pytest
from window_tools import Script, drag, run_bodiless, settled

from app.gui.main_window import MainWindow
from app.gui.widgets.notification_bar import SCAN
from core.errors import UserError
from core.messages import Message

pytestmark = pytest.mark.usefixtures("empty_house")


def test_notices_leave_the_view_its_size_and_go_with_their_cause() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield from they_float(window)
        yield from they_go_with_their_cause(window)

    assert run_bodiless([], script) == 0


def they_float(window: MainWindow) -> Script:
    notices, view = window.notices, window.view
    notices.clear()
    before = view.geometry()
    notices.show_notice("bad", "Nothing is wrong.", "Go on.", lasting=True, details="at all\n" * 60)
    notices.unfold.click()
    yield notices.details.isVisible
    yield lambda: view.floating.clashes(notices) == 0
    assert view.geometry() == before
    assert view.rect().contains(notices.geometry()), "what is long is scrolled"
    drag(window, "mid-bust", -10, release=False)
    assert notices.isVisible(), "a slider lies beside the view"
    drag(window, "mid-bust", 0)
    window.start_controller.show_page()
    yield window.start_controller.page.isVisible
    assert notices.isVisible(), "a page that takes the place of the work shows them too"
    window.start_controller.leave_page()
    yield view.isVisible
    assert view.isAncestorOf(notices)
    assert view.geometry() == before
    notices.clear()


def they_go_with_their_cause(window: MainWindow) -> Script:
    notices, session = window.notices, window.session
    for error in (UserError(Message("Refused.")), RuntimeError("a fault")):
        drag(window, "mid-bust", -10)
        yield settled(window)
        window.notifications.error(error)
        assert notices.notice() is not None
        session.undo_stack.undo()
        assert notices.notice() is None, "what was decided since is another design"
        yield settled(window)
    notices.show_notice("warn", "The scan is poor.", lasting=True, about=SCAN)
    notices.keep_only(SCAN, ["The scan is poor."])
    assert notices.notice() is not None
    notices.keep_only(SCAN, [])
    assert notices.notice() is None
    notices.show_notice("info", "Under the hand.")
    notices.set_aside(True)
    assert notices.isHidden()
    notices.set_aside(False)
    assert notices.isVisible()
