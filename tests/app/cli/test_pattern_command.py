"""Pattern pieces on the command line: files, JSON, the verdict as exit code, what cannot be cut."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import ezdxf
import pytest

from app.cli.main import main
from app.presenters.samples import sample_path
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.garment_pattern import GarmentPattern
from core.document.storage.project_file import read_scan_file, save_project
from core.pattern.block_library import find_block, read_block
from core.pattern.cloth_csv import TEMPLATE, read_cloth
from core.pattern.cloth_library import find_cloth, with_cloth

STANDING = ("--unit", "mm", "--up", "+z", "--front=-y")
PERSON = (str(sample_path("person")), *STANDING)
MANNEQUIN = (str(sample_path("mannequin")), *STANDING)


def test_pieces_and_seams_are_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    kinds = ("dxf", "svg", "plt", "pieces", "seams", "json", "save-block")
    files = {kind: tmp_path / f"a.{kind}" for kind in kinds}
    files["save-block"] = tmp_path / "mine.json"
    options = [text for kind, path in files.items() for text in (f"--{kind}", str(path))]
    files["avatar"] = tmp_path / "avatar.obj"
    options += ["--avatar", str(files["avatar"])]
    worn = ["--line", "mid-bust=99%", "--elastic", "mid-bust=picot 8", "--strips"]
    worn += ["--line", "under-bust=98%", "--elastic", "under-bust=plush 12", "--cloth", "wing=stretch lace"]
    assert main(["pattern", *MANNEQUIN, *worn, "--block", "three-part-cup", *options]) == 0
    told = capsys.readouterr().out
    assert all(f"written to {path}" in told for path in files.values())
    found = json.loads(files["json"].read_text("utf-8"))
    assert found["fits"]
    assert len(found["pieces"]) == 11
    assert {piece["cloth"] for piece in found["pieces"]} == {"cup tricot", "sheer tricot", "stretch lace"}
    assert {each["line"] for each in found["elastics"]} == {"under-bust"}
    assert "Strip: Mid-bust, Picot edge 8 mm" in told
    block = read_block(files["save-block"])
    assert {panel.name: panel.cloth for panel in block.panels}["wing"] == "stretch lace"
    assert block.seams == find_block("three-part-cup").seams
    for seam in found["seams"]:
        assert seam["lengths_mm"][0] == pytest.approx(seam["lengths_mm"][1], abs=0.05)
    drawing = ezdxf.readfile(files["dxf"])
    names = {block.name for block in drawing.blocks if not block.name.startswith("*")}
    rows = files["pieces"].read_text("utf-8-sig").splitlines()
    assert len(names) == len(rows) - 1
    assert "MID_BUST" in names
    edges = files["seams"].read_text("utf-8-sig").splitlines()
    assert sum("under-bust" in row for row in edges) >= 3, "wing, cradle, bridge"
    groups = {row[2:] for row in files["avatar"].read_text("ascii").splitlines() if row.startswith("g ")}
    assert {"body", "wire_left", "wire_right"} <= groups


def test_a_piece_that_does_not_fit_its_cloth_is_told_and_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, project = tmp_path / "cup.svg", tmp_path / "her.busk"
    stiff = replace(find_cloth("cup foam"), name="her foam", title="Her foam", limit=0.04)
    plan = with_cloth(GarmentPattern(find_block("one-part-cup"), allowance=9.0), "cup", stiff)
    design = Design(ScanSource(PERSON[0], unit="mm", up="+z", front="-y"), pattern=plan)
    save_project(project, Document.single(design), read_scan_file(design.scan), b"")
    files = ["--svg", str(out), "--seams", str(tmp_path / "seams"), "--json", str(tmp_path / "cup.json")]
    assert main(["pattern", str(project), *files]) == 3
    told = capsys.readouterr().out
    assert "Cup, left: Strain of " in told
    values = json.loads((tmp_path / "cup.json").read_text("utf-8"))
    assert not values["fits"]
    assert {piece["limit_percent"] for piece in values["pieces"]} == {4.0}
    assert all(piece["strain_p95_percent"] > 4.0 and piece["reason"] for piece in values["pieces"])
    assert ",9," in (tmp_path / "seams").read_text("utf-8-sig"), "the allowance of the project"
    assert out.exists()


def test_what_cannot_be_cut_is_refused_with_the_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["pattern", "--list"]) == 0
    assert "two-part-cup" in capsys.readouterr().out
    assert main(["pattern", "--save-cloth", str(tmp_path / "mine.csv")]) == 0
    assert (tmp_path / "mine.csv").read_text("utf-8-sig") == TEMPLATE
    save = ["pattern", "--save-cloth", str(tmp_path / "net.csv")]
    assert main([*save, "--cloth", "power net"]) == 0
    assert read_cloth(tmp_path / "net.csv") == find_cloth("power net")
    capsys.readouterr()
    (tmp_path / "broken.json").write_text("{}", "utf-8")
    same, first = str(tmp_path / "same.csv"), ["--json", str(tmp_path / "first.json")]
    cup = ["--block", "two-part-cup"]
    for words, why in (
        (["pattern", *PERSON], "block are required"),
        (["pattern", *PERSON, "--block", "hat"], "There is no block 'hat'"),
        (["pattern", *PERSON, "--block", "brief"], "waist, hips and seat"),
        (["pattern", *PERSON, "--block", str(tmp_path / "broken.json")], "block broken cannot be used"),
        (["pattern", *PERSON, "--block", str(tmp_path / "none.json")], "none.json"),
        (["pattern", *PERSON, *cup, "--cloth", "wing"], "'wing' is not a piece and its cloth"),
        (["pattern", *PERSON, *cup, "--cloth", "hat=power net"], "There is no piece 'hat'"),
        (["pattern", *PERSON, *cup, "--cloth", "wing=tin"], "No cloth matches 'tin'"),
        (["pattern", *PERSON, *cup, "--cloth", f"wing={tmp_path / 'mine.csv'}"], "not specify the stretch"),
        (["pattern", *PERSON, *cup, *first, "--dart-chart", "cup"], "There is no piece 'cup'"),
        (["pattern", *PERSON, *cup, *first, "--avatar", str(tmp_path / "a.stl")], ".stl files"),
        (["pattern", *PERSON, *cup, "--pieces", same, "--seams", same], "same.csv is used twice"),
        ([*save, "--cloth", "power net", "--cloth", "stretch lace"], "one cloth"),
    ):
        assert main(words) == 2
        assert why in capsys.readouterr().err
    assert {path.name for path in tmp_path.iterdir()} == {"mine.csv", "net.csv", "broken.json"}
