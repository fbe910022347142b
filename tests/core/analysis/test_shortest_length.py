"""How short a line can be made: against a scan of the slider, and where there is nothing to find."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from shapes import fitted, torso

from app.cli.main import main
from app.presenters.length_limits import legend_entries, tone_at
from core.analysis.length_limits.limits import PRECISION, SIGNS, all_limits, limits_from, limits_of
from core.analysis.length_limits.zones import length_limits_of
from core.errors import LineError
from core.garment.elastic_library import find_elastic
from core.mechanics.constraint_lines import RATIO_LIMITS
from core.mechanics.exact_solution import solve_exact
from core.mechanics.model import constrained_model
from core.mechanics.options import ModelOptions
from core.mechanics.solver_comparison import shape_of
from core.pipeline.build import build

WORN = ("mid-bust", "full-bust")
CHOICES = {
    "prestressed": ModelOptions(member_law="prestressed"),
    "co-rotated": ModelOptions(member_law="co-rotated"),
    "sliding": ModelOptions(line_contact="sliding"),
    "held": ModelOptions(line_hold="held"),
    "stiff": ModelOptions(line_stiffness=200.0),
    "firm": ModelOptions(firm_chest=0.1),
}


def model_of(sample, mechanics=None, worn=WORN):
    return constrained_model(fitted(sample), worn=worn, mechanics=mechanics)


def signs_at(model, ratios):
    """What an exact answer from rest shows."""
    balance = solve_exact(model, ratios)
    condition = shape_of(model).quality(model.tensegric.expand(balance.state.moved))
    return {sign for sign in SIGNS if getattr(condition, sign)} if balance.is_converged else {"no balance"}


def with_mid_bust(ratio, full_bust=1.0):
    return (1.0, float(ratio), full_bust)


@pytest.mark.parametrize("full_bust", [1.0, 0.9])
@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_a_scan_of_the_slider_finds_the_same_beginnings(sample, full_bust):
    model = model_of(sample)
    found = limits_from(model, with_mid_bust(0.97, full_bust), "mid-bust")
    scanned = {}
    for ratio in np.arange(1.0, RATIO_LIMITS[0] - 1e-9, -0.005):
        for sign in signs_at(model, with_mid_bust(ratio, full_bust)):
            scanned.setdefault(sign, ratio)
    assert scanned.keys() == {sign for sign in SIGNS if found.onsets[sign]}
    for sign, ratio in scanned.items():
        assert ratio - 1e-9 <= found.onsets[sign].ratio <= ratio + 0.005 + 1e-9
    assert found.last is None


@pytest.mark.parametrize("mechanics", CHOICES.values(), ids=CHOICES)
def test_each_sign_shows_at_its_beginning_and_not_a_little_above(mechanics):
    model = model_of("person", mechanics)
    found = limits_from(model, (1.0, 1.0, 1.0), "mid-bust")
    assert found.onsets["strained"].ratio > found.onsets["overstrained"].ratio
    for sign, begins in found.onsets.items():
        if begins:
            assert sign in signs_at(model, with_mid_bust(begins.ratio))
            assert sign not in signs_at(model, with_mid_bust(begins.ratio + PRECISION))
            line = next(line for line in model.lines if line.name == "mid-bust")
            points = model.tensegric.expand(solve_exact(model, with_mid_bust(begins.ratio)).state.moved)
            assert begins.reached == pytest.approx(line.length(points), abs=1e-4)


def test_a_held_line_reaches_what_is_set_and_ends_where_nothing_balances():
    model = model_of("mannequin", ModelOptions(line_contact="sliding", line_hold="held"), worn=["mid-bust"])
    found = limits_from(model, (1.0, 0.95, 1.0), "mid-bust")
    rest = found.line.rest_length
    for begins in (found.present, found.onsets["strained"], found.onsets["overstrained"], found.last):
        assert begins.reached == pytest.approx(begins.ratio * rest)
    assert 0.7 < found.last.ratio < found.onsets["overstrained"].ratio
    assert solve_exact(model, with_mid_bust(found.last.ratio + PRECISION)).is_converged
    assert not solve_exact(model, with_mid_bust(found.last.ratio - 2.0 * PRECISION)).is_converged


def test_a_setting_that_is_beyond_says_so():
    model = model_of("person")
    assert limits_from(model, with_mid_bust(0.98), "mid-bust").beyond == ()
    assert limits_from(model, with_mid_bust(0.92), "mid-bust").beyond == ("strained",)
    assert limits_from(model, with_mid_bust(0.85), "mid-bust").beyond == ("strained", "overstrained")
    assert limits_from(model, with_mid_bust(0.6), "mid-bust").beyond == SIGNS


def test_what_the_other_lines_do_begins_at_the_rest_length():
    found = limits_from(model_of("person"), (1.0, 1.0, 0.8), "mid-bust")
    assert found.onsets["strained"].ratio == found.onsets["overstrained"].ratio == 1.0
    assert found.onsets["inverted"].ratio < 0.9


def test_where_the_other_lines_leave_no_balance_nothing_is_told():
    model = model_of("mannequin", ModelOptions(line_contact="sliding", line_hold="held"))
    found = limits_from(model, (1.0, 0.95, 0.6), "mid-bust")
    assert not found.found
    assert (found.present, found.last, found.beyond) == (None, None, ())
    assert found.onsets == dict.fromkeys(SIGNS)


def test_a_line_on_the_rib_cage_has_no_limit():
    model = model_of("person", worn=["under-bust"])
    found = limits_from(model, (0.8, 1.0, 1.0), "under-bust")
    assert found.onsets == dict.fromkeys(SIGNS)
    assert (found.beyond, found.last) == ((), None)
    assert found.present.reached == pytest.approx(found.line.rest_length)


def test_the_torso_is_overstrained_later_with_a_softer_line():
    ends = []
    for stiffness in (200.0, 64.0, 16.0):
        model = constrained_model(
            torso(), worn=["mid-bust"], mechanics=ModelOptions(line_stiffness=stiffness)
        )
        ends.append(limits_from(model, (1.0, 1.0, 1.0), "mid-bust").onsets["overstrained"].ratio)
    assert ends[0] > ends[1] > ends[2]


def test_every_line_that_moves_anything_is_looked_at_worn_or_not(built):
    stages = built("mannequin")  # its mid-bust line is worn at 97 %
    mid, full = all_limits(stages)
    assert (mid.line.name, full.line.name) == WORN
    assert mid.present.ratio == 0.97
    assert full.present is None
    alone = constrained_model(fitted("mannequin"), worn=WORN)
    again = limits_from(alone, (1.0, 0.97, 1.0), "full-bust")
    assert full.onsets["strained"].ratio == pytest.approx(again.onsets["strained"].ratio, abs=PRECISION)


def test_the_command_prints_a_table_and_the_same_as_json(person, capsys):
    arguments = ["limits", str(person), "--line", "mid-bust=92%", "--line", "under-bust=95%"]
    assert main(arguments) == 0
    said = capsys.readouterr().out
    assert "Mid-bust, original length" in said
    assert "under-bust is on the rib cage" in said
    assert main([*arguments, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["lines"].keys() == set(WORN)
    line = found["lines"]["mid-bust"]
    assert line["present"]["set_percent"] == pytest.approx(92.0)
    assert (line["beyond"], line["no_balance_below"]) == (["strained"], None)
    assert [zone["tone"] for zone in line["zones"]] == ["red", "amber", "green", "slack"]
    green = next(zone for zone in line["zones"] if zone["tone"] == "green")
    assert re.search(rf"^  green: .* {green['from_percent']:.1f} to {green['to_percent']:.1f} %$", said, re.M)
    assert re.search(rf"^  slack: .* {green['to_percent']:.1f} %$", said, re.M)
    for sign in SIGNS:
        begins = line["begins"][sign]
        assert begins["reached_percent"] == pytest.approx(100.0 * begins["reached_mm"] / line["rest_mm"])
    assert found["lines"]["full-bust"]["present"] is None


def test_the_command_tells_where_an_elastic_presses_too_much(person, capsys):
    worn = ["--line", "mid-bust=90%", "--elastic", "mid-bust=strap 15", "--line", "full-bust=98%"]
    assert main(["limits", str(person), *worn]) == 0
    told = capsys.readouterr().out
    assert told.startswith("Verdict: Do not use\n"), "of what is set, whatever else may be"
    mid, full = told.split("Full bust, original length")
    assert re.search(r"^  amber: .*below 7\d\.\d %", mid, re.M)
    assert main(["limits", str(person), *worn, "--json"]) == 0
    lines = json.loads(capsys.readouterr().out)["lines"]
    assert {name: line["pressure_known"] for name, line in lines.items()} == {
        "mid-bust": True,
        "full-bust": False,
    }
    assert lines["mid-bust"]["elastic_ends"] is not None
    assert "green" in full


@pytest.mark.parametrize("words", [["--line", "wing=90%"], ["--settings", "a=b"]])
def test_the_command_says_in_one_sentence_what_is_wrong(person, capsys, words):
    assert main(["limits", str(person), *words]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_a_line_of_elastic_ends_where_a_shorter_one_is_refused(built, contact):
    stages = built("mannequin")
    strap = find_elastic("strap 15")
    design = replace(stages.design, line_contact=contact).with_line("mid-bust", 0.7)
    stages = build(design.with_elastic("mid-bust", strap), stages)
    limits = limits_of(stages, "mid-bust")
    end = limits.stretched
    rest = next(line.rest_length for line in stages.model.lines if line.name == "mid-bust")
    assert end.reached / (end.ratio * rest) - 1.0 == pytest.approx(strap.max_elongation, abs=PRECISION)
    assert build(stages.design.with_line("mid-bust", end.ratio + PRECISION), stages)
    with pytest.raises(LineError, match="the table of the elastic ends at 70 %"):
        build(stages.design.with_line("mid-bust", end.ratio - PRECISION), stages)
    told = length_limits_of(stages, "mid-bust")
    assert told.zones[0].reasons[0].why == "stretched"
    others = [span for sign, spans in limits.shows.items() if sign != "stretched" for span in spans]
    assert all(span.long.ratio > end.ratio for span in others), "nothing begins where a length is refused"
    assert told.red_below == end.ratio
    assert tone_at(told, 0.52) == "bad"
    assert "utside the elastic's curve below" in legend_entries(told)["red"]


def test_a_line_of_nothing_in_particular_ends_at_no_table(built):
    assert limits_of(built("mannequin"), "mid-bust").stretched is None
