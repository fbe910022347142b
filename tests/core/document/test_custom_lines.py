"""Own lines: how they are written, where they lie, what they do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from core.control_mesh.template import read_template
from core.document.design import Design, ScanSource
from core.document.line_notation import format_point, parse_line, with_custom_lines
from core.document.lines import CustomLine
from core.document.serialization import from_json, to_json
from core.errors import LineError
from core.mechanics.exact_solution import solve_exact
from core.pipeline.build import Stages, build
from core.pipeline.warnings import immovable_lines

BIG, SMALL = read_template("168"), read_template("120")


@pytest.mark.parametrize(
    ("text", "points"),
    [
        ("strap=29,42", (29, 42)),
        ("strap=r2c-3,r3c0", (2 * 13 + 3, 3 * 13 + 6)),
        (" Strap = R2C+1 , r3c1", (2 * 13 + 7, 3 * 13 + 7)),
        ("strap=r2c-1:r2c1", (31, 32, 33)),
        ("strap=r2c1:r2c-1", (33, 32, 31)),
        ("strap=r5c0:r3c0,40", (71, 58, 45, 40)),
        ("strap=r2c\N{MINUS SIGN}3,r3c0", (29, 45)),
    ],
)
def test_points_are_named_by_number_or_by_place(text: str, points: tuple[int, ...]) -> None:
    assert parse_line(text, BIG) == CustomLine("strap", points)


def test_a_closed_line_ends_where_it_begins() -> None:
    line = parse_line("ring=r3c1:r3c3,r4c3:r4c1,closed", BIG)
    assert line.closed
    assert line.path[0] == line.path[-1] == line.points[0]
    assert len(line.path) == len(line.points) + 1 == 7


def test_places_and_numbers_say_the_same() -> None:
    for template in (BIG, SMALL):
        for point in range(len(template.row)):
            other = 0 if point else 1
            assert parse_line(f"a={format_point(point, template)},{other}", template).points == (point, other)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("strap", "is not a line"),
        ("=1,2", "is not a line"),
        ("strap=", "is not a line"),
        ("strap=closed", "is not a line"),
        ("strap=1,,2", "is not a line"),
        ("strap=1,104", "'104' is not a control point of the template 168"),
        ("strap=1,-2", "'-2' is not a control point"),
        ("strap=r8c0,r3c0", "no position 'r8c0'"),
        ("strap=r3c7,r3c0", "columns -6 to 6"),
        ("strap=r2c0:r3c1", "does not follow a row or a column"),
        ("strap=r2c0:r2c0", "does not follow a row or a column"),
        ("strap=r2c0:r2c1:r2c2", "does not follow a row or a column"),
        ("strap=5", "not a sequence of points"),
        ("strap=5,5", "not a sequence of points"),
        ("strap=5,6,closed", "not a sequence of points"),
        ("strap=5,6,5,closed", "not a sequence of points"),
    ],
)
def test_what_is_no_line_is_refused_in_a_sentence(text: str, sentence: str) -> None:
    with pytest.raises(LineError, match=sentence) as refused:
        parse_line(text, BIG)
    assert refused.value.hint


def test_own_lines_lie_beside_those_of_the_template(built: Callable[[str], Stages]) -> None:
    control = built("mannequin").control
    ring = CustomLine("ring", (45, 46, 59, 58), closed=True)
    laid = with_custom_lines(control, (CustomLine("strap", (48, 61, 74)), ring))
    assert list(laid.paths) == [*control.paths, "strap", "ring"]
    assert laid.paths["ring"] == (45, 46, 59, 58, 45)
    for wrong in (CustomLine("mid-bust", (1, 2)), CustomLine("far", (1, 104)), CustomLine("far", (-1, 2))):
        with pytest.raises(LineError):
            with_custom_lines(control, (wrong,))


def test_a_strap_lifts_and_one_on_fixed_points_is_measured_only(built: Callable[[str], Stages]) -> None:
    before = built("mannequin")
    strap, edge = parse_line("strap=r2c3:r6c3", BIG), parse_line("edge=r6c-2:r6c2", BIG)
    design = replace(before.design, lines=(), own_lines=(strap, edge))
    stages = build(design.with_line("strap", 0.95).with_line("edge", 0.9), before)
    assert stages.model.lines[-1].name == "edge"
    assert not stages.model.lines[-1].constrains
    [sentence] = immovable_lines(stages)
    assert str(sentence).startswith("edge is on fixed points")
    assert stages.model.lines[-2].back_length == 0.0
    answer = solve_exact(stages.model, (1.0, 1.0, 1.0, 0.95, 0.9))
    points = stages.model.tensegric.expand(answer.state.moved)
    rest = stages.control.mesh.vertices
    assert stages.model.lines[-2].length(points) < 0.97 * stages.model.lines[-2].rest_length
    left, right = (points[point, 2] - rest[point, 2] for point in stages.control.bust_points)
    assert left > 2.0
    assert abs(right) < 0.3
    assert np.array_equal(points[list(edge.points)], rest[list(edge.points)])


def test_own_lines_are_saved_and_keep_their_template() -> None:
    design = Design(ScanSource("a.ply")).with_custom_line(parse_line("ring=r3c1:r3c3,r4c2,closed", BIG))
    again = from_json(to_json(design.with_line("ring", 0.9)))
    assert again.own_lines == design.own_lines
    assert again.ratio("ring") == 0.9
    assert again.with_template("168") == again
    with pytest.raises(LineError, match="168-polygon"):
        again.with_template("120")
    assert again.without_custom_line("ring") == Design(ScanSource("a.ply"))
    assert again.without_custom_line("ring").with_template("120").template == "120"
    longer = again.with_custom_line(CustomLine("ring", (1, 2)))
    assert longer.own_lines == (CustomLine("ring", (1, 2)),)
