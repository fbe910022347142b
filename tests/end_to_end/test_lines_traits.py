"""Names, colours, locks and links of lines, and own measures, do not act on the model: runs go on."""

from __future__ import annotations

from dataclasses import replace

import pytest
from window_tools import Script, run_bodiless
from window_tools import settled as at_rest

from app.gui.main_window import MainWindow
from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.document.lines import LineSettings
from core.pipeline.live_solver import LiveSolver
from tests.core.pipeline.test_live_solver import Built, settled, solver

__all__ = ["solver"]

RIBS = CustomMeasurement("Ribs", "girth", ("fold_left",), -30.0)
DESIGN = Design(ScanSource("a.ply")).with_line("mid-bust", 0.95)


@pytest.mark.parametrize(
    "what", [{"title": "Mine"}, {"colour": "#e5536b"}, {"locked": True}, {"linked": False}]
)
def test_what_a_line_is_called_does_not_act_and_its_stiffness_does(what: dict[str, object]) -> None:
    assert DESIGN.is_equivalent(DESIGN.with_line_settings(LineSettings("mid-bust", **what)))  # type: ignore[arg-type]
    assert not DESIGN.is_equivalent(DESIGN.with_line_settings(LineSettings("mid-bust", stiffness=3.0)))
    assert not DESIGN.is_equivalent(DESIGN.with_line("mid-bust", 0.94))
    assert not DESIGN.is_equivalent(replace(DESIGN, volume="exact"))


def test_a_run_goes_on_over_a_new_name_and_a_measure(solver: LiveSolver, built: Built) -> None:
    design = built("mannequin").design.with_line("mid-bust", 0.95)
    before = settled(solver, solver.submit(design, fresh=True))
    named = design.with_line_settings(LineSettings("mid-bust", "Mine"))
    for alike in (named, named.with_custom_measurement(RIBS)):
        assert design.is_equivalent(alike)
        after = settled(solver, solver.submit(alike))
        assert after.stages.design == alike
        for control, records in before.tracks.items():
            assert after.tracks[control] == records, "no turn is made, and none is forgotten"


@pytest.mark.usefixtures("empty_house")
def test_the_plots_stay_when_a_line_is_renamed_locked_or_undone() -> None:
    def script(window: MainWindow) -> Script:
        yield at_rest(window)
        window.lines.length_committed.emit("mid-bust", 0.9)
        yield at_rest(window)
        frame = window.session.frame
        assert frame is not None
        turns = {control: len(records) for control, records in frame.tracks.items()}
        for trait, value in (("title", "Mine"), ("colour", "#e5536b"), ("locked", True)):
            window.lines_controller.decide("mid-bust", trait, value)
            yield at_rest(window)
        window.actions_.undo.trigger()
        yield at_rest(window)
        frame = window.session.frame
        assert frame is not None
        assert {control: len(records) for control, records in frame.tracks.items()} == turns
        marks = window.convergence_controller._events["bust"]
        assert len(marks) == 1, "only what acts has a mark on the axis"

    assert run_bodiless([], script) == 0
