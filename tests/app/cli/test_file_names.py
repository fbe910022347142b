"""What is said of a file names it as it was typed: not where on the disk that is."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from app.cli.main import BAD_INPUT, main


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["detect", "nobody.ply"], "nobody.ply does not exist. "),
        (["measure", "some/nobody.ply"], f"{Path('some/nobody.ply')} does not exist. "),
        (["solve", "nobody.busk", "--out", "out"], "Project nobody.busk does not exist. "),
        (["detect", "."], ". cannot be read: not a file. "),
        (["detect", ""], "No file specified. "),
        (["measure", ""], "No file specified. "),
        ([""], "No file specified. "),
        (["detect", "a\nb\r\x1b[31m.ply"], "a\\nb\\r\\x1b[31m.ply does not exist. "),
        (["measure", "anna.ply", "--out", "nowhere/a.csv"], f"{Path('nowhere/a.csv')} cannot be written: "),
        (["picture", "anna.ply", "--out", "nowhere/a.png"], "Folder nowhere does not exist. "),
        (["report", "anna.ply", "--out", "nowhere/a.pdf"], "Folder nowhere does not exist. "),
        (["export", "anna.ply", "--body", "anna.ply/a.glb"], "anna.ply/a.glb cannot be written: "),
    ],
)
def test_a_file_is_named_as_it_was_typed(
    mannequin: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    said: str,
) -> None:
    shutil.copy(mannequin, tmp_path / "anna.ply")
    monkeypatch.chdir(tmp_path)
    assert main(words) == BAD_INPUT
    assert capsys.readouterr().err.startswith(f"busk: {said}")
    assert [each.name for each in tmp_path.iterdir()] == ["anna.ply"]
