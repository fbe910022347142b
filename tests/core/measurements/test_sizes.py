"""Sizes: every worked example of the sources, and what must hold for every pair of girths."""

import json
import re
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import SizeError
from core.measurements.size_table import BAND
from core.measurements.sizes import built_in, size, sizes, sizes_text
from core.messages import plain

TABLES = {table.key: table for table in built_in()}
every_table = pytest.mark.parametrize("table", built_in(), ids=lambda table: table.key)
underbusts, differences = st.floats(450.0, 1500.0), st.floats(-60.0, 480.0)


def made(key, underbust, bust, allowance_mm=0.0):
    """Return the size of two girths in the unit of a table."""
    table = TABLES[key]
    return size(table, underbust * table.unit_mm, bust * table.unit_mm, allowance_mm)


@pytest.mark.parametrize(
    ("key", "underbust", "bust", "label"),
    [
        ("jp", 65, 80, "C65"),
        ("jp", 70, 85, "C70"),
        ("eu", 87, 107, "85D"),
        ("eu", 89, 108, "90D"),
        ("eu", 82, 100, "80C"),
        ("fr", 70, 83, "85A"),
        ("fr", 70, 85, "85B"),
        ("fr", 75, 90, "90B"),
        ("it", 70, 85, "2B"),
        ("it", 70, 90, "2D"),
        ("au", 65, 78, "8A"),
        ("au", 70, 83, "10A"),
        ("au", 70, 85, "10B"),
        ("au", 80, 93, "14A"),
        ("au", 75, 96, "12DD"),
        ("uk", 34, 38, "34D"),
        ("uk", 32, 34, "32B"),
        ("uk", 32, 35, "32C"),
        ("us", 34, 38, "34D"),
        ("us", 38, 43, "38DD"),
    ],
)
def test_worked_examples_of_the_sources_come_out(key, underbust, bust, label):
    answer = made(key, underbust, bust)
    assert answer.label == label
    assert (underbust, bust, label) in [(x.underbust, x.bust, x.size) for x in TABLES[key].examples]


@pytest.mark.parametrize(
    ("key", "underbust", "band"),
    [
        *[("eu", 60 + 5 * i + off, str(60 + 5 * i)) for i in range(17) for off in (-2, 2)],
        *[("fr", 60 + 5 * i, str(75 + 5 * i)) for i in range(17)],
        *[("it", 60 + 5 * i, str(i)) for i in range(17)],
        *[("au", 65 + 5 * i, str(8 + 2 * i)) for i in range(9)],
        *[("jp", 60 + 5 * i + off, str(60 + 5 * i)) for i in range(11) for off in (-2.4, 2.4)],
        ("uk", 33, "34"),
        ("us", 27, "28"),
        ("us", 28.99, "28"),
        ("us", 29, "30"),
        ("us", 31, "32"),
    ],
)
def test_bands_are_those_that_the_sources_list(key, underbust, band):
    assert made(key, underbust, underbust + 5).band == band


@pytest.mark.parametrize(
    ("key", "differences", "cups"),
    [
        ("jp", [5 + 2.5 * i for i in range(11)], "AAA AA A B C D E F G H I"),
        ("jp", [6.5, 8.5, 9, 11, 11.5, 13.5, 14, 16, 29, 31], "AA AA A A B B C C I I"),
        ("eu", [12, 14, 16, 18, 20, 22, 24, 26, 28], "AA A B C D E F G H"),
        ("fr", [12, 14, 16, 18, 20], "AA A B C D"),
        ("it", [13, 15, 17, 19, 21, 23], "A B C D E F"),
        ("au", [13, 15, 17, 19, 21, 23, 25, 27], "A B C D DD E F G"),
        ("uk", range(13), "AA A B C D DD E F FF G GG H HH"),
        ("us", range(11), "AA A B C D DD DDD G H I J"),
    ],
)
def test_cups_are_those_that_the_sources_list(key, differences, cups):
    middle = TABLES[key].bands.steps[2].middle
    assert [made(key, middle, middle + over).cup for over in differences] == cups.split()


def test_the_rule_is_told_with_the_numbers_put_in():
    answer = made("jp", 72.3, 87.1)
    assert tuple(map(str, answer.rule)) == (
        "Under-bust 72.3 cm: band 70 (67.5 to 72.5).",
        "Bust minus under-bust 14.8 cm: cup C (13.75 to 16.25).",
    )
    gap = made("jp", 70, 81.3)
    assert gap.label == "B70"
    assert tuple(map(str, gap.rule[1:])) == (
        "Bust minus under-bust 11.3 cm: cup B (11.25 to 13.75).",
        "The size chart lists 11.5 to 13.5 for B; intermediate values use the nearest step.",
    )
    assert "The size chart lists 3 for C" in str(made("uk", 32, 35.2).rule[-1])


@pytest.mark.parametrize("key", ["jp", "eu", "fr", "it", "au"])
def test_the_borders_that_are_told_are_as_far_as_the_neighbours(key):
    answer = made(key, 71.1, 83.57)
    rules = [
        re.findall(r"\((.*) to (.*)\)", each)[0]
        for each in map(str, answer.rule)
        if ": cup " in each or ": band " in each
    ]
    told = [float(end) for ends in rules for end in ends]
    away = [each.missing_mm * (1 if each.up else -1) / 10 for each in answer.neighbours]
    assert told == pytest.approx([71.1 + away[0], 71.1 + away[1], 12.47 + away[2], 12.47 + away[3]])


def test_both_neighbours_are_told_with_what_is_missing():
    told = {(each.part, each.up): (each.label, each.missing_mm) for each in made("jp", 72.3, 87.1).neighbours}
    assert {key: (label, pytest.approx(mm)) for key, (label, mm) in told.items()} == {
        ("band", False): ("E65", 48.0),
        ("band", True): ("C75", 2.0),
        ("cup", False): ("B70", 10.5),
        ("cup", True): ("D70", 14.5),
    }


def test_sister_sizes_are_those_of_the_sources():
    line = ["30D", "32C", "34B", "36A"]
    for key in ("uk", "us"):
        answers = [made(key, band, band + over) for band, over in ((30, 4), (32, 3), (34, 2), (36, 1))]
        assert [each.label for each in answers] == line
        for low, high in pairwise(answers):
            assert (low.sisters[-1].label, high.sisters[0].label) == (high.label, low.label)
    assert [each.label for each in made("jp", 70, 85).sisters] == ["D65", "B75"]


def test_where_others_find_quite_another_size_a_few_words_say_so():
    told = {key: sizes_text(answer, "en")["caution"] for key, answer in sizes(720.0, 870.0).items()}
    assert {key for key, caution in told.items() if caution} == {"uk", "us", "it", "au"}
    assert sizes_text(made("uk", 28, 34), "ja")["caution"] == "4インチ加算なし"
    for table in TABLES.values():
        assert table.caution is None or (table.doubts and len(table.caution.en) < 20), (
            "it stands beside a size"
        )


def test_what_a_tight_tape_takes_off_is_told():
    answer = made("eu", 68.2, 84, 10.0)
    assert answer.label == "65C"
    assert str(answer.rule[0]) == "Under-bust 68.2 cm minus tape tension allowance 1 cm: 67.2 cm."
    assert (answer.allowance_mm, answer.underbust_mm) == (10.0, 682.0)
    assert made("eu", 68.2, 84).label == "70B"
    assert not any("tape tension" in str(sentence) for sentence in made("eu", 68.2, 84).rule)
    for wrong in (-0.1, 20.1, float("nan")):
        with pytest.raises(SizeError, match="Enter a value from 0 to 20"):
            made("eu", 68.2, 84, wrong)


@pytest.mark.parametrize(
    ("key", "underbust", "bust", "why", "nearest"),
    [
        ("jp", 56.5, 70, "is below the smallest band, 60 (from 57.5)", ("band", True, "60", 10.0)),
        ("eu", 144, 160, "is above the largest band, 140 (up to 142.5)", ("band", False, "140", 15.0)),
        ("eu", 70, 80, "is below the smallest cup, AA (from 10)", ("cup", True, "AA", 0.0)),
        ("jp", 70, 102, "is above the largest cup, I (up to 31.25)", ("cup", False, "I", 7.5)),
        ("uk", 32, 31, "is below the smallest cup, AA (from -0.5)", ("cup", True, "AA", 12.7)),
    ],
)
def test_what_lies_outside_a_table_is_said_with_the_nearest_step(key, underbust, bust, why, nearest):
    answer = made(key, underbust, bust)
    assert (answer.inside, answer.label, answer.sisters) == (False, "", ())
    assert any(why in str(sentence) for sentence in answer.rule)
    found = [(x.part, x.up, x.name, pytest.approx(x.missing_mm, abs=1e-6)) for x in answer.neighbours]
    assert nearest in found


@pytest.mark.parametrize("girth", [0.0, -5.0, float("nan"), float("inf"), 6000.0])
def test_what_is_no_girth_is_refused(girth):
    for pair in ((girth, 900.0), (700.0, girth)):
        with pytest.raises(SizeError, match="is implausible for a body"):
            sizes(*pair)


@every_table
@given(underbust=underbusts, difference=differences)
def test_every_body_inside_gets_exactly_one_size(table, underbust, difference):
    answer = size(table, underbust, underbust + difference)
    value, over = (
        table.in_unit(underbust),
        table.over(table.in_unit(underbust), table.in_unit(underbust + difference)),
    )
    for scale, name, at in ((table.bands, answer.band, value), (table.cups, answer.cup, over)):
        ends = pairwise(scale.borders)
        holds = (
            [low <= at < high if scale.upward else low < at <= high for low, high in ends]
            if at is not None
            else []
        )
        assert [step.name for step, held in zip(scale.steps, holds, strict=False) if held] == [name] * bool(
            name
        )
    assert answer.inside == bool(answer.band and answer.cup)


@every_table
@given(underbust=underbusts, difference=differences)
def test_neighbours_are_adjacent_and_as_far_as_told(table, underbust, difference):
    answer = size(table, underbust, underbust + difference)
    over = table.over(table.in_unit(underbust), table.in_unit(underbust + difference))
    told = {(each.part, each.up): each for each in answer.neighbours}
    assert len(told) == len(answer.neighbours)
    for part, scale, here in (("band", table.bands, table.in_unit(underbust)), ("cup", table.cups, over)):
        for up, step in ((True, 1), (False, -1)):
            there = None if here is None else scale.step(scale.place(here) + step)
            each = told.get((part, up))
            assert (each and each.name) == (there and there.name)
            if each is not None:
                assert each.missing_mm >= 0.0
                beyond = here + (each.missing_mm / table.unit_mm + 1e-5) * step
                assert scale.step(scale.place(beyond)) == there


@every_table
@given(underbust=underbusts, difference=differences)
def test_a_neighbour_is_the_size_of_a_body_just_beyond_the_border(table, underbust, difference):
    bust = underbust + difference
    for each in size(table, underbust, bust).neighbours:
        step = (each.missing_mm + 1e-4) * (1 if each.up else -1)
        there = (underbust + step, bust) if each.part == "band" else (underbust, bust + step)
        over = table.over(*map(table.in_unit, there))
        if over is not None and min(abs(over - border) for border in table.cups.borders) > 1e-4:
            assert size(table, *there).label == each.label


@every_table
def test_a_border_belongs_to_one_step_alone(table):
    for scale in (table.bands, table.cups):
        for place, border in enumerate(scale.borders):
            assert scale.place(border) == (place if scale.upward else place - 1)
            assert scale.place(border + 1e-6) == place
            assert scale.place(border - 1e-6) == place - 1
    over = 5.0 if table.cup_from == BAND else 15.0
    for place, border in enumerate(table.bands.borders[1:-1], start=1):
        assert made(table.key, border, border + over).band == table.bands.steps[place].name


@every_table
def test_sister_sizes_are_made_for_a_bust_as_far_off_as_told(table):
    cup_mm = (table.cups.steps[3].middle - table.cups.steps[2].middle) * table.unit_mm
    band_mm = (table.bands.steps[3].middle - table.bands.steps[2].middle) * table.unit_mm
    middle = table.bands.steps[3].middle
    answer = made(table.key, middle, middle + table.cups.steps[3].middle)
    assert [each.bust_mm for each in answer.sisters] == pytest.approx([cup_mm - band_mm, band_mm - cup_mm])
    if table.key in ("jp", "uk", "us"):
        assert all(abs(each.bust_mm) <= cup_mm + 1e-9 for each in answer.sisters)
    else:
        assert any("one step of the cup and a half" in doubt.en for doubt in table.doubts)


@given(underbust=st.integers(26 * 254, 56 * 254), over=st.integers(0, 9 * 254))
def test_inches_and_millimetres_agree(underbust, over):
    table = TABLES["uk"]
    inches = (underbust / 254, (underbust + over) / 254)
    answer = size(table, underbust / 10, (underbust + over) / 10)
    names = [step.name if step else "" for step in table.steps(*(round(each, 6) for each in inches))]
    assert [answer.band, answer.cup] == names


def test_the_british_and_the_american_letters_part_after_dd():
    pairs = {over: (made("uk", 32, 32 + over).cup, made("us", 32, 32 + over).cup) for over in (4, 5, 6, 7, 9)}
    assert pairs == {4: ("D", "D"), 5: ("DD", "DD"), 6: ("E", "DDD"), 7: ("F", "G"), 9: ("G", "I")}


def test_conflicts_between_sources_are_told_as_data():
    assert any("liquisearch" in doubt.en for doubt in TABLES["au"].doubts)
    assert any("III C" in doubt.en for doubt in TABLES["it"].doubts)
    assert any("AAA" in doubt.en for doubt in TABLES["jp"].doubts)
    assert any("add 4 to 5 inches" in doubt.en for doubt in TABLES["uk"].doubts)
    for table in TABLES.values():
        assert table.sources
        assert all(words.en.endswith(".") and words.ja.endswith("。") for words in table.doubts)


def test_an_answer_is_plain_data():
    told = plain({key: sizes_text(answer, "ja") for key, answer in sizes(723.0, 871.0, 5.0).items()})
    assert json.loads(json.dumps(told, allow_nan=False)) == told
    assert list(told)[:7] == ["jp", "eu", "uk", "us", "fr", "it", "au"]
    assert told["jp"]["size"] == "C70"
    assert told["jp"]["title"].startswith("日本")
    assert told["jp"]["neighbours"][1] == {
        "part": "band",
        "direction": "up",
        "name": "75",
        "size": "C75",
        "missing_mm": 7.0,
    }
    outside = sizes_text(sizes(500.0, 600.0)["jp"])
    assert (outside["size"], outside["band"], outside["cup"], outside["inside"]) == (None, None, "A", False)
