"""Measures of one's own in the real window: made in the view or from lists, changed, removed, undone."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, QSettings, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget
from window_tools import Script, run_bodiless, run_main, settled

from app.gui import file_export as tables
from app.gui.features.measurements.table import MeasurementsTable
from app.gui.main_window import MainWindow
from app.gui.widgets.option_field import LandmarkCombo
from core.document.custom_measures import CustomMeasurement
from core.measurements.table import before_after
from tests.end_to_end.test_accessibility import shortcomings

pytestmark = pytest.mark.usefixtures("empty_house")

GORE = CustomMeasurement("Gore", "straight", ("bust_point_left", "front_centre"))
KEY = Qt.Key


def begun(window: MainWindow) -> Script:
    """Open the window on the sample, and its form for a measure."""
    yield settled(window)
    window.custom_measures_controller.action.trigger()
    assert window.result.editing


def canvas(window: MainWindow) -> QWidget:
    parent = window.view.viewport.overlay.parentWidget()
    assert parent is not None
    return parent


def click_pin(window: MainWindow, name: str) -> None:
    """Click a landmark where it is seen."""
    overlay = window.view.viewport.overlay
    (pin,) = (pin for pin in overlay.pins if pin.name == name)
    x, y, _ = window.view.viewport.scene.view.to_picture(
        pin.position[None], overlay.width(), overlay.height()
    )[0]
    assert overlay.chosen_at(QPointF(x, y)) == name
    QTest.mouseClick(canvas(window), Qt.MouseButton.LeftButton, pos=QPoint(round(x), round(y)))


def own(window: MainWindow) -> tuple[CustomMeasurement, ...]:
    assert window.session.design is not None
    return window.session.design.own_measures


def listed(window: MainWindow, name: str) -> bool:
    """The table has a measure of one's own, measured on the body as it is."""
    there = any(view.key == f"own:{name}" for view in window.result.measured)
    return window.is_settled() and there and not window.result.stale


def test_two_clicks_on_landmarks_measure_at_once_and_add_is_one_step() -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        form, frame = window.result.editor, window.session.frame
        assert frame is not None
        turns = {control: len(records) for control, records in frame.tracks.items()}
        window.view.viewport.set_view("front")
        click_pin(window, "bust_point_left")
        assert not form.keep.isEnabled(), "an end is missing"
        click_pin(window, "front_centre")
        assert form.draft.ends == GORE.marks
        yield form.keep.isEnabled
        assert window.view.viewport.scene.measure.shown, "it is seen before it is added"
        assert form.name.placeholderText() == "Bust point left → Centre front, bust"
        assert own(window) == ()
        QTest.keyClicks(form.name, "Gore")
        yield form.keep.isEnabled
        QTest.keyClick(form.name, KEY.Key_Return)
        assert (own(window), window.result.editing) == ((GORE,), False)
        yield lambda: listed(window, "Gore")
        as_the_core_measures(window)
        frame = window.session.frame
        assert frame is not None
        after = {control: len(records) for control, records in frame.tracks.items()}
        assert after == turns, "nothing is solved again"
        assert window.result.mark == "own:Gore"
        window.actions_.undo.trigger()
        assert own(window) == ()

    run_main([], script)


def as_the_core_measures(window: MainWindow) -> None:
    frame = window.session.frame
    assert frame is not None
    before, after = before_after(frame.stages, frame.control_points)
    view = next(view for view in window.result.measured if view.own)
    assert (view.before, view.after) == (before[view.key].value, after[view.key].value)
    assert view.group == "Custom"
    assert "straight distance from bust point left" in view.tip


def test_a_landmark_that_is_chosen_is_not_moved_and_a_second_click_gives_it_up() -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        form = window.result.editor
        window.view.viewport.set_view("front")
        for name in ("bust_point_left", "bust_point_right", "bust_point_left"):
            click_pin(window, name)
        assert form.draft.ends == ("", "bust_point_right")
        assert window.session.design is not None
        assert window.session.design.placed == ()
        QTest.keyClick(window.view.viewport, KEY.Key_Backspace)
        assert form.draft.ends == ("", "")
        QTest.keyClick(window.view.viewport, KEY.Key_Escape)
        assert not window.result.editing
        assert not window.view.viewport.overlay.pins, "the pins went with the form"
        window.custom_measures_controller.begin()
        window.rail.setFocus()
        yield lambda: not window.jobs.at_work()  # which Esc would end first
        for _ in range(2):  # the tour of the first start lies over it
            QTest.keyClick(window, KEY.Key_Escape)
        assert not window.result.editing, "wherever the keyboard is"
        assert window.view.viewport.scene.is_visible("bands")

    run_main([], script)


def test_a_girth_lies_where_the_skin_is_clicked_or_off_a_landmark() -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        form, viewport = window.result.editor, window.view.viewport
        form.kind.button("girth").click()
        viewport.set_view("front")
        middle = canvas(window).rect().center() + QPoint(20, 45)  # away from the pins of the back
        skin = viewport.skin_at(QPointF(middle))
        assert skin is not None
        QTest.mouseClick(canvas(window), Qt.MouseButton.LeftButton, pos=middle)
        yield form.keep.isEnabled
        form.accepted.emit()
        (level,) = own(window)
        assert (level.kind, level.marks) == ("girth", ())
        assert window.session.frame is not None
        low = window.session.frame.stages.body.mesh.vertices[:, 2].min()
        assert level.level == pytest.approx(skin[2] - low, abs=0.5), "whole mm from the lowest point"
        yield lambda: listed(window, level.name)
        (view,) = (each for each in window.result.measured if each.own)
        height = f"{level.level:.0f} mm above the lowest point of the scan"
        assert height in view.tip
        assert height in str(level.text), "the command line says the same"
        window.custom_measures_controller.begin()
        form.kind.button("girth").click()
        form.at.chosen.emit("fold_left")
        typed(form.level, "-30")
        yield form.keep.isEnabled
        form.accepted.emit()
        assert own(window)[1] == CustomMeasurement(
            "Girth, Inframammary fold left −30 mm", "girth", ("fold_left",), -30.0
        )

    run_main([], script)


def typed(field: QWidget, text: str) -> None:
    field.setFocus()
    field.selectAll()  # type: ignore[attr-defined]
    QTest.keyClicks(field, text)
    QTest.keyClick(field, KEY.Key_Return)


def test_one_is_changed_renamed_and_deleted_by_keys_each_one_step() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.edit(lambda design: design.with_custom_measurement(GORE), "Gore")
        window.navigation.show_step("result")
        yield lambda: listed(window, "Gore")
        table, form = window.result.findChild(MeasurementsTable), window.result.editor
        window.result.select("own:Gore")
        assert table.tools.isVisible()
        window.activateWindow()  # else the keys of the menus are asleep
        yield window.isActiveWindow
        QTest.keyClick(table, KEY.Key_F2)
        assert (window.result.editing, form.draft.ends) == (True, GORE.marks)
        yield form.keep.isEnabled
        form.kind.button("skin").click()
        assert not form.keep.isEnabled(), "not before it is known what it measures"
        form.name.setFocus()
        form.name.selectAll()
        QTest.keyClicks(form.name, "Arc")
        yield form.keep.isEnabled
        form.keep.click()
        assert own(window) == (CustomMeasurement("Arc", "skin", GORE.marks),)
        assert window.session.undo_stack.undoText() == "Measurement changed: Arc"
        yield lambda: listed(window, "Arc")
        QTest.keyClick(table, KEY.Key_Delete)
        assert own(window) == ()
        assert window.session.undo_stack.undoText() == "Measurement deleted: Arc"
        window.actions_.undo.trigger()
        window.actions_.undo.trigger()
        assert own(window) == (GORE,)

    run_bodiless([], script)


def test_a_name_that_is_taken_is_refused_and_another_body_ends_it() -> None:
    def script(window: MainWindow) -> Script:
        yield from begun(window)
        window.session.edit(lambda design: design.with_custom_measurement(GORE), "Gore")
        form = window.result.editor
        for name in GORE.marks:
            form.show_draft(form.draft.picked(name))
        typed(form.name, "Gore")
        assert "Gore already" in form.doubt.text()
        assert not form.keep.isEnabled()
        QTest.keyClick(form.name, KEY.Key_Return)
        assert window.result.editing
        window.navigation.show_step("lines")
        assert not window.result.editing
        assert own(window) == (GORE,)

    run_bodiless([], script)


@pytest.mark.parametrize("language", ["en", "ja"])
def test_one_is_made_by_keys_alone_and_all_of_the_form_has_a_name_and_room(language: str) -> None:
    QSettings().setValue("language", language)

    def script(window: MainWindow) -> Script:
        yield from begun(window)
        form = window.result.editor
        assert window.focusWidget() is form.name
        choose(form.start, 1)
        choose(form.end, 2)
        yield form.keep.isEnabled
        suggested = form.name.placeholderText()
        assert suggested == {"en": "Bust point left → Bust point right", "ja": "左BP → 右BP"}[language]
        yield from all_have_a_name_and_room(window)
        form.name.setFocus()
        QTest.keyClick(form.name, KEY.Key_Return)
        assert own(window) == (
            CustomMeasurement(suggested, "straight", ("bust_point_left", "bust_point_right")),
        )
        yield lambda: listed(window, suggested)
        assert window.focusWidget() is window.result.findChild(MeasurementsTable)
        yield from all_have_a_name_and_room(window)

    run_bodiless([], script)


def all_have_a_name_and_room(window: MainWindow) -> Script:
    yield lambda: not window.jobs.at_work()
    for _ in range(12):  # what has got other words takes its room a moment later
        yield lambda: True
    assert not set(shortcomings(window))


def choose(field: LandmarkCombo, turn: int) -> None:
    """Open the menu of a field by the keyboard, and go down so far."""
    field.setFocus()
    QTest.keyClick(field, KEY.Key_Space)
    menu = QApplication.activePopupWidget()
    assert menu is not None
    for _ in range(turn):
        QTest.keyClick(menu, KEY.Key_Down)
    QTest.keyClick(menu, KEY.Key_Return)


def test_own_measures_are_copied_and_written_with_all_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "measures.csv"
    monkeypatch.setattr(tables, "ask_save", lambda *_: str(path))

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.session.edit(lambda design: design.with_custom_measurement(GORE), "Gore")
        window.navigation.show_step("result")
        yield lambda: listed(window, "Gore")
        window.result.table_requested.emit()
        yield path.exists
        rows = csv.reader(path.read_text(encoding="utf-8-sig").splitlines())
        (row,) = (row for row in rows if row[:1] == ["Gore"])
        view = next(view for view in window.result.measured if view.own)
        assert np.allclose([float(row[3]), float(row[4])], [view.before or 0, view.after or 0], atol=0.06)
        window.result.copy_requested.emit()
        assert "Gore\t" in QApplication.clipboard().text()

    run_bodiless([], script)
