"""Cloths: those that come with the program, the 10 cm test, and tables of one's own."""

from dataclasses import replace

import pytest

from core.errors import PatternError
from core.pattern.cloth_csv import TEMPLATE, cloth_from_csv, read_cloth, write_cloth
from core.pattern.cloth_library import built_in, cloth_of_stretch, find_cloth, stretch_test

HEAD = "direction,stretch %,ease %,stiffness\n"
MINE = replace(cloth_of_stretch("my net, soft", (0.4, 0.3), "tested"), limit=0.123, estimate=False)


def test_the_cloths_that_come_with_busk_are_marked_as_estimates_and_keep_their_own_rule():
    cloths = built_in()
    assert len({each.name for each in cloths}) == len({each.title for each in cloths}) == len(cloths) >= 6
    for each in cloths:
        assert each.estimate
        assert each.source.startswith("Estimate, not measured")
        assert each.limit == pytest.approx(0.5 * max(each.stretch), abs=0.001)
        tested = cloth_of_stretch(each.name, each.stretch)
        assert each.stiffness[:2] == pytest.approx(tested.stiffness[:2], rel=0.12)
        assert (1.0 + each.ease[0]) * (1.0 + each.limit) - 1.0 <= each.stretch[0], "worn beyond its stretch"


def test_ten_centimetres_stretched_by_hand_give_the_stretch():
    assert stretch_test(145.0, 112.0) == pytest.approx((0.45, 0.12))
    assert stretch_test(75.0, 50.0, 50.0) == pytest.approx((0.5, 0.0))


@pytest.mark.parametrize("lengths", [(99.0, 120.0), (120.0, 99.9), (401.0, 120.0), (float("nan"), 120.0)])
def test_a_length_that_no_stretched_cloth_has_is_refused(lengths):
    with pytest.raises(PatternError, match="cannot stretch to"):
        stretch_test(*lengths)


@pytest.mark.parametrize(
    "cloth", [*built_in(), MINE, replace(MINE, stretch=None)], ids=lambda each: each.name
)
def test_a_table_that_is_written_is_read_back_as_it_was(cloth, tmp_path):
    write_cloth(tmp_path / "x.csv", cloth)
    assert read_cloth(tmp_path / "x.csv") == cloth


def test_a_filled_template_is_a_cloth_with_estimates():
    cloth = cloth_from_csv(TEMPLATE.replace("across,,0", "across,14,10").replace("down,,0", "down,13,0"), "x")
    assert (cloth.name, cloth.source, cloth.estimate) == ("my cloth", "", True)
    assert cloth.stretch == pytest.approx((0.4, 0.3))
    assert cloth.ease == (0.1, 0.0)
    assert cloth.limit == pytest.approx(0.2)


def test_tables_come_with_other_marks_and_words():
    cloth = cloth_from_csv("# name: Netz\nRichtung;Dehnung %\nquer;40,5\nlängs;30\n", "x")
    assert cloth.stretch == pytest.approx((0.405, 0.3))
    assert cloth_from_csv("方向,伸び %\nよこ,50\nたて,20\n", "編地").stretch == pytest.approx((0.5, 0.2))


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "has no columns"),
        (HEAD + "across,40,0,1\n", "no row 'down'"),
        (HEAD + "across,x,0,1\ndown,1,0,1\n", "Row 2 of the table roll"),
        ("direction,ease %\nacross,1\ndown,1\n", "does not specify the stretch"),
        (HEAD + "across,40,,\ndown,,,\n", "does not specify the stretch"),
        ("direction,10 cm to cm\nacross,9\ndown,12\n", "cannot stretch"),
        (HEAD + "across,40,0,0\ndown,30,0,1\n", "stiffness 0 of the cloth roll is out of range"),
        ("# limit_percent: much\n" + HEAD + "across,40,0,1\ndown,30,0,1\n", "'much' of roll is not a number"),
    ],
)
def test_a_table_that_is_none_is_refused_in_a_sentence(text, sentence):
    with pytest.raises(PatternError, match=sentence):
        cloth_from_csv(text, "roll")


@pytest.mark.parametrize("text", ["power net", "Power net", "NET power"])
def test_a_cloth_is_found_by_words_that_only_it_has(text):
    assert find_cloth(text).name == "power net"
    assert find_cloth("my soft", (MINE,)) is MINE


def test_no_cloth_or_more_than_one_is_refused():
    with pytest.raises(PatternError, match=r"Several cloths match 'tricot'.*Cup tricot, stable"):
        find_cloth("tricot")
    with pytest.raises(PatternError, match="No cloth matches 'tin'"):
        find_cloth("tin")
