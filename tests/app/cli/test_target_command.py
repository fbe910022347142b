"""busk ask: what is printed and saved, how it ends, and what is refused."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from shapes import SAMPLES

from app.cli.commands.target import goals_of
from app.cli.main import BAD_INPUT, main
from app.cli.options import WANT_HELP
from app.cli.output import DONE, NOT_CONVERGED
from app.presenters.assessment import headline
from core.analysis.inverse_design.quantities import NAMES, Goal
from core.document.storage.project_file import open_project
from core.errors import UserError

SCAN = str(SAMPLES / "mannequin.ply")
WORN = ("--unit", "mm", "--up", "+z", "--front", "-y", "--line", "mid-bust=100%", "--line", "full-bust=100%")


def test_wishes_are_read_as_people_write_them() -> None:
    goals = goals_of(["lift=12mm", "out  left = -0,5 cm", "GIRTH=34.5in", "out right=−３"])
    told = [(goal.name, pytest.approx(goal.value)) for goal in goals]
    assert told == [("lift", 12.0), ("out left", -5.0), ("girth", 876.3), ("out right", -3.0)]
    assert goals_of(["lift=1"]) == (Goal("lift", 1.0),)


@pytest.mark.parametrize(
    ("wants", "sentence"),
    [
        (["lift"], "cannot be asked for"),
        (["lift=much"], "cannot be asked for"),
        (["lift=nan"], "cannot be asked for"),
        (["waist=700mm"], "the names are: lift, lift left"),
        (["girth=88000mm"], "no length of a body"),
        (["lift=1mm", "lift=2mm"], "asked for twice"),
    ],
)
def test_what_is_no_wish_is_refused(wants: list[str], sentence: str) -> None:
    with pytest.raises(UserError) as refused:
        goals_of(wants)
    assert sentence in f"{refused.value.message} {refused.value.hint}"


def test_what_is_reached_is_told_and_saved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "found.busk"
    assert main(["ask", SCAN, *WORN, "--want", "girth=870mm", "--out", str(out)]) == DONE
    told = capsys.readouterr().out
    assert told.startswith("Verdict: ")
    assert re.search(r"^girth +870\.0 mm +870\.0 mm$", told, re.M)
    assert "Reached." in told
    design = open_project(out).design
    for line in design.lines:
        assert f"{line.name}: {100.0 * line.ratio:.1f} %" in told
    assert main(["ask", str(out), "--want", "girth=870mm", "--json"]) == DONE
    again = json.loads(capsys.readouterr().out)
    assert told.startswith(f"Verdict: {headline(again['assessment']['level'])}\n"), "on what was found"
    assert again["figures"]["girth"]["reached_mm"] == pytest.approx(870.0, abs=0.05)
    assert again["lines"]["mid-bust"]["before_percent"] == pytest.approx(100.0 * design.ratio("mid-bust"))


def test_what_is_not_reached_ends_with_three_and_says_why(capsys: pytest.CaptureFixture[str]) -> None:
    wishes = ("--want", "girth=700mm", "--shortest", "mid-bust=99%", "--shortest", "full-bust=99%")
    assert main(["ask", SCAN, *WORN, *wishes]) == NOT_CONVERGED
    told = capsys.readouterr().out
    assert "Not reachable; this is the nearest, because " in told
    assert "full-bust is as short as it may be" in told
    assert "mid-bust is as short as it may be" in told
    assert "Not looked at for pressure" in told


def test_a_profile_is_asked_for_from_a_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table = tmp_path / "wish.csv"
    table.write_text("height_mm;out_mm\n330,0;135,5\n350;140\n370;138\n")
    assert main(["ask", SCAN, *WORN, "--profile", f"right={table}", "--pressure", "2.5"]) == NOT_CONVERGED
    told = capsys.readouterr().out
    assert re.search(
        r"^profile right: 3 heights, off by \d+\.\d mm in the mean, \d+\.\d mm at most\.$", told, re.M
    )
    assert (
        main(["ask", SCAN, *WORN, "--profile", str(table), "--want", "lift=0mm", "--json"]) == NOT_CONVERGED
    )
    figures = json.loads(capsys.readouterr().out)["figures"]
    assert list(figures) == ["lift", *(f"profile left {height}.000" for height in (330, 350, 370))]
    assert figures["profile left 330.000"]["wanted_mm"] == 135.5


def test_something_has_to_be_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["ask", SCAN, *WORN]) == BAD_INPUT
    assert "Nothing is asked for. Name a figure" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ((), "No line is worn"),
        ((*WORN, "--lock", "wing"), "'wing' names no worn line. Worn are: mid-bust, full-bust."),
        ((*WORN, "--shortest", "mid-bust=soon"), "is not a length for mid-bust"),
        ((*WORN, "--lock", "mid-bust", "--lock", "full-bust"), "No line that moves the body may change"),
        ((*WORN, "--out", "found.ply"), "no name of a project"),
        ((*WORN, "--profile", "missing.csv"), "cannot be read as a table"),
        ((*WORN, "--profile", "bust=missing.csv"), "no section 'bust'"),
        ((*WORN, "--pressure", "0"), "no pressure to keep to"),
    ],
)
def test_what_cannot_be_asked_is_refused(
    words: tuple[str, ...], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["ask", SCAN, *words, "--want", "lift=1mm"]) == BAD_INPUT
    assert sentence in capsys.readouterr().err


def test_the_help_names_what_can_be_asked_for() -> None:
    # The help stands apart from the search: the command line loads nothing of that before it is asked for.
    assert WANT_HELP.endswith(f"The names are: {', '.join(NAMES)}")
