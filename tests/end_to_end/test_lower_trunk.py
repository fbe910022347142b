"""A girdle in the window: its preset, its lines under headings, a drag, undo, and a scan without legs."""

from __future__ import annotations

import numpy as np
import pytest
from ask_tools import answered
from PySide6.QtWidgets import QLabel
from window_tools import Script, drag, run_undrawn, settled

from app.gui.main_window import MainWindow
from app.presenters.samples import sample_path
from core.garment.presets import find_preset
from core.measurements.figure import figure_girths
from tests.end_to_end.test_model_options import choose

pytestmark = pytest.mark.usefixtures("empty_house")


def test_a_girdle_is_worn_dragged_and_taken_back() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        panel, session = window.lines, window.session
        window.presets_controller.wear(find_preset("girdle"))
        yield settled(window)
        assert panel.head.presets.text() == "Girdle"
        shown = [name for name, row in panel.rows.items() if not row.isHidden()]
        assert {"waist", "hip", "sling-left", "leg-opening-left"} <= set(shown)
        assert "above-waist" not in shown, "its group is closed, and it is not worn"
        panel.groups.headings["waist"].click()
        assert not panel.rows["above-waist"].isHidden()
        frame = session.frame
        assert frame is not None
        assert frame.lower is not None
        before = frame.lower.lengths["waist"]
        drag(window, "waist", -20)
        yield settled(window)
        assert session.frame.lower.lengths["waist"] < before - 3.0
        session.undo_stack.undo()
        yield settled(window)
        assert session.frame.lower.lengths["waist"] == pytest.approx(before, abs=0.2)
        lower = session.frame.lower
        moved = lower.control_points - lower.stages.control.mesh.vertices
        assert np.abs(moved).max() > 3.0
        yield lambda: any("Waist" in label.text() for label in window.strip.findChildren(QLabel))
        yield from a_waist_is_asked_for(window)

    run_undrawn([str(sample_path("trunk"))], script)


def a_waist_is_asked_for(window: MainWindow) -> Script:
    """Ask for a waist 20 mm less than the original, see it, and take it."""
    session, target = window.session, window.target_shape_controller
    rest = figure_girths(session.frame)["waist"][0]
    target.begin()
    yield lambda: target.answer is not None and not target.work.at_work
    assert list(target.wishes) == ["waist girth", "hip girth"]
    assert target.card.hand.isHidden(), "no line reshapes the bust"
    target.wish("waist girth", -20.0)
    yield lambda: target.answer.reply is not None and not target.work.at_work
    assert target.wishes["waist girth"] == pytest.approx(rest - 20.0, abs=0.3)
    assert target.answer.reply.reachable
    yield answered(window)  # not settled: that is never said of what is tried on
    target.apply()
    yield settled(window)
    assert figure_girths(session.frame)["waist"][1] == pytest.approx(rest - 20.0, abs=0.5)
    assert "Waist girth" in session.undo_stack.undoText()


def test_its_settings_are_model_options_while_it_is_worn() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        panel, session, steps = window.model, window.session, window.session.undo_stack
        window.actions_.model.trigger()
        row, head = panel._rows["waist_kept"], panel._heads["Waist, hips and seat"]
        assert not row.isVisible()
        assert not head.isVisible()
        window.presets_controller.wear(find_preset("girdle"))
        yield settled(window)
        window.actions_.model.trigger()
        assert row.isVisible()
        assert head.isVisible()
        reached = session.frame.lower.lengths["waist"]
        choose(window, "waist_kept", "100")
        yield settled(window)
        assert session.design.lower.waist_kept == 1.0
        assert session.frame.lower.lengths["waist"] > reached + 1.0, "kept volume resists the band"
        assert steps.undoText() == "Volume kept at waist: 100 %"
        assert "Volume kept at waist 100 %" in window.door.accessibleDescription()
        panel._reset.click()
        assert session.design.lower.waist_kept == 0.5
        assert session.design.lower.lines, "a reset of options leaves the lines"
        steps.undo()
        steps.undo()
        yield settled(window)
        assert session.frame.lower.lengths["waist"] == pytest.approx(reached, abs=0.1)

    run_undrawn([str(sample_path("trunk"))], script)


def test_its_zones_are_plotted_where_it_is_chosen() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        strip = window.strip
        assert not strip.region.isVisible(), "there is one region"
        window.presets_controller.wear(find_preset("girdle"))
        yield settled(window)
        assert strip.zone_plot.isVisible(), "no line of the bust is worn"
        assert not strip.height_plot.isVisible()
        strip.region.button("bust").click()
        assert strip.height_plot.isVisible()
        strip.region.button("lower").click()
        assert strip.zone_plot.isVisible()
        drag(window, "waist", -10)
        yield settled(window)
        yield lambda: strip.zone_plot.canvas.plotted.turns()[1] > 20.0
        names = [curve.name for curve in strip.zone_plot.canvas.plotted.curves]
        assert names == ["Waist", "Belly", "Lower front", "Left seat", "Right seat"]
        assert [name for name, _, _ in strip.legend][-5:] == names
        assert "Taken up inside: Waist" in window.status._taken_up.text()
        for width in (window.minimumWidth(), 1700):
            window.resize(width, window.height())
            yield settled(window)
            for legend in (strip._zone_legend, strip._legends[2]):
                right = legend.mapTo(strip, legend.rect().topRight()).x()
                assert right < strip.tools.geometry().left(), "the legend has room"
        window.session.undo_stack.undo()
        window.session.undo_stack.undo()
        yield settled(window)
        assert strip.height_plot.isVisible()
        assert not strip.zone_plot.isVisible()
        assert not window.status._taken_up.isVisible()

    run_undrawn([str(sample_path("trunk"))], script)


def test_a_scan_without_legs_keeps_its_bust_and_says_why() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        panel = window.lines
        panel.add_lower.click()
        yield settled(window)
        assert panel.add_lower.isHidden()
        assert "Scan down to the middle of both thighs." in panel._why_not.text()
        assert window.session.frame.lower is None
        assert "waist" not in panel.rows
        window.session.undo_stack.undo()
        yield settled(window)
        assert not panel.add_lower.isHidden()

    run_undrawn([], script)
