"""KEY=VALUE on the command line: every choice of the design, in hyphens or underscores."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest

from app.cli.design import cup_of, settings_of
from app.cli.options import NUMBERS, SWITCHES, WORDS
from app.presenters.model_options import defaults
from core.document.cup import CUP_RANGES, Cup
from core.document.design import Design, ScanSource
from core.document.lower_trunk import LOWER_RANGES, LOWER_SETTINGS, LowerTrunk
from core.errors import UserError
from core.mechanics.options import ModelOptions


@pytest.mark.parametrize(
    ("pairs", "fields"),
    [
        (["member-law=co_rotated", "prestress=0.7"], {"member_law": "co-rotated", "prestress": 0.7}),
        (["Member_Law=Prestressed"], {"member_law": "prestressed"}),
        (["line-force=explicit", "line-stiffness=0,2"], {"line_force": "explicit", "line_stiffness": 0.2}),
        (["line-contact=bonded", "line-hold=fixed"], {"line_contact": "glued", "line_hold": "held"}),
        (["line-contact=sliding", "line-hold=held"], {"line_contact": "sliding", "line_hold": "held"}),
        (["firm-chest=on"], {"firm_chest": 0.1}),
        (["firm-chest=free"], {"firm_chest": 0.0}),
        (["firm_chest=0.3", "volume-of=both"], {"firm_chest": 0.3, "volume_of": "both"}),
        (["weights=paper", "scaled-normals=yes"], {"weights": "paper", "scaled_normals": True}),
        (["dense-volume=on", "dense_volume=no"], {"dense_volume": False}),
        (["template=120", "line-height=0.6"], {"template": "120", "line_height": 0.6}),
        (["gain=1.2", "gain=auto"], {"gain": None}),
        (["tissue-stiffness=300"], {"tissue_stiffness": 300.0}),
        (
            ["belly-line-height=0.4", "lower_firmness=0,2", "waist_kept=1", "lower-stiffness=200"],
            {"lower": LowerTrunk(belly_height=0.4, firmness=0.2, waist_kept=1.0, stiffness=200.0)},
        ),
    ],
)
def test_settings_are_read_with_hyphens_and_underscores(pairs: list[str], fields: dict[str, object]) -> None:
    design = Design(ScanSource("a.ply"))
    assert design.with_settings(settings_of(pairs)) == replace(design, **fields)


def test_every_choice_of_the_design_can_be_set() -> None:
    not_settings = {"scan", "placed", "lines", "own_lines", "own_measures", "traits", "volume", "unknown"}
    not_settings |= {"elastics", "customer", "worn_tight_mm", "calibration", "cup", "lower", "pattern"}
    of_lower_trunk = {field.name for field in fields(LowerTrunk)} - {"lines", "traits"}
    assert set(LOWER_SETTINGS.values()) == set(LOWER_RANGES) == of_lower_trunk
    named = {*WORDS, *NUMBERS, *SWITCHES} - LOWER_SETTINGS.keys()
    assert named == {field.name for field in fields(Design)} - not_settings


def test_every_model_option_is_in_the_design_and_in_the_window() -> None:
    options = {field.name: field.default for field in fields(ModelOptions)}
    saved = {field.name: field.default for field in fields(Design)}
    assert options.items() <= saved.items(), "give Design a field of the same name and default"
    assert options.keys() <= defaults().keys(), "describe it in groups() of app/presenters/model_options.py"


def test_a_cup_is_read_key_by_key_and_changes_the_one_that_is_there() -> None:
    cup = cup_of("kind=moulded, lift=20,wire=yes,Wire-Width=1,1".replace("1,1", "1.1"), None)
    assert cup == Cup(lift=20.0, wire=True, wire_width=1.1)
    assert cup_of("gather=12", cup) == replace(cup, gather=12.0)
    assert cup_of("none", cup) is None
    every = ",".join(f"{key}={low}" for key, (low, _) in CUP_RANGES.items())
    assert cup_of(every, None) == Cup(**{key: low for key, (low, _) in CUP_RANGES.items()})


@pytest.mark.parametrize("text", ["lift", "lyft=3", "lift=high", "wire=perhaps", "kind=tin", "lift=400"])
def test_a_cup_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(UserError):
        cup_of(text, None)
