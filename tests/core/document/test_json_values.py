"""Whatever a project holds in the place of a value, it is read, or refused in a sentence."""

import copy
import json
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_designs import anything, designs

from core.document.calibration_record import Calibration, FittedParameter
from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.elastic import Elastic
from core.document.json_values import parsed, value_of
from core.document.lines import ActiveLine, CustomLine, LineSettings
from core.document.serialization import from_json, from_texts, to_json, to_texts
from core.errors import ProjectError, UserError
from core.landmarks.manual import PlacedMark

WHOLE = Design(
    ScanSource("", "scan/body.ply", "cm", "+z", "-y"),
    lines=(ActiveLine("strap", 0.9),),
    gain=0.5,
    own_lines=(CustomLine("strap", (1, 2, 3), closed=True),),
    traits=(LineSettings("strap", "Strap", "#e5536b", True, False, 3.0, 12.0, "plush"),),
    placed=(PlacedMark("bust_point_left", (1.0, 2.0, 3.0)),),
    own_measures=(CustomMeasurement("Ribs", "girth", ("waist_front",), 20.0),),
    elastics=(Elastic("plush", 12.0, ((0.0, 0.0), (0.5, 6.0)), 10.0, "measured", False),),
    tissue_stiffness=400.0,
    customer="Anna",
    worn_tight_mm=5.0,
    calibration=Calibration("worn.ply", 3.0, 1.0, (FittedParameter("tissue", 1.0, 2.0, 0.1, True),), 0.5),
    unknown={"later": {"a": [1]}},
)
ODD: tuple[Any, ...] = (
    None,
    True,
    7,
    10**400,
    1.5,
    1e300,
    "",
    "x" * 100_000,
    "\ud800\x1b\u202e",
    [],
    [[]],
    {},
    {"a": 1},
)


def places(value: Any) -> Iterator[tuple[Any, ...]]:
    """Yield the way to every value inside of a JSON value, by keys and numbers."""
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, each in inner:
        yield (key,)
        yield from ((key, *way) for way in places(each))


def with_value(values: Any, way: tuple[Any, ...], value: Any) -> Any:
    changed = copy.deepcopy(values)
    at = changed
    for key in way[:-1]:
        at = at[key]
    at[way[-1]] = value
    return changed


def test_any_value_in_any_place_of_a_design_is_read_or_refused() -> None:
    whole = json.loads(to_json(WHOLE))
    for way in places(whole):
        for odd in (*ODD, float("nan"), float("-inf")):
            # Any other error than a refusal fails this test.
            with suppress(UserError):
                read = from_json(json.dumps(with_value(whole, way, odd)))
                assert from_json(to_json(read)) == read, "what is read can be saved"


def test_any_value_in_any_place_of_the_variants_is_read_or_refused() -> None:
    document = Document.single(WHOLE).with_shown("B").with_design(replace(WHOLE, gain=0.7))
    texts = to_texts(document)
    variants = json.loads(texts["variants.json"])
    for way in places(variants):
        for odd in ODD:
            text = json.dumps(with_value(variants, way, odd))
            with suppress(UserError):
                read = from_texts({**texts, "variants.json": text})
                assert from_texts(to_texts(read)) == read


@settings(deadline=None, max_examples=60)
@given(designs(), anything, st.data())
def test_anything_in_any_place_of_any_design(design: Design, odd: Any, data: st.DataObject) -> None:
    values = json.loads(to_json(design))
    way = data.draw(st.sampled_from(list(places(values))))
    with suppress(UserError):
        read = from_json(json.dumps(with_value(values, way, odd)))
        assert from_json(to_json(read)) == read


@dataclass(frozen=True)
class _Part:
    name: str
    at: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class _Whole:
    parts: tuple[_Part, ...]
    count: int = 1
    level: float | None = None


def test_fields_take_their_types_and_their_defaults() -> None:
    read = value_of(_Whole, {"parts": [{"name": "a", "at": [1, 2.5]}], "later": 1}, "whole")
    assert read == _Whole((_Part("a", (1.0, 2.5)),))
    assert isinstance(read.parts[0].at[0], float)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        (3, "'whole' in this file is not an object."),
        ({}, "'whole.parts' is missing in this file."),
        ({"parts": {}}, "'whole.parts' in this file is not a list."),
        ({"parts": ["a"]}, r"'whole.parts[0]' in this file is not an object."),
        ({"parts": [{"name": 3}]}, "'whole.parts[0].name' in this file is not text."),
        (
            {"parts": [{"name": "a", "at": [1]}]},
            "'whole.parts[0].at' in this file is not a list of 2 values.",
        ),
        ({"parts": [{"name": "a", "at": [1, True]}]}, "'whole.parts[0].at[1]' in this file is not a number."),
        ({"parts": [], "count": 1.0}, "'whole.count' in this file is not a whole number."),
        ({"parts": [], "level": "high"}, "'whole.level' in this file is not a number."),
    ],
)
def test_the_sentence_names_the_field(values: Any, sentence: str) -> None:
    with pytest.raises(ProjectError) as refused:
        value_of(_Whole, values, "whole")
    assert str(refused.value.message) == sentence


@pytest.mark.parametrize("text", ["[" * 100_000, "{", "", "9" * 5000])
def test_what_is_no_json_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r".+"):
        parsed(text)


@pytest.mark.parametrize("text", ["NaN", "Infinity", "-Infinity", "1e999"])
def test_what_other_programs_would_not_read_is_no_number(text: str) -> None:
    with pytest.raises(ProjectError, match=r"whole\.level"):
        value_of(_Whole, parsed(f'{{"parts": [], "level": {text}}}'), "whole")
    later = to_json(WHOLE).replace('"later": {', f'"later": {{"b": {text},')
    with pytest.raises(ProjectError, match="cannot be read"):
        from_json(later)
