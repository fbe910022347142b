"""The command line is a contract: forms, files, exit codes, sentences."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from app.cli.main import main
from core import __version__
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.lines import ActiveLine, CustomLine
from core.document.storage.project_file import ScanFile, open_project, save_project

TURN_COLUMNS = [
    "turn",
    "volume_error_percent",
    "volume_error_ml",
    "bust_point_left_above_lowest_mm",
    "bust_point_right_above_lowest_mm",
    "apex_above_lowest_mm",
    "apex_protrusion_mm",
    "length_under-bust_mm",
    "length_mid-bust_mm",
    "length_full-bust_mm",
    "step_mm",
]


def test_solve_writes_everything(person: Path, tmp_path: Path) -> None:
    lines = ["--line", "under-bust=97%", "--line", "mid-bust=-20mm"]
    assert main(["solve", str(person), *lines, "--volume", "adaptive", "--out", str(tmp_path / "out")]) == 0
    rows = list(csv.reader((tmp_path / "out" / "turns.csv").read_text("utf-8").splitlines()))
    assert rows[0] == TURN_COLUMNS
    figures = json.loads((tmp_path / "out" / "report.json").read_text("utf-8"))
    assert figures["state"] == "settled"
    assert figures["turns"] == len(rows) - 1 == int(rows[-1][0])
    assert abs(float(rows[-1][1])) < 0.001
    shown = trimesh.load(tmp_path / "out" / "body.ply", process=False).vertices
    left = shown[shown[:, 0] > 0.0]
    nipple = left[left[:, 1].argmin(), 2] - shown[:, 2].min()
    assert float(rows[-1][3]) == pytest.approx(nipple, abs=2.0), "heights are above the lowest point"
    final = figures["marks"]["final"]["bust_point_left_above_lowest_mm"]
    assert final == pytest.approx(float(rows[-1][3]))
    line = figures["lines"]["mid-bust"]
    assert line["set_mm"] == pytest.approx(line["rest_mm"] - 20.0)
    assert line["set_mm"] < line["reached_mm"] < line["rest_mm"]
    assert any("under-bust" in note and "rib cage" in note for note in figures["notes"])
    assert figures["versions"]["busk"] == __version__
    assert "read scan" in figures["seconds"]


def test_the_written_body_is_the_scan_with_a_moved_bust(fine_mannequin: Path, tmp_path: Path) -> None:
    assert (
        main(
            [
                "solve",
                str(fine_mannequin),
                "--line",
                "mid-bust=95%",
                "--volume",
                "exact",
                "--out",
                str(tmp_path),
            ]
        )
        == 0
    )
    before = trimesh.load(fine_mannequin, process=False)
    after = trimesh.load(tmp_path / "body.ply", process=False)
    assert np.array_equal(before.faces, after.faces)
    away = np.linalg.norm(before.vertices - after.vertices, axis=1)
    assert 2.0 < away.max() < 20.0
    assert np.mean(away < 1e-4) > 0.6
    control = trimesh.load(tmp_path / "control.ply", process=False)
    assert len(control.faces) == 168


HELD = ["--settings", "line_hold=held", "--settings", "line_contact=sliding"]


@pytest.mark.parametrize(("volume", "line", "code"), [("none", "97%", 0), ("conventional", "60%", 3)])
def test_the_exit_code_is_that_of_convergence(
    mannequin: Path, tmp_path: Path, volume: str, line: str, code: int
) -> None:
    arguments = [
        "solve",
        str(mannequin),
        "--line",
        f"mid-bust={line}",
        "--volume",
        volume,
        "--out",
        str(tmp_path),
    ]
    assert main(arguments) == code
    state = json.loads((tmp_path / "report.json").read_text("utf-8"))["state"]
    assert state == ("settled" if code == 0 else "vibrating")


def test_the_requested_number_of_iterations_is_made(mannequin: Path, tmp_path: Path) -> None:
    main(["solve", str(mannequin), "--line", "mid-bust=97%", "--iterations", "7", "--out", str(tmp_path)])
    assert len((tmp_path / "turns.csv").read_text("utf-8").splitlines()) == 8


def test_settings_reach_the_solver(mannequin: Path, tmp_path: Path) -> None:
    arguments = [
        "solve",
        str(mannequin),
        "--line",
        "mid-bust=97%",
        "--volume",
        "conventional",
        "--iterations",
        "80",
    ]
    arguments += [
        "--settings",
        "gain=2",
        "--settings",
        "line_stiffness=8",
        "--settings",
        "line_contact=glued",
    ]
    assert main([*arguments, "--out", str(tmp_path)]) == 3
    figures = json.loads((tmp_path / "report.json").read_text("utf-8"))
    assert figures["settings"]["gain"] == 2.0
    assert figures["settings"]["line_stiffness"] == 8.0
    assert figures["state"] in ("vibrating", "diverged")


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--line", "wing=97%"], "is not a line"),
        (["--line", "mid-bust"], "is not a line"),
        (["--line", "mid-bust=soon"], "'soon' is not a valid length for mid-bust"),
        (["--line", "mid-bust=20%"], "Enter 50 to 130 % ("),
        (["--settings", "colour=red"], "not a setting"),
        (["--settings", "gain=high"], "not a number"),
        (["--settings", "gain=11"], "Enter a value from 0 to 10."),
        (["--settings", "member-law=soft"], "force-density, prestressed, co-rotated"),
        (["--settings", "line_force=weak"], "implicit, explicit"),
        (["--settings", "line_contact=wet"], "bonded, sliding"),
        (["--settings", "line_hold=tied"], "elastic, fixed"),
        (["--settings", "volume_of=left"], "each, both"),
        (["--settings", "weights=even"], "smooth, paper"),
        (["--settings", "template=200"], "168, 120"),
        (["--settings", "scaled-normals=perhaps"], "yes, no"),
        (["--settings", "firm_chest=rock"], "not a number"),
        (["--line", "mid-bust=60%", *HELD], "mid-bust cannot be fixed at 60.0 %"),
        (["--path", "strap=r9c0,r3c0"], "no position 'r9c0'"),
        (["--path", "mid-bust=r2c0,r3c0"], "Two lines are named 'mid-bust'"),
        (["--path", "strap=r2c0,r3c0", "--line", "swing=97%"], "full-bust, strap"),
    ],
)
def test_bad_requests_get_one_sentence(
    mannequin: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], sentence: str
) -> None:
    assert main(["solve", str(mannequin), *arguments, "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr()
    assert sentence in said.err
    assert said.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--frob"], "Unrecognized arguments: --frob"),
        (["solve", "body.ply"], "required: --out"),
        (["solve", "body.ply", "--out", "o", "--iterations", "abc"], "'abc' is not a number of iterations"),
        (["solve", "body.ply", "--out", "o", "--iterations", "0"], "'0' is not a number of iterations"),
        (["solve", "body.ply", "--out", "o", "--volume", "all"], "invalid choice: 'all'"),
        (["picture", "body.ply", "--out", "a.png", "--size", "0x0"], "'0x0' is not a size"),
        (["picture", "body.ply", "--out", "a.png", "--size", "800"], "'800' is not a size"),
        (["picture", "body.ply", "--out", "a"], "ending in .png"),
        (["picture", "body.ply", "--out", "a.png", "--window", "--view", "left"], "not allowed with"),
        *(
            ([command, "body.ply", "--json", "--csv"], "--csv: not allowed with argument --json")
            for command in ("measure", "cut", "pressure")
        ),
        (["picture", "body.ply", "--out", "a.jpg", "--window"], "ending in .png"),
    ],
)
def test_bad_words_get_one_sentence(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    sentence: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(words) == 2
    said = capsys.readouterr().err
    assert said.startswith("busk: ")
    assert sentence in said
    assert said.count("\n") == 1


def test_a_reader_who_leaves_early_meets_no_traceback(mannequin: Path) -> None:
    command = [sys.executable, "-m", "app", "detect", str(mannequin), "--json"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as busk:
        assert busk.stdout is not None
        assert busk.stderr is not None
        busk.stdout.close()
        assert busk.stderr.read() == b""
    assert busk.returncode == 1


@pytest.mark.parametrize("name", ["gone.ply", "note.txt", "broken.ply", "broken.busk"])
def test_bad_files_get_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    path = tmp_path / name
    if name != "gone.ply":
        path.write_bytes(b"not a body at all")
    assert main(["solve", str(path), "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert said.startswith("busk: ")
    assert said.count("\n") == 1
    assert "Traceback" not in said


def test_detect_prints_the_contract(person: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["detect", str(person), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    names = {f"{what}_{side}" for what in ("bust_point", "fold", "lowest") for side in ("left", "right")}
    assert names <= set(found["landmarks"])
    for mark in found["landmarks"].values():
        assert 0.0 <= mark["confidence"] <= 1.0
        assert mark["rule"]
        in_mm = np.array(found["file_to_mm"]) @ [*mark["file"], 1.0]
        assert in_mm[:3] == pytest.approx(mark["mm"], abs=1e-6)
    assert found["unit"] == "mm"
    assert {"bust", "underbust"} <= set(found["levels"])
    assert found["girths"]["bust"]["tape_mm"] > found["girths"]["underbust"]["tape_mm"]
    assert {"level_mm", "tape_mm", "skin_mm"} <= set(found["girths"]["bust"])


def test_a_project_can_be_solved_and_overruled(mannequin: Path, tmp_path: Path) -> None:
    design = Design(ScanSource(str(mannequin)), lines=(ActiveLine("mid-bust", 0.96),))
    save_project(
        tmp_path / "a.busk", Document.single(design), ScanFile("scan.ply", mannequin.read_bytes()), None
    )
    assert open_project(tmp_path / "a.busk").design.ratio("mid-bust") == 0.96
    for extra, expected in (([], 96.0), (["--line", "mid-bust=98%"], 98.0)):
        assert (
            main(["solve", str(tmp_path / "a.busk"), *extra, "--volume", "exact", "--out", str(tmp_path)])
            == 0
        )
        figures = json.loads((tmp_path / "report.json").read_text("utf-8"))
        assert figures["lines"]["mid-bust"]["set_percent"] == pytest.approx(expected)


def test_version_and_help(capsys: pytest.CaptureFixture[str]) -> None:
    for words in (["--version"], ["--help"], ["solve", "--help"]):
        with pytest.raises(SystemExit) as leaving:
            main(words)
        assert leaving.value.code == 0
    said = capsys.readouterr().out
    assert f"busk {__version__}" in said
    assert "detect" in said


def test_batch_commands_load_no_qt(mannequin: Path, tmp_path: Path) -> None:
    code = (
        "import sys; from app.cli.main import main; "
        f"code = main(['solve', {str(mannequin)!r}, '--line', 'mid-bust=97%', '--volume', 'exact', "
        f"'--out', {str(tmp_path)!r}]); "
        "sys.exit(code or any(name.startswith(('PySide6', 'pyvistaqt')) for name in sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False, capture_output=True).returncode == 0


def test_a_custom_line_is_active_and_reported(mannequin: Path, tmp_path: Path) -> None:
    strap = ["--path", "Strap=r2c3:r6c3", "--line", "STRAP=-4%", "--volume", "accumulating"]
    assert main(["solve", str(mannequin), *strap, "--out", str(tmp_path)]) == 0
    figures = json.loads((tmp_path / "report.json").read_text("utf-8"))
    line = figures["lines"]["strap"]
    assert line["worn"]
    assert line["set_percent"] == pytest.approx(96.0)
    assert line["whole_band_rest_mm"] == line["rest_mm"]
    left = "bust_point_left_above_lowest_mm"
    assert figures["marks"]["final"][left] > figures["marks"]["rest"][left] + 1.0
    assert figures["design"]["own_lines"][0]["points"] == [35, 48, 61, 74, 87]
    with open(tmp_path / "control.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert figures["control_points"] == len(rows) == 104
    place = {(int(row["row"]), int(row["column"])): row for row in rows}
    assert place[2, 3]["number"] == "35"
    assert place[2, 3]["free"] == "yes"
    assert place[6, 3]["free"] == "no"


def test_a_project_with_own_lines_keeps_its_template(tmp_path: Path, mannequin: Path) -> None:
    design = Design(ScanSource(str(mannequin)), own_lines=(CustomLine("strap", (35, 48)),))
    save_project(
        tmp_path / "a.busk", Document.single(design), ScanFile("mannequin.ply", mannequin.read_bytes()), None
    )
    words = ["solve", str(tmp_path / "a.busk"), "--settings", "template=120", "--out", str(tmp_path)]
    assert main(words) == 2
