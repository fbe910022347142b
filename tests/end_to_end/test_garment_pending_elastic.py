"""An elastic whose length is still looked for: it goes to the lines it was chosen for, or nowhere."""

from __future__ import annotations

import threading
from typing import Any

import pytest
from garment_tools import at_rest, made_of
from window_tools import PATIENCE, Script, run_bodiless, run_undrawn, settled

from app.gui.features.garment import elastic_offer
from app.gui.main_window import MainWindow
from app.presenters.samples import sample_design
from core.garment.elastic_library import find_elastic

pytestmark = pytest.mark.usefixtures("empty_house", "few_elastics")


@pytest.fixture
def gate(monkeypatch: pytest.MonkeyPatch) -> threading.Event:
    """Lengths are looked for until it is open."""
    opened, found = threading.Event(), elastic_offer.elastic_option

    def waits(*asked: Any) -> Any:
        opened.wait(PATIENCE)
        return found(*asked)

    monkeypatch.setattr(elastic_offer, "elastic_option", waits)
    return opened


def take(window: MainWindow, line: str) -> None:
    """Choose an elastic for a line before its effect is known."""
    design = window.session.design
    assert design is not None
    window.elastic_assignment_controller.choose(design.linked_lines(line), find_elastic("strap 15"))


def test_an_elastic_goes_to_no_other_variant_and_to_no_other_document(gate: threading.Event) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.navigation.show_panel("garment")
        take(window, "mid-bust")
        assert window.jobs.at_work()
        window.variants_controller.choose("B")
        gate.set()
        yield at_rest(window)
        document = window.session.document
        assert document is not None
        assert [design.elastics for _, design in document.designs] == [(), ()]
        gate.clear()
        window.session.undo_stack.setClean()
        take(window, "mid-bust")
        window.project_controller.open_sample("person")
        yield lambda: window.session.name == "person" and window.is_settled()
        gate.set()
        yield at_rest(window)
        assert window.session.design == sample_design("person")
        assert window.session.undo_stack.isClean()

    run_undrawn([], script)


def test_an_elastic_goes_with_the_next_edit_and_leaves_with_an_undo_and_with_its_line(
    gate: threading.Event,
) -> None:
    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.add_lines_controller.add("straps")
        window.lines_controller.commit_length("strap left", 0.97)
        window.navigation.show_panel("garment")
        yield at_rest(window)
        take(window, "mid-bust")
        window.actions_.undo.trigger()
        gate.set()
        yield at_rest(window)
        assert window.session.design is not None
        assert window.session.design.elastics == ()
        assert window.notices.notice() is None
        window.actions_.redo.trigger()
        yield at_rest(window)
        gate.clear()
        take(window, "strap left")
        for name in ("strap left", "strap right"):
            if name in window.lines.rows:
                window.lines_controller.remove(name)
        gate.set()
        yield at_rest(window)
        design = window.session.design
        assert not {"strap left", "strap right"} & {each.name for each in design.traits}
        gate.clear()
        take(window, "mid-bust")
        window.lines_controller.commit_length("mid-bust", 0.96)
        gate.set()
        yield made_of(window, "mid-bust")

    run_bodiless([], script)
