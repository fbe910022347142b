"""The sheet: the same figures as those who work them out, as plain data, JSON and one long table."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from whole_trunk import wearing as whole_trunk

from core.export.report_data import Heading, Report, make_report
from core.export.report_data_file import COLUMNS, report_csv, report_json
from core.garment.cut_list import cut_list
from core.garment.elastic_library import find_elastic
from core.garment.pressure_list import pressure_list
from core.landmarks.warnings import collect_warnings
from core.measurements.lower_trunk import lower_before_after
from core.measurements.table import before_after, measure_rows
from core.messages import plain
from core.pipeline.build import Stages, build
from core.pipeline.solve import Solution, solve

HEADING = Heading("Anna", "2026-11-22", "Customer 0412", system="uk", allowance_mm=5.0)
Built = Callable[[str], Stages]


@pytest.fixture(scope="module")
def worn(built: Built) -> Solution:
    stages = built("mannequin")
    design = replace(stages.design, volume="exact").with_line("mid-bust", 0.7).with_line("full-bust", 0.98)
    return solve(build(design.with_elastic("mid-bust", find_elastic("plush 12")), stages))


@pytest.fixture(scope="module")
def sheet(worn: Solution) -> Report:
    return make_report(worn, worn.records, HEADING)


def test_a_customer_is_no_formula_in_the_table(sheet: Report) -> None:
    named = replace(sheet, heading=replace(HEADING, customer="=1+1"))
    rows = list(csv.DictReader(io.StringIO(report_csv(named))))
    assert next(row["after"] for row in rows if row["key"] == "customer") == "'=1+1"


def test_the_sheet_holds_what_others_work_out(worn: Solution, sheet: Report) -> None:
    points = worn.control_points
    assert sheet.measures == tuple(measure_rows(*before_after(worn.stages, points)))
    assert sheet.cuts == cut_list(worn.stages, points)
    found = pressure_list(worn.stages, points)
    assert sheet.pressures == found.rows
    assert sheet.limits == found.as_data()["limits"]
    assert [row.line for row in sheet.pressures] == [row.line for row in sheet.cuts.rows]


def test_the_chosen_system_comes_first_and_the_allowance_counts(worn: Solution, sheet: Report) -> None:
    assert [each["key"] for each in sheet.sizes][:3] == ["uk", "jp", "eu"]
    assert len(sheet.sizes) == 7
    assert sheet.sizes[0]["allowance_mm"] == 5.0
    girth = next(row["before"] for row in sheet.measures if row["key"] == "underbust_girth")
    assert sheet.sizes[0]["underbust_mm"] == girth


def test_lift_and_volume_are_those_of_the_run(worn: Solution, sheet: Report) -> None:
    rest, now = worn.stages.rest_marks, worn.last.marks
    assert now is not None
    assert sheet.lift is not None
    assert sheet.lift.left_up == pytest.approx(now.bust_point_left_z - rest.bust_point_left_z)
    assert sheet.lift.up == pytest.approx(0.5 * (sheet.lift.left_up + sheet.lift.right_up))
    assert sheet.volume.error_ml == pytest.approx(worn.last.error_ml)
    assert sheet.volume.error_percent == pytest.approx(100.0 * worn.last.error)
    assert sheet.turns.turn == (), "the exact answer makes no turns"


def test_turns_end_where_the_lift_does_and_a_fold_has_none(built: Built) -> None:
    stages = built("mannequin")
    turned = solve(build(replace(stages.design, volume="adaptive"), stages))
    sheet = make_report(turned, turned.records, HEADING)
    assert sheet.lift is not None
    assert sheet.turns.turn == tuple(row.iteration for row in turned.records)
    assert sheet.turns.up_mm[-1] == pytest.approx(sheet.lift.up)
    assert sheet.turns.error_percent[-1] == pytest.approx(100.0 * turned.last.error)
    folded = solve(build(stages.design.with_line("mid-bust", 0.55), stages), turns=30)
    told = make_report(folded, folded.records, HEADING)
    assert told.state not in ("settled", "strained", "settling")
    assert told.lift is None
    assert any("does not represent a real body" in str(each) for each in told.warnings)


def test_the_sections_go_through_the_bust(worn: Solution, sheet: Report) -> None:
    side, level = sheet.sections
    left = worn.stages.landmarks.points["bust_point_left"].position
    assert (side.name, side.axis, side.at_mm) == ("side", "x", left[0])
    assert side.bust_point == pytest.approx((-left[1], left[2]), abs=0.1), "the landmark lies on the skin"
    assert (level.name, level.axis) == ("bust", "z")
    for each in sheet.sections:
        assert len(each.before) >= 1
        assert len(each.before) == len(each.after)
        assert each.before != each.after, "the body was reshaped there"
        (low, high), (across, up) = each.box, each.before[0][0]
        assert low < high
        assert isinstance(across, float)
        assert isinstance(up, float)


def test_the_side_is_cut_through_the_bust_point_before_and_after(worn: Solution, sheet: Report) -> None:
    side, lift = sheet.sections[0], sheet.lift
    assert lift is not None
    assert abs(side.after_at_mm - side.at_mm) > 0.3, "it has moved aside"
    way = np.subtract(side.bust_point_after, side.bust_point)
    assert way == pytest.approx((lift.left_forward, lift.left_up), abs=0.3)
    for curves, place in ((side.before, side.bust_point), (side.after, side.bust_point_after)):
        ends = np.concatenate([np.stack([each[:-1], each[1:]], axis=1) for each in map(np.array, curves)])
        ends = ends[(ends[:, 0] != ends[:, 1]).any(axis=1)]
        along = ends[:, 1] - ends[:, 0]
        share = np.einsum("kx,kx->k", place - ends[:, 0], along) / np.einsum("kx,kx->k", along, along)
        foot = ends[:, 0] + np.clip(share, 0.0, 1.0)[:, None] * along
        assert np.linalg.norm(foot - place, axis=1).min() < 0.02


def test_a_body_at_rest_has_an_empty_cut_list(built: Built) -> None:
    stages = built("mannequin")
    bare = solve(build(replace(stages.design, volume="exact", lines=()), stages))
    sheet = make_report(bare, bare.records, HEADING)
    assert sheet.cuts.rows == ()
    assert sheet.pressures == ()
    assert sheet.lift is not None
    assert sheet.lift.up == pytest.approx(0.0, abs=1e-9)


def test_doubts_are_told_apart_from_what_else_is_warned_of(built: Built) -> None:
    stages = built("mannequin")
    marks = {name: replace(mark, confidence=0.3) for name, mark in stages.landmarks.points.items()}
    stages = replace(stages, landmarks=replace(stages.landmarks, points=marks))
    solution = solve(stages)
    sheet = make_report(solution, solution.records, HEADING)
    assert sheet.doubts == tuple(collect_warnings(stages.body, stages.landmarks)) != ()
    assert not set(sheet.doubts) & set(sheet.warnings)
    rows = csv.DictReader(io.StringIO(report_csv(sheet)))
    assert str(sheet.doubts[0]) in [row["note"] for row in rows if row["section"] == "warning"]


def test_json_is_the_whole_sheet(sheet: Report) -> None:
    told = json.loads(report_json(sheet))
    assert told["heading"]["customer"] == "Customer 0412"
    assert told["measures"] == plain(sheet.measures)
    assert told["cuts"]["rows"][0]["cut_mm"] == sheet.cuts.rows[0].cut_mm
    assert told["pressures"][0]["max_kpa"] == sheet.pressures[0].max_kpa
    assert told["sections"][0]["after"][0][0] == list(sheet.sections[0].after[0][0])
    assert len(told["definitions"]) > 20
    assert told["limits"]["red_kpa"] == 4.0
    assert set(told["versions"]) == {"busk", "python", "numpy"}


def test_the_table_has_every_figure_once(sheet: Report) -> None:
    rows = list(csv.DictReader(io.StringIO(report_csv(sheet))))
    assert tuple(rows[0]) == COLUMNS
    keys = [(row["section"], row["key"]) for row in rows]
    assert len(set(keys)) == len(keys)
    found = {(row["section"], row["key"]): row for row in rows}
    measured = {row["key"]: row for row in sheet.measures}
    assert float(found["measure", "bust_girth"]["after"]) == pytest.approx(
        measured["bust_girth"]["after"], rel=1e-5
    )
    cut = next(row for row in sheet.cuts.rows if row.line == "mid-bust")
    assert float(found["cut", "mid-bust: cut"]["after"]) == pytest.approx(cut.cut_mm, rel=1e-5)
    assert found["cut", "full-bust: cut"]["after"] == "", "no elastic is chosen for it"
    assert found["size", "uk"]["before"] == sheet.sizes[0]["size"]
    assert found["sheet", "customer"]["after"] == "Customer 0412"


def test_the_levels_of_waist_and_hip_are_shown_where_lines_shape_them() -> None:
    solution = solve(whole_trunk({"waist": 0.9}))
    waist, hip = make_report(solution, solution.records, HEADING).lower_sections
    assert (waist.name, hip.name) == ("waist", "hip")
    lower = solution.stages.lower
    assert lower is not None
    assert waist.at_mm == pytest.approx(lower.landmarks.levels["waist"])
    girths = lower_before_after(lower, solution.region_points[1])
    for cut, name, curves in ((waist, "waist", 1), (hip, "hip", 1)):
        assert len(cut.before) == len(cut.after) == curves
        for line, girth in zip((cut.before[0], cut.after[0]), girths[name], strict=True):
            assert np.linalg.norm(np.diff(line, axis=0), axis=1).sum() == pytest.approx(
                girth.skin_mm, abs=0.05
            )


def test_a_bust_alone_has_no_levels_below(sheet: Report) -> None:
    assert sheet.lower_sections == ()
