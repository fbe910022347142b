"""± in the real window: beside the measures, below them, round the curve of the section; faint when stale."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from window_tools import PATIENCE, Script, run_bodiless, settled

import core.analysis.uncertainty.estimate
from app.gui.main_window import MainWindow
from app.presenters.uncertainty import limitation_sentences
from core.errors import UserError
from core.measurements.uncertain_value import OutputUncertainties
from core.messages import Message
from core.progress import Progress

pytestmark = pytest.mark.usefixtures("landmarks_known")


@pytest.fixture(autouse=True)
def soon(empty_house: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """Compute uncertainties as soon as the solver has converged."""
    monkeypatch.setattr("app.gui.features.uncertainty.controller.PAUSE", 50)


def whole(window: MainWindow) -> bool:
    spread, faint = window.uncertainty_controller.shown
    return spread is not None and not faint and bool(window.result.measured) and not window.result.stale


def test_it_is_told_where_it_is_looked_at_and_fades_while_a_line_moves() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        desk, card = window.uncertainty_controller, window.uncertainty_controller.card
        assert not desk.is_computing, "nobody has looked"
        window.navigation.show_step("result")
        yield lambda: whole(window)
        views = {view.key: view for view in window.result.measured}
        waist, volume = views["waist_girth"], views["breast_volume_left"]
        assert waist.off[0] == pytest.approx(2.5, abs=0.1)
        assert "scan 100 %" in waist.told()
        assert views["hip_girth"].off == (), "what is not known has none"
        assert volume.caption == "estimate", "the ± stands beside it, with all sources"
        assert any(view.moves == "lift" and view.off[2] for view in window.result.rows)
        assert "twice the standard deviation" in card.meaning.text()
        assert "With sliding lines" in card.contact.text()
        card.folds[1].click()
        assert all(
            any(sentence in words.text() for words in card.findChildren(type(card.meaning)))
            for sentence in limitation_sentences()
        )
        window.sections_controller.set_on(True)
        yield lambda: bool(window.sections_controller.panel.plot._drawn.bands)
        drawn = window.sections_controller.panel.plot._drawn
        assert len(drawn.bands["after"]) == len(drawn.curves["after"])
        outline, curve = drawn.bands["after"][0], drawn.curves["after"][0]
        gap = np.linalg.norm(outline[: len(curve)] - curve, axis=1)
        assert gap.min() == pytest.approx(0.4, abs=0.01)  # the scan alone
        assert gap.max() > 0.6
        window.session.preview_line("mid-bust", 0.9)
        yield lambda: not window.is_settled()
        assert desk.shown[1], "of a former shape"
        window.session.cancel_preview()
        yield lambda: whole(window)

    run_bodiless([], script)


def test_nothing_is_shown_before_all_sources_are_in(monkeypatch: pytest.MonkeyPatch) -> None:
    reached, go, known = (
        threading.Event(),
        threading.Event(),
        core.analysis.uncertainty.estimate.UncertaintyEstimator.estimate,
    )

    def waiting(
        self: core.analysis.uncertainty.estimate.UncertaintyEstimator, progress: Progress
    ) -> OutputUncertainties:
        self.estimate_partial(progress)
        reached.set()
        go.wait(PATIENCE)
        return known(self, progress)

    monkeypatch.setattr(core.analysis.uncertainty.estimate.UncertaintyEstimator, "estimate", waiting)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_step("result")
        yield reached.is_set
        yield lambda: bool(window.result.measured)
        assert window.uncertainty_controller.shown == (None, True)
        assert all(view.off == () for view in window.result.measured), "what is known by then is too small"
        go.set()
        yield lambda: whole(window)
        waist = next(view for view in window.result.measured if view.key == "waist_girth")
        assert "narrowest" in waist.label
        assert "several centimetres" in waist.told()

    run_bodiless([], script)


def test_where_it_is_given_up_there_is_none_and_the_reason_stands_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refused(*_: object) -> object:
        raise UserError(
            Message("No equilibrium found for these line lengths."),
            Message("Set the lengths closer to 100 %."),
        )

    monkeypatch.setattr(core.analysis.uncertainty.estimate.UncertaintyEstimator, "estimate", refused)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        desk, card = window.uncertainty_controller, window.uncertainty_controller.card
        window.navigation.show_step("result")
        yield lambda: "No equilibrium found" in card.meaning.text()
        assert card.meaning.text().startswith("Uncertainties were not computed.")
        assert desk.shown == (None, True), "without the landmarks it would be too small for good"
        yield lambda: bool(window.result.measured)
        assert all(view.off == () for view in window.result.measured)

    run_bodiless([], script)
