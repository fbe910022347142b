"""Elastics: their curves, the library, tables of one's own, and how a project keeps them."""

import json
from dataclasses import replace

import pytest

from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.elastic import Elastic
from core.document.lines import LineSettings
from core.document.serialization import DESIGN, VARIANTS, from_json, from_texts, to_json, to_texts
from core.errors import LineError, UserError
from core.garment.elastic_csv import TEMPLATE, csv_of, elastic_from_csv
from core.garment.elastic_library import (
    ALLOWANCE,
    built_in,
    find_elastic,
    library,
    read_elastic,
    save_elastic,
    specified_allowance,
    user_elastics,
    user_folder,
    write_elastic,
)

pytestmark = pytest.mark.usefixtures("own_data")

ROLL = Elastic("roll 7", 12.0, ((0.0, 0.0), (0.2, 1.0), (0.5, 4.0)), 30.0, "measured", estimate=False)
WORN = Design(ScanSource("a.ply")).with_line("mid-bust", 0.7)
HEAD = "elongation %,force N\n"


def test_between_its_points_a_curve_is_straight_and_goes_both_ways():
    assert ROLL.force(0.1) == pytest.approx(0.5)
    assert ROLL.force(0.35) == pytest.approx(2.5)
    assert ROLL.secant(0.35) == pytest.approx(2.5 / 0.35)
    assert ROLL.secant(0.5) == pytest.approx(8.0)
    for force in (0.3, 1.0, 2.2, 4.0):
        assert ROLL.force(ROLL.elongation(force)) == pytest.approx(force)


def test_a_slack_elastic_does_not_pull_and_begins_as_its_first_piece():
    assert ROLL.force(-0.1) == ROLL.force(0.0) == 0.0
    assert ROLL.elongation(0.0) == ROLL.elongation(-1.0) == 0.0
    assert ROLL.secant(-0.1) == ROLL.secant(0.0) == pytest.approx(5.0)


def test_beyond_its_end_a_curve_goes_on_for_those_who_look_at_its_reach():
    assert (ROLL.max_elongation, ROLL.max_force) == (0.5, 4.0)
    assert ROLL.force(0.6) == pytest.approx(5.0)


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"curve": ((0.0, 0.0), (0.2, 1.0), (0.1, 2.0))}, "decreases after 20 % and 1 N"),
        ({"curve": ((0.0, 0.0), (0.2, 1.0), (0.3, 1.0))}, "decreases after 20 % and 1 N"),
        ({"curve": ((0.0, 0.5), (0.2, 1.0))}, "is not valid"),
        ({"curve": ((0.0, 0.0),)}, "is not valid"),
        ({"curve": ((0.0, 0.0), (0.2, float("nan")))}, "is not valid"),
        ({"curve": ((0.0, 0.0), (20.0, 1.0))}, "ends at 2000 %.*units"),
        ({"width_mm": 0.0}, "width 0 mm of roll 7 is out of range"),
        ({"allowance_mm": -1.0}, "allowance -1 mm"),
        ({"name": " "}, "requires a name"),
    ],
)
def test_what_no_elastic_can_be_is_refused(wrong, sentence):
    with pytest.raises(LineError, match=sentence):
        replace(ROLL, **wrong)


def test_the_elastics_that_come_with_busk_are_told_to_be_estimates_and_lie_where_they_say():
    elastics = built_in()
    assert {each.name.rsplit(" ", 2)[0] for each in elastics} >= {"Picot edge", "Strap", "Power-net band"}
    assert len({each.name for each in elastics}) == len(elastics) > 20
    for each in elastics:
        assert each.estimate
        assert "not measured" in each.source
        per_cm = [10.0 * each.force(share) / each.width_mm for share in (0.3, 0.5)]
        assert 1.0 <= per_cm[0] < per_cm[1] <= 4.0
        assert str(int(each.width_mm)) in each.name


@pytest.mark.parametrize("elastic", [*built_in()[::5], ROLL], ids=lambda each: each.name)
def test_a_table_that_is_written_is_read_back_as_it_was(elastic, tmp_path):
    write_elastic(tmp_path / "x.csv", elastic)
    assert read_elastic(tmp_path / "x.csv") == elastic


@pytest.mark.parametrize(
    ("heading", "rows", "per_newton"),
    [
        ("elongation %,force N", "20,1\n50,4", 1.0),
        ("Strain [%];Load (N)", "20;1,0\n50;4,0", 1.0),
        ("no.\textension %\ttension N", "1\t20\t1\n2\t50\t4", 1.0),
        ("Dehnung %\tKraft cN", "20\t100\n50\t400", 1.0),
        ("elongation 1,force N/cm", "0.2,1\n0.5,4", 1.2),
        ("force gf,elongation %", "100,20\n400,50", 0.980665),
        ("伸び率（%）,荷重（N）", "20,1\n50,4", 1.0),
    ],
)
def test_tables_come_in_many_units_and_marks(heading, rows, per_newton):
    text = f"# width: 12 mm\n\n{heading}\n{rows}\n"
    elastic = elastic_from_csv(text, "roll")
    assert (elastic.name, elastic.width_mm, elastic.estimate) == ("roll", 12.0, False)
    assert [share for share, _ in elastic.curve] == pytest.approx([0.0, 0.2, 0.5])
    assert [force for _, force in elastic.curve] == pytest.approx([0.0, per_newton, 4.0 * per_newton])


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "is empty"),
        ("elongation\n10\n", "has only one column"),
        ("width,force N\n1,2\n", "no column 'elongation'"),
        ("elongation,force N\n10,1\n20,2\n", "'elongation' of roll has no unit"),
        ("elongation %,tension\n10,1\n20,2\n", "'tension' of roll has no unit.*'force N'"),
        ("extension %,cN\n10,1\n20,2\n", "no column 'force'"),
        (HEAD + "10,1\n", "too few rows"),
        (HEAD + "0,0\n10,1\n", "too few rows"),
        (HEAD + "0,0.4\n10,1\n20,2\n", "begins with 0.4 N at zero elongation"),
        (HEAD + "10,1\n20,x\n", "Row 3 of the table roll"),
        ("# width: 12\n\n" + HEAD + "10,1\n\n20\n", "Row 6 of the table roll"),
        (HEAD + "10,1\n20,2\n10,0.8\n", "decreases after 20 % and 2 N"),
        (HEAD + "10,100\n20,90000\n", "Check the units"),
        (HEAD + "0.1,1\n0.2,2\n0.4,3\n", "ends at 0.4 %, which is implausibly low.*'elongation 1'"),
        (
            HEAD + "20,900\n40,2800\n",
            "ends at 2800 N, which is implausibly high for an elastic 12 mm wide.*cN",
        ),
    ],
)
def test_a_table_that_is_none_is_refused_in_a_sentence(text, sentence):
    with pytest.raises(LineError, match=sentence):
        elastic_from_csv(text, "roll", 12.0)


def test_what_the_template_says_of_a_source_is_none():
    filled = TEMPLATE
    for share in (20, 40, 60, 80):
        filled = filled.replace(f"{share},\n", f"{share},{share / 20}\n")
    assert elastic_from_csv(filled, "roll").source == ""
    assert elastic_from_csv("# width: 12\n# source: ours\n" + HEAD + "10,1\n20,2\n", "roll").source == "ours"


def test_a_table_must_tell_the_width():
    with pytest.raises(LineError, match="specify the width"):
        elastic_from_csv(HEAD + "10,1\n20,2\n", "roll")


def test_a_file_that_is_not_there_or_too_large_is_told(tmp_path):
    with pytest.raises(LineError, match=r"none\.csv cannot be read"):
        read_elastic(tmp_path / "none.csv")
    (tmp_path / "large.csv").write_bytes(b"1" * 2_000_000)
    with pytest.raises(LineError, match="too large"):
        read_elastic(tmp_path / "large.csv")


def test_a_spreadsheet_is_asked_for_as_a_table(tmp_path):
    (tmp_path / "roll.xlsx").write_bytes(b"PK\3\4\0\0# width: 12")
    with pytest.raises(LineError, match=r"roll\.xlsx is not a text file.*as CSV"):
        read_elastic(tmp_path / "roll.xlsx")


def test_a_table_without_an_allowance_is_known_by_it(tmp_path):
    path = tmp_path / "roll.csv"
    path.write_text("# width: 12\n" + HEAD + "10,1\n20,2\n")
    assert not specified_allowance(path)
    assert read_elastic(path).allowance_mm == ALLOWANCE
    write_elastic(path, ROLL)
    assert specified_allowance(path)


@pytest.mark.parametrize("name", ["Roll 7,", "Roll; ", ' "Roll" ', '"Roll"', '"', "a: 1, b"])
def test_names_with_marks_of_cells_at_their_ends_are_read_back(name, tmp_path):
    told = replace(ROLL, name=name, source=f"of {name.strip()}")
    write_elastic(tmp_path / "x.csv", told)
    assert read_elastic(tmp_path / "x.csv") == told


@pytest.mark.parametrize("letters", [5, 200_000])
def test_a_quotation_mark_that_stays_open_spoils_no_more_than_its_line(letters):
    user_folder().mkdir(parents=True)
    heap = "x" * letters
    (user_folder() / "torn.csv").write_text(f'# width: 12\n{HEAD}10,1\n20,"2{heap}\n30,3\n')
    save_elastic(ROLL)
    elastics, problems = user_elastics()
    assert elastics == [ROLL]
    assert [str(each).split(".")[0] for each in problems] == [
        "Row 4 of the table torn does not contain two numbers"
    ]


def test_an_elastic_takes_the_place_of_its_name_and_of_no_other():
    one, other = (replace(ROLL, name=name) for name in ("Roll 1/2", "Roll 1:2"))
    save_elastic(one)
    save_elastic(other)
    assert user_elastics()[0] == [other, one]
    wider = replace(one, width_mm=15.0)
    save_elastic(wider)
    assert user_elastics()[0] == [other, wider]
    write_elastic(user_folder() / "zz.csv", replace(ROLL, name="Foo"))
    foo = replace(ROLL, name="Foo", width_mm=33.0)
    save_elastic(foo)
    assert library()["Foo"] == foo
    assert len(user_elastics()[0]) == 3


def test_spreadsheets_of_japan_are_read(tmp_path):
    (tmp_path / "sjis.csv").write_bytes("# width: 12\n伸び %,荷重 N\n10,1\n20,2\n".encode("cp932"))
    assert read_elastic(tmp_path / "sjis.csv").max_force == 2.0


def test_own_elastics_join_the_library_and_a_broken_one_does_not_spoil_it():
    mine = replace(ROLL, name="Strap 10 mm")
    save_elastic(mine)
    (user_folder() / "broken.csv").write_text("nothing")
    assert library()["Strap 10 mm"] == mine
    elastics, problems = user_elastics()
    assert elastics == [mine]
    assert "broken" in str(problems[0])


@pytest.mark.parametrize("text", ["Picot edge 10 mm", "picot EDGE 10 mm", "picot 10", "10 picot"])
def test_an_elastic_is_found_by_words_that_only_it_has(text):
    assert find_elastic(text).name == "Picot edge 10 mm"


@pytest.mark.parametrize("text", ["Waistband, soft 40", "waistband soft 40"])
def test_a_comma_in_the_name_of_an_elastic_may_be_typed(text):
    assert find_elastic(text).name == "Waistband, soft 40 mm"


def test_no_elastic_or_more_than_one_is_said():
    with pytest.raises(LineError, match=r"Several elastics match 'picot'.*8 mm; Picot edge 10 mm"):
        find_elastic("picot")
    with pytest.raises(LineError, match="No elastic matches 'rope'"):
        find_elastic("rope")


def test_a_design_keeps_what_its_lines_are_made_of_and_no_more():
    design = WORN.with_elastic("mid-bust", ROLL)
    assert design.active_elastics() == {"mid-bust": ROLL}
    assert design.line_settings("mid-bust").width == 12.0
    assert design.with_line("mid-bust", None).active_elastics() == {}
    assert design.with_elastic("mid-bust", None) == WORN
    other = design.with_elastic("mid-bust", built_in()[0])
    assert other.elastics == (built_in()[0],)
    with pytest.raises(LineError, match="roll 7 of the line mid-bust is missing"):
        replace(design, elastics=())
    with pytest.raises(LineError, match="Two elastics are named 'roll 7'"):
        replace(design, elastics=(ROLL, ROLL))


def test_a_project_opens_elsewhere_with_its_elastics():
    design = replace(WORN.with_elastic("mid-bust", ROLL), tissue_stiffness=300.0)
    assert from_json(to_json(design)) == design
    assert json.loads(to_json(design))["format"] == 3, "an older program must not drop them"


def test_what_uses_no_elastic_is_written_as_before():
    design = WORN.with_line_settings(LineSettings("mid-bust", title="Middle"))
    values = json.loads(to_json(design))
    assert values["format"] == 1
    assert not {"elastics", "tissue_stiffness"} & values.keys()
    assert "elastic" not in values["traits"][0]
    assert from_json(to_json(design)) == design


def test_variants_may_be_made_of_different_elastics_on_the_same_tissue():
    document = Document.single(WORN.with_elastic("mid-bust", ROLL)).with_shown("B")
    document = document.with_design(
        replace(document.design.with_elastic("mid-bust", None), tissue_stiffness=400.0)
    )
    assert document.variants["A"].tissue_stiffness == 400.0
    assert document.variants["A"].elastics == (ROLL,)
    texts = to_texts(document)
    assert from_texts(texts) == document
    assert json.loads(texts[DESIGN])["format"] == 3, "an older program could not read variant A"
    assert json.loads(texts[VARIANTS])["others"]["A"]["format"] == 3


@pytest.mark.parametrize(
    "broken", [{"curve": 3}, {"width_mm": "wide"}, {"estimate": "yes"}, {"name": ""}], ids=str
)
def test_a_broken_elastic_in_a_project_is_refused(broken):
    values = json.loads(to_json(WORN.with_elastic("mid-bust", ROLL)))
    values["elastics"][0].update(broken)
    with pytest.raises(UserError, match=r"elastics\[0\]|requires a name"):
        from_json(json.dumps(values))


def test_a_written_table_can_be_read_by_a_person():
    lines = csv_of(ROLL).splitlines()
    assert "# name: roll 7" in lines
    assert lines[-2:] == ["20,1.0", "50,4.0"]
