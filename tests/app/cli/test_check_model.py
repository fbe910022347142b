"""busk check-model: its table, its JSON, its exit codes, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from coarse_bodies import coarse_body
from reference_cases import SLINGS, case_arrays, write_case

from app.cli.main import main

NET = ("--settings", "tissue=net")
"""The model whose displacements the cases hold."""


@pytest.fixture(scope="module")
def cases(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A case of the model's own displacements, and the same of twice these."""
    folder = tmp_path_factory.mktemp("cases")
    body = coarse_body("mannequin", folder)
    arrays = case_arrays(body, SLINGS)
    met = write_case(folder / "met", arrays, body)
    return met, write_case(folder / "missed", arrays, body, displacement=2.0 * arrays["displacement"])


def test_a_table_is_printed_and_the_exit_code_tells_the_result(
    cases: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    met, missed = map(str, cases)
    assert main(["check-model", "--case", met, *NET]) == 0
    assert "1 of 1 cases within the limits." in capsys.readouterr().out
    assert main(["check-model", "--case", met, "--case", missed, *NET]) == 3
    heading, first, second, *_, last = capsys.readouterr().out.splitlines()
    assert heading.split()[:2] == ["case", "kind"]
    assert first.split()[:2] == ["case", "sling"]
    assert first.endswith("passed")
    assert " 50.0 " in second
    assert second.endswith("failed")
    assert last.startswith("Lines: stiffness 16 ")


def test_json_has_the_agreed_keys(cases: tuple[Path, Path], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check-model", "--case", str(cases[1]), "--json", *NET]) == 3
    (told,) = json.loads(capsys.readouterr().out)["cases"]
    keys = {"case", "rms_mm", "reference_rms_mm", "ratio", "bust_up_mm", "reference_bust_up_mm", "passed"}
    assert keys <= set(told)
    assert (told["case"], told["passed"]) == ("case", False)
    assert told["ratio"] == pytest.approx(0.5, rel=1e-6)
    assert told["rms_mm"] == pytest.approx(0.5 * told["reference_rms_mm"], rel=1e-6)
    assert told["reference_bust_up_mm"] == pytest.approx(2.0 * told["bust_up_mm"], rel=1e-6)


def test_settings_choose_the_model(cases: tuple[Path, Path], capsys: pytest.CaptureFixture[str]) -> None:
    softer = ("--settings", "line_stiffness=2", "--settings", "firm_chest=0.1")
    assert main(["check-model", "--case", str(cases[0]), *NET, *softer]) == 3
    assert "Lines: stiffness 2 times" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (["--case", "nowhere.npz"], "nowhere.npz does not exist."),
        (["--case", "nothing"], "There is no reference case 'nothing'."),
        (["--settings", "line_height=0.6"], "each case contains its control mesh"),
        (["--settings", "template=120"], "each case contains its control mesh"),
        (["--settings", "softness=2"], "'softness=2' is not a setting."),
    ],
)
def test_bad_requests_get_one_sentence(
    capsys: pytest.CaptureFixture[str], words: list[str], problem: str
) -> None:
    assert main(["check-model", *words]) == 2
    told = capsys.readouterr()
    assert (told.out, told.err.count("\n")) == ("", 1)
    assert problem in told.err


def test_cases_that_come_with_the_program_are_the_default(
    cases: tuple[Path, Path], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    found: dict[str, Path] = {}
    for module in ("app.cli.commands.check_model", "core.analysis.model_check.reference_case"):
        monkeypatch.setattr(f"{module}.included_cases", lambda: found)
    assert main(["check-model"]) == 2
    assert "No reference cases are installed. Specify a file:" in capsys.readouterr().err
    found["met"] = cases[0]
    assert main(["check-model", *NET]) == 0
