"""Landmarks in the list and on their pins: the one that is shown is the one that is meant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from app.gui.features.landmarks.panel import LandmarksPanel
from app.presenters.landmarks import LandmarkView, landmark_view, spot_of
from core.landmarks.bust_point import NIPPLE
from core.landmarks.detect import find_landmarks
from core.landmarks.lower_breast import CREASE
from core.landmarks.types import CERTAIN, Landmark, Landmarks
from core.landmarks.warnings import LandmarkWarning, landmark_warnings
from core.messages import Message
from tests.core.landmarks.test_damaged_scans import body
from tests.core.landmarks.test_landmarks import found, sample, truth

LEFT = LandmarkView("fold_left", "Fold left", 0.3, "A rule.", "under", weak=True)
RIGHT = LandmarkView("fold_right", "Fold right", 0.4, "A rule.", "under", weak=True)
CALM = LandmarkView("side_left", "Side", 0.9, "A rule.", "under")


@pytest.fixture
def panel(qtbot: QtBot) -> LandmarksPanel:
    result = LandmarksPanel()
    qtbot.addWidget(result)
    result.set_landmarks([LEFT, RIGHT, CALM])
    result.resize(340, 600)
    result.show()
    result.activateWindow()
    qtbot.waitUntil(result.isActiveWindow)
    return result


def test_the_row_with_the_keyboard_is_the_one_whose_pin_enter_takes(panel: LandmarksPanel) -> None:
    chosen: list[str] = []
    panel.landmark_selected.connect(chosen.append)
    panel.keys_requested.connect(lambda: chosen.append("keys"))
    panel.select("fold_left")
    panel.rows["fold_right"].setFocus(Qt.FocusReason.TabFocusReason)
    QTest.keyClick(panel.rows["fold_right"], Qt.Key.Key_Return)
    QTest.keyClick(panel.rows["fold_right"], Qt.Key.Key_Down)
    assert panel.rows["side_left"].hasFocus()
    assert chosen == ["fold_right", "keys", "side_left"]


def test_enter_on_a_button_never_takes_a_pin(panel: LandmarksPanel, qtbot: QtBot) -> None:
    panel.select("fold_left")
    panel.right.setFocus()
    with qtbot.assertNotEmitted(panel.keys_requested):
        QTest.keyClick(panel.right, Qt.Key.Key_Return)


def test_it_is_right_goes_on_to_the_next_doubt_but_not_at_a_double_click(panel: LandmarksPanel) -> None:
    heard: list[tuple[str, ...]] = []
    panel.confirmed.connect(heard.append)
    panel.select("fold_left")
    panel.right.click()
    panel.right.click()
    assert heard == [("fold_left",)]
    assert panel.rows["fold_right"].isChecked()


def test_finding_again_has_a_place_where_nothing_else_is_ever_asked(panel: LandmarksPanel) -> None:
    panel.select("fold_left")
    right = panel.right.geometry()
    panel.set_landmarks([replace(LEFT, by_hand=True, weak=False), RIGHT, CALM])
    panel.select("fold_left")
    panel.layout().activate()
    assert panel.right.isHidden()
    assert panel.reset.isVisible()
    assert not panel.reset.geometry().intersects(right)


def test_what_the_colour_says_is_told_in_words_and_by_a_mark(panel: LandmarksPanel) -> None:
    views = [replace(CALM, confidence=share) for share in (CERTAIN, CERTAIN - 0.01)]
    views.append(replace(LEFT, confidence=CERTAIN - 0.01))
    assert [(view.tone, view.sureness) for view in views] == [
        ("ok", "certain"),
        ("control", "unneeded"),
        ("warn", "doubtful"),
    ]
    assert "50 % or more needs no review" in views[0].words()
    assert "below 50 % the landmark needs review" in views[2].words()
    row, dots = panel.rows["side_left"], []
    for sureness in ("certain", "unneeded", "doubtful"):
        view = next(view for view in views if view.sureness == sureness)
        row.show_view(view)
        shade = row.grab().toImage().copy(6, 8, 17, 18)
        body = shade.pixelColor(4, 6).rgb()
        dots.append([shade.pixelColor(x, y).rgb() == body for y in range(4, 14) for x in range(4, 13)])
    assert len({tuple(each) for each in dots}) == 3, "told apart without their colours"


def test_a_point_by_hand_far_from_a_sure_rule_says_so_and_a_near_one_does_not() -> None:
    place = found("person").position("bust_point_left")
    far = find_landmarks(body(sample("person")), {"bust_point_left": place + np.array([-15.0, 0.0, -25.0])})
    near = find_landmarks(body(sample("person")), {"bust_point_left": place + np.array([-6.0, 0.0, 0.0])})
    mark = far.points["bust_point_left"]
    assert mark.off == pytest.approx(np.linalg.norm(mark.position - place))
    assert str(mark.rule) == f"Placed manually, {mark.off:.0f} mm from the detected position."
    said = landmark_view(mark.name, mark)
    assert (said.tone, said.state, said.weak) == ("warn", f"manual, moved {mark.off:.0f} mm", True)
    again = landmark_view(mark.name, mark, {spot_of(mark)})
    assert (again.tone, again.weak) == ("accent", False), "the designer has said that it is right"
    assert near.points["bust_point_left"].off == 0.0
    smooth = found("mannequin").position("bust_point_left")
    for down, told in ((12.0, False), (28.0, True)):
        moved = find_landmarks(
            body(sample("mannequin")), {"bust_point_left": smooth - np.array([0.0, 0.0, down])}
        )
        assert (moved.points["bust_point_left"].off > 0.0) == told
    assert landmark_view(mark.name, near.points["bust_point_left"]).state == "manual"


def test_a_fold_by_hand_makes_nobody_surer_of_the_lowest_point_above_it() -> None:
    was = found("person").points["lowest_left"].confidence
    place = truth("person", "fold", "left") + np.array([0.0, 0.0, 4.0])
    now = find_landmarks(body(sample("person")), {"fold_left": place})
    assert now.points["fold_left"].by_hand
    assert now.points["lowest_left"].confidence <= was + 1e-9


def test_the_first_doubt_is_of_the_landmark_that_is_shown_and_does_not_deny_its_rule() -> None:
    points = {
        f"{kind}_{side}": Landmark(f"{kind}_{side}", np.zeros(3), sure, rule)
        for kind, rule in (("bust_point", NIPPLE), ("fold", CREASE))
        for side, sure in (("left", 0.4 if kind == "bust_point" else 0.1), ("right", 0.9))
    }
    landmarks = Landmarks(points, 1.0, 0.0)
    said = landmark_warnings(landmarks)
    nipple = "The nipple of the left breast is not clearly visible. Check its bust point."
    assert str(said[0].message) == nipple
    assert [each.landmark for each in said] == ["bust_point_left", "fold_left"]
    assert [each.prominent for each in said] == [False, True], "only the fold is more likely wrong"
    told = landmark_warnings(replace(landmarks, warnings=(Message("The scan is coarse."),)))
    assert told == [*said, LandmarkWarning("fold_left", Message("The scan is coarse."))]
