"""Presets: each that is shipped can be worn, own ones are saved and read, broken files say what is wrong."""

import json
from dataclasses import replace

import pytest

from core.control_mesh.template import read_template
from core.document.cup import Cup
from core.document.line_notation import format_path, ready_made_lines
from core.document.lines import CustomLine, LineSettings
from core.errors import LineError
from core.garment.elastic_library import find_elastic
from core.garment.presets import (
    FORMAT,
    Preset,
    PresetLine,
    built_in,
    is_active,
    preset_from,
    preset_of,
    read_preset,
    save_preset,
    user_folder,
    user_presets,
    with_preset,
)
from core.mechanics.exact_solution import solve_exact
from core.mechanics.solver_comparison import shape_of
from core.pipeline.build import build
from core.pipeline.model_stages import line_targets

GOOD = {"format": FORMAT, "title": "X", "lines": [{"line": "mid-bust", "length": 0.97}]}


LINES = [each for each in built_in() if not each.tissue]


@pytest.mark.parametrize("sample", ["mannequin", "person"])
@pytest.mark.parametrize("preset", LINES, ids=lambda each: each.title)
def test_every_preset_of_lines_can_be_worn(preset, sample, built):
    stages = built(sample)
    bare = replace(stages.design, lines=())
    design = with_preset(bare, preset)
    assert preset.leaves_out
    assert with_preset(design, preset) == design
    worn = build(design, stages)
    balance = solve_exact(worn.model, line_targets(design, worn).ratios)
    assert balance.is_converged
    condition = worn_condition(worn, balance)
    shown = [sign for sign in ("overstrained", "folded", "inverted") if getattr(condition, sign)]
    assert shown == []


def worn_condition(stages, balance):
    return shape_of(stages.model).quality(stages.model.tensegric.expand(balance.state.moved))


def test_a_preset_takes_other_lines_off_but_keeps_them_and_leaves_locked_ones(built):
    left, right = ready_made_lines(read_template("168"))["slings"]
    design = replace(built("mannequin").design, lines=()).with_custom_line(left).with_custom_line(right)
    design = design.with_line("sling left", 0.9).with_line("full-bust", 0.95).with_line("mid-bust", 0.92)
    design = design.with_line_settings(LineSettings("mid-bust", locked=True))
    after = with_preset(
        design,
        Preset("X", (PresetLine("full-bust", length=0.98, width=9.0), PresetLine("mid-bust", length=0.99))),
    )
    assert after.active_lines() == {"full-bust", "mid-bust"}
    assert (after.ratio("full-bust"), after.ratio("mid-bust")) == (0.98, 0.92)
    assert after.own_lines == design.own_lines
    assert after.line_settings("full-bust").width == 9.0


def test_a_ready_made_line_stays_as_it_was_led_and_one_through_places_goes_through_them(built):
    template = read_template("168")
    left, right = ready_made_lines(template)["straps"]
    led = CustomLine("strap left", left.points[1:])
    design = replace(built("mannequin").design, lines=()).with_custom_line(led).with_custom_line(right)
    after = with_preset(design, Preset("X", (PresetLine("straps", length=0.95),)))
    assert after.own_lines == design.own_lines
    assert after.ratio("strap left") == 0.95
    through = PresetLine("strap left", format_path(left, template))
    assert with_preset(design, Preset("X", (through,), template="168")).own_lines == (left, right)


def test_the_lines_of_a_design_come_back_from_their_preset(built, monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    bare = replace(built("mannequin").design, lines=())
    design = (
        bare.with_custom_line(CustomLine("v", (81, 45, 87))).with_line("v", 0.95).with_line("mid-bust", 0.97)
    )
    design = design.with_custom_line(CustomLine("ring", (34, 35, 49, 48), closed=True))
    traits = LineSettings("v", title="My V", colour="#112233", width=7.5, stiffness=4.0)
    design = design.with_line_settings(traits)
    for line, ratio in zip(ready_made_lines(read_template("168"))["straps"], (0.95, 0.9), strict=True):
        design = design.with_custom_line(line).with_line(line.name, ratio)
        design = design.with_line_settings(LineSettings(line.name, linked=False))
    save_preset(preset_from(design, "Mine / ours"))
    (preset,), problems = user_presets()
    assert (preset.title, problems) == ("Mine / ours", [])
    assert with_preset(bare, preset) == design
    with pytest.raises(LineError, match="168-polygon control mesh"):
        with_preset(replace(bare, template="120"), preset)
    (user_folder() / "broken.json").write_text("{", encoding="utf-8")
    presets, problems = user_presets()
    assert (len(presets), len(problems)) == (1, 1)
    assert str(problems[0].message).startswith("The preset broken.json cannot be read")
    with pytest.raises(LineError, match="no lines"):
        preset_from(bare, "none")


def test_a_preset_holds_elastics_of_the_library_cups_and_their_tissue(built):
    bare = replace(built("mannequin").design, lines=())
    cup = Cup(lift=20.0, gather=12.0, wire=True)
    made = replace(bare, tissue="solid", cup=cup).with_line("mid-bust", 0.9)
    made = made.with_elastic("mid-bust", find_elastic("strap 15"))
    preset = preset_of(save_preset(preset_from(made, "Mine")).read_text(encoding="utf-8"))
    assert with_preset(bare, preset) == made
    assert is_active(made, preset)
    assert not is_active(replace(made, cup=None), preset)
    assert with_preset(made, Preset("X", (PresetLine("mid-bust", "", 0.97),))) == replace(
        bare, tissue="solid"
    ).with_line("mid-bust", 0.97)


def test_a_preset_of_lines_alone_is_written_as_older_versions_read_it(built):
    design = replace(built("mannequin").design, lines=()).with_line("mid-bust", 0.97)
    values = json.loads(save_preset(preset_from(design, "Lines")).read_text(encoding="utf-8"))
    assert values["format"] == 1
    assert not {"cup", "tissue"} & values.keys()
    assert "elastic" not in values["lines"][0]


def test_an_elastic_that_is_not_in_the_library_is_no_part_of_a_preset(built):
    mine = replace(find_elastic("strap 15"), name="Mine 15 mm")
    design = replace(built("mannequin").design, lines=()).with_line("mid-bust", 0.9)
    with pytest.raises(LineError, match="not in the library"):
        preset_from(design.with_elastic("mid-bust", mine), "Mine")


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"format": 9}, "format 3"),
        ({"lines": []}, "title and lines"),
        ({"title": " "}, "title and lines"),
        ({"lines": [{"line": "waste"}]}, "no line 'waste'"),
        ({"lines": [{"line": "mid-bust", "length": 3.0}]}, "300.0 %"),
        ({"lines": [{"line": "mid-bust", "colour": "red"}]}, "'red' is not a colour"),
        ({"lines": [{"line": "mid-bust", "width": 900}]}, "900 mm"),
        ({"lines": [{"line": "mid-bust", "length": 0.9, "elastic": "rubber"}]}, "No elastic matches"),
        ({"cup": {"lift": 900.0}}, "cup lift 900 is out of range"),
        ({"cup": {"kind": "tin"}}, "no cup 'tin'"),
        ({"lines": [{"line": "a", "places": "r99c0,r1c0"}]}, "no position 'r99c0'"),
        ({"lines": [{"line": "mid-bust", "length": "0.9"}]}, "TypeError"),
        ({"lines": [{"line": "mid-bust", "length": [1]}]}, "TypeError"),
        ({"lines": [{"line": "mid-bust", "width": {}}]}, "TypeError"),
        ({"lines": [{"line": "mid-bust", "stiffness": True}]}, "TypeError"),
        ({"lines": [{"line": "straps", "linked": "no"}]}, "TypeError"),
        ({"lines": [{"name": "mid-bust"}]}, "TypeError"),
        ({"lines": 3}, "TypeError"),
        ({"template": "9"}, "no template"),
    ],
)
def test_a_broken_preset_says_what_is_wrong(change, why, tmp_path):
    path = tmp_path / "x.json"
    path.write_text(json.dumps(GOOD | change), encoding="utf-8")
    with pytest.raises(LineError, match=f"x.json cannot be read[.:] .*{why}"):
        read_preset(path)
    assert preset_of(json.dumps(GOOD)).lines == (PresetLine("mid-bust", length=0.97),)
