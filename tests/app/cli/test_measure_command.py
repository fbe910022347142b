"""`busk measure`: what it prints and writes of a scan and of a project."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from app.cli.main import main
from core.document.custom_measures import CustomMeasurement
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.project_file import open_project, read_scan_file, save_project
from core.measurements.definitions import KEYS, LOWER_KEYS

DOCS = Path(__file__).parents[3] / "docs"
BUST = [key for key in KEYS if key not in LOWER_KEYS]
GORE = CustomMeasurement("Gore", "straight", ("bust_point_left", "bust_point_right"))


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    sample = Path(__file__).parents[3] / "resources" / "samples" / "mannequin.ply"
    source = ScanSource(str(sample))
    design = Design(source, volume="exact").with_line("mid-bust", 0.95).with_custom_measurement(GORE)
    path = tmp_path_factory.mktemp("measure") / "anna.busk"
    save_project(path, Document.single(design), read_scan_file(source), b"")
    return path


def test_a_scan_is_measured_before_only(person: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["measure", str(person), "--custom", "Ribs=girth:fold_left-30", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["measures"]
    assert list(found) == [*(key for key in BUST if key != "apex_lift"), "own:Ribs"]
    assert 850.0 < found["bust_girth"]["before"] < 950.0
    assert found["bust_girth"]["after"] is None
    assert found["waist_girth"]["before"] is None
    assert "No waist detected" in found["waist_girth"]["note"]
    assert found["breast_volume_left"]["estimate"] is True
    assert found["bust_girth"]["iso"] == "Bust girth"


def test_a_project_is_measured_before_and_after(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["measure", str(project), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["measures"]
    assert set(BUST) < set(found)
    assert not LOWER_KEYS & set(found)
    assert found["apex_lift"]["after"] > 1.0
    bust = found["bust_girth"]
    assert bust["difference"] == pytest.approx(bust["after"] - bust["before"])
    assert bust["difference"] < -2.0
    assert found["own:Gore"]["after"] == found["bust_point_distance"]["after"]
    assert found["own:Gore"]["definition"] == str(GORE.text)
    assert open_project(project).design.own_measures == (GORE,)


def test_a_long_custom_name_keeps_the_columns(person: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = "Bust point left to the middle of the front, straight"
    assert main(["measure", str(person), "--custom", f"{name}=straight:bust_point_left,front_centre"]) == 0
    heading, first, *_, last = capsys.readouterr().out.splitlines()
    assert last.startswith(f"{name} ")
    assert first.index(" mm") == last.index(" mm") == heading.index(" unit")


def test_text_and_csv_have_the_same_values(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["measure", str(project)]) == 0
    text = capsys.readouterr().out.splitlines()
    assert text[0].startswith("Verdict: ")
    text = text[next(row for row, line in enumerate(text) if "before" in line) :]
    assert main(["measure", str(project), "--csv"]) == 0
    rows = list(csv.DictReader(capsys.readouterr().out.splitlines()))
    assert len(text) == len(rows) + 1
    for row in rows:
        title = f"{row['title']}, {row['side']}" if row["side"] else row["title"]
        line = next(line for line in text if line.startswith(f"{title} "))
        if row["after"]:
            assert f"{float(row['after']):z.{0 if row['unit'] == 'ml' else 1}f}" in line
        else:
            assert row["note"] in line


def test_it_is_written_whole_by_the_ending_of_its_name(person: Path, tmp_path: Path) -> None:
    for name in ("a.json", "a.csv", "a.txt"):
        assert main(["measure", str(person), "--out", str(tmp_path / name)]) == 0
    assert json.loads((tmp_path / "a.json").read_text("utf-8"))["versions"]
    assert len(list(csv.DictReader((tmp_path / "a.csv").read_text("utf-8").splitlines()))) == len(BUST) - 1
    assert "Bust girth" in (tmp_path / "a.txt").read_text("utf-8")


def test_a_requested_form_overrules_the_ending(person: Path, tmp_path: Path) -> None:
    assert main(["measure", str(person), "--json", "--out", str(tmp_path / "a.txt")]) == 0
    assert json.loads((tmp_path / "a.txt").read_text("utf-8"))["versions"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--custom", "Gore=straight:nose,chin"], "no landmark nose"),
        (["--out", " "], "has no name"),
        (["--custom", "A=girth:900", "--custom", "B=straight:a"], "no landmark a"),
    ],
)
def test_bad_words_get_one_sentence(
    person: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    assert main(["measure", str(person), *words]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert told.count("\n") == 1
