"""What worn lines press with in figures: rows, places in words, and the command line."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapes import SAMPLES

from app.cli.main import main
from app.research.sphere import sphere
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.project_file import read_scan_file, save_project
from core.garment.body_location import SHOULDERS, SIDES, body_location
from core.garment.elastic_library import find_elastic
from core.garment.presets import find_preset, with_preset
from core.garment.pressure import LEFT_OUT, pressure_limits, pressures
from core.garment.pressure_list import pressure_list
from core.garment.tension import line_tensions
from core.pipeline.build import Stages, build
from core.pipeline.solve import Solution, solve

BALL = sphere(rings=61, spokes=120)  # of radius 100 mm
SCAN = str(SAMPLES / "mannequin.ply")
LINES = ("under-bust", "mid-bust", "full-bust")


def solved(stages: Stages) -> Solution:
    design = stages.design
    for name in LINES:
        design = design.with_line(name, 0.8)
    for name in LINES[1:]:
        design = design.with_elastic(name, find_elastic("picot 10"))
    return solve(build(replace(design, volume="adaptive"), stages))


@pytest.mark.parametrize(("turn", "side"), [(45 * k, side) for k, side in enumerate(SIDES)])
def test_a_place_round_a_body_is_told_as_its_side(turn: float, side: str) -> None:
    way = np.array([np.sin(np.radians(turn)), -np.cos(np.radians(turn)), 0.0])
    for aside in (-0.3, 0.0, 0.3):  # rad
        c, s = np.cos(aside), np.sin(aside)
        place = 95.0 * np.array([c * way[0] - s * way[1], s * way[0] + c * way[1], 0.0]) + [0.0, 0.0, 20.0]
        found = body_location(BALL, 0.0, place, place / 100.0)
        assert found.side == side
        assert found.height_mm == pytest.approx(120.0, abs=0.1)


def test_what_looks_up_between_front_and_back_is_a_shoulder() -> None:
    up = np.array([0.0, 0.0, 1.0])
    sides = [body_location(BALL, 10.0, np.array([x, 5.0, 80.0]), up).side for x in (40.0, -20.0)]
    assert sides == list(SHOULDERS)
    assert body_location(BALL, 0.0, np.array([0.0, -55.0, 80.0]), up).side == "front"


def test_rows_say_what_the_bands_say(built: Callable[[str], Stages]) -> None:
    solution = solved(built("mannequin"))
    stages, points = solution.stages, solution.control_points
    listed, worn = pressure_list(stages, points), pressures(stages, points)
    assert [row.line for row in listed.rows] == [line.name for line in stages.model.lines]
    rows = {row.line: row for row in listed.rows}
    for name, band in worn.items():
        row = rows[name]
        assert (row.mean_kpa, row.max_kpa, row.force_n) == (band.mean, band.largest, band.force)
        assert (row.mean_mmhg, row.max_mmhg) == pytest.approx((band.mean / 0.133322, band.largest / 0.133322))
        assert row.place == pytest.approx(tuple(band.places[band.peak]))
        assert row.tension_n == line_tensions(stages, points)[name].mean
        assert (row.width_mm, row.light, row.bridged_mm) == (10.0, band.rating, band.bridged_length)
        assert row.elastic == "Picot edge 10 mm"
        low = solution.body.vertices[:, 2].min()
        assert row.height_mm == pytest.approx(row.place[2] - low, abs=0.5)
    assert listed.force_n == pytest.approx(sum(band.force for band in worn.values()))
    assert not listed.complete, "the under-bust line has no elastic"
    assert listed.highest is rows["full-bust"]


def test_a_line_whose_tension_is_not_known_says_why_and_has_no_figures(
    built: Callable[[str], Stages],
) -> None:
    solution = solved(built("mannequin"))
    (row,) = (each for each in pressure_list(solution.stages, solution.control_points).rows if not each.light)
    assert (row.line, row.mean_kpa, row.max_kpa, row.force_n, row.place) == (
        "under-bust",
        None,
        None,
        None,
        (),
    )
    assert "choose an elastic to compute the tension" in str(row.notes[0])


def test_a_slack_line_presses_nowhere(built: Callable[[str], Stages]) -> None:
    stages = built("mannequin")
    design = replace(stages.design, lines=()).with_line("under-bust", 1.1)
    design = design.with_elastic("under-bust", find_elastic("picot 10"))
    listed = pressure_list(build(design, stages), stages.control.mesh.vertices)
    (row,) = listed.rows
    assert (row.max_kpa, row.where, row.height_mm, row.place, row.light) == (0.0, "", None, (), "green")
    assert listed.highest is None


def test_a_strap_is_pressed_on_its_own_side(built: Callable[[str], Stages]) -> None:
    stages = built("mannequin")
    design = with_preset(replace(stages.design, volume="adaptive"), find_preset("Bra"))
    solution = solve(build(design, stages))
    rows = {row.line: row for row in pressure_list(solution.stages, solution.control_points).rows}
    for side in ("left", "right"):
        assert side in rows[f"strap {side}"].where
        assert (rows[f"strap {side}"].place[0] > 0.0) == (side == "left")


WORDS = [word for name in LINES for word in ("--line", f"{name}=80%")]
WORDS += [word for name in LINES[1:] for word in ("--elastic", f"{name}=picot 10")]


def test_the_command_says_what_python_says(
    built: Callable[[str], Stages], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    solution = solved(built("mannequin"))
    listed = pressure_list(solution.stages, solution.control_points)
    assert main(["pressure", SCAN, *WORDS, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    by_hand = json.loads(json.dumps(listed.as_data()))
    assert {key: told[key] for key in by_hand} == by_hand
    assert main(["pressure", SCAN, *WORDS, "--out", str(tmp_path / "press.csv")]) == 0
    rows = list(csv.DictReader((tmp_path / "press.csv").read_text(encoding="utf-8").splitlines()))
    assert [float(row["max_kpa"] or "nan") for row in rows] == pytest.approx(
        [row.max_kpa or np.nan for row in listed.rows], rel=1e-5, nan_ok=True
    )


def test_the_command_prints_limits_with_their_sources_and_what_is_left_out(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["pressure", SCAN, *WORDS]) == 0
    plain, limits = capsys.readouterr().out, pressure_limits()
    assert re.search(r"^Full bust +0\.83 +6\.2 +2\.36 +17\.7 .* 5\.5 +293  front \w+, \d+ mm", plain, re.M)
    assert "from 2 kPa" in plain
    assert all(each.name in plain and each.words.en in plain for each in limits.sources)
    assert all(sentence in plain for sentence in (*map(str, LEFT_OUT), *(each.en for each in limits.doubts)))


def test_without_a_worn_line_there_is_nothing_to_press(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pressure", SCAN]) == 2
    assert "No active lines" in capsys.readouterr().err


def test_the_total_of_unknown_tensions_is_not_printed_as_none(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pressure", SCAN, "--line", "under-bust=90%"]) == 0
    plain = capsys.readouterr().out
    assert "Total force on the skin unknown" in plain
    assert " 0.0 N" not in plain
    assert main(["pressure", SCAN, "--line", "under-bust=90%", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["force_n"] is None


def test_a_project_needs_no_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scan = read_scan_file(ScanSource(SCAN))
    design = Design(ScanSource(SCAN)).with_line("mid-bust", 0.8)
    design = design.with_elastic("mid-bust", find_elastic("picot 10"))
    save_project(tmp_path / "anna.busk", Document.single(design), scan, None)
    assert main(["pressure", str(tmp_path / "anna.busk"), "--csv"]) == 0
    (row,) = csv.DictReader(capsys.readouterr().out.splitlines())
    assert (row["line"], row["elastic"]) == ("mid-bust", "Picot edge 10 mm")
    assert float(row["max_kpa"]) > float(row["mean_kpa"]) > 0.0
