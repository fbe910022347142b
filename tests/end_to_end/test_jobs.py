"""What the window promises about work that takes its time: it is named, can be left, and what stood stays."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import Script, drag, run_main, settled

import app.gui.features.export.controller
import app.gui.features.lines.limits_controller
import app.gui.features.scan.controller
import app.gui.viewport.view_area
import app.presenters.export_preview
import core.scan.body
from app.gui.main_window import MainWindow
from app.gui.session.jobs import Jobs
from core.analysis.length_limits.zones import length_limits_of
from core.progress import Pieces, Progress
from tests.end_to_end.test_scan import doubtful

pytestmark = pytest.mark.usefixtures("empty_house")


def endless(reached: list[str]) -> Callable[..., Any]:
    """Return work that goes on until it is left, and then notes that it was."""

    def work(*args: Any, progress: Progress | None = None, **_: Any) -> Any:
        hear = progress or args[-1]
        try:
            for step in range(10_000):
                hear("endless", step / 10_000)
                time.sleep(0.005)
        finally:
            reached.append("left")

    return work


def jobs_end() -> bool:
    """Tell whether no thread of a job is left."""
    return not any(thread.name == "busk-job" for thread in threading.enumerate())


def test_an_export_is_named_and_can_be_left_by_card_key_and_status_bar(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    body, left = tmp_path / "body.ply", []
    body.write_text("what stood there")
    monkeypatch.setattr(app.gui.features.export.controller, "ask_save", lambda *_: str(body))
    write, begun = app.presenters.export_preview.write_mesh, []

    def never_written(path: Path, mesh: Any, hear: Progress, space: Any) -> None:
        begun.append(path)
        endless(left)(hear)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.activateWindow()
        yield window.isActiveWindow
        busy, status = window.view.busy, window.status
        busy._wait.setInterval(0)
        monkeypatch.setattr(app.presenters.export_preview, "write_mesh", never_written)
        for count, way in enumerate(("card", "key", "status bar"), start=1):
            window.actions_.export.trigger()
            yield lambda n=count: busy.isVisible() and status.stop.isVisible() and len(begun) == n
            assert status._job_name.text() == "Saving body.ply…"
            if way == "card":
                QTest.mouseClick(busy.stop, Qt.MouseButton.LeftButton)
            elif way == "key":
                QTest.keyClick(window, Qt.Key.Key_Escape)
            else:
                QTest.mouseClick(status.stop, Qt.MouseButton.LeftButton)
            assert not busy.isVisible(), "the window is free at once"
            assert status._job_name.text() != "Saving body.ply…", "limits may be at work beside it"
            assert not window.actions_.cancel.isEnabled()
            yield jobs_end
            assert len(left) == count
            assert body.read_text() == "what stood there"
            assert window.notices.notice().tone == "warn", "the verdict alone, no file is reported"
        monkeypatch.setattr(app.presenters.export_preview, "write_mesh", write)
        window.actions_.export.trigger()
        yield lambda: window.notices.notice().tone == "ok"
        assert body.read_bytes().startswith(b"ply")

    run_main([], script)


@pytest.mark.usefixtures("limits_sought")
def test_limits_come_beside_the_window_and_are_those_of_the_core(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    work_out = app.gui.features.lines.limits_controller.length_limits_of

    def counted(stages: Any, name: str, progress: Progress, **told: Any) -> Any:
        asked.append(name)
        return work_out(stages, name, progress, **told)

    def shown(window: MainWindow) -> dict[str, Any]:
        rows = window.lines.rows.values()
        return {row.view.name: (row.view.leeway, row.view.stale) for row in rows if row.view.constrained}

    def known(window: MainWindow) -> Callable[[], bool]:
        return lambda: settled(window)() and all(each and not stale for each, stale in shown(window).values())

    monkeypatch.setattr(app.gui.features.lines.limits_controller, "length_limits_of", counted)

    def script(window: MainWindow) -> Script:
        yield known(window)
        frame, before = window.session.frame, shown(window)
        assert frame is not None
        assert asked[0] == window.view.selected_line
        for name, (leeway, _) in before.items():
            assert leeway == length_limits_of(frame.stages, name)
        drag(window, "mid-bust", -10)
        assert not shown(window)["mid-bust"][1], "its limits hang on the other lines alone"
        yield settled(window)
        asked.clear()
        yield known(window)
        assert shown(window)["mid-bust"] == before["mid-bust"]
        assert shown(window)["full-bust"] != before["full-bust"]
        window.actions_.undo.trigger()
        yield settled(window)
        assert shown(window) == before, "what was known is shown at once"
        assert asked in ([], ["full-bust"])
        assert not window.view.busy.isVisible()

    run_main([], script)


@pytest.mark.usefixtures("limits_sought")
def test_an_edit_ends_what_was_worked_out_for_the_design_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    left: list[str] = []
    monkeypatch.setattr(app.gui.features.lines.limits_controller, "length_limits_of", endless(left))
    monkeypatch.setattr(app.gui.viewport.view_area, "bake_occlusion", endless(left))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield lambda: len(window.jobs.at_work()) == 2
        assert not window.actions_.cancel.isEnabled(), "nobody waits for these"
        drag(window, "mid-bust", -10)
        yield lambda: left == ["left"]
        yield settled(window)
        window.session.undo_stack.setClean()
        window.project_controller.open_sample("person")
        yield lambda: window.session.name == "person" and settled(window)()

    run_main([], script)
    assert jobs_end(), "a window that is closed leaves no work behind"
    assert len(left) >= 3


def test_a_job_that_fails_tells_who_asked_and_one_that_is_left_nobody(qtbot: Any) -> None:
    jobs, told = Jobs(), []

    def fail(progress: Progress) -> None:
        raise ValueError("no")

    jobs.run("failing", fail, told.append, told.append)
    qtbot.waitUntil(lambda: bool(told))
    assert isinstance(told[0], ValueError)
    jobs.cancel(jobs.run("left", fail, told.append, told.append))
    assert jobs.at_work() == []
    qtbot.waitUntil(jobs_end)
    qtbot.wait(1)
    assert len(told) == 1
    seen: list[int] = []
    jobs.changed.connect(lambda: seen.append(len(jobs.at_work())))
    with qtbot.captureExceptions() as faults:
        jobs.run("done badly", lambda _: 1, [].remove)
        qtbot.waitUntil(lambda: bool(faults))
    assert seen[-1] == 0, "whoever shows the jobs hears that this one has gone"
    jobs.close()


def test_pieces_of_work_are_done_between_events_and_jobs_take_turns(qtbot: Any) -> None:
    jobs, order, told = Jobs(), [], []

    def pieces(name: str, fault: bool = False, count: int = 3) -> Pieces[str]:
        try:
            for step in range(count):
                order.append(name)
                yield (step + 1) / count
            if fault:
                raise ValueError(name)
            return name
        finally:
            order.append(f"{name} put away")

    first = jobs.run_pieces("first", pieces("a"), told.append, told.append)
    jobs.run_pieces("second", pieces("b", fault=True), told.append, told.append)
    assert (order, jobs.at_work()[0]) == ([], first), "who asks does not wait"
    qtbot.waitUntil(lambda: len(told) == 2)
    assert first.share == 1.0
    assert order == [*"ababab", "a put away", "b put away"], "a short job does not wait for a long one"
    assert told[0] == "a"
    assert isinstance(told[1], ValueError)
    assert jobs.at_work() == []
    third = jobs.run_pieces("third", pieces("c", count=10**9), told.append, told.append)
    qtbot.waitUntil(lambda: third.share is not None)
    jobs.leave(third)
    assert order[-1] == "c put away", "at once"
    jobs.run_pieces("fourth", pieces("d"), told.append, told.append)
    jobs.close()
    qtbot.wait(5)
    assert len(told) == 2
    assert "d" not in order, "what was never begun holds nothing"


def test_pictures_that_cannot_be_painted_leave_no_question(
    mannequin: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: Any) -> None:
        raise RuntimeError("no paint")

    monkeypatch.setattr(core.scan.body, "estimate_pose", doubtful(0.0))
    monkeypatch.setattr(app.gui.features.scan.controller, "option_thumbnails", fail)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        yield lambda: "Scan step" in getattr(window.notices.notice(), "hint", "")
        assert not window.view.question.isVisible()
        monkeypatch.setattr(app.gui.features.scan.controller, "option_thumbnails", endless([]))
        window.scan_controller.ask()
        assert "image below" in window.notices.notice().hint
        yield lambda: window.progress_controller._shown_job() is window.scan_controller._painting
        window.progress_controller.cancel()
        assert "Scan step" in window.notices.notice().hint, "there is no picture to choose below"
        assert not window.scan_controller.painting

    run_main([str(mannequin)], script)
