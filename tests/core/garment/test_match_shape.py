"""From lines as they are worn to lines of elastic that reach the same."""

import json
from dataclasses import replace

import numpy as np
import pytest

from app.cli.main import main
from core.control_mesh.template import read_template
from core.document.elastic import Elastic
from core.document.line_notation import ready_made_lines
from core.document.lines import ActiveLine
from core.errors import LineError
from core.garment.cut_list import cut_list
from core.garment.elastic_library import find_elastic
from core.garment.match_shape import match_lengths, reached_points
from core.garment.tension import line_tensions
from core.mechanics.exact_solution import solve_exact
from core.pipeline.build import build
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import exact_equilibrium

STRAP, BAND = find_elastic("strap 15"), find_elastic("plush 12")


def exactly_as_worn(stages, elastics):
    return match_lengths(stages, reached_points(stages), elastics)


def worn_at(stages, lines, **choices):
    return build(
        replace(stages.design, lines=tuple(ActiveLine(*line) for line in lines), volume="exact", **choices),
        stages,
    )


def points_of(stages):
    balance = solve_exact(stages.model, line_targets(stages.design, stages).ratios)
    assert balance.is_converged
    return stages.model.tensegric.expand(balance.state.moved)


@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_lines_of_elastic_reach_what_the_lines_reached(built, contact):
    lines = [("full-bust", 0.985), ("mid-bust", 0.97), ("under-bust", 0.9)]
    stages = worn_at(built("mannequin"), lines, line_contact=contact)
    before = points_of(stages)
    design = match_lengths(stages, before, {"mid-bust": STRAP, "full-bust": BAND})
    after = points_of(build(design, stages))
    for line in stages.model.lines:
        if line.constrains:
            assert line.length(after) == pytest.approx(line.length(before), rel=2e-5)
    assert design.ratio("under-bust") == 0.9
    assert design.ratio("mid-bust") < 0.75
    assert np.abs(after - before).max() < (0.5 if contact == "glued" else 2.0)


def test_the_elastic_pulls_as_the_line_did(built):
    stages = worn_at(built("mannequin"), [("mid-bust", 0.97)])
    before = points_of(stages)
    told = line_tensions(stages, before)["mid-bust"].mean
    made = build(match_lengths(stages, before, {"mid-bust": STRAP}), stages)
    row = cut_list(made, points_of(made)).rows[0]
    assert row.tension_n == pytest.approx(told, rel=0.05)


def test_lines_that_cannot_move_or_are_held_keep_their_lengths(built):
    ribs = worn_at(built("mannequin"), [("under-bust", 0.8)])
    assert match_lengths(ribs, points_of(ribs), {"under-bust": BAND}) == ribs.design.with_elastic(
        "under-bust", BAND
    )
    held = worn_at(built("mannequin"), [("mid-bust", 0.98)], line_hold="held")
    assert match_lengths(held, points_of(held), {"mid-bust": BAND}).lines == held.design.lines


@pytest.mark.parametrize(
    ("curve", "sentence"),
    [
        (
            ((0.0, 0.0), (0.3, 0.5)),
            "weak is too weak for mid-bust: .* mm too long at the maximum elongation, 30 %",
        ),
        (
            ((0.0, 0.0), (3.0, 6.0)),
            "weak is too weak for mid-bust: .* mm too long at the shortest cut length, 50 %",
        ),
    ],
)
def test_an_elastic_that_cannot_do_it_is_refused(built, curve, sentence):
    stages = worn_at(built("mannequin"), [("mid-bust", 0.95)])
    with pytest.raises(LineError, match=sentence):
        match_lengths(stages, points_of(stages), {"mid-bust": Elastic("weak", 10.0, curve)})


def test_the_command_cuts_for_the_shape_that_is_there(mannequin, capsys):
    words = ["cut", str(mannequin), "--line", "mid-bust=97%", "--json"]
    assert main(words) == 0
    bare = json.loads(capsys.readouterr().out)["rows"][0]
    assert main([*words, "--elastic", "mid-bust=strap 15", "--keep-fit"]) == 0
    row = json.loads(capsys.readouterr().out)["rows"][0]
    assert bare["cut_mm"] is None
    assert row["reached_front_mm"] == pytest.approx(bare["reached_front_mm"], rel=1e-4)
    assert row["cut_mm"] < 0.8 * row["reached_whole_mm"]


def test_lines_of_elastic_reach_the_same_where_the_body_keeps_its_volume(built):
    """Of the answer at the control mesh's volume the line reaches another length."""
    stages = worn_at(built("mannequin"), [("mid-bust", 0.96)], dense_volume=True)
    reached = []
    for each in (stages, build(exactly_as_worn(stages, {"mid-bust": STRAP}), stages)):
        points = each.model.tensegric.expand(exact_equilibrium(each).state.moved)
        reached += [line.length(points) for line in each.model.lines if line.name == "mid-bust"]
    assert reached[1] == pytest.approx(reached[0], rel=2e-5)


@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_a_line_of_elastic_becomes_one_of_the_model_again(built, contact):
    lines = [("full-bust", 0.985), ("mid-bust", 0.97)]
    stages = worn_at(built("mannequin"), lines, line_contact=contact)
    elastics = {"mid-bust": STRAP, "full-bust": BAND}
    made = build(exactly_as_worn(stages, elastics), stages)
    bare = exactly_as_worn(made, dict.fromkeys(elastics))
    assert bare.active_elastics() == {}
    assert bare.elastics == ()
    for name, ratio in lines:
        assert bare.ratio(name) == pytest.approx(ratio, abs=2e-4)


def test_a_linked_lines_stays_one_though_its_sides_are_uneven(built):
    stages = built("person")
    design = replace(stages.design, own_lines=ready_made_lines(read_template("168"))["straps"], lines=())
    design = design.with_line("strap left", 0.99).with_line("strap right", 0.99)
    made = exactly_as_worn(build(design, stages), {"strap left": STRAP, "strap right": STRAP})
    assert made.ratio("strap left") == made.ratio("strap right") < 0.85
    assert made.linked_lines("strap left") == ("strap left", "strap right")
    alone = exactly_as_worn(build(design, stages), {"strap left": STRAP})
    assert alone.ratio("strap right") == 0.99
    assert alone.ratio("strap left") < 0.85
