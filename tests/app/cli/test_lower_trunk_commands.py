"""Commands on a whole trunk: lines of both regions by one name, presets, landmarks, what cannot be had."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from app.cli.main import main
from app.presenters.samples import dressed_sample, sample_path
from core.document.document import Document
from core.document.storage.project_file import open_project, read_scan_file, save_project
from core.progress import quiet

STANDING = ("--unit", "mm", "--up", "+z", "--front=-y")
TRUNK = (str(sample_path("trunk")), *STANDING)
PERSON = (str(sample_path("person")), *STANDING)


def test_both_regions_are_worn_and_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = ("--line", "mid-bust=97%", "--line", "waist=-4cm", "--line", "sling=95%")
    assert main(["solve", *TRUNK, *lines, "--volume", "exact", "--out", str(tmp_path)]) == 0
    report = json.loads((tmp_path / "report.json").read_text("utf-8"))
    lower = report["lower_trunk"]
    waist = lower["lines"]["waist"]
    assert waist["set_mm"] == pytest.approx(waist["rest_mm"] - 40.0)
    assert waist["whole_band_rest_mm"] == waist["rest_mm"]
    worn = {name for name, line in lower["lines"].items() if line["worn"]}
    assert worn == {"waist", "sling-left", "sling-right"}
    assert lower["zones"]["waist"]["taken_up_inside_ml"] > 30.0
    assert max(abs(zone["error_ml"]) for zone in lower["zones"].values()) < 1e-6
    assert lower["girths"]["waist"]["after_mm"] < lower["girths"]["waist"]["before_mm"] - 20.0
    rises = [lower["moves"][f"gluteal_fold_{side}_up_mm"] for side in ("left", "right")]
    assert all(2.0 < rise < 5.0 for rise in rises), "half of what slings at 90 % do: 6.7 mm"
    told = capsys.readouterr().out
    assert f"gluteal fold: left {rises[0]:+.1f}, right {rises[1]:+.1f} mm up" in told
    assert "girth, waist: " in told
    assert set(report["lines"]) == {"under-bust", "mid-bust", "full-bust"}
    heading = (tmp_path / "turns-lower.csv").read_text("utf-8").splitlines()[0]
    assert "volume_error_seat-left_ml" in heading
    assert (tmp_path / "control-lower.ply").exists()


def test_a_preset_of_one_region_leaves_the_other(tmp_path: Path) -> None:
    worn = ("--preset", "girdle", "--line", "mid-bust=98%")
    assert main(["solve", *TRUNK, *worn, "--volume", "exact", "--out", str(tmp_path)]) == 0
    design = json.loads((tmp_path / "report.json").read_text("utf-8"))["design"]
    assert [line["name"] for line in design["lines"]] == ["mid-bust"]
    assert {"hip", "leg-opening-left", "leg-opening-right"} <= {
        each["name"] for each in design["lower"]["lines"]
    }


def test_elastics_are_chosen_for_both_sides(capsys: pytest.CaptureFixture[str]) -> None:
    worn = ("--line", "sling=90%", "--elastic", "sling=strap 15")
    assert main(["pressure", *TRUNK, *worn, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    rows = {row["line"]: row for row in found.get("pressures", found)["rows"]}
    assert {rows[f"sling-{side}"]["elastic"] for side in ("left", "right")} == {"Strap 15 mm"}
    assert all(row["tension_n"] > 0.0 for row in rows.values())


def test_landmarks_and_girths_of_the_lower_trunk_are_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["detect", *TRUNK, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    for name in ("waist", "belly", "hip", "buttock_left", "gluteal_fold_right", "crotch"):
        assert name in found["landmarks"]
        assert found["levels"][name] == pytest.approx(found["landmarks"][name]["mm"][2], abs=1e-6)
    assert found["girths"]["hip"]["tape_mm"] > found["girths"]["waist"]["tape_mm"] + 200.0


def test_a_placed_waist_moves_the_waist_row(tmp_path: Path) -> None:
    place = ("--landmark", "waist=0,-203,180")
    assert main(["solve", *TRUNK, *place, "--line", "waist=97%", "--out", str(tmp_path)]) == 0
    report = json.loads((tmp_path / "report.json").read_text("utf-8"))
    assert report["lower_trunk"]["girths"]["waist"]["level_mm"] == pytest.approx(180.0, abs=2.0)


def test_a_scan_without_legs_says_what_to_do(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", *PERSON, "--line", "waist=90%", "--out", str(tmp_path)]) == 2
    assert "Scan down to the middle of both thighs." in capsys.readouterr().err
    assert not (tmp_path / "report.json").exists()
    assert main(["solve", *PERSON, "--preset", "bodysuit", "--volume", "exact", "--out", str(tmp_path)]) == 0
    assert "lower trunk" in "".join(capsys.readouterr())
    assert "lower_trunk" not in json.loads((tmp_path / "report.json").read_text("utf-8"))


def test_a_project_keeps_the_lower_trunk(tmp_path: Path) -> None:
    project, design = tmp_path / "girdle.busk", dressed_sample("trunk")
    save_project(project, Document.single(design), read_scan_file(design.scan, quiet), None)
    assert open_project(project).design.lower == design.lower
    out = tmp_path / "out"
    bare = ("--cup", "none", "--settings", "tissue=net", "--volume", "exact")
    assert main(["solve", str(project), *bare, "--out", str(out)]) == 0
    assert "lower_trunk" in json.loads((out / "report.json").read_text("utf-8"))


def test_the_exported_body_is_that_of_both_regions(tmp_path: Path) -> None:
    worn = ("--line", "waist=90%", "--settings", "tissue=net", "--volume=exact")
    assert main(["solve", *TRUNK, *worn, "--out", str(tmp_path)]) == 0
    assert main(["export", TRUNK[0], *worn[:-1], "--body", str(tmp_path / "exported.ply")]) == 0
    solved, exported = (trimesh.load(tmp_path / name, process=False) for name in ("body.ply", "exported.ply"))
    assert len(solved.vertices) == len(exported.vertices)
    rest = trimesh.load(TRUNK[0], process=False).vertices
    assert np.abs(exported.vertices - rest).max() > 5.0
    assert np.abs(exported.vertices - solved.vertices).max() < 0.2  # adaptive turns end a little earlier


def test_cut_list_and_drawings_have_the_lines_below(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    worn = ("--line", "waist=97%", "--line", "sling=97%", "--settings", "tissue=net")
    assert main(["cut", *TRUNK, *worn, "--csv"]) == 0
    assert [row.split(",")[0] for row in capsys.readouterr().out.splitlines()[1:]] == [
        "waist",
        "sling-left",
        "sling-right",
    ]
    drawings = ("--lines", str(tmp_path / "lines.dxf"), "--strips", str(tmp_path / "strips.svg"))
    assert main(["export", TRUNK[0], *worn, *drawings]) == 0
    assert "Seat sling" in (tmp_path / "strips.svg").read_text("utf-8")


def test_own_lines_below_the_bust_and_bands_over_both_regions(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    belt = ("--path", "belt=r4c9:r4c11,r4c-10,r4c-9,lower")
    band = ("--path", "front=r2c2,r1c2", "--path", "front lower=r1c2:r5c2,lower,continues front")
    worn = ("--line", "belt=96%", "--line", "front=-10mm")
    assert main(["solve", *TRUNK, *belt, *band, *worn, "--volume", "exact", "--out", str(tmp_path)]) == 0
    report = json.loads((tmp_path / "report.json").read_text("utf-8"))
    below, above = report["lower_trunk"]["lines"], report["lines"]["front"]
    assert below["belt"]["set_mm"] == pytest.approx(0.96 * below["belt"]["rest_mm"])
    shorter = [each["rest_mm"] - each["set_mm"] for each in (above, below["front lower"])]
    assert sum(shorter) == pytest.approx(10.0), "the length is that of the whole band"
    assert shorter[0] / above["rest_mm"] == pytest.approx(shorter[1] / below["front lower"]["rest_mm"])
    capsys.readouterr()
    assert main(["solve", *PERSON, *belt, "--line", "belt=96%", "--out", str(tmp_path)]) == 2
    assert "The scan ends above the crotch" in capsys.readouterr().err
