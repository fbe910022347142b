"""busk uncertainty: what it prints, as JSON and as a table, and what it refuses."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from pathlib import Path

import pytest
from coarse_bodies import coarse_body

from app.cli.main import main

QUICK = ("--assume", "landmark_mm=0", "--assume", "unsure_landmark_mm=0")
WORN = ("--line", "mid-bust=70%", "--elastic", "mid-bust=picot 10")


@pytest.fixture(scope="module")
def mannequin(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return coarse_body("mannequin", tmp_path_factory.mktemp("coarse"))


def test_values_are_printed_with_their_uncertainty(
    mannequin: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["uncertainty", str(mannequin), *WORN, *QUICK]) == 0
    said = capsys.readouterr().out
    assert said.startswith("Verdict: Check before use\n  Mid-bust: contact pressure ")
    assert re.search(r"^Waist girth \(narrowest\) +69\d\.\d ± +2\.5 ", said, re.M)
    assert "mid-bust: cut length" in said
    assert "skin contact sliding" in said
    assert re.search(r"mid-bust: tension +\d+\.\d \(\d+\.\d to \d+(\.\d)?\)", said)
    assert "Hip girth" not in said  # the scan shows none
    assert "Not included:" in said


def test_it_writes_shares_as_json_and_standard_deviations_as_a_table(
    mannequin: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wider = (*WORN, *QUICK, "--assume", "sds=3", "--assume", "skin_mm=0.4")
    assert main(["uncertainty", str(mannequin), *wider, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["assessment"]["level"] == "caution"
    waist = told["figures"]["before:waist_girth"]
    assert waist["plus_minus"] == pytest.approx(3.0 * 2.0 * 1.26, rel=0.02)
    assert waist["shares"]["scan"] == pytest.approx(1.0)
    assert told["figures"]["before:hip_girth"]["plus_minus"] is None
    assert told["figures"]["cut:mid-bust"]["other_contact"] > 300.0
    assert main(["uncertainty", str(mannequin), *WORN, *QUICK, "--csv"]) == 0
    rows = {row["key"]: row for row in csv.DictReader(io.StringIO(capsys.readouterr().out))}
    pull = rows["tension:mid-bust"]
    parts = [float(pull[name]) for name in ("tissue", "tape", "elastic") if pull[name]]
    off = 2.0 * math.hypot(*parts) / float(pull["value"])
    assert pull["plus_minus"] == ""
    assert float(pull["low"]) == pytest.approx(float(pull["value"]) * math.exp(-off), rel=1e-3)
    assert float(pull["high"]) == pytest.approx(float(pull["value"]) * math.exp(off), rel=1e-3)


def test_without_lines_the_original_body_is_printed(
    mannequin: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["uncertainty", str(mannequin), *QUICK]) == 0
    said = capsys.readouterr().out
    assert said.startswith("Verdict: No active lines\n\nNo active lines: ")
    assert re.search(r"^Waist girth \(narrowest\) +69\d\.\d ± +2\.5 +mm", said, re.M)
    assert "girth of the anatomical waist may" in said
    assert not any(word in said for word in ("sliding", "as set", "Bust point lift", "skin contact"))


@pytest.mark.parametrize("wrong", ["tape=3", "skin_mm=thick", "skin_mm=-1"])
def test_an_invalid_assumption_is_refused(
    mannequin: Path, capsys: pytest.CaptureFixture[str], wrong: str
) -> None:
    assert main(["uncertainty", str(mannequin), "--assume", wrong]) == 2
    assert capsys.readouterr().err
