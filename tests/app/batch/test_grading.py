"""A run is graded from its table: known rules are found, no body counts twice, nothing is lost."""

from __future__ import annotations

import csv
import json
import math
import re
import xml.etree.ElementTree as ET
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from graded_runs import STRAP, UNDER, made_row, made_rows, run_of, write_run

from app.batch.compare_files import BODY_COLUMNS, DIFFERENCE_COLUMNS
from app.batch.grade_files import (
    INCREMENT_COLUMNS,
    NEW_SIZE_COLUMNS,
    RULE_COLUMNS,
    SERVED_COLUMNS,
    SIZE_COLUMNS,
    write_gradings,
)
from app.batch.grade_page import grade_page
from app.batch.graded_bodies import BAND, SIZE, graded_bodies, grouping_of, measures_of
from app.batch.grading import FitMeasure, Grading, ServiceOptions, grading_of
from app.batch.results import Results, chosen_variants, read_results
from core.analysis.grading.service import RULE
from core.errors import UserError

OPTIONS = ServiceOptions(0.05, RULE, 0.9)


def graded(results: Results, by: str = SIZE, options: ServiceOptions = OPTIONS) -> Grading:
    bodies = graded_bodies(results, grouping_of(by, "jp"), measures_of(results, [], []))
    return grading_of(bodies, options)


def rows_of(path: Path) -> list[dict[str, str]]:
    with open(path, newline="", encoding="utf-8-sig") as file:
        return list(csv.DictReader(file))


def written(folder: Path, *gradings: Grading) -> dict[str, list[dict[str, str]]]:
    folder.mkdir(exist_ok=True)
    write_gradings(folder, gradings)
    return {path.stem: rows_of(path) for path in folder.glob("*.csv")}


def test_the_rule_of_the_bodies_is_found(tmp_path: Path) -> None:
    tables = written(tmp_path / "out", graded(run_of(tmp_path / "run", made_rows(80))))
    (rule,) = (row for row in tables["grade_rules"] if row["measure"] == UNDER)
    assert float(rule["per_band_low_95"]) < 30.0 < float(rule["per_band_high_95"])
    assert float(rule["per_cup_low_95"]) < 8.0 < float(rule["per_cup_high_95"])
    assert 2.0 < float(rule["residual_deviation"]) < 4.0
    assert rule["within_tolerance_share"] == "1"
    assert sum(int(row["bodies"]) for row in tables["grade"] if row["measure"] == UNDER) == 80


def test_sizes_and_increments_are_named_as_in_the_size_chart(tmp_path: Path) -> None:
    rows = [made_row(at, *size) for at, size in enumerate([(1, 0), (1, 0), (1, 1), (1, 1), (2, 0)])]
    tables = written(tmp_path / "out", graded(run_of(tmp_path / "run", rows)))
    assert {row["size"] for row in tables["grade"]} == {"A70", "B70", "A75"}
    steps = {
        (row["step"], row["from_size"], row["to_size"]): row
        for row in tables["increments"]
        if row["measure"] == UNDER
    }
    cup, band = steps["cup", "A70", "B70"], steps["band", "A70", "A75"]
    assert (float(cup["increment"]), cup["standard_error"]) == (8.0, "0")
    assert (float(band["increment"]), band["standard_error"], band["low_95"]) == (30.0, "", "")


def test_a_copy_of_a_scan_is_counted_once(tmp_path: Path) -> None:
    rows = [*made_rows(10), {**made_rows(10)[3], "scan": "copy of 003.ply"}]
    found = graded(run_of(tmp_path, rows))
    assert found.graded.bodies.count == 10
    assert found.graded.left_out.copies == 1


def test_rows_that_are_not_graded_are_counted_by_their_reason(tmp_path: Path) -> None:
    refused = {"scan": "r.ply", "scan_sha256": "r", "variant": "one", "state": "refused", "message": "No."}
    small = {**made_row(90, 0, 0), "band_jp": "", "cup_jp": ""}
    run = run_of(tmp_path, [*made_rows(6), refused, small, {**made_row(91, 0, 0), "verdict": "bad"}])
    found = graded(run).graded
    assert (found.bodies.count, found.left_out.states, found.left_out.no_size) == (7, {"refused": 1}, 1)
    good = graded_bodies(run, grouping_of(SIZE, "jp"), measures_of(run, [], []), ["good"])
    assert (good.bodies.count, good.left_out.verdicts) == (6, {"bad": 1})


def test_bands_are_grouped_without_cups(tmp_path: Path) -> None:
    found = graded(run_of(tmp_path, made_rows(40)), BAND)
    assert {found.graded.grouping.label(code) for code in found.graded.bodies.codes} == {
        "65",
        "70",
        "75",
        "80",
    }
    (rule,) = (each for each in found.rules if each.measure.name == UNDER)
    assert rule.per_cup is None
    assert rule.per_band is not None


def test_straps_do_not_decide_unless_they_are_chosen(tmp_path: Path) -> None:
    run = run_of(tmp_path, [{**row, STRAP: 100.0 + 40.0 * at} for at, row in enumerate(made_rows(30))])
    usual, chosen = graded(run), graded(run, SIZE, ServiceOptions(0.05, RULE, 0.9, (FitMeasure("*strap*"),)))
    assert [each.name for each in usual.service.measures] == [UNDER]
    assert usual.by_own[RULE].share == 1.0
    assert [each.name for each in chosen.service.measures] == [STRAP]
    assert chosen.by_own[RULE].share < 0.5
    loose = graded(run, SIZE, ServiceOptions(0.05, RULE, 0.9, (FitMeasure("*strap*", 100.0),)))
    assert loose.by_own[RULE].share == 1.0
    with pytest.raises(UserError, match="decides whom a size serves"):
        graded(run, SIZE, ServiceOptions(0.05, RULE, 0.9, (FitMeasure("nothing"),)))


def test_every_body_is_in_the_list_of_served_once(tmp_path: Path) -> None:
    rows = made_rows(25)
    rows[7][UNDER] = 900.0
    rows[8][UNDER] = None
    tables = written(tmp_path / "out", graded(run_of(tmp_path / "run", rows)))
    served = {row["scan"]: row for row in tables["served"]}
    assert len(served) == len(tables["served"]) == 25
    assert served["007.ply"]["served"] == served["007.ply"]["served_by_best"] == "false"
    assert (served["007.ply"]["measure"], float(served["007.ply"]["body"])) == (UNDER, 900.0)
    assert (served["008.ply"]["served"], served["008.ply"]["note"]) == ("", f"{UNDER} is not known")
    new = tables["new_sizes"]
    values = json.loads((tmp_path / "out" / "grade.json").read_text("utf-8"))["variants"][0]["new_sizes"]
    assert sum(int(row["bodies_served"]) for row in new) == values["served"] >= math.ceil(0.9 * 24)
    assert len({row["scan"] for row in new}) == len(new) == values["sizes"]


def test_measures_without_values_and_other_columns(tmp_path: Path) -> None:
    run = run_of(tmp_path, [{**row, STRAP: None} for row in made_rows(5)])
    assert [each.name for each in measures_of(run, [], [])] == [UNDER]
    assert [each.name for each in measures_of(run, ["lift_*"], ["*right*"])] == ["lift_left_mm"]
    with pytest.raises(UserError, match="no values of measures"):
        measures_of(run, ["scan"], [])


def test_variants_are_chosen_by_name(tmp_path: Path) -> None:
    rows = [*made_rows(4, variant="one"), *made_rows(4, variant="two")]
    found = read_results(write_run(tmp_path, rows, ("one", "two")))
    assert [each.variant for each in found] == ["one", "two"]
    assert [each.variant for each in chosen_variants(found, ["two"])] == ["two"]
    with pytest.raises(UserError, match="no variant 'three'"):
        chosen_variants(found, ["three"])


def test_every_column_is_in_the_reference() -> None:
    page = (Path(__file__).parents[3] / "docs" / "reference" / "grade-columns.md").read_text("utf-8")
    columns = (*SIZE_COLUMNS, *INCREMENT_COLUMNS, *RULE_COLUMNS, *SERVED_COLUMNS, *NEW_SIZE_COLUMNS)
    for column in (*columns, *BODY_COLUMNS, *DIFFERENCE_COLUMNS):
        assert re.search(rf"(?m)^\|[^|]*`{column}`[^|]*\|", page), column


class Tags(HTMLParser):
    """Checks that tags are closed in the order in which they are opened."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        if tag not in ("meta", "path", "circle", "rect"):
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: Any) -> None:
        pass

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_the_page_is_well_formed_and_needs_nothing_else(tmp_path: Path) -> None:
    hostile = "</svg><script>alert(1)</script>.ply"
    rows = made_rows(30)
    rows[3] |= {"scan": hostile, UNDER: 900.0}
    page = grade_page([graded(run_of(tmp_path, rows))])
    tags = Tags()
    tags.feed(page)
    assert tags.open == []
    assert hostile not in page
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    assert "default-src 'none'" in page
    assert not any(word in page for word in ("http:", "https:", "src=", "@import", "url("))
    for part in page.split("<figure>")[1:]:
        picture = ET.fromstring(part.partition("<figcaption>")[0])
        marks = [float(each.attrib["cy"]) for each in picture.iter("circle")]
        assert all(0.0 <= each <= 220.0 for each in marks)


def test_a_single_body_has_a_page(tmp_path: Path) -> None:
    page = grade_page([graded(run_of(tmp_path, [made_row(0, 1, 1)]))])
    assert "1 body in 1 size " in page
    assert "nan" not in page.lower()
