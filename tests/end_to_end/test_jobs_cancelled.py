"""Work that the user stops, or that fails: it says so where its figures were awaited, and comes again."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import pytest
from PySide6.QtWidgets import QLabel
from window_tools import PATIENCE, Script, run_main, settled, undrawn

from app.gui.features.diagnosis import assessment as verdict_desk
from app.gui.features.garment import pressure_controller as pressure_desk
from app.gui.features.measurements import controller as measures_desk
from app.gui.features.measurements import custom_measures as own_measures_desk
from app.gui.features.report import controller as report_desk
from app.gui.main_window import MainWindow
from app.gui.session.jobs import Job

pytestmark = pytest.mark.usefixtures("empty_house")


@pytest.fixture
def gate(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Nothing is measured, pressed or put on a sheet until it is open."""
    opened = threading.Event()

    def behind(work: Callable[..., Any]) -> Callable[..., Any]:
        def waits(*asked: Any) -> Any:
            opened.wait(PATIENCE)
            return work(*asked)

        return waits

    for module, name in (
        (measures_desk, "before_after"),
        (own_measures_desk, "custom_before_after"),
        (pressure_desk, "pressure_list_of"),
        (report_desk, "make_report"),
    ):
        monkeypatch.setattr(module, name, behind(getattr(module, name)))
    return opened


def stop(window: MainWindow, words: str) -> None:
    """Leave a job as the status bar does; it is the only one with these words."""
    job: Job
    (job,) = [each for each in window.jobs.at_work() if each.words == words]
    window.jobs.leave(job)


def run_gated(gate: threading.Event, script: Callable[[MainWindow], Script]) -> None:
    """Play a script and open the gate at its end, whatever fails: the window's end waits for all jobs."""

    def gated(window: MainWindow) -> Script:
        try:
            yield from script(window)
        finally:
            gate.set()

    run_main([], gated)


def test_what_is_stopped_says_so_and_is_worked_out_when_it_is_looked_at_again(gate: threading.Event) -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        window.report_controller.open()
        stop(window, "Creating report…")
        state = window.report_controller.page.state
        assert state.text() == "Report stopped. Return to the report page to create it."
        window.report_controller.leave()
        window.navigation.show_panel("garment")
        stop(window, "Computing contact pressure…")
        assert window.notices.notice().sentence == "Stopped: Computing contact pressure…"
        yield lambda: window.strip.chip.state() != "pending"  # nothing is computed any more
        assert "pressure was not computed" in window.strip.hint.text()
        assert "was not computed" in window.pressure_controller.card.says.text()
        window.navigation.show_step("result")
        stop(window, "Measuring body…")
        assert window.result._waiting.text().startswith("Measuring stopped")
        gate.set()
        window.navigation.show_step("lines")
        window.navigation.show_panel("garment")
        yield lambda: window.pressure_controller.shown is not None
        window.navigation.show_step("result")
        yield lambda: bool(window.result.measured) and not window.result.stale
        window.report_controller.open()
        yield window.report_controller.page.does["pdf"].isEnabled

    run_gated(gate, script)


def test_a_measure_of_ones_own_that_is_stopped_is_measured_at_the_next_change(gate: threading.Event) -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        window.custom_measures_controller.action.trigger()
        stop(window, "Measuring body…")
        form = window.result.editor
        for name in ("bust_point_left", "front_centre"):
            form.show_draft(form.draft.picked(name))
        stop(window, "Measuring body…")
        assert form.doubt.text().startswith("Computation stopped")
        gate.set()
        form.show_draft(form.draft)
        window.custom_measures_controller._follow()
        yield lambda: bool(form.value.text())

    run_gated(gate, script)


def test_what_fails_is_told_and_waits_no_longer(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: Any) -> None:
        raise ValueError("no")

    monkeypatch.setattr(measures_desk, "before_after", fail)
    monkeypatch.setattr(pressure_desk, "pressure_list_of", fail)
    monkeypatch.setattr(report_desk, "make_report", fail)

    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        window.navigation.show_step("result")
        yield lambda: window.result._waiting.text() == "The body could not be measured."
        assert "internal error" in window.notices.notice().sentence
        yield lambda: "pressure was not computed" in window.strip.hint.text()
        window.report_controller.open()
        yield lambda: window.report_controller.page.state.text() == "The report could not be created."

    run_main([], script)


def test_the_bust_girth_of_the_strip_is_measured_beside_the_window(monkeypatch: pytest.MonkeyPatch) -> None:
    threads = []

    def measured(*_: object) -> dict[str, tuple[float, float]]:
        threads.append(threading.current_thread())
        return {"bust": (900.0, 880.0)}

    monkeypatch.setattr(verdict_desk, "figure_girths", measured)

    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        yield lambda: any("900" in value.text() for value in window.strip.findChildren(QLabel))

    run_main([], script)
    assert threads
    assert threading.main_thread() not in threads
