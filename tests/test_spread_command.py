"""busk spread: what it prints, as JSON and as a table, and what it refuses."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import pytest

from app.cli import main

QUICK = ("--assume", "landmark_mm=0", "--assume", "unsure_landmark_mm=0")
WORN = ("--line", "mid-bust=70%", "--elastic", "mid-bust=picot 10")


def test_it_prints_figures_with_what_they_may_be_off_by(
    mannequin: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["spread", str(mannequin), *WORN, *QUICK]) == 0
    said = capsys.readouterr().out
    assert "Waist girth                              692.9 ±  2.5" in said
    assert "mid-bust: length to cut" in said
    assert "if the line slides over it" in said
    assert "Hip girth" not in said  # the scan shows none
    assert "Left out:" in said


def test_it_writes_shares_as_json_and_standard_deviations_as_a_table(
    mannequin: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wider = (*WORN, *QUICK, "--assume", "sds=3", "--assume", "skin_mm=0.4")
    assert main(["spread", str(mannequin), *wider, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    waist = told["figures"]["before:waist_girth"]
    assert waist["plus_minus"] == pytest.approx(3.0 * 2.0 * 1.26, rel=0.02)
    assert waist["shares"]["scan"] == pytest.approx(1.0)
    assert told["figures"]["before:hip_girth"]["plus_minus"] is None
    assert told["figures"]["cut:mid-bust"]["other_contact"] > 300.0
    assert main(["spread", str(mannequin), *WORN, *QUICK, "--csv"]) == 0
    rows = {row["key"]: row for row in csv.DictReader(io.StringIO(capsys.readouterr().out))}
    pull = rows["tension:mid-bust"]
    assert float(pull["plus_minus"]) == pytest.approx(
        2.0 * sum(float(pull[name]) ** 2 for name in ("tissue", "tape", "elastic") if pull[name]) ** 0.5,
        rel=1e-3,
    )


@pytest.mark.parametrize("wrong", ["tape=3", "skin_mm=thick", "skin_mm=-1"])
def test_what_cannot_be_assumed_is_said(
    mannequin: Path, capsys: pytest.CaptureFixture[str], wrong: str
) -> None:
    assert main(["spread", str(mannequin), "--assume", wrong]) == 2
    assert capsys.readouterr().err
