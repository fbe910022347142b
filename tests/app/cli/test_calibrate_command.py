"""``busk calibrate``: what it prints, how it ends, what it saves and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from worn_pair import write_worn_pair

from app.cli.main import main
from core.document.storage.project_file import open_project


@pytest.fixture(scope="module")
def pair(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    """A project on a body of 2,100 corners, and a scan with the garment on that needs other numbers."""
    return write_worn_pair(tmp_path_factory.mktemp("worn"), hole=0.0)[:2]


def test_residuals_and_parameters_are_printed_and_saved(
    pair: tuple[str, str], tmp_path: Path, capsys
) -> None:
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
        (["--unit", "cm"], "In cm, the trunk girth would be 872"),
    ],
)
def test_invalid_options_are_refused(pair: tuple[str, str], words: list[str], said: str, capsys) -> None:
    assert main(["calibrate", *pair, *words]) == 2
    assert said in capsys.readouterr().err
