"""What the command line says of a shape that no body has."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import trimesh

from app.cli.main import main


@pytest.mark.parametrize(
    ("line", "code", "state", "sentence"),
    [
        ("97%", 0, "settled", ""),
        (
            "80%",
            0,
            "overstrained",
            "original lengths. The shape does not represent a real body.",
        ),
        ("60%", 3, "folded", "degrees. The shape does not represent a real body."),
    ],
)
def test_an_invalid_shape_is_named_with_its_line(
    fine_mannequin: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    line: str,
    code: int,
    state: str,
    sentence: str,
) -> None:
    words = ["solve", str(fine_mannequin), "--line", f"mid-bust={line}", "--line", "full-bust=99.5%"]
    assert main([*words, "--volume", "exact", "--out", str(tmp_path)]) == code
    said = capsys.readouterr()
    figures = json.loads((tmp_path / "report.json").read_text("utf-8"))
    assert (figures["motion"], figures["state"]) == ("settled", state)
    assert ("settled" if state == "settled" else f"settled but {state}") in said.out
    assert sentence in said.err
    assert len(said.err.splitlines()) == (1 if sentence else 0)
    shape = figures["condition"]
    assert (shape["folded"], shape["overstrained"]) == (state == "folded", state != "settled")
    assert shape["shortest_edge_percent"] < 100.0 < shape["longest_edge_percent"]
    assert abs(figures["volume"]["error_percent"]) < 1e-6
    before, after = (trimesh.load(path, process=False) for path in (fine_mannequin, tmp_path / "body.ply"))
    assert figures["volume"]["body_change_ml"] == pytest.approx(
        (after.volume - before.volume) / 1e3, abs=0.05
    )


@pytest.mark.parametrize(
    ("words", "code", "told", "warned"),
    [
        (["--settings", "line_force=explicit"], 3, "diverging after ", "The solver diverged: "),
        (["--volume", "exact"], 0, " Newton iterations, volume error +0.0000 % (+0.00 ml)", ""),
        (
            ["--volume", "exact", "--settings", "dense_volume=yes"],
            0,
            " volume error +0.0000 % (+0.00 ml)",
            "",
        ),
        (["--iterations", "1"], 3, "settling after 1 iteration, ", ""),
    ],
)
def test_the_last_line_states_the_result(
    fine_mannequin: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    code: int,
    told: str,
    warned: str,
) -> None:
    assert (
        main(["solve", str(fine_mannequin), "--line", "mid-bust=95%", *words, "--out", str(tmp_path)]) == code
    )
    said = capsys.readouterr()
    assert told in said.out
    assert warned in said.err
    assert bool(said.err.splitlines()) == bool(warned)
