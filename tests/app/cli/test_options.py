"""KEY=VALUE on the command line: every choice of the design, in hyphens or underscores."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest

from app.cli.design import settings_of
from app.cli.options import NUMBERS, SWITCHES, WORDS
from app.presenters.model_options import defaults
from core.document.design import Design, ScanSource
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
    ],
)
def test_settings_are_read_with_hyphens_and_underscores(pairs: list[str], fields: dict[str, object]) -> None:
    design = Design(ScanSource("a.ply"))
    assert replace(design, **settings_of(pairs)) == replace(design, **fields)


def test_every_choice_of_the_design_can_be_set() -> None:
    not_settings = {"scan", "placed", "lines", "own_lines", "own_measures", "traits", "volume", "unknown"}
    not_settings |= {"elastics", "customer", "worn_tight_mm", "calibration"}
    assert {*WORDS, *NUMBERS, *SWITCHES} == {field.name for field in fields(Design)} - not_settings


def test_every_model_option_is_in_the_design_and_in_the_window() -> None:
    options = {field.name: field.default for field in fields(ModelOptions)}
    saved = {field.name: field.default for field in fields(Design)}
    assert options.items() <= saved.items(), "give Design a field of the same name and default"
    assert options.keys() <= defaults().keys(), "describe it in groups() of app/presenters/model_options.py"
