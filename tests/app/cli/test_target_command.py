"""busk target: what is printed and saved, how it ends, and what is refused."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from shapes import SAMPLES

from app.cli.main import BAD_INPUT, main
from app.cli.output import DONE, NOT_CONVERGED
from app.presenters.assessment import headline
from core.analysis.inverse_design.quantity import Goal
from core.analysis.inverse_design.target_requests import goals_of
from core.document.storage.project_file import open_project
from core.errors import UserError

SCAN = str(SAMPLES / "mannequin.ply")
WORN = ("--unit", "mm", "--up", "+z", "--front", "-y", "--line", "mid-bust=100%", "--line", "full-bust=100%")


def test_targets_are_read_in_common_notations() -> None:
    goals = goals_of(["lift=12mm", "out  left = -0,5 cm", "GIRTH=34.5in", "out right=−３"])
    told = [(goal.name, pytest.approx(goal.value)) for goal in goals]
    assert told == [("lift", 12.0), ("out left", -5.0), ("girth", 876.3), ("out right", -3.0)]
    assert goals_of(["lift=1"]) == (Goal("lift", 1.0),)


@pytest.mark.parametrize(
    ("wants", "sentence"),
    [
        (["lift"], "not a target"),
        (["lift=much"], "not a target"),
        (["lift=nan"], "not a target"),
        (["waist=700mm"], "Names: lift, lift left"),
        (["girth=88000mm"], "not a valid body length"),
        (["lift=1mm", "lift=2mm"], "specified twice"),
    ],
)
def test_an_invalid_target_is_refused(wants: list[str], sentence: str) -> None:
    with pytest.raises(UserError) as refused:
        goals_of(wants)
    assert sentence in f"{refused.value.message} {refused.value.hint}"


def test_a_reached_target_is_printed_and_saved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "found.busk"
    assert main(["target", SCAN, *WORN, "--target", "girth=870mm", "--out", str(out)]) == DONE
    told = capsys.readouterr().out
    assert told.startswith("Verdict: ")
    assert re.search(r"870\.0 mm +870\.0 mm$", told, re.M)
    design = open_project(out).design
    for line in design.lines:
        assert f" → {100.0 * line.ratio:.1f} %" in told
    assert main(["target", str(out), "--target", "girth=870mm", "--json"]) == DONE
    again = json.loads(capsys.readouterr().out)
    assert told.startswith(f"Verdict: {headline(again['assessment']['level'])}\n"), "on what was found"
    assert again["figures"]["girth"]["reached_mm"] == pytest.approx(870.0, abs=0.05)
    assert again["lines"]["mid-bust"]["before_percent"] == pytest.approx(100.0 * design.ratio("mid-bust"))


def test_a_target_that_is_not_reached_ends_with_three_and_names_the_lines(
    capsys: pytest.CaptureFixture[str],
) -> None:
    targets = ("--target", "girth=700mm", "--shortest", "mid-bust=99%", "--shortest", "full-bust=99%")
    assert main(["target", SCAN, *WORN, *targets, "--json"]) == NOT_CONVERGED
    found = json.loads(capsys.readouterr().out)
    assert not found["reached"]
    assert {name: line["set_percent"] for name, line in found["lines"].items()} == {
        "mid-bust": pytest.approx(99.0, abs=0.1),
        "full-bust": pytest.approx(99.0, abs=0.1),
    }
    assert [each.rpartition(": ")[2] for each in found["because"]] == ["shortest length, 99.0 %"] * 2
    assert set(found["not_looked_at_for_pressure"]) == {"mid-bust", "full-bust"}


def test_a_target_profile_is_read_from_a_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "wish.csv"
    table.write_text("height_mm;out_mm\n330,0;135,5\n350;140\n370;138\n")
    assert main(["target", SCAN, *WORN, "--profile", f"right={table}", "--pressure", "2.5"]) == NOT_CONVERGED
    told = capsys.readouterr().out
    assert re.search(r": .*\d+\.\d mm, .*\d+\.\d mm$", told, re.M), "mean and largest error"
    assert (
        main(["target", SCAN, *WORN, "--profile", str(table), "--target", "lift=0mm", "--json"])
        == NOT_CONVERGED
    )
    figures = json.loads(capsys.readouterr().out)["figures"]
    assert list(figures) == ["lift", *(f"profile left {height}.000" for height in (330, 350, 370))]
    assert figures["profile left 330.000"]["wanted_mm"] == 135.5


def test_a_target_is_required(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["target", SCAN, *WORN]) == BAD_INPUT
    assert "No target specified." in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ((), "No active lines"),
        ((*WORN, "--lock", "wing"), "'wing' is not an active line. Active lines: mid-bust, full-bust."),
        ((*WORN, "--shortest", "mid-bust=soon"), "is not a valid length for mid-bust"),
        ((*WORN, "--lock", "mid-bust", "--lock", "full-bust"), "No unlocked line moves the body"),
        ((*WORN, "--out", "found.ply"), "not a project file name"),
        ((*WORN, "--profile", "missing.csv"), "cannot be read as a table"),
        ((*WORN, "--profile", "bust=missing.csv"), "no section 'bust'"),
        ((*WORN, "--pressure", "0"), "pressure limit is out of range"),
    ],
)
def test_an_invalid_request_is_refused(
    words: tuple[str, ...], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["target", SCAN, *words, "--target", "lift=1mm"]) == BAD_INPUT
    assert sentence in capsys.readouterr().err
