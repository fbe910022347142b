"""A line is split at the front centre: where its halves lie, how they are treated, what they do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.presenters.samples import sample_design
from core.control_mesh.template import read_template
from core.document.design import Design, ScanSource
from core.document.line_notation import mirrored, ready_made_lines
from core.document.lines import CustomLine, LineSettings
from core.document.split_lines import can_split, halves, is_split, split
from core.errors import LineError
from core.garment.elastic_library import find_elastic
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve

TEMPLATE = read_template("168")
PLAIN = Design(ScanSource("a.ply"), lines=()).with_line("mid-bust", 0.93)


def test_halves_meet_at_the_front_centre_and_make_the_whole() -> None:
    path = TEMPLATE.paths["mid-bust"]
    left, right = halves("mid-bust", path, TEMPLATE)
    assert (left.name, right.name) == ("mid-bust left", "mid-bust right")
    assert left.points[0] == right.points[0]
    assert TEMPLATE.column[left.points[0]] == 0
    assert (*right.points[::-1], *left.points[1:]) == path
    assert mirrored(left.points, TEMPLATE) == right.points
    assert halves("mid-bust", path[::-1], TEMPLATE) == (left, right)  # whichever way it was drawn


def test_what_has_no_two_halves_is_refused() -> None:
    ring, strap = ready_made_lines(TEMPLATE)["rings"][0], ready_made_lines(TEMPLATE)["straps"][0]
    with pytest.raises(LineError, match="is closed"):
        halves(ring.name, ring.path, TEMPLATE)
    for path in (strap.points, TEMPLATE.paths["mid-bust"][:6], TEMPLATE.paths["mid-bust"][5:]):
        with pytest.raises(LineError, match="does not cross"):
            halves("a", path, TEMPLATE)
    twice = [TEMPLATE.point(3, column) for column in (-2, 0, 2)] + [TEMPLATE.point(4, 0)]
    with pytest.raises(LineError, match="does not cross"):
        halves("a", twice, TEMPLATE)
    with pytest.raises(LineError, match="on the fixed part"):
        split(PLAIN, TEMPLATE, "under-bust")
    with pytest.raises(LineError, match="There is no line"):
        split(PLAIN, TEMPLATE, "waist")


def test_halves_are_worn_and_treated_as_the_whole_was() -> None:
    traits = LineSettings("mid-bust", title="Belt", colour="#112233", stiffness=40.0, width=9.0)
    after = split(PLAIN.with_line_settings(traits), TEMPLATE, "mid-bust")
    assert after.active_lines() == {"mid-bust left", "mid-bust right"}
    for name in after.active_lines():
        assert after.ratio(name) == 0.93
        assert after.line_settings(name) == replace(traits, name=name, linked=False)
        assert after.linked_lines(name) == (name,)
    assert is_split(after, "mid-bust")
    assert is_split(after.with_line("mid-bust left", None), "mid-bust"), "one half is worn"
    assert not is_split(after.with_line("mid-bust", 0.9), "mid-bust"), "it is worn besides"
    assert not is_split(PLAIN.with_line("mid-bust", None), "mid-bust"), "it is off, and nothing in its place"
    tied = split(PLAIN, TEMPLATE, "mid-bust", linked=True)
    assert tied.linked_lines("mid-bust left") == ("mid-bust left", "mid-bust right")
    elastic = find_elastic("picot 10")
    made = split(PLAIN.with_elastic("mid-bust", elastic), TEMPLATE, "mid-bust")
    assert made.active_elastics() == {"mid-bust left": elastic, "mid-bust right": elastic}
    assert split(replace(PLAIN, lines=()), TEMPLATE, "mid-bust").active_lines() == set()


def test_an_own_line_goes_and_a_locked_or_named_one_stays() -> None:
    path = tuple(TEMPLATE.point(row, column) for row, column in ((3, -3), (4, 0), (3, 3)))
    own = PLAIN.with_custom_line(CustomLine("sash", path)).with_line("sash", 0.9)
    after = split(own, TEMPLATE, "sash")
    assert [line.name for line in after.own_lines] == ["sash left", "sash right"]
    assert after.ratio("sash left") == 0.9
    for name in ("mid-bust", "sash"):
        locked = own.with_line_settings(LineSettings(name, locked=True))
        with pytest.raises(LineError, match="is locked"):
            split(locked, TEMPLATE, name)
        assert not can_split(locked, TEMPLATE, name)
    other = own.with_custom_line(CustomLine("sash left", path[:2]))
    with pytest.raises(LineError, match="already exists"):
        split(other, TEMPLATE, "sash")
    # Halves that are there already, from an earlier time, are worn again.
    again = split(after.with_custom_line(CustomLine("sash", path)), TEMPLATE, "sash")
    assert [line.name for line in again.own_lines] == ["sash left", "sash right"]


@pytest.fixture(scope="module")
def plain() -> Stages:
    return build(replace(sample_design("person"), volume="exact", lines=()))


@pytest.mark.parametrize(
    ("choice", "near"),
    [({}, 0.01), ({"line_hold": "held"}, 0.1), ({"line_contact": "sliding"}, 0.02)],
    ids=str,
)
def test_equal_halves_do_what_the_whole_does(plain: Stages, choice: dict[str, str], near: float) -> None:
    whole = build(replace(plain.design, **choice).with_line("mid-bust", 0.93), plain)
    parts = build(split(whole.design, TEMPLATE, "mid-bust"), whole)
    moves = [solve(stages).control_points - plain.control.mesh.vertices for stages in (whole, parts)]
    off = np.linalg.norm(moves[1] - moves[0], axis=1).max()
    assert np.linalg.norm(moves[0], axis=1).max() > 5.0
    assert off < near
