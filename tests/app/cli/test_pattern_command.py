"""Pattern pieces on the command line: files, JSON, the verdict as exit code, what cannot be cut."""

from __future__ import annotations

import json
from pathlib import Path

import ezdxf
import pytest

from app.cli.main import main
from app.presenters.samples import sample_path

STANDING = ("--unit", "mm", "--up", "+z", "--front=-y")
PERSON = (str(sample_path("person")), *STANDING)
MANNEQUIN = (str(sample_path("mannequin")), *STANDING)


def test_pieces_and_seams_are_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = {kind: tmp_path / f"a.{kind}" for kind in ("dxf", "svg", "plt", "pieces", "seams", "json")}
    options = [text for kind, path in files.items() for text in (f"--{kind}", str(path))]
    files["avatar"] = tmp_path / "avatar.obj"
    options += ["--avatar", str(files["avatar"])]
    worn = ("--line", "mid-bust=99%")
    assert main(["pattern", *MANNEQUIN, *worn, "--block", "three-part-cup", *options]) == 0
    told = capsys.readouterr().out
    assert all(f"written to {path}" in told for path in files.values())
    found = json.loads(files["json"].read_text("utf-8"))
    assert found["fits"]
    assert len(found["pieces"]) == 11
    assert {piece["cloth"] for piece in found["pieces"]} == {"cup tricot", "sheer tricot", "power net"}
    for seam in found["seams"]:
        assert seam["lengths_mm"][0] == pytest.approx(seam["lengths_mm"][1], abs=0.05)
    drawing = ezdxf.readfile(files["dxf"])
    names = {block.name for block in drawing.blocks if not block.name.startswith("*")}
    rows = files["pieces"].read_text("utf-8-sig").splitlines()
    assert len(names) == len(rows) - 1
    groups = {row[2:] for row in files["avatar"].read_text("ascii").splitlines() if row.startswith("g ")}
    assert {"body", "wire_left", "wire_right"} <= groups


def test_a_piece_that_does_not_fit_its_cloth_is_told_and_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "cup.svg"
    assert main(["pattern", *PERSON, "--block", "one-part-cup", "--svg", str(out)]) == 3
    assert "more than its cloth takes up" in capsys.readouterr().out
    assert out.exists()


def test_what_cannot_be_cut_is_refused_with_the_reason(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pattern", "--list"]) == 0
    assert "two-part-cup" in capsys.readouterr().out
    for words, why in (
        (["pattern", *PERSON], "block are required"),
        (["pattern", *PERSON, "--block", "hat"], "There is no block 'hat'"),
        (["pattern", *PERSON, "--block", "brief"], "waist, hips and seat"),
    ):
        assert main(words) == 2
        assert why in capsys.readouterr().err
