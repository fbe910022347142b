"""``busk calibrate``: what it prints, how it ends, what it saves and what it refuses."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.cli.main import main
from benchmarks.worn_pairs import scanned, worn_mesh, written
from core.document.document import Document
from core.document.storage.project_file import open_project, save_project
from core.pipeline.build import build


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    """A project on a body of 2,100 corners, and a scan with the garment on that needs other numbers."""
    folder = tmp_path_factory.mktemp("worn")
    small = open_project(Path(__file__).parents[2] / "releases/0.1.0/first.busk").design
    design = replace(small, volume="exact", firm_chest=0.03).with_line("mid-bust", 0.88)
    stages = build(design)
    truth = worn_mesh(stages, replace(design, line_stiffness=6.0, firm_chest=0.1))
    mesh, _ = scanned(truth, stages, np.random.default_rng(4), noise=0.2, resampled=False, hole=0.0)
    save_project(folder / "plan.busk", Document.single(design), stages.scan, None)
    return str(folder / "plan.busk"), written(mesh, folder / "worn.ply")


def test_it_tells_finds_and_saves(pair: tuple[str, str], tmp_path: Path, capsys) -> None:
    out = str(tmp_path / "calibrated.busk")
    assert main(["calibrate", *pair, "--out", out]) == 0
    said = capsys.readouterr().out
    assert "100 %" in said.splitlines()[0], "of the skin is aligned"
    assert said.endswith(f"written to {out}\n")
    design = open_project(out).design
    assert design.calibration is not None
    assert design.line_stiffness == pytest.approx(6.0, rel=0.15)
    again = str(tmp_path / "again.busk")
    arguments = ["calibrate", out, pair[1], "--json", "--out", again]
    assert main(arguments) == 3, "a second time it does not help"
    assert open_project(again).design.line_stiffness == design.line_stiffness, "saved as it was"
    told = json.loads(capsys.readouterr().out)
    assert told["helped"] is False
    assert told["alignment"]["met"] == pytest.approx(1.0, abs=0.01)
    assert told["after"]["all"]["rms_mm"] == pytest.approx(told["before"]["all"]["rms_mm"], rel=0.01)
    assert {number["name"] for number in told["numbers"]} == {"line_stiffness", "firm_chest"}
    for number in told["numbers"]:
        assert number["told"] is (number["plus_minus"] <= 0.05 * number["after"])
    assert told["points"] > 300


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--thickness", "25"], "thickness 25 mm is out of range"),
        (["--out", "found.ply"], "found.ply is not a project file name"),
        (["--unit", "cm"], "is not the size of a body"),
    ],
)
def test_what_cannot_be_is_refused(pair: tuple[str, str], words: list[str], said: str, capsys) -> None:
    assert main(["calibrate", *pair, *words]) == 2
    assert said in capsys.readouterr().err
