"""The cut list: lengths to cut and tensions, for springs, held lines and lines on the rib cage."""

import codecs
import csv
import io
import json
import re
from dataclasses import replace

import numpy as np
import pytest

from app.cli.main import main
from app.presenters.cut_list import as_table
from core.control_mesh.template import read_template
from core.document.elastic import Elastic
from core.document.line_notation import ready_made_lines
from core.document.lines import ActiveLine, CustomLine, LineSettings
from core.errors import LineError
from core.garment.cut_list import FAR, FRONT_ONLY, SLACK, cut_list
from core.garment.elastic_library import find_elastic, write_elastic
from core.garment.pressure import NOT_FOR_STRAPS
from core.garment.pressure_list import pressure_list
from core.garment.tension import line_tensions
from core.mechanics.exact_solution import solve_exact
from core.mechanics.force_units import newtons_per_unit
from core.mechanics.iteration import LineTargets, iterate
from core.pipeline.build import build
from core.pipeline.model_stages import line_targets
from core.pipeline.solve import solve

EDGE = Elastic("edge", 10.0, ((0.0, 0.0), (0.2, 0.8), (0.5, 1.8), (1.0, 4.0)), 15.0)
HOOKE = Elastic("straight", 10.0, ((0.0, 0.0), (1.0, 6.0)), 20.0, "manual", estimate=False)


def stages_of(stages, lines, elastics=(), **choices):
    design = replace(
        stages.design, lines=tuple(ActiveLine(*line) for line in lines), volume="exact", **choices
    )
    for name, elastic in elastics:
        design = design.with_elastic(name, elastic)
    return build(design, stages)


def listed(stages):
    """The cut list of the exact answer, its rows by line."""
    ratios = line_targets(stages.design, stages).ratios
    balance = solve_exact(stages.model, ratios)
    assert balance.is_converged
    points = stages.model.tensegric.expand(balance.state.moved)
    cuts = cut_list(stages, points)
    return cuts, {row.line: row for row in cuts.rows}, points, balance


def line_of(stages, name):
    return next(line for line in stages.model.lines if line.name == name)


def test_a_straight_elastic_is_cut_as_the_formula_says(built):
    stages = stages_of(built("mannequin"), [("mid-bust", 0.7)], [("mid-bust", HOOKE)])
    _, rows, points, _ = listed(stages)
    row, line = rows["mid-bust"], line_of(stages, "mid-bust")
    front = line.length(points)
    elongation = front / (0.7 * line.rest_length) - 1.0
    assert (row.reached_front_mm, row.reached_whole_mm) == (front, front + line.back_length)
    assert row.elongation == pytest.approx(elongation, rel=1e-12)
    assert row.tension_n == pytest.approx(6.0 * elongation, rel=1e-12)
    # The front of the piece is the natural length that was set; its back is stretched as far.
    natural = 0.7 * line.rest_length + line.back_length / (1.0 + elongation)
    assert row.cut_mm == pytest.approx(natural + 20.0, rel=1e-12)
    assert row.closed
    assert not row.estimate


@pytest.mark.parametrize(("ratio", "far"), [(0.8, False), (0.6, True)])
def test_an_elastic_near_the_end_of_its_table_is_told(built, ratio, far):
    stages = stages_of(built("mannequin"), [("mid-bust", ratio)], [("mid-bust", find_elastic("strap 15"))])
    _, rows, _, _ = listed(stages)
    row = rows["mid-bust"]
    assert (row.elongation > FAR * 0.7, row.far) == (far, far)
    assert any("the table ends at 70 %): 30 to 50 % is usual" in str(note) for note in row.notes) == far


@pytest.mark.parametrize("list_of", [cut_list, pressure_list])
@pytest.mark.parametrize("hold", ["spring", "held"])
@pytest.mark.parametrize("place", [np.nan, np.inf, 0.0])
def test_points_that_are_no_shape_are_refused(built, list_of, hold, place):
    stages = stages_of(built("mannequin"), [("mid-bust", 0.7)], [("mid-bust", HOOKE)], line_hold=hold)
    with pytest.raises(LineError, match="solver diverged"):
        list_of(stages, np.full_like(stages.control.mesh.vertices, place))


@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_the_tension_listed_is_that_of_the_model_s_springs(built, contact):
    stages = stages_of(built("mannequin"), [("mid-bust", 0.7)], [("mid-bust", EDGE)], line_contact=contact)
    _, rows, points, _ = listed(stages)
    tension = line_tensions(stages, points)["mid-bust"]
    assert tension.mean == pytest.approx(rows["mid-bust"].tension_n, rel=1e-6)
    assert tension.segments.min() < tension.mean < tension.segments.max()
    assert not tension.estimate


@pytest.mark.parametrize("contact", ["glued", "sliding"])
@pytest.mark.parametrize("volume_of", ["each", "both"])
def test_the_tension_of_held_lines_is_the_multiplier_of_the_exact_answer(built, contact, volume_of):
    choices = {"line_hold": "held", "line_contact": contact, "volume_of": volume_of}
    stages = stages_of(built("mannequin"), [("full-bust", 0.98), ("mid-bust", 0.98)], **choices)
    _, _, points, balance = listed(stages)
    unit = newtons_per_unit(stages.model, 530.0)
    for at, line in enumerate(stages.model.lines):
        if line.name in stages.design.active_lines():
            tension = line_tensions(stages, points)[line.name]
            assert tension.mean == pytest.approx(unit * balance.tensions[at], rel=1e-6)
            assert np.ptp(tension.segments) == 0.0


def test_turns_without_a_force_on_the_volume_balance_held_lines_alone(built):
    stages = stages_of(built("mannequin"), [("mid-bust", 0.98)], line_hold="held")
    stages = build(replace(stages.design, volume="none"), stages)
    targets = LineTargets(line_targets(stages.design, stages).ratios, "none")
    *_, (state, _) = iterate(stages.model, lambda: targets, turns=2000)
    at = [line.name for line in stages.model.lines].index("mid-bust")
    points = stages.model.tensegric.expand(state.moved)
    told = newtons_per_unit(stages.model, 530.0) * state.tensions[at]
    assert line_tensions(stages, points)["mid-bust"].mean == pytest.approx(told, rel=1e-4)


def test_a_held_line_is_cut_for_its_tension(built):
    stages = stages_of(built("mannequin"), [("mid-bust", 0.985)], [("mid-bust", EDGE)], line_hold="held")
    _, rows, points, _ = listed(stages)
    row = rows["mid-bust"]
    assert row.tension_n == pytest.approx(line_tensions(stages, points)["mid-bust"].mean, rel=1e-12)
    assert EDGE.force(row.elongation) == pytest.approx(row.tension_n, rel=1e-12)
    assert row.cut_mm == pytest.approx(row.reached_whole_mm / (1.0 + row.elongation) + 15.0)


@pytest.mark.parametrize(
    ("ratio", "note"),
    [(0.9, "requires .* N for mid-bust; the table of the elastic ends at 4 N"), (1.03, "^Slack: ")],
)
def test_a_held_line_that_no_elastic_can_hold_says_so(built, ratio, note):
    stages = stages_of(built("mannequin"), [("mid-bust", ratio)], [("mid-bust", EDGE)], line_hold="held")
    _, rows, _, _ = listed(stages)
    assert rows["mid-bust"].cut_mm is None
    assert any(re.search(note, str(each)) for each in rows["mid-bust"].notes)


def test_a_line_on_the_rib_cage_is_cut_for_its_own_length(built):
    stages = stages_of(built("mannequin"), [("under-bust", 0.8)], [("under-bust", EDGE)])
    _, rows, _, _ = listed(stages)
    row, line = rows["under-bust"], line_of(stages, "under-bust")
    assert not line.constrains
    assert row.elongation == pytest.approx(0.25, rel=1e-9)
    assert row.tension_n == pytest.approx(EDGE.force(0.25), rel=1e-9)
    assert row.cut_mm == pytest.approx(0.8 * line.whole_length + 15.0, rel=1e-9)


def test_a_held_line_on_the_rib_cage_is_not_refused_and_has_no_known_tension(built):
    short = Elastic("short", 10.0, ((0.0, 0.0), (0.3, 2.0)))
    stages = stages_of(built("mannequin"), [("under-bust", 0.6)], [("under-bust", short)], line_hold="held")
    _, rows, _, _ = listed(stages)
    assert (rows["under-bust"].tension_n, rows["under-bust"].cut_mm) == (None, None)
    assert any("unknown" in str(note) for note in rows["under-bust"].notes)


def test_an_open_line_is_its_own_whole_and_a_ring_is_closed(built):
    path = built("mannequin").control.paths["mid-bust"]
    own = (CustomLine("arc", tuple(path[2:-2])),)
    stages = stages_of(built("mannequin"), [("arc", 0.8)], own_lines=own)
    stages = stages_of(stages, [("arc", 0.8)], [("arc", EDGE)])
    _, rows, _, _ = listed(stages)
    row = rows["arc"]
    assert (row.closed, row.front_only) == (False, False)
    assert row.reached_whole_mm == row.reached_front_mm
    assert row.cut_mm == pytest.approx(0.8 * line_of(stages, "arc").rest_length + 15.0, rel=1e-12)


def test_a_piece_that_goes_on_beyond_the_control_mesh_is_told_from_a_whole_one(built):
    stages = built("mannequin")
    template = read_template("168")
    ready = ready_made_lines(template)
    upright = CustomLine(
        "upright", tuple(template.point(row, 3) for row in range(1, 4))
    )  # from the under-bust
    chest = tuple(replace(strap, over_shoulder=False) for strap in ready["straps"])
    own = (*chest, *ready["rings"], upright)
    worn = [(line.name, 0.98) for line in own]
    stages = stages_of(stages, [("mid-bust", 0.97), *worn], [("strap left", EDGE)], own_lines=own)
    _, rows, points, _ = listed(stages)
    assert {name for name, row in rows.items() if row.front_only} == {"strap left", "strap right"}
    pressed = {row.line for row in pressure_list(stages, points).rows if NOT_FOR_STRAPS in row.notes}
    assert pressed == {"strap left", "strap right"}  # the light was not made for them
    assert {name for name, row in rows.items() if FRONT_ONLY in row.notes} == {"strap left", "strap right"}


def test_a_strap_is_cut_as_long_as_it_is_over_the_shoulder(built):
    own = ready_made_lines(read_template("168"))["straps"]
    stages = stages_of(built("mannequin"), [("strap left", 0.9)], [("strap left", EDGE)], own_lines=own)
    _, rows, points, _ = listed(stages)
    row, line, tail = rows["strap left"], line_of(stages, "strap left"), stages.tails["strap left"]
    assert 350.0 < tail.length < 600.0
    front = np.linalg.norm(np.diff(line.places(points), axis=0), axis=1).sum()
    assert row.reached_whole_mm == pytest.approx(front + tail.length, rel=1e-12)
    # All of it is stretched: as long unstretched as the slider tells, wherever the body lets it go.
    rest = np.linalg.norm(np.diff(line.places(stages.control.mesh.vertices), axis=0), axis=1).sum()
    assert row.cut_mm == pytest.approx(0.9 * (rest + tail.length) + 15.0, rel=1e-12)
    assert not row.front_only
    assert any("over the shoulder" in str(note) for note in row.notes)
    [pressed] = [each for each in pressure_list(stages, points).rows if each.line == "strap left"]
    assert NOT_FOR_STRAPS in pressed.notes


def test_a_slack_elastic_is_listed_as_slack(built):
    stages = stages_of(built("mannequin"), [("mid-bust", 1.05)], [("mid-bust", EDGE)])
    _, rows, _, _ = listed(stages)
    row = rows["mid-bust"]
    assert (row.elongation, row.tension_n, row.slack) == (0.0, 0.0, True)
    assert SLACK in row.notes


def test_a_line_of_nothing_in_particular_has_a_tension_and_asks_for_an_elastic(built):
    stages = stages_of(built("mannequin"), [("mid-bust", 0.97)])
    traits = LineSettings("mid-bust", title="Middle")
    cuts, rows, points, _ = listed(build(stages.design.with_line_settings(traits), stages))
    row = rows["mid-bust"]
    assert (row.title, row.elastic, row.cut_mm, row.estimate) == ("Middle", "", None, True)
    assert row.tension_n == pytest.approx(line_tensions(stages, points)["mid-bust"].mean)
    # A line about as stiff as a held one carries newtons, not grams and not stones.
    assert 1.0 < row.tension_n < 20.0
    assert any("choose one" in str(note) for note in row.notes)
    assert cuts.newtons_per_unit == pytest.approx(newtons_per_unit(stages.model, 530.0))
    assert len(cuts.notes) == 1


def test_the_list_says_what_it_rests_on(built):
    stages = stages_of(built("mannequin"), [("mid-bust", 0.7)], [("mid-bust", EDGE)], tissue_stiffness=300.0)
    cuts, _, _, _ = listed(stages)
    told = " ".join(map(str, cuts.notes))
    assert "300 N per m" in told
    assert "edge is an estimate" in told
    assert "back of a band" in told
    assert f"includes {EDGE.allowance_mm:g} mm seam allowance" in told
    assert json.loads(json.dumps(cuts.as_data()))["rows"][0]["elastic"] == "edge"


COMMAND = ["--line", "mid-bust=70%", "--line", "under-bust=80%", "--elastic", "mid-bust=picot 10"]
COMMAND += ["--settings", "tissue_stiffness=400"]


def test_the_command_prints_what_python_says(mannequin, built, capsys, tmp_path):
    write_elastic(tmp_path / "roll.csv", EDGE)
    assert (tmp_path / "roll.csv").read_bytes().startswith(codecs.BOM_UTF8), "spreadsheets know its letters"
    words = ["cut", str(mannequin), *COMMAND, "--elastic", f"under-bust={tmp_path / 'roll.csv'}"]
    assert main([*words, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    lines = [("mid-bust", 0.7), ("under-bust", 0.8)]
    made = [("mid-bust", find_elastic("picot 10")), ("under-bust", EDGE)]
    stages = stages_of(built("mannequin"), lines, made, tissue_stiffness=400.0)
    stages = build(replace(stages.design, volume="adaptive"), stages)
    by_hand = cut_list(stages, solve(stages).control_points)
    assert told["rows"] == json.loads(json.dumps(by_hand.as_data()))["rows"]
    assert told["tissue_stiffness"] == 400.0
    assert main([*words, "--csv", "--out", str(tmp_path / "cut.csv")]) == 0
    rows = list(csv.DictReader(io.StringIO((tmp_path / "cut.csv").read_text())))
    assert [row["line"] for row in rows] == [row["line"] for row in told["rows"]]
    assert float(rows[0]["cut_mm"]) == pytest.approx(told["rows"][0]["cut_mm"], rel=1e-5)
    assert main(words) == 0
    plain = capsys.readouterr().out
    assert f"{told['rows'][1]['cut_mm']:.1f}" in plain
    assert "Forces in N are estimates" in plain


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "No active lines"),
        (["--line", "mid-bust=70%", "--elastic", "waist=picot 10"], "is not an active line.*: mid-bust"),
        (["--line", "mid-bust=70%", "--elastic", "mid-bust=rope"], "No elastic matches 'rope'"),
        (["--line", "mid-bust=52%", "--elastic", "mid-bust=strap 10"], "elongation .*ends at 70 %"),
    ],
)
def test_what_cannot_be_cut_is_said_in_a_sentence(mannequin, capsys, words, sentence):
    assert main(["cut", str(mannequin), *words]) == 2
    assert re.search(sentence, capsys.readouterr().err)


def test_the_list_leaves_in_the_order_of_the_window_with_what_presses(built):
    lines = [("under-bust", 0.8), ("mid-bust", 0.98), ("full-bust", 0.98)]
    stages = stages_of(built("mannequin"), lines, [("under-bust", EDGE)])
    cuts, _, points, _ = listed(stages)
    pressed = pressure_list(stages, points)
    heading, *rows = as_table(stages, cuts, pressed)
    assert [row[0] for row in rows] == ["Full bust", "Mid-bust", "Under-bust"]
    most = {row.line: f"{row.max_kpa:.1f}" for row in pressed.rows}
    at = heading.index("Maximum contact pressure kPa")
    assert [row[at] for row in rows] == [most[name] for name in ("full-bust", "mid-bust", "under-bust")]
    assert {row[at] for row in as_table(stages, cuts, None)[1:]} == {""}
    told = dict(zip([row.line for row in cuts.rows], [row.estimate for row in cuts.rows], strict=True))
    at = heading.index("Estimate")
    assert [row[at] == "yes" for row in rows] == [
        told[name] for name in ("full-bust", "mid-bust", "under-bust")
    ]
