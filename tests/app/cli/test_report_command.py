"""``busk report``: the sheet with no display at all, whole files or none, and what is refused."""

from __future__ import annotations

import csv
import errno
import json
import os
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest
from pdf_tools import Pdf

from app.cli.main import BAD_INPUT, main
from app.cli.output import DONE
from app.i18n import lengths
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.project_file import read_scan_file, save_project

ROOT = Path(__file__).parents[3]
WORN = ["--line", "mid-bust=70%", "--elastic", "mid-bust=plush 12"]
RUNS_AWAY = ["--line", "mid-bust=60%", "--settings=line_force=explicit", "--settings=line_stiffness=60"]
NO_DISPLAY = ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM", "VTK_DEFAULT_OPENGL_WINDOW")


def test_a_report_without_a_display(mannequin: Path, tmp_path: Path) -> None:
    environment = {key: value for key, value in os.environ.items() if key not in NO_DISPLAY}
    words = ["report", str(mannequin), *WORN, "--out", "sheet.pdf", "--json", "sheet.json"]
    words += ["--csv", "sheet.csv", "--language", "ja", "--customer", "佐藤 0412", "--system", "eu"]
    run = "import sys; from app.cli.main import main; sys.exit(main(sys.argv[1:]))"
    command = [sys.executable, "-c", run, *words]
    path = {**environment, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=tmp_path, env=path, capture_output=True, text=True, check=False)
    assert done.returncode == DONE, done.stderr
    assert "written to sheet.pdf, sheet.json, sheet.csv" in done.stdout
    assert "could not be rendered" not in done.stderr
    data = json.loads((tmp_path / "sheet.json").read_text("utf-8"))
    pdf = Pdf(tmp_path / "sheet.pdf")
    text = pdf.text()
    assert len(pdf.sizes) == 2
    assert "佐藤 0412" in text
    assert data["heading"]["customer"] == "佐藤 0412"
    assert data["sizes"][0]["key"] == "eu"
    assert f"{data['cuts']['rows'][0]['cut_mm']:,.0f} mm" in text
    bust = next(row for row in data["measures"] if row["key"] == "bust_girth")
    assert f"{bust['before']:.1f} {bust['after']:.1f}" in text
    rows = list(csv.DictReader((tmp_path / "sheet.csv").read_text("utf-8-sig").splitlines()))
    assert {row["section"] for row in rows} >= {"sheet", "size", "measure", "cut", "pressure", "left out"}
    # The pictures are there: skin and bands are no greys.
    part = pdf.pixels(0)[150:280].astype(int)
    assert (abs(part[..., 0] - part[..., 2]) > 25).mean() > 0.1


def test_the_customer_of_a_project_is_taken_and_can_be_overruled(mannequin: Path, tmp_path: Path) -> None:
    design = Design(ScanSource(str(mannequin)), volume="exact", customer="Anna")
    project, out = tmp_path / "coat.busk", tmp_path / "sheet.json"
    document = Document.single(design).with_shown("B")
    save_project(project, document, read_scan_file(design.scan), None)
    words = ["report", str(project), "--out", str(tmp_path / "sheet.pdf"), "--json", str(out)]
    assert main(words) == DONE
    heading = json.loads(out.read_text("utf-8"))["heading"]
    assert (heading["customer"], heading["project"], heading["variant"]) == ("Anna", "coat", "B")
    assert main([*words, "--customer", ""]) == DONE
    assert json.loads(out.read_text("utf-8"))["heading"]["customer"] == ""


def test_a_report_in_inches_has_data_in_millimetres(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lengths, "_unit", "mm")  # as before, once it is over
    sheet, data = tmp_path / "sheet.pdf", tmp_path / "sheet.json"
    words = ["report", str(mannequin), *WORN, "--length-unit", "in"]
    assert main([*words, "--out", str(sheet), "--json", str(data)]) == DONE
    text, told = Pdf(sheet).text(), json.loads(data.read_text("utf-8"))
    cut, bust = told["cuts"]["rows"][0]["cut_mm"] / 25.4, told["measures"][0]["before"] / 25.4
    whole, part = divmod(round(16 * cut), 16)
    assert f"{whole} {Fraction(part, 16)} in" in text
    assert f"{bust:.2f}" in text
    assert not re.search(r"\d mm(?![A-Za-z])", text)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (["--out", "sheet.txt"], "ending in .pdf"),
        (["--out", "nowhere/sheet.pdf"], "does not exist"),
        (["--out", "sheet.pdf", "--json", "sheet.csv"], "ending in .json"),
        (["--out", "sheet.pdf", "--system", "xx"], "Unknown size system 'xx'"),
        (["--out", "sheet.pdf", "--allowance", "40"], "tape tension allowance of 40 mm is out of range"),
        ([], "--out"),
        (["--out", "a.pdf", *RUNS_AWAY], "The solver diverged"),
    ],
)
def test_invalid_options_are_refused_before_writing(
    mannequin: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    wrong: list[str],
    said: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["report", str(mannequin), *wrong]) == BAD_INPUT
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_report_without_pictures_where_they_cannot_be_rendered(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fails(*_: object, **__: object) -> None:
        raise RuntimeError("no graphics")

    monkeypatch.setattr("pyvista.Plotter", fails)
    out = tmp_path / "sheet.pdf"
    assert main(["report", str(mannequin), "--out", str(out)]) == DONE
    assert "could not be rendered" in capsys.readouterr().err
    assert "The images of the body could not be drawn" in Pdf(out).text()


def test_a_full_disk_leaves_the_old_report_or_one_without_pictures(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    written, fsync = [], os.fsync

    def full(handle: int) -> None:
        written.append(handle)
        if len(written) > room:
            raise OSError(errno.ENOSPC, "No space left on device")
        fsync(handle)

    monkeypatch.setattr(os, "fsync", full)
    out, room = tmp_path / "sheet.pdf", 1
    assert main(["report", str(mannequin), "--out", str(out)]) == DONE
    assert "No space left on device" in capsys.readouterr().err
    assert "The images of the body could not be drawn" in Pdf(out).text()
    before, room = out.read_bytes(), 0
    assert main(["report", str(mannequin), "--out", str(out)]) == BAD_INPUT
    assert "cannot be written: No space left on device" in capsys.readouterr().err
    assert out.read_bytes() == before
    assert list(tmp_path.iterdir()) == [out]
