"""The design: what it accepts, and that its text brings back the very same design."""

import json
from contextlib import suppress
from dataclasses import FrozenInstanceError, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_designs import KNOWN, PLAIN, anything, designs

from core.document.design import Design, ScanSource
from core.document.lines import CustomLine, LineSettings
from core.document.serialization import FORMAT, from_json, to_json
from core.errors import LineError, ProjectError, UserError
from core.pipeline.solve import NoEquilibriumError


@settings(deadline=None, max_examples=50)
@given(designs())
def test_text_brings_back_the_same_design(design):
    text = to_json(design)
    assert from_json(text) == design
    assert to_json(from_json(text)) == text
    text.encode("utf-8")


def test_what_is_written():
    values = json.loads(to_json(PLAIN.with_line("mid-bust", 0.97)))
    assert next(iter(values)) == "format"
    assert values["format"] == 1, "what has no variants, older programs can read"
    assert values["length_unit"] == "mm"
    assert values["lines"] == [{"name": "mid-bust", "ratio": 0.97}]
    assert values["scan"]["path"] == "/scans/body.ply"


def test_what_a_later_version_wrote_survives_an_edit():
    later = {**json.loads(to_json(PLAIN)), "straps": {"width": [12, 15]}, "note": "胸"}
    edited = from_json(json.dumps(later)).with_line("mid-bust", 0.95)
    written = json.loads(to_json(edited))
    assert written["straps"] == {"width": [12, 15]}
    assert written["note"] == "胸"
    assert written["lines"][0]["ratio"] == 0.95


def test_settings_that_an_earlier_version_did_not_have_take_their_defaults():
    early = {"format": 1, "scan": {"path": "a.ply"}, "lines": []}
    assert from_json(json.dumps(early)) == Design(ScanSource("a.ply"))


def test_a_newer_format_is_refused_with_what_to_do():
    newer = json.dumps({**json.loads(to_json(PLAIN)), "format": FORMAT + 1})
    with pytest.raises(ProjectError, match=f"format {FORMAT + 1}.*Update Busk"):
        from_json(newer)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "nonsense",
        "null",
        "[]",
        "[1, 2]",
        '"format"',
        "{}",
        '{"format": 1}',
        '{"format": "1"}',
        "[" * 100_000,
        "9" * 5000,
        to_json(PLAIN)[:-20],
        to_json(PLAIN) + "}",
    ],
)
def test_garbage_is_refused_in_a_sentence(text):
    with pytest.raises(ProjectError, match="cannot be read"):
        from_json(text)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("scan", None),
        ("scan", {"file": "a.ply"}),
        ("lines", 5),
        ("lines", [5]),
        ("lines", [{"name": "mid-bust"}]),
        ("lines", [{"name": "mid-bust", "ratio": None}]),
        ("lines", [{"name": "mid-bust", "ratio": 10**400}]),
        ("gain", "much"),
        ("gain", 10**400),
        ("line_height", [0.5]),
        ("line_stiffness", {}),
        ("template", "169"),
        ("template", ["168"]),
        ("volume", 1),
        ("weights", None),
        ("line_contact", "slipping"),
        ("line_hold", True),
        ("member_law", "soft"),
        ("line_force", None),
        ("volume_of", "left"),
        ("prestress", 0.0),
        ("firm_chest", "on"),
        ("scaled_normals", "yes"),
        ("dense_volume", 1),
        ("own_lines", {"name": "strap"}),
        ("own_lines", [{"name": "strap"}]),
        ("own_lines", [{"name": "", "points": [1, 2]}]),
        ("own_lines", [{"name": "strap", "points": [1]}]),
        ("own_lines", [{"name": "strap", "points": [1, 1]}]),
        ("own_lines", [{"name": "strap", "points": [1.5, 2]}]),
        ("own_lines", [{"name": "strap", "points": [1, 2, 3], "closed": "no"}]),
        ("own_lines", [{"name": "strap", "points": [1, 2]}, {"name": "strap", "points": [2, 3]}]),
    ],
)
def test_values_of_the_wrong_kind_are_refused_in_a_sentence(key, value):
    with pytest.raises(UserError) as refused:
        from_json(json.dumps({**json.loads(to_json(PLAIN)), key: value}))
    assert str(refused.value.message).endswith(".")
    assert refused.value.hint


@settings(deadline=None)
@given(
    st.text(max_size=60)
    | anything.map(json.dumps)
    | st.dictionaries(st.sampled_from(sorted(KNOWN)), anything).map(json.dumps)
)
def test_no_text_at_all_does_worse_than_a_refusal(text):
    # Any other error than a refusal fails this test.
    with suppress(UserError):
        assert isinstance(from_json(text), Design)


@pytest.mark.parametrize("ratio", [0.49, 1.31, -1.0, float("nan"), float("inf")])
def test_a_line_out_of_range_is_refused(ratio):
    with pytest.raises(LineError, match="mid-bust cannot be set"):
        PLAIN.with_line("mid-bust", ratio)


@pytest.mark.parametrize(
    "change",
    [
        {"line_height": 0.24},
        {"line_height": 0.76},
        {"line_stiffness": 0.0},
        {"line_stiffness": 501.0},
        {"gain": -0.1},
        {"gain": 11.0},
        {"gain": float("nan")},
        {"template": "200"},
        {"volume": "magic"},
        {"prestress": 0.09},
        {"firm_chest": 1.1},
        {"firm_chest": float("nan")},
        {"own_lines": (CustomLine("a", (1, 2)), CustomLine("a", (3, 4)))},
    ],
)
def test_settings_out_of_range_are_refused(change):
    with pytest.raises(UserError):
        replace(PLAIN, **change)


def test_lines_are_put_on_changed_and_taken_off():
    worn = PLAIN.with_line("mid-bust", 0.97).with_line("full-bust", 1.0).with_line("mid-bust", 0.9)
    assert [line.name for line in worn.lines] == ["full-bust", "mid-bust"]
    assert worn.ratio("mid-bust") == 0.9
    assert worn.active_lines() == {"mid-bust", "full-bust"}
    bare = worn.with_line("mid-bust", None)
    assert bare.active_lines() == {"full-bust"}
    assert bare.ratio("mid-bust") == 1.0
    assert PLAIN.lines == ()


def test_the_order_of_putting_on_makes_no_difference():
    one = PLAIN.with_line("a", 0.9).with_line("b", 0.8)
    two = PLAIN.with_line("b", 0.8).with_line("a", 0.9)
    assert one == two
    assert hash(one) == hash(two)


def test_a_design_cannot_be_changed():
    with pytest.raises(FrozenInstanceError):
        PLAIN.volume = "none"


def test_a_scan_is_called_by_its_file_name():
    assert ScanSource("/scans/body.ply").name == "body.ply"
    assert ScanSource("/customers/project.busk", member="scan/body.ply").name == "body.ply"


@pytest.mark.parametrize(
    ("force", "advice"), [("implicit", "closer to 100 %"), ("explicit", "implicit line forces")]
)
def test_a_length_that_cannot_be_held_comes_with_the_advice_that_helps(force, advice):
    design = replace(Design(ScanSource("a.ply")), line_hold="held", line_force=force)
    refusal = NoEquilibriumError(design.with_line("mid-bust", 0.7))
    assert "mid-bust cannot be fixed at 70.0 %" in str(refusal.message)
    assert advice in str(refusal.hint)


def test_a_locked_line_keeps_its_length_and_stays():
    own = PLAIN.with_custom_line(CustomLine("strap left", (35, 48))).with_line("strap left", 0.9)
    locked = own.with_line_settings(LineSettings("strap left", locked=True))
    with pytest.raises(LineError, match="locked"):
        locked.with_line("strap left", 0.8)
    with pytest.raises(LineError, match="locked"):
        locked.without_custom_line("strap left")
    assert locked.with_lines_reset().active_lines() == {"strap left"}
    assert not own.with_lines_reset().lines
    assert from_json(to_json(locked)) == locked
    assert locked.with_line_settings(LineSettings("strap left")) == own


def test_a_linked_line_shares_its_length():
    both = PLAIN.with_custom_line(CustomLine("strap left", (35, 48))).with_custom_line(
        CustomLine("strap right", (36, 49))
    )
    assert both.with_linked("strap right", 0.9).active_lines() == {"strap left", "strap right"}
    alone = both.with_line_settings(LineSettings("strap right", linked=False))
    assert alone.with_linked("strap right", 0.9).active_lines() == {"strap right"}
    assert PLAIN.with_linked("mid-bust", 0.9).active_lines() == {"mid-bust"}
    assert both.with_line("strap left", 0.9).linked_lines("strap left") == ("strap left",), (
        "it is not shared yet"
    )


def test_a_pair_is_linked_from_both_sides_and_its_lock_is_for_both():
    both = PLAIN.with_custom_line(CustomLine("strap left", (35, 48))).with_custom_line(
        CustomLine("strap right", (36, 49))
    )
    apart = both.with_line("strap left", 0.9).with_line("strap right", 0.9)
    apart = apart.with_line_settings(LineSettings("strap right", locked=True, linked=False))
    assert apart.linked_lines("strap left") == ("strap left",), "as seen from the other side"
    assert apart.with_line_settings(LineSettings("strap right", locked=True)).linked_lines("strap left") == (
        "strap left",
    )
    linked = apart.with_link("strap left")
    assert linked.linked_lines("strap left") == ("strap left", "strap right")
    assert linked.line_settings("strap left").locked
    assert apart.with_line("strap left", 0.8).with_link("strap right").ratio("strap left") == 0.9
    with pytest.raises(LineError, match="strap right is locked"):
        apart.with_line("strap left", 0.8).with_link("strap left")


@pytest.mark.parametrize(
    "wrong", [{"colour": "red"}, {"title": "a\nb"}, {"title": "x" * 61}, {"stiffness": 0.0}]
)
def test_traits_that_cannot_be_are_refused(wrong):
    with pytest.raises(LineError):
        LineSettings("mid-bust", **wrong)
