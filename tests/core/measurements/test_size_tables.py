"""Tables of sizes as files: shipped ones are whole, own ones are read, broken ones say what is wrong."""

import json
import re
from importlib import resources
from pathlib import Path

import pytest

from app.i18n.catalog import use_language
from app.presenters.messages import render
from core.errors import SizeError
from core.measurements.size_table import read_table, table_of
from core.measurements.sizes import built_in, sizes, user_folder, user_tables

ROOT = Path(__file__).parents[3]
GOOD = {
    "format": 1,
    "system": "X",
    "names": {"en": "Of our own"},
    "unit": "cm",
    "label": "{band}-{cup}",
    "cup_from": "underbust",
    "borders": {"band": "up", "cup": "down"},
    "bands": [["S", 60, 70], ["M", 70, 80]],
    "cups": [["1", 10, 14], ["2", 15, 20]],
    "sources": [{"name": "us", "en": "By hand."}],
    "doubts": [],
    "examples": [{"underbust": 65, "bust": 77, "size": "S-1", "source": "us"}],
}


def changed(**values):
    return json.dumps(GOOD | values)


def without(key):
    return json.dumps({name: value for name, value in GOOD.items() if name != key})


@pytest.fixture
def folder(own_data, tmp_path):
    folder = user_folder()
    assert folder.is_relative_to(tmp_path)
    folder.mkdir(parents=True)
    return folder


def test_every_shipped_file_is_one_of_the_tables():
    files = {each.name for each in (resources.files("resources") / "sizes").iterdir()}
    assert files == {f"{table.key}.json" for table in built_in()}
    for table in built_in():
        assert table.title.ja
        assert all(source.words.ja for source in table.sources)
        assert table.examples


def test_an_own_table_is_one_more_system(folder):
    (folder / "ours.json").write_text(changed(), encoding="utf-8")
    answers = sizes(650.0, 790.0)
    assert list(answers)[-1] == "ours"
    assert answers["ours"].label == "S-1"
    assert str(answers["ours"].rule[-1]) == "Bust minus under-bust 14 cm: cup 1 (9.5 to 14.5)."
    assert sizes(650.0, 795.0)["ours"].label == "S-1"
    assert sizes(650.0, 795.1)["ours"].label == "S-2"
    assert sizes(700.0, 850.0)["ours"].label == "M-2"


def test_own_tables_that_cannot_be_read_are_told_and_left_out(folder):
    (folder / "good.json").write_text(changed(), encoding="utf-8")
    (folder / "bad.json").write_text("[", encoding="utf-8")
    (folder / "eu.json").write_text(changed(), encoding="utf-8")
    (folder / "latin.json").write_bytes(b"\xff\xfe\xff")
    tables, problems = user_tables()
    assert [table.key for table in tables] == ["good"]
    told = [str(problem) for problem in problems]
    assert "bad.json cannot be read" in told[0]
    assert told[1] == "eu is the name of a built-in size chart. Rename eu.json."
    assert "latin.json cannot be read" in told[2]
    assert list(sizes(650.0, 790.0)) == [*(table.key for table in built_in()), "good"]


BROKEN = [
    ("[]", "must be a JSON object"),
    ("{", "Expecting"),
    ("[" * 100_000, "nested too deeply"),
    (changed(format=2), "not of format 1"),
    (changed(format=True), "not of format 1"),
    (changed(more=1), "has 'more', which is unknown"),
    (without("doubts"), "lacks 'doubts'"),
    (changed(system=" "), "system must be a text"),
    (changed(names={"ja": "日本"}), "names must have 'en'"),
    (changed(names={"en": "X", "de": "Y"}), "names must have 'en'"),
    (changed(unit="mm"), "unit must be one of cm, in, not 'mm'"),
    (changed(unit=["cm"]), "unit must be one of cm, in"),
    (changed(cup_from="waist"), "cup_from must be one of underbust, band"),
    (changed(borders={"band": "up"}), "borders lacks 'cup'"),
    (changed(borders={"band": "up", "cup": "both"}), "borders must be one of up, down"),
    (changed(label="{band}"), "label must have"),
    (changed(label="{band}{cup.name}"), "label must have"),
    (changed(label="{band}{cup!r:>9}"), "label must have"),
    (changed(label="{band"), "label must have|expected '}'"),
    (changed(bands=[["S", 60, 70]]), "bands must be a list of 2 at least"),
    (changed(bands={"S": [60, 70]}), "bands must be a list"),
    (changed(bands=[["S", 60, 70], ["M", 69, 80]]), "in bands M begins before S ends"),
    (changed(bands=[["S", 60, 70], ["S", 70, 80]]), "a name in bands is repeated"),
    (changed(bands=[["S", 70, 60], ["M", 70, 80]]), "in bands S ends before it begins"),
    (changed(bands=[["S", 70, 70], ["M", 70, 80]]), "S in bands is empty"),
    (changed(bands=[["S", 60], ["M", 70, 80]]), "must hold steps as"),
    (changed(bands=[[65, 60, 70], ["M", 70, 80]]), "the name of one of the bands must be a text"),
    (changed(cups=[["1", 10, "14"], ["2", 15, 20]]), "1 in cups must be a number, not '14'"),
    (changed(cups=[["1", True, 14], ["2", 15, 20]]), "1 in cups must be a number"),
    (changed(cups=[["1", 10, 10**400], ["2", 15, 20]]), "1 in cups must be a number"),
    (changed(cups=[["1", 10, float("nan")], ["2", 15, 20]]), "NaN is not a number"),
    (changed(sources=[]), "sources must be a list of 1 at least"),
    (changed(sources=["us"]), "sources must hold objects"),
    (changed(sources=[{"en": "By hand."}]), "the name of a source must be a text"),
    (changed(doubts=["none"]), "doubts must have 'en'"),
    (changed(examples=[{"underbust": 65}]), "an example lacks 'bust'"),
    (
        changed(examples=[GOOD["examples"][0] | {"size": "S-2"}]),
        "it makes S-1 of 65 and 77 cm, but the example lists",
    ),
    (changed(examples=[GOOD["examples"][0] | {"bust": 67}]), "it makes no size of 65 and 67 cm"),
]


@pytest.mark.parametrize(("text", "why"), BROKEN, ids=[why[:40] for _, why in BROKEN])
def test_a_broken_table_is_refused_with_what_is_wrong(text, why, tmp_path):
    path = tmp_path / "x.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SizeError, match=why) as told:
        read_table(path)
    assert str(told.value.message).startswith("The size chart x.json cannot be read: ")
    assert str(told.value.hint) == "Correct the file or remove it."


def test_a_file_that_is_far_too_large_or_not_there_is_refused(tmp_path):
    path = tmp_path / "x.json"
    path.write_text(changed() + " " * 1_000_000, encoding="utf-8")
    with pytest.raises(SizeError, match="too large"):
        read_table(path)
    with pytest.raises(SizeError, match=r"gone\.json cannot be read"):
        read_table(tmp_path / "gone.json")


def test_what_is_right_is_read_whole():
    table = table_of("x", changed())
    assert (table.key, table.unit, table.title.told("ja")) == ("x", "cm", "Of our own")
    assert table.bands.borders == (60.0, 70.0, 80.0)
    assert table.cups.borders == (9.5, 14.5, 20.5)


def test_a_shop_that_adds_four_inches_writes_its_table_as_the_page_says():
    values = json.loads((resources.files("resources") / "sizes" / "uk.json").read_text(encoding="utf-8"))
    values["bands"] = [[str(int(name) + 4), least, most] for name, least, most in values["bands"]]
    values["cups"] = [[name, least + 4, most + 4] for name, least, most in values["cups"]]
    assert ["32", 27, 29] in values["bands"]
    assert ["A", 5, 5] in values["cups"]
    values["examples"] = [{"underbust": 30, "bust": 36, "size": "34B", "source": "30 + 4, 36 - 34 = 2"}]
    table = table_of("ours", json.dumps(values))
    assert [each.name for each in table.steps(28.46, 34.29) if each] == ["32", "B"]


def test_every_rule_is_said_in_japanese_too():
    rules = {
        s
        for u in (450, 690, 676, 1500)
        for d in (-60, 50, 113, 480)
        for a in sizes(u, u + d, 3.0).values()
        for s in a.rule
    }
    use_language("ja")
    try:
        assert [rule for rule in rules if re.search("[a-z]{3}", render(rule))] == []
    finally:
        use_language("en")
