"""busk diagnose: what is printed and saved, and how it ends."""

from __future__ import annotations

import json
import re
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


def test_an_oscillation_is_printed_with_its_fixes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path / "cured.busk")
    lines = ("--line", "mid-bust=95%", "--volume", "conventional", "--settings", "gain=1.7")
    assert main(["diagnose", SCAN, *READ, *lines, "--out", out]) == DONE
    told = capsys.readouterr().out
    assert told.startswith("Verdict: Do not use\n")
    assert len(re.findall(r"^  \d\. ", told, re.M)) >= 2, "fixes are numbered"
    assert told.endswith(f"written to {out}\n")
    assert open_project(out).design.volume == "adaptive", "the best is written"
    assert main(["diagnose", out, "--json"]) == DONE
    again = json.loads(capsys.readouterr().out)
    assert (again["complaint"], again["state"]) == (None, "settled")
    assert {str(each["of"]) for each in again["forces"]} == {"['mid-bust']", "volume"}


def test_without_a_fix_the_locked_lines_are_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = str(tmp_path / "locked.busk")
    assert main(["diagnose", SCAN, *READ, "--line", "mid-bust=85%", "--out", out]) == DONE
    capsys.readouterr()
    project = open_project(out)
    locked = replace(project.design.line_settings("mid-bust"), locked=True)
    project = project.with_design(project.design.with_line("mid-bust", 0.85).with_line_settings(locked))
    save_project(out, project, build(project.design).scan, None)
    unwritten = tmp_path / "none.busk"
    assert main(["diagnose", out, "--out", str(unwritten), "--json"]) == NOT_CONVERGED
    found = json.loads(capsys.readouterr().out)
    assert (found["cure"], found["fixes"], found["locked"]) == (None, [], ["mid-bust"])
    assert not unwritten.exists()


def test_a_fixed_design_is_written_as_a_project_or_not_at_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["diagnose", SCAN, "--out", "cured.ply"]) == BAD_INPUT
    assert "is not a project file name" in capsys.readouterr().err
