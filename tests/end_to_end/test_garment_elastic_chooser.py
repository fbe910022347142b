"""The chooser of elastics: what cannot be used is grey with its reason, what can is one click away."""

from __future__ import annotations

import re
import threading
from typing import Any

import pytest
from garment_tools import at_rest, chooser_of, cut_rows, made_of, mark
from window_tools import PATIENCE, Script, run_bodiless, settled

from app.gui.features.garment import elastic_offer
from app.gui.features.garment.elastic_chooser import PRESSURE
from app.gui.main_window import MainWindow
from app.i18n.catalog import number
from app.presenters.bust_shift import bust_shift
from core.document.elastic import Elastic
from core.garment.elastic_library import save_elastic
from core.garment.elastic_options import KEEP_CUT

pytestmark = pytest.mark.usefixtures("empty_house", "own_data", "few_elastics")

SAME = 0.2
"""By how much a reached length may differ once an elastic is chosen [mm]."""


def test_an_elastic_that_cannot_be_used_is_grey_and_the_nearest_that_can_is_one_click_away() -> None:
    def script(window: MainWindow) -> Script:
        save_elastic(Elastic("weak", 10.0, ((0.0, 0.0), (0.1, 0.05), (0.3, 0.2)), estimate=False))
        yield settled(window)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        before, rows = window.session.design, cut_rows(window)
        window.garment.rows["mid-bust"].elastic.click()
        chooser = chooser_of(window)
        assert chooser.views()[1].note == "Computing…"
        yield from mark(window, "weak")
        view = chooser.views()[chooser.current]
        assert not view.usable
        assert re.fullmatch(r"Too weak: band [\d.]+ mm too long at the maximum elongation, 30 %\.", view.note)
        assert view.note in chooser.advice.text()
        assert not chooser.use.isEnabled()
        assert window.session.design is before
        nearest = next(each for each in chooser.offers() if "maximum" not in each).removeprefix("Use ")
        assert next(each for each in chooser.views() if each.title == nearest).usable
        chooser.press_offer(chooser.offers().index(f"Use {nearest}"))
        yield made_of(window, "mid-bust")
        row = cut_rows(window)["mid-bust"]
        assert row.elastic == nearest
        assert row.reached_front_mm == pytest.approx(rows["mid-bust"].reached_front_mm, abs=SAME)
        window.session.undo_stack.undo()
        yield at_rest(window)
        window.garment.rows["mid-bust"].elastic.click()
        yield from mark(window, "weak")
        chooser = chooser_of(window)
        limited = chooser.views()[chooser.current]
        chooser.press_offer(chooser.offers().index("Use maximum elongation"))
        yield made_of(window, "mid-bust")
        row = cut_rows(window)["mid-bust"]
        assert row.elastic == "weak"
        assert row.elongation == pytest.approx(0.3, rel=0.02)
        assert number(row.reached_front_mm) == limited.reached

    run_bodiless([], script)


def test_the_loss_of_lift_is_shown_before_it_is_chosen() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.add_lines_controller.add("straps")
        window.lines_controller.commit_length("strap left", 0.93)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        window.garment.rows["strap left"].elastic.click()
        chooser = chooser_of(window)
        chooser.mode_requested.emit(KEEP_CUT)
        yield from mark(window, "Strap 15 mm")
        view = chooser.views()[chooser.current]
        rigid = float(chooser.views()[0].lift)
        kept = round(100.0 * float(view.lift) / rigid)
        assert kept < 30
        longer, share = view.note.split(" · ")
        assert abs(int(share.removeprefix("Lift: ").removesuffix(" %")) - kept) <= 2
        off = float(view.reached) - float(chooser.views()[0].reached)
        assert float(longer.removesuffix(" mm longer on body")) == pytest.approx(off, abs=0.11)
        assert f"{view.lift} mm" in chooser.advice.text()
        assert chooser.table.topLevelItem(chooser.current).text(PRESSURE) == view.pressure  # type: ignore[union-attr]
        word, kpa = view.pressure.split(" · ")
        chooser.use.click()
        yield made_of(window, "strap left", "strap right")
        assert window.session.frame is not None
        assert bust_shift(window.session.frame).mean.up == pytest.approx(float(view.lift), abs=0.15)
        shown = [window.garment.rows[each].pressure.view for each in ("strap left", "strap right")]
        most = max(shown, key=lambda each: float(each.kpa))
        assert (float(most.kpa), most.word) == (pytest.approx(float(kpa), abs=0.15), word)

    run_bodiless([], script)


def test_effects_that_come_late_are_dropped_with_the_chooser(monkeypatch: pytest.MonkeyPatch) -> None:
    gate, found = threading.Event(), elastic_offer.elastic_option

    def waits(*asked: Any) -> Any:
        gate.wait(PATIENCE)
        return found(*asked)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        monkeypatch.setattr(elastic_offer, "elastic_option", waits)
        window.garment.rows["mid-bust"].elastic.click()
        former = chooser_of(window)
        assert not former.use.isEnabled()
        former.reject()
        window.lines_controller.commit_length("mid-bust", 1.05)
        yield at_rest(window)
        window.garment.rows["mid-bust"].elastic.click()
        gate.set()
        yield lambda: not window.jobs.at_work()
        views = chooser_of(window).views()
        assert not any(view.usable for view in views[1:]), "they are of the line as it is now"
        assert {view.note for view in views[1:]} == {"Slack at this length: set the line to 99 % or less."}
        chooser_of(window).reject()

    run_bodiless([], script)


def test_what_was_edited_while_the_chooser_was_open_is_kept() -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        window.garment.rows["mid-bust"].elastic.click()
        yield from mark(window, "Power-net band 80 mm")
        chooser = chooser_of(window)
        window.lines_controller.commit_length("under-bust", 0.97)  # as what is found late in a job may do
        chooser.use.click()
        yield made_of(window, "mid-bust")
        assert window.session.design is not None
        assert window.session.design.ratio("under-bust") == pytest.approx(0.97)

    run_bodiless([], script)
