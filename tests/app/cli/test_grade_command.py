"""``busk grade`` and ``busk compare`` on the results of a real run, and what they refuse."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from batch_tools import run_batch
from graded_runs import STRAP, made_rows, write_run

from app.cli.main import BAD_INPUT, main
from app.cli.output import DONE

GRADE_FILES = {"grade.csv", "increments.csv", "grade_rules.csv", "served.csv", "new_sizes.csv", "grade.json"}


@pytest.fixture(scope="module")
def results(person: Path, mannequin: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of two designs on two bodies."""
    out = tmp_path_factory.mktemp("run") / "results"
    designs = ("--design", "soft bra", "--design", "underwired bra")
    code, _, errors = run_batch(person, mannequin, *designs, "--out", out, "--workers", "1")
    assert code == DONE, errors
    return out


def test_a_real_run_is_graded(results: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grade", str(results), "--by", "size", "--system", "eu"]) == DONE
    printed = capsys.readouterr().out
    folder = results / "grade"
    assert {path.name for path in folder.iterdir()} == GRADE_FILES | {"grade.html"}
    values = json.loads((folder / "grade.json").read_text("utf-8"))["variants"]
    assert [each["variant"] for each in values] == ["Soft bra", "Underwired bra"]
    for each in values:
        assert each["bodies"] + each["left_out"]["no_size"] == 2
        assert f"{each['variant']}: {each['bodies']} bod" in printed
    with open(folder / "grade.csv", newline="", encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    means = {
        (row["variant"], row["size"]): float(row["mean"]) for row in rows if "under-bust" in row["measure"]
    }
    assert set(means.values()) <= _cut_lengths(results)


def _cut_lengths(results: Path) -> set[float]:
    with open(results / "results.csv", newline="", encoding="utf-8-sig") as file:
        return {float(f"{float(row['cut_length_under-bust_mm']):.6g}") for row in csv.DictReader(file)}


def test_the_designs_of_a_real_run_are_compared(results: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", str(results)]) == DONE
    assert "2 bodies have results of both" in capsys.readouterr().out
    values = json.loads((results / "compare" / "compare.json").read_text("utf-8"))
    assert (values["first"], values["second"], values["bodies"]) == ("Soft bra", "Underwired bra", 2)
    reverse = ["--variants", "Underwired bra", "Soft bra", "--out", str(results / "reverse")]
    assert main(["compare", str(results), *reverse]) == DONE
    swapped = json.loads((results / "reverse" / "compare.json").read_text("utf-8"))["lift_and_pressure"]
    assert swapped["better"] == values["lift_and_pressure"]["worse"]


def test_grading_again_writes_the_same(results: Path, tmp_path: Path) -> None:
    for name in ("a", "b"):
        assert main(["grade", str(results), "--out", str(tmp_path / name)]) == DONE
    for path in (tmp_path / "a").iterdir():
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes()


def test_two_runs_with_one_design_each_are_compared(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, second = (str(write_run(tmp_path / name, made_rows(5))) for name in ("one", "two"))
    assert main(["compare", first, second]) == DONE
    assert "First: one (one). Second: one (two)" in capsys.readouterr().out


def test_a_column_that_no_design_has_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = str(write_run(tmp_path, made_rows(5)))
    assert main(["grade", run, "--fit", "cut_length_under*", "--fit", "seam_wier*=8"]) == DONE
    assert "--fit seam_wier* is none of the graded measures" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (["grade", "absent"], "holds no results"),
        (["grade", "run", "--variant", "none"], "There is no variant 'none'"),
        (["grade", "run", "--measure", "bust_mm"], "no values of measures"),
        (["grade", "run", "--fit", "bust_mm"], "decides whom a size serves"),
        (["grade", "run", "--system", "eu"], "has a size in this system"),
        (["grade", "run", "--serve", "0"], "is not a number above 0"),
        (["grade", "run", "--fit", "seam*=x"], "is not a number above 0"),
        (["compare", "run"], "not clear which two designs"),
        (["compare", "run", "--variants", "one", "two"], "There is no variant 'two'"),
        (["compare", "run", "absent"], "holds no results"),
    ],
)
def test_wrong_words_are_refused(
    words: list[str],
    problem: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    write_run(tmp_path / "run", made_rows(5))
    monkeypatch.chdir(tmp_path)
    assert main(words) == BAD_INPUT
    assert problem in capsys.readouterr().err
    assert not (tmp_path / "run" / "grade").exists()


def test_a_measure_that_none_of_the_chosen_bodies_has_is_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = made_rows(6)
    for number, row in enumerate(rows):
        row["verdict"] = "good" if number else "bad"
        row.update({STRAP: None} if number else {})
    run = write_run(tmp_path / "run", rows)
    assert main(["grade", str(run), "--verdict", "good"]) == DONE
    assert STRAP not in capsys.readouterr().out
    assert main(["grade", str(run), "--verdict", "good", "--measure", STRAP, "--fit", STRAP]) == BAD_INPUT
    assert "no values of measures to grade" in capsys.readouterr().err
