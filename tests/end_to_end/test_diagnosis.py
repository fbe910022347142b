"""The doctor in the window: what the notice says, its button as one step, and when it keeps quiet."""

from __future__ import annotations

import threading

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import PATIENCE, Script, run_bodiless, settled

import app.gui.features.garment.pressure_controller
from app.gui.features.diagnosis.controller import ABOUT
from app.gui.main_window import MainWindow
from app.gui.widgets.notification_bar import REFUSED, Notification
from app.presenters.assessment import tone
from core.garment.pressure_list import pressure_list_of

pytestmark = pytest.mark.usefixtures("empty_house")


def notice_of(window: MainWindow) -> Notification:
    notice = window.notices.notice()
    assert notice is not None
    return notice


def told(window: MainWindow) -> bool:
    """Whether the doctor has said what he found: then there are figures to unfold."""
    notice = window.notices.notice()
    return notice is not None and bool(notice.details) and window.diagnosis_controller._job is None


def words(window: MainWindow) -> list[str]:
    return [text for text, _ in notice_of(window).actions]


def test_a_vibration_is_told_at_once_and_ended_by_one_button() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.choose_control("conventional")
        window.session.change({"gain": 1.7}, "gain")
        yield settled(window)
        assert "does not converge" in str(notice_of(window).sentence)
        assert notice_of(window).tone == "bad", "as the verdict"
        assert words(window) == [], "what was not tried is not offered"
        yield lambda: told(window)
        notice = notice_of(window)
        assert notice.sentence.startswith("Mid-bust and the volume conflict: the bust point oscillates")
        assert notice.sentence.endswith("(period 2 iterations).")
        assert words(window)[0].startswith("Use adaptive"), "only the conventional control vibrates"
        assert len(words(window)) == 2
        assert "Reduce gain to " in notice.details
        assert "for this shape" in notice.details
        steps = window.session.undo_stack.count()
        window.notices.buttons[0].click()
        yield settled(window)
        frame = window.session.frame
        assert frame is not None
        assert frame.verdict.display_state == "settled"
        assert window.session.undo_stack.count() == steps + 1
        assert window.session.undo_stack.undoText() == "Use adaptive"
        assert window.notices.notice() is None
        window.actions_.undo.trigger()
        yield settled(window)
        yield lambda: told(window)
        assert words(window)[0].startswith("Use adaptive")

    run_bodiless([], script)


@pytest.mark.usefixtures("fine_samples")
def test_strain_is_told_calmly_once_and_never_again() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.preview_line("mid-bust", 0.9)
        yield lambda: window.session.frame is not None and not window.session.frame.is_running
        assert not window.diagnosis_controller._later.isActive(), "while a hand drags nothing is said"
        window.lines_controller.commit_length("mid-bust", 0.9)
        yield settled(window)
        assert window.notices.notice() is None
        assert window.diagnosis_controller._later.isActive(), "who is still at work hears nothing"
        yield lambda: told(window)
        overall = window.assessment_controller.of(window.session.frame)
        assert notice_of(window).tone == tone(overall.level), "not calm beside a red verdict"
        assert not notice_of(window).lasting
        assert words(window)[0].startswith("Lengthen Mid-bust by ")
        window.notices.close_notice()
        window.lines_controller.commit_length("mid-bust", 0.95)
        yield settled(window)
        window.actions_.undo.trigger()
        yield settled(window)
        assert not window.diagnosis_controller._later.isActive()
        window.diagnosis_controller.ask()
        yield lambda: told(window)
        window.notices.buttons[0].click()
        yield settled(window)
        frame = window.session.frame
        assert frame is not None
        assert frame.verdict.display_state == "settled"

    run_bodiless([], script)


def test_a_length_that_was_refused_gets_the_nearest_that_is_not() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.change({"line_hold": "held", "volume": "exact"}, "held")
        yield settled(window)
        window.lines_controller.commit_length("mid-bust", 0.5)
        yield lambda: told(window)
        notice = notice_of(window)
        assert (notice.tone, notice.about) == ("bad", REFUSED)
        assert notice.sentence == "Mid-bust cannot be fixed at 50.0 % of its original length."
        assert "conflict" in notice.hint
        assert all(each.startswith("Set Mid-bust to ") for each in words(window))
        window.notices.buttons[1].click()  # the nearest; the first leaves nothing to be checked
        yield settled(window)
        design = window.session.design
        assert design is not None
        assert 0.8 < design.ratio("mid-bust") < 0.95
        assert f"{100.0 * design.ratio('mid-bust'):.1f} %" in window.session.undo_stack.undoText()

    run_bodiless([], script)


def test_asked_of_a_calm_design_he_says_that_nothing_is_wrong() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        (command,) = (each for _, each in window.actions_.all() if each.text() == "Diagnose design…")
        command.trigger()
        yield lambda: told(window)
        overall = window.assessment_controller.of(window.session.frame)
        assert notice_of(window).tone == tone(overall.level)
        for message, _ in overall.reasons:
            assert message in notice_of(window).sentence, "it contradicts the verdict nowhere"
        window.lines_controller.commit_length("mid-bust", 0.97)
        yield lambda: window.notices.notice() is None
        assert not [each for each in window.notices._waiting if each.about == ABOUT]

    run_bodiless([], script)


def test_asked_before_the_verdict_is_known_he_says_what_presses(monkeypatch: pytest.MonkeyPatch) -> None:
    known, asked = threading.Event(), []

    def slow(*arguments: object) -> object:
        known.wait(PATIENCE)
        return pressure_list_of(*arguments)  # type: ignore[arg-type]

    def script(window: MainWindow) -> Script:
        yield settled(window)
        monkeypatch.setattr(app.gui.features.garment.pressure_controller, "pressure_list_of", slow)
        window.lines_controller.commit_length("mid-bust", 0.93)
        yield settled(window)
        frame = window.session.frame
        assert window.assessment_controller.of(frame).level == "pending"
        window.diagnosis_controller.ask()
        yield lambda: told(window)
        asked.append((notice_of(window).tone, notice_of(window).sentence))
        known.set()
        yield lambda: window.assessment_controller.of(frame).level == "bad"

    try:
        run_bodiless([], script)
    finally:
        known.set()
    ((seen, sentence),) = asked
    assert seen == "bad", "not calm beside a red verdict"
    assert "Mid-bust: contact pressure" in str(sentence)


def test_what_is_asked_before_the_first_frame_is_answered_with_it() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.lines_controller.commit_length("mid-bust", 0.97)
        assert not window.session.is_answered
        window.diagnosis_controller.ask()
        yield settled(window)
        yield lambda: told(window)
        assert notice_of(window).lasting
        assert window.diagnosis_controller._about is window.session.design

    run_bodiless([], script)


def test_what_was_closed_stays_away_until_something_else_is_wrong() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.lines_controller.commit_length("mid-bust", 0.7)
        yield lambda: told(window)
        state = window.session.frame.verdict.display_state  # type: ignore[union-attr]
        window.notices.close_notice()
        window.lines_controller.commit_length("mid-bust", 0.705)
        yield settled(window)
        assert window.session.frame.verdict.display_state == state  # type: ignore[union-attr]
        yield lambda: window.diagnosis_controller._job is None
        assert window.notices.notice() is None
        window.diagnosis_controller.ask()
        yield lambda: told(window)
        window.notices.close_notice()
        window.lines_controller.commit_length("mid-bust", 0.97)
        yield settled(window)
        window.lines_controller.commit_length("mid-bust", 0.7)
        yield lambda: told(window)

    run_bodiless([], script)


def test_a_run_that_comes_back_slowly_is_let_go_on() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        for name in ("mid-bust", "full-bust"):
            window.lines_controller.commit_length(name, 0.6)
        yield settled(window)
        yield lambda: told(window)
        window.notices.buttons[0].click()
        yield settled(window)
        yield lambda: window.session.frame.verdict.motion == "settled"  # type: ignore[union-attr]

    run_bodiless([], script)


def test_what_was_edited_meanwhile_is_not_told_of() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.lines_controller.commit_length("mid-bust", 0.6)
        yield lambda: window.diagnosis_controller._job is not None
        job = window.diagnosis_controller._job
        assert notice_of(window).sentence.startswith("The skin overlaps itself")
        window.lines_controller.commit_length("mid-bust", 0.96)
        yield settled(window)
        assert job is not None
        assert not job.wanted
        assert window.notices.notice() is None

    run_bodiless([], script)


@pytest.mark.usefixtures("fine_samples")
def test_the_pill_opens_what_the_button_ends_and_what_will_still_be_strained() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        chip = window.strip.chip
        window.lines_controller.commit_length("mid-bust", 0.848)
        yield lambda: told(window)
        said = words(window)[1]
        assert "with the second: contact pressure" in str(notice_of(window).hint), "it is told before"
        assert said.startswith("Lengthen Mid-bust by ")
        window.notices.buttons[1].click()
        yield settled(window)
        assert window.session.undo_stack.undoText() == said
        yield lambda: chip.state() in ("caution", "bad")
        assert window.notices.notice() is None
        assert "suggest a fix" in chip.toolTip()
        chip.setFocus()
        QTest.keyClick(chip, Qt.Key.Key_Space)
        yield lambda: told(window)
        notice = notice_of(window)
        level = window.assessment_controller.of(window.session.frame).level
        assert (notice.tone, notice.lasting) == (tone(level), True), "who asks is not hurried"
        assert "conflict: skin is compressed" in notice.sentence
        assert "forces on the skin" in notice.details.splitlines()[0]
        assert "each was verified from the original and the current shape" in notice.details.splitlines()[1]
        window.notices.unfold.click()
        yield window.notices.details.isVisible
        text = window.notices.details
        assert text.document().lineCount() > 6

    run_bodiless([], script)
