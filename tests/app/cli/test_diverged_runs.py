"""Of a run that ran away the commands that tell or write figures of the body say so, and nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.main import BAD_INPUT, main
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.storage.project_file import read_scan_file, save_project


@pytest.fixture
def runaway(mannequin: Path, tmp_path: Path) -> Path:
    source = ScanSource(str(mannequin))
    design = Design(source, line_force="explicit", line_stiffness=60.0).with_line("mid-bust", 0.6)
    path = tmp_path / "runaway.busk"
    save_project(path, Document.single(design), read_scan_file(source), b"")
    return path


@pytest.mark.parametrize(
    "words",
    [
        ["measure"],
        ["cut"],
        ["cut", "--keep-fit", "--elastic", "mid-bust=plush 12"],
        ["pressure"],
        ["report", "--out", "a.pdf"],
        ["export", "--measurements", "a.csv"],
        ["export", "--body", "a.glb"],
        ["export", "--strips", "a.svg"],
    ],
    ids=" ".join,
)
def test_nothing_is_printed_or_written_of_a_diverged_run(
    runaway: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main([words[0], str(runaway), *words[1:]]) == BAD_INPUT
    said = capsys.readouterr()
    assert said.err == (
        "busk: The solver diverged: no shape is available for measurements or cutting. "
        "Make the lines longer or softer.\n"
    )
    assert said.out == ""
    assert list(tmp_path.iterdir()) == [runaway]
