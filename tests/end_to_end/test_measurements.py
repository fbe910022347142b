"""The tab of measures in the real window: the body measured once the run rests, beside the window."""

from __future__ import annotations

from itertools import groupby

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit
from window_tools import Script, run_bodiless, run_undrawn, settled

from app.gui.features.measurements.table import MeasurementsTable
from app.gui.main_window import MainWindow
from app.gui.session.settings import get_setting
from app.presenters.measurements import as_table
from core.measurements.sizes import letter_sizes, sizes
from core.measurements.table import before_after

TOPS = letter_sizes().tables[0]

pytestmark = pytest.mark.usefixtures("empty_house")


def measured(window: MainWindow) -> bool:
    """The body as it is now has been measured and is shown so."""
    return window.is_settled() and bool(window.result.measured) and not window.result.stale


def test_the_body_is_measured_where_it_is_seen_once_the_run_rests() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        assert not window.result.measured, "nobody has looked"
        window.navigation.show_step("result")
        assert not window.result.measured, "the window does not wait for it"
        yield lambda: measured(window)
        as_the_core_measures(window)
        yield from former_measures_fade_until_the_run_rests(window)
        as_the_core_measures(window)

    run_bodiless([], script)


def as_the_core_measures(window: MainWindow) -> None:
    frame = window.session.frame
    assert frame is not None
    before, after = before_after(frame.stages, frame.control_points)
    shown = {view.key: view for view in window.result.measured}
    assert sorted(shown) == sorted(after)
    groups = [view.group for view in shown.values()]
    assert len(list(groupby(groups))) == len(set(groups)), "each heading stands once"
    for key, view in shown.items():
        assert view.after == after[key].value
        assert view.before == (before[key].value if key in before else None)
    followed = frame.marks.apex_z - frame.stages.rest_marks.apex_z
    assert shown["apex_lift"].after == pytest.approx(followed, abs=0.01)
    hip, volume = shown["hip_girth"], shown["breast_volume_left"]
    assert (hip.after, "hip" in hip.caption) == (None, True)
    assert (volume.estimate, "±" in volume.caption) == (True, True)
    assert len(window.result.rows) > 5, "what is followed while it solves stays"


def former_measures_fade_until_the_run_rests(window: MainWindow) -> Script:
    former = window.result.measured
    name = next(iter(window.lines.rows))
    window.session.commit_line(name, name, 0.93)
    yield lambda: window.result.stale
    assert window.result.measured == former, "greyed, not gone"
    told = [row[0] for row in as_table([*window.result.rows])]
    assert former[0].label not in told
    yield lambda: measured(window)
    assert window.result.measured != former


def test_band_and_cup_follow_the_system_and_the_allowance_that_are_remembered() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("result")
        yield lambda: measured(window)
        card, shown = window.result.sizes, {view.key: view for view in window.result.measured}
        girths = [shown[key].before or 0.0 for key in ("underbust_girth", "bust_girth")]
        assert card.main.text() == f"JP {sizes(*girths)['jp'].label}"
        card.button("uk").click()
        assert card.main.text() == f"UK {sizes(*girths)['uk'].label}"
        assert card.button("jp").text().startswith("JP ")
        typed(card.allowance, "20")
        assert window.session.design is not None
        assert window.session.design.worn_tight_mm == 20.0
        window.actions_.undo.trigger()
        yield lambda: card.main.text() == f"UK {sizes(*girths)['uk'].label}"
        window.actions_.redo.trigger()
        tight = sizes(*girths, 20.0)["uk"]
        yield lambda: card.main.text() == f"UK {tight.label}"
        assert card.main.text() == f"UK {tight.label}"
        assert " ".join(str(each) for each in tight.rule) == card.rule.text()
        assert card.near.isVisible(), "what lies near stands there, as the doubt does"
        assert all(each.label in card.near.text() for each in (*tight.neighbours, *tight.sisters))
        assert card.doubt.text() == tight.doubts[0].en
        assert not card.doubts.isVisible()
        card.fold.setFocus()
        QTest.keyClick(card.fold, Qt.Key.Key_Space)
        assert card.doubts.isVisible(), "without a pointer too"
        assert all(each.en in card.doubts.text() for each in tight.doubts)
        assert card.caution.text() == "4 in not added"
        assert card.button("us").accessibleName().endswith("4 in not added")
        card.button("jp").click()
        assert (card.caution.text(), card.doubt.isVisible()) == ("", False)
        assert card.doubts.text().count("The standard itself was not read") == 1
        letters = TOPS.sizes(girths[1])
        assert card.near.text().endswith(f"{TOPS.title.en}: {' / '.join(letters)}"), "the scan shows no hip"
        card.button("uk").click()
        assert TOPS.title.en not in card.near.text()
        typed(card.allowance, "21")
        assert "0 to 20" in card.allowance.accessibleDescription()

    run_bodiless([], script)
    assert get_setting("size_system") == "uk"


def typed(field: QLineEdit, text: str) -> None:
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Return)


def test_a_measure_is_shown_on_the_body_until_esc_and_framed_at_a_double_click() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("result")
        yield lambda: measured(window)
        scene, table = window.view.viewport.scene, window.result.findChild(MeasurementsTable)
        view = scene.view
        click(table, "bust_girth")
        assert (window.result.mark, scene.measure.shown) == ("bust_girth", True)
        window.activateWindow()  # else the keys of the menus are asleep
        yield window.isActiveWindow
        table.setFocus()
        for key, place in ((Qt.Key.Key_End, -1), (Qt.Key.Key_Home, 0), (Qt.Key.Key_F2, 0)):
            QTest.keyClick(table, key)
            assert window.result.mark == [each.key for each in table.rows if each.key][place]
        assert window.result.isVisible(), "what is not one's own is not renamed elsewhere"
        window.result.select("bust_girth")
        QTest.keyClick(table, Qt.Key.Key_Down)
        assert window.result.mark == "bust_girth_skin"
        assert scene.view == view, "the body is only turned at a double-click"
        window.view.set_after(False)
        assert scene.measure.shown
        QTest.keyClick(table, Qt.Key.Key_Escape)
        assert (window.result.mark, scene.measure.shown) == ("", False)
        click(table, "hip_girth")
        assert (window.result.mark, scene.measure.shown) == ("hip_girth", False), "it can only be read"
        click(table, "apex_lift")
        assert not scene.measure.shown, "the body at rest has none"
        window.view.set_after(True)
        assert scene.measure.shown
        QTest.mouseDClick(table, Qt.MouseButton.LeftButton, pos=table.place_of("bust_girth").center())
        assert scene.view != view
        name = next(iter(window.lines.rows))
        window.session.commit_line(name, name, 0.95)
        yield lambda: window.result.stale
        assert not scene.measure.shown, "no curve of a former body"
        yield lambda: measured(window)
        assert scene.measure.shown
        window.navigation.show_step("lines")
        assert not scene.measure.shown

    run_undrawn([], script)


def test_what_is_opened_is_scrolled_to_with_all_that_it_tells() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("result")
        yield lambda: measured(window)
        table = window.result.findChild(MeasurementsTable)
        for key in ("waist_girth", "asymmetry_volume"):
            closed = table.place_of(key).height()
            window.result.sizes.button("uk" if key == "waist_girth" else "jp").click()  # it grows or shrinks
            window.result.select(key)
            opened = table.place_of(key)
            assert opened.height() > closed + 20
            for _ in range(12):  # what has got other words takes its room a moment later
                yield lambda: True
            assert table.visibleRegion().boundingRect().contains(opened.adjusted(4, 1, -4, -1)), key

    run_bodiless([], script)


def test_side_by_side_and_wiped_each_body_has_its_own_curve() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("result")
        yield lambda: measured(window)
        frame = window.session.frame
        assert frame is not None
        found = before_after(frame.stages, frame.control_points)
        window.result.select("bust_girth")
        for way in ("side", "wipe"):
            window.view.compare_by(way)
            traces = {body.after: body.viewport.scene.measure for body in window.view.beside.bodies}
            for after, measures in zip((False, True), found, strict=True):
                (ring,) = measures["bust_girth"].curves
                assert traces[after].shown
                assert np.array_equal(traces[after].points, ring)
        window.result.unmark()
        assert not any(trace.shown for trace in traces.values())

    run_undrawn([], script)


def click(table: MeasurementsTable, key: str) -> None:
    QTest.mouseClick(table, Qt.MouseButton.LeftButton, pos=table.place_of(key).center())
