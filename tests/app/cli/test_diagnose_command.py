"""busk doctor: what is printed and saved, and how it ends."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from shapes import SAMPLES

from app.cli.main import BAD_INPUT, main
from app.cli.output import DONE, NOT_CONVERGED
from core.document.storage.project_file import open_project, save_project
from core.pipeline.build import build

SCAN = str(SAMPLES / "mannequin.ply")
READ = ("--unit", "mm", "--up", "+z", "--front", "-y")


def test_a_vibration_is_told_with_what_fights_and_what_ends_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = str(tmp_path / "cured.busk")
    lines = ("--line", "mid-bust=95%", "--volume", "conventional", "--settings", "gain=1.7")
    assert main(["doctor", SCAN, *READ, *lines, "--out", out]) == DONE
    told = capsys.readouterr().out
    assert told.startswith("Verdict: Do not use\n")
    assert "\nvibrating: it swings and does not come to rest\nswings every 2.0 turns by " in told
    assert "mid-bust and the volume pull against each other: " in told
    assert "\n  1. keep the volume by the adaptive control: " in told, (
        "only the conventional control vibrates"
    )
    assert ". lower the gain from 1.70 to 1." in told
    assert told.endswith(f"written to {out}\n")
    assert open_project(out).design.volume == "adaptive", "the best is written"
    assert main(["doctor", out, "--json"]) == DONE
    again = json.loads(capsys.readouterr().out)
    assert (again["complaint"], again["state"]) == (None, "settled")
    assert {str(each["of"]) for each in again["forces"]} == {"['mid-bust']", "volume"}


def test_what_nothing_ends_is_said_with_the_locked_lines(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = str(tmp_path / "locked.busk")
    assert main(["doctor", SCAN, *READ, "--line", "mid-bust=85%", "--out", out]) == DONE
    assert ". lengthen mid-bust by " in capsys.readouterr().out
    project = open_project(out)
    locked = replace(project.design.traits_of("mid-bust"), locked=True)
    project = project.with_design(project.design.with_line("mid-bust", 0.85).with_traits(locked))
    save_project(out, project, build(project.design).scan, None)
    unwritten = tmp_path / "none.busk"
    assert main(["doctor", out, "--out", str(unwritten)]) == NOT_CONVERGED
    told = capsys.readouterr().out
    assert "was found that ends it." in told
    assert "Locked, and so left as they are: mid-bust." in told
    assert not unwritten.exists()


def test_a_cured_design_is_written_as_a_project_or_not_at_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", SCAN, "--out", "cured.ply"]) == BAD_INPUT
    assert "is no name of a project" in capsys.readouterr().err
