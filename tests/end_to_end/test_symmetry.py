"""Left and right in the real window: the card beside the measures, the map's ml, splitting, making even."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from pathlib import Path
from types import SimpleNamespace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from whole_trunk import TRUNK
from window_tools import Script, run_main, settled, undrawn

import app.gui.features.symmetry.controller as desk_module
from app.gui.features.symmetry.card import SymmetryCard
from app.gui.features.uncertainty.controller import UncertaintyController
from app.gui.main_window import MainWindow
from core.analysis.symmetry.compare import BeforeAfter, compare_sides
from core.control_mesh.template import read_template
from core.document.lower_trunk import LowerTrunk
from core.document.split_lines import split

pytestmark = pytest.mark.usefixtures("empty_house")
SIDES = ("left", "right")


@pytest.fixture(autouse=True)
def not_how_sure(monkeypatch: pytest.MonkeyPatch) -> None:
    """How sure the figures are takes longest by far of what the tab works out, and is tested elsewhere."""
    monkeypatch.setattr(UncertaintyController, "follow", lambda _: None)


def opened(window: MainWindow, mid: float = 0.95, full: float = 0.97) -> Script:
    """Open the Measures tab on a design of two lines."""
    undrawn(window)
    yield settled(window)
    window.session.edit(lambda d: d.with_line("mid-bust", mid).with_line("full-bust", full), "Worn")
    yield settled(window)
    window.navigation.show_step("result")
    yield lambda: is_fresh(window)


def is_fresh(window: MainWindow) -> bool:
    """The card tells of the frame that is shown."""
    return (
        window.is_settled()
        and window.symmetry_controller._shown is not None
        and not faint(window.symmetry_controller.card)
    )


def faint(card: SymmetryCard) -> bool:
    return card.summary is None or card._faint


def told(window: MainWindow) -> BeforeAfter:
    frame = window.session.frame
    assert frame is not None
    return compare_sides(frame.stages, frame.control_points)


def test_the_card_tells_what_differs_shows_where_and_makes_it_even(
    person: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def script(window: MainWindow) -> Script:
        yield from opened(window)
        shows_the_map(window)
        yield from tells_and_fades(window)
        takes_the_spread_of_the_table(window, monkeypatch)
        yield from leaves_what_is_not_worth_it(window)
        yield from makes_even(window, monkeypatch)

    run_main([str(person)], script)


def tells_and_fades(window: MainWindow) -> Script:
    """What differs, with sides; and while a line is dragged all of it is faint."""
    card, now = window.symmetry_controller.card, told(window)
    assert card.summary is not None
    assert card.says.text() == f"Bust points: right {-now.after.higher:.1f} mm higher."
    first, *_ = card.summary.views
    assert (first.before, first.after) == (f"R {-now.before.higher:.1f}", f"R {-now.after.higher:.1f}")
    assert first.shares[1] == pytest.approx(now.after.higher / 10.0)
    seen = [row.title.text() for row in card._rows if row.title.isVisible()]
    assert len(seen) == 4
    card.fold.click()
    seen = [row.title.text() for row in card._rows if row.title.isVisible()]
    assert "Left excess [ml]" in seen
    assert "at constant volume" in card.notes.text()
    window.session.preview_line("mid-bust", 0.93)
    yield lambda: faint(card) and card.summary is not None
    assert not card.make.isEnabled()
    window.session.cancel_preview()
    yield lambda: is_fresh(window)
    assert card.make.isEnabled()


def shows_the_map(window: MainWindow) -> None:
    """The button lays the map on the body and takes it off; the legend tells ml."""
    card, maps = window.symmetry_controller.card, window.maps_controller
    assert card.look.text() == "Show on body"
    card.look.click()
    assert maps.name == "sides"
    assert card.look.text() == "Hide map"
    skin = told(window).after.skin
    assert skin is not None
    assert f"left {skin.left_more:.0f} ml, right {skin.right_more:.0f} ml" in maps.legend.note.text()
    maps.choose("displacement")
    assert card.look.text() == "Show on body"
    assert "ml" not in maps.legend.note.text()
    maps.choose("sides")
    card.look.click()
    assert maps.name == ""


def takes_the_spread_of_the_table(window: MainWindow, monkeypatch: pytest.MonkeyPatch) -> None:
    """One figure has one ±: until all of it is known the card says of what it is."""
    desk = window.symmetry_controller

    def off() -> str:
        assert desk.card.summary is not None
        return next(view.off for view in desk.card.summary.views if view.title == "Height [mm]")

    assert off() == ""
    known = {"after:asymmetry_height": 36.2}
    with monkeypatch.context() as patch:
        patch.setattr(desk, "_uncertainty_of", lambda _: SimpleNamespace(whole=True, plus_minus=known.get))
        desk.follow()
        assert off() == "± 36"
        assert "No significant difference in position." in desk.card.says.text()
    desk.follow()
    assert off() == ""


def leaves_what_is_not_worth_it(window: MainWindow) -> Script:
    """Glued lines across both sides do not level a breast: it is said, and nothing is changed."""
    before, count = window.session.design, window.session.undo_stack.count()
    window.symmetry_controller.card.make.click()
    yield window.notices.isVisible
    shown = window.notices._shown
    assert shown is not None
    assert shown.sentence.startswith("The active lines cannot reduce the asymmetry")
    assert window.session.design is before
    assert window.session.undo_stack.count() == count
    window.session.edit(lambda d: replace(d, line_contact="sliding"), "Sliding")
    yield lambda: is_fresh(window)


def makes_even(window: MainWindow, monkeypatch: pytest.MonkeyPatch) -> Script:
    """Lines are parted in the one step that takes the answer; left, or changed meanwhile, nothing is."""
    card, desk, before = (
        window.symmetry_controller.card,
        window.target_shape_controller,
        window.session.design,
    )
    assert card.hint.text() == "Balancing unlinks left and right: Full bust, Mid-bust."
    count, uneven = window.session.undo_stack.count(), -told(window).after.higher
    for end in (desk.leave, desk.apply):
        card.make.click()
        yield lambda: desk.is_tried_on and not desk.work.at_work
        assert [(goal.name, goal.value) for goal in desk.goals()[:2]] == [
            ("left higher", 0.0),
            ("left further out", 0.0),
        ]
        assert {"lift", "out"} <= set(desk.card.wishes), "what moves besides is seen"
        assert desk.card.note.text() == "Left and right unlinked: Full bust, Mid-bust"
        first, *nearer = desk.card.answer.text().splitlines()
        assert first in ("All targets reached.", "Not reachable. Closest result:")
        assert nearer[0].startswith(f"Right higher: {uneven:.1f} → "), "from where to where, with no sign"
        assert "Mid-bust (left) 95.0 → " in desk.card.changes.text()
        assert desk.card.price.text().startswith("Trade-off: ") != desk.card.price.isHidden()
        assert window.session.design is before, "seen, not taken"
        assert window.session.undo_stack.count() == count
        end()
        yield settled(window)
        if end == desk.leave:
            assert window.session.design is before
            window.navigation.show_step("result")
            yield lambda: is_fresh(window)
    after = window.session.design
    assert after is not None
    assert after.active_lines() == {f"{line} {side}" for line in ("mid-bust", "full-bust") for side in SIDES}
    assert window.session.undo_stack.count() == count + 1
    asked = "Left and right unlinked: Full bust, Mid-bust · Targets: Left higher than right 0.0 mm"
    assert window.session.undo_stack.undoText().startswith(asked)
    window.actions_.undo.trigger()
    yield settled(window)
    assert window.session.design == before
    window.navigation.show_step("result")
    yield lambda: is_fresh(window)
    begun: list[object] = []
    window.symmetry_controller.targets_proposed.connect(lambda *_: begun.append(_))
    card.make.click()
    making = window.symmetry_controller._balancing
    card.make.click()
    assert window.symmetry_controller._balancing is making, "it is looked for already"
    window.session.edit(lambda d: d.with_line("mid-bust", 0.96), "Another")
    yield lambda: is_fresh(window)
    assert not begun, "what was looked for was for another design"


def splits(window: MainWindow) -> Script:
    """A line is split by its row, the key and the menu, each as one step."""
    window.navigation.show_step("lines")
    window.activateWindow()
    yield window.isActiveWindow
    before = window.session.design
    assert before is not None
    link = window.lines.rows["mid-bust"].details._tools["link"]
    for ask_for in (
        lambda: QTest.keyClick(window.lines, Qt.Key.Key_L),
        lambda: window.lines.do("split"),
        link.click,
    ):
        window.lines.select("mid-bust")
        assert "Split at" in link.toolTip()
        ask_for()
        yield lambda: "mid-bust left" in window.lines.rows and window.is_settled()
        assert window.session.undo_stack.undoText() == "Mid-bust split into left and right"
        assert list(window.lines.rows)[1:4] == ["mid-bust", "mid-bust left", "mid-bust right"]
        left, whole = window.lines.rows["mid-bust left"], window.lines.rows["mid-bust"]
        assert left.view.ratio == before.ratio("mid-bust")
        assert left.view.color == whole.view.color
        assert left.view.title == "Mid-bust, left"
        assert left._open
        assert whole.view.ratio == 1.0
        window.actions_.undo.trigger()
        yield lambda: "mid-bust left" not in window.lines.rows and window.is_settled()
        assert window.session.design == before
        window.throttled.flush()
        assert window.view.selected_line == "mid-bust", "it is whole again"
    yield from parted_elsewhere(window)
    window.lines.select("under-bust")
    assert not window.lines.rows["under-bust"].view.splits, "it moves nothing"


def parted_elsewhere(window: MainWindow) -> Script:
    """Who looks at a line that something else splits goes on in its left half; the whole tells no gap."""
    window.selection.select_line("mid-bust")
    window.lines_controller.commit_length("mid-bust", 0.95)
    template = read_template("168")
    window.session.edit(lambda design: split(design, template, "mid-bust"), "Made even")
    yield lambda: "mid-bust left" in window.lines.rows and window.is_settled()
    window.throttled.flush()
    assert window.view.selected_line == "mid-bust left"
    assert window.lines.rows["mid-bust left"]._open
    window.selection.select_line("mid-bust")  # whoever wants to see it can
    row = window.lines.rows["mid-bust"]
    assert row._open
    assert row.details._figures[0][3].text() == "–", "a line that does not pull has no gap"
    assert "replaced by its left and right halves" in row.details._part.text()
    assert row.view.leeway is None
    window.actions_.undo.trigger()
    yield lambda: "mid-bust left" not in window.lines.rows and window.is_settled()


def test_an_even_body_has_nothing_to_be_made_even_and_a_line_is_split_all_the_same(
    mannequin: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[object] = []
    monkeypatch.setattr(
        desk_module, "compare_sides", lambda *given: asked.append(given) or compare_sides(*given)
    )

    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        assert not asked, "nobody looks at it"
        window.navigation.show_step("result")
        yield lambda: is_fresh(window)
        card = window.symmetry_controller.card
        assert card.says.text() == "Bust points are symmetric within 0.5 mm."
        assert not card.make.isEnabled()
        assert len(asked) == 1
        yield from splits(window)

    run_main([str(mannequin)], script)


def test_an_uneven_seat_is_levelled() -> None:
    def script(window: MainWindow) -> Script:
        undrawn(window)
        yield settled(window)
        lengths = {"waist": 0.98, "sling-left": 0.94, "sling-right": 0.98}
        lengths |= {f"{name}-{side}": 0.98 for name in ("buttock-lift", "leg-opening") for side in SIDES}
        bare = replace(window.session.design, lower=LowerTrunk())
        worn = reduce(lambda each, line: each.with_line(*line), lengths.items(), bare)
        window.session.edit(lambda _: worn, "Worn")
        yield settled(window)
        window.navigation.show_step("result")
        yield lambda: is_fresh(window)
        card, target = window.symmetry_controller.card, window.target_shape_controller
        assert "Left gluteal fold " in card.says.text()
        assert card.hint.text() == ""
        card.make.click()
        yield lambda: target.is_tried_on and not target.work.at_work
        assert {goal.name for goal in target.goals()[:2]} == {"left buttock higher", "left fold higher"}
        assert "Left gluteal fold higher: " in target.card.answer.text()
        target.apply()
        yield settled(window)
        window.navigation.show_step("result")
        yield lambda: is_fresh(window)
        assert "gluteal fold" not in card.says.text()
        assert not card.make.isEnabled()
        window.session.undo_stack.setClean()

    run_main([TRUNK], script)
