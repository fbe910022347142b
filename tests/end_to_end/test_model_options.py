"""How the model works, chosen in the real window: what each choice does, and that it can be taken back."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from window_tools import Script, points, run_bodiless, run_undrawn, settled

from app.gui.main_window import MainWindow
from app.gui.widgets.option_field import AmountField, MenuField, SegmentField
from app.presenters.model_options import consequences, defaults, groups, summary
from core.document.design import Design, ScanSource
from core.document.lines import CustomLine
from core.document.lower_trunk import LOWER_SETTINGS
from core.pipeline.live_solver import Frame
from core.pipeline.warnings import controlled_volume

pytestmark = pytest.mark.usefixtures("empty_house")


def choose(window: MainWindow, key: str, value: Any) -> None:
    """Choose a value as a hand does."""
    field = window.model.fields[key]
    if isinstance(field, SegmentField):
        name = next(name for name, each in field._values.items() if each == value)
        field.segment.button(name).click()
    elif isinstance(field, MenuField):
        field.actions_by_value[value].trigger()
    elif isinstance(field, AmountField):
        field.edit.selectAll()
        QTest.keyClicks(field.edit, str(value))
        QTest.keyClick(field.edit, Qt.Key.Key_Return)


def frame_of(window: MainWindow) -> Frame:
    frame = window.session.frame
    assert frame is not None
    return frame


def bust_points(window: MainWindow) -> float:
    """Return the mean height of the bust points over their rest [mm]."""
    now, rest = frame_of(window).marks, frame_of(window).stages.rest_marks
    return 0.5 * (
        now.bust_point_left_z + now.bust_point_right_z - rest.bust_point_left_z - rest.bust_point_right_z
    )


@pytest.mark.usefixtures("fine_samples")
def test_a_sliding_line_lifts_the_bust_points_and_undo_brings_the_old_result_back() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.actions_.model.trigger()
        assert window.inspector.panel() is window.model
        choose(window, "volume", "exact")
        yield settled(window)
        at_start, glued = points(window).copy(), bust_points(window)
        choose(window, "line_contact", "sliding")
        yield settled(window)
        assert bust_points(window) > glued + 1.0
        assert frame_of(window).verdict.state == "settled"
        assert window.session.undo_stack.undoText() == "Skin contact: Frictionless sliding"
        assert window.session.undo_stack.index() == 2
        window.actions_.undo.trigger()
        yield settled(window)
        assert np.abs(points(window) - at_start).max() < 1e-6
        assert window.model._present["line_contact"] == "glued"

    run_bodiless([], script)


def test_a_held_line_reaches_its_length() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        choose(window, "line_hold", "held")
        yield settled(window)
        assert frame_of(window).verdict.state == "settled"
        for control in ("adaptive", "exact"):
            choose(window, "volume", control)
            yield settled(window)
            line = next(line for line in frame_of(window).stages.model.lines if line.name == "mid-bust")
            assert abs(frame_of(window).lengths["mid-bust"] - 0.95 * line.rest_length) < 0.01

    run_bodiless([], script)


def test_what_cannot_be_held_is_said_and_the_last_good_state_stays() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        choose(window, "line_contact", "sliding")
        choose(window, "line_hold", "held")
        yield settled(window)
        design, at_start = window.session.design, points(window).copy()
        window.lines.length_previewed.emit("mid-bust", 0.76)
        window.lines.length_previewed.emit("mid-bust", 0.75)
        yield lambda: window.notices.notice() is not None
        window.lines.length_committed.emit("mid-bust", 0.75)
        yield lambda: window.session.design == design and window.is_settled()
        notice = window.notices.notice()
        assert notice is not None
        assert "mid-bust cannot be fixed at 7" in notice.sentence.lower()
        assert not window.notices._waiting
        assert np.abs(points(window) - at_start).max() < 0.2
        assert window.session.undo_stack.index() == 2
        assert window.lines.rows["mid-bust"].slider.ratio() == pytest.approx(0.95)
        window.lines.length_committed.emit("mid-bust", 0.92)
        yield settled(window)
        assert window.notices.notice() is None, "what is solved since is not refused"

    run_bodiless([], script)


def test_the_volume_that_is_told_is_the_one_that_is_kept() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        choose(window, "volume", "exact")
        choose(window, "dense_volume", True)
        yield settled(window)
        assert abs(frame_of(window).error_ml) > 0.1
        assert controlled_volume(frame_of(window)) == pytest.approx((0.0, 0.0), abs=1e-4)
        assert window.status._volume.text() == "Volume 0.00 % (0.0 ml)"
        choose(window, "volume", "adaptive")
        yield settled(window)
        assert controlled_volume(frame_of(window))[1] == frame_of(window).error_ml

    run_bodiless([], script)


def test_every_setting_is_one_step_and_the_reset_brings_back_all() -> None:
    wanted = {
        "line_height": ("60", 0.6),
        "line_stiffness": ("8", 8.0),
        "firm_chest": (0.1, 0.1),
        "member_law": ("prestressed", "prestressed"),
        "prestress": ("70", 0.7),
        "weights": ("paper", "paper"),
        "scaled_normals": (True, True),
        "volume_of": ("both", "both"),
        "dense_volume": (True, True),
        "gain": ("1,2", 1.2),
        "volume": ("conventional", "conventional"),
    }

    def script(window: MainWindow) -> Script:
        yield settled(window)
        steps = window.session.undo_stack
        for count, (key, (typed, value)) in enumerate(wanted.items(), start=1):
            choose(window, key, typed)
            assert steps.count() == count, key
            assert getattr(window.session.design, key) == value
        yield settled(window)
        assert frame_of(window).stages.gain == 1.2
        assert window.model.fields["gain"].edit.text() == "1.20"
        chosen = window.session.design
        window.model._reset.click()
        yield settled(window)
        steps.undo()
        assert window.session.design == chosen, "all come back"
        steps.redo()
        yield settled(window)
        assert steps.undoText() == "Model options reset to defaults"
        assert not window.model._reset.isEnabled()
        assert all(window.session.design.setting(key) == value for key, value in defaults().items())
        assert window.session.design.lower is None

    run_bodiless([], script)


def test_what_cannot_be_is_refused_and_the_field_shows_what_is() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        field = window.model.fields["line_stiffness"].edit
        told = field.accessibleDescription()
        for typed, why in (
            ("700", "Enter a value from 0.1 to 500.0 ×."),
            ("soft", "“soft” is not a number."),
        ):
            choose(window, "line_stiffness", typed)
            assert field.accessibleDescription() == why, "the card under the field says it"
            assert field.property("wrong")
            QTest.keyClick(field, Qt.Key.Key_Escape)
            assert field.text() == "16.0"
            assert field.accessibleDescription() == told
        choose(window, "line_height", "90")
        assert (
            window.model.fields["line_height"].edit.accessibleDescription()
            == "Enter a value from 25 to 75 %."
        )
        assert window.notices.notice() is None
        assert window.session.undo_stack.count() == 0
        window.session.add_own_lines((CustomLine("strap", (35, 48, 61)),), "Strap")
        window.session.choose_template("120")
        assert window.session.design.template == "168"
        assert window.actions_.templates["168"].isChecked()

    run_bodiless([], script)


def test_forces_one_turn_late_come_with_a_soft_line_and_leave_with_it() -> None:
    usual = defaults()
    late = consequences("line_force", "explicit", usual)
    assert late == {"line_force": "explicit", "line_stiffness": 0.2}
    assert consequences("line_force", "implicit", usual | late) == {
        "line_force": "implicit",
        "line_stiffness": 16.0,
    }
    softer = usual | {"line_force": "explicit", "line_stiffness": 0.1}
    assert consequences("line_force", "implicit", softer) == {"line_force": "implicit"}
    assert consequences("line_contact", "sliding", usual) == {"line_contact": "sliding"}


def test_every_choice_has_its_words_and_the_door_says_what_is_not_usual() -> None:
    settings = [setting for _, group in groups() for setting in group]
    values = vars(Design(ScanSource("a.ply")))
    elsewhere = {"scan", "lines", "own_lines", "traits", "placed", "unknown", "template"}
    # Measures and elastics have parts of their own, and are no choice of the model.
    elsewhere |= {"own_measures", "elastics", "tissue_stiffness", "customer", "worn_tight_mm", "calibration"}
    elsewhere |= {"cup", "lower", "pattern"}
    assert {setting.key for setting in settings} == (set(values) - elsewhere) | LOWER_SETTINGS.keys()
    assert all(each.tip.endswith(".") and each.words(defaults()[each.key]) for each in settings)
    assert summary(values) == "Bonded · Elastic length · Net (paper)"
    assert summary(values | {"firm_chest": 0.3}) == "Bonded · Elastic length · Net (paper) · Rib-cage support"


def test_another_body_is_opened_with_its_lines_in_sight() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        for show, page in (
            (window.model_controller.show, "lines"),
            (window.scan_comparison_controller.show_page, "result"),
        ):
            show()
            left = window.inspector.panel()
            before = window.session.frame.stages.body
            window.session.undo_stack.setClean()
            window.project_controller.open_sample("person" if page == "lines" else "mannequin")
            yield lambda before=before: window.session.frame.stages.body is not before
            yield settled(window)
            assert window.inspector.panel() is window.inspector._panels[page] is not left

    run_undrawn([], script)
