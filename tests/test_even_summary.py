"""What the card of left and right says: sides, what is done first, and what is not told of a doubtful run."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.presenting.even import even_summary, map_note
from app.wording.samples import sample_design
from core.design_lines import LineTraits
from core.evenness import BeforeAfter, Evenness, Volumes, evenness
from core.own_lines import ready_made
from core.pipeline import Stages, build
from core.splitting import split
from core.template import read_template

TEMPLATE = read_template("168")


@pytest.fixture(scope="module")
def person() -> Stages:
    return build(sample_design("person").with_line("mid-bust", 0.97))


@pytest.fixture(scope="module")
def told(person: Stages) -> BeforeAfter:
    return evenness(person, person.control.mesh.vertices)


def test_each_figure_names_the_side_that_is_more(person: Stages) -> None:
    left = Evenness(2.04, 0.3, -0.04, 0.0, Volumes(150.0, 121.0, 20.0, 21.0), None)
    summary = even_summary(BeforeAfter(left, replace(left, higher=-1.2), ()), person)
    views = {view.title: view for view in summary.views}
    assert summary.says == "Bust points: right 1.2 mm higher."
    assert (views["Bust point higher [mm]"].before, views["Bust point higher [mm]"].after) == (
        "L 2.0",
        "R 1.2",
    )
    assert views["Bust point higher [mm]"].shares == pytest.approx((0.204, -0.12))
    assert views["Further aside [mm]"].after == "0.0"
    assert views["Breast larger [ml]"].after == "L 29"
    assert "± 29 ml by the roots alone" in views["Breast larger [ml]"].tip
    known = even_summary(BeforeAfter(left, left, ()), person, off=36.2).views
    assert "An estimate, ± 36 ml." in next(view for view in known if view.title == "Breast larger [ml]").tip
    assert views["Skin apart, mean [mm]"].after == "–"
    assert views["Skin apart, mean [mm]"].shares == (None, None)


def test_of_a_doubtful_run_only_before_is_told(person: Stages, told: BeforeAfter) -> None:
    summary = even_summary(told, person, "It vibrates.")
    assert not summary.possible
    assert summary.hint == "It vibrates."
    assert {view.after for view in summary.views} == {"–"}
    assert summary.views[0].before == "R 11.8"


def test_the_hint_says_what_is_parted_first_or_what_is_lacking(person: Stages, told: BeforeAfter) -> None:
    design = person.design
    for line in ready_made(TEMPLATE)["straps"]:
        design = design.with_own_line(line).with_line(line.name, 0.95)
    summary = even_summary(told, build(design, person))
    assert summary.hint == "Make even begins by setting left and right apart: Mid-bust, Straps."
    assert summary.possible
    halves = even_summary(told, build(split(person.design, TEMPLATE, "mid-bust"), person))
    assert (halves.hint, halves.possible) == ("", True)
    locked = person.design.with_traits(LineTraits("mid-bust", locked=True))
    summary = even_summary(told, build(locked, person))
    assert "wear a line that moves one side" in summary.hint
    assert not summary.possible


def test_the_legend_tells_ml_of_what_is_shown(told: BeforeAfter) -> None:
    assert map_note(None, after=True) == ""
    skin = told.before.skin
    assert skin is not None
    after = replace(told.after, skin=replace(skin, left_more=3.2, right_more=7.9))
    both = BeforeAfter(told.before, after, ())
    assert map_note(both, after=True).endswith("left 3 ml, right 8 ml")
    assert map_note(both, after=False).endswith(
        f"left {skin.left_more:.0f} ml, right {skin.right_more:.0f} ml"
    )
