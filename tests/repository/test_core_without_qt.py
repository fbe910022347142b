"""The method runs where no Qt is installed: a script, a server, a notebook."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np

from core.scan.body import read_scan

ROOT = Path(__file__).parents[2]
NO_QT = """
import sys

class NoQt:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {"PySide6", "shiboken6", "pyvistaqt", "qtpy"}:
            raise ModuleNotFoundError(f"{name} is not installed here", name=name)

sys.meta_path.insert(0, NoQt())
"""
CORE = sorted(path for path in (ROOT / "core").rglob("*.py") if path.stem != "__init__")
PACKAGES = ("i18n", "rendering", "presenters")
APP = sorted(path for name in PACKAGES for path in (ROOT / "app" / name).rglob("[a-z]*.py"))
QT_FREE = [".".join(path.relative_to(ROOT).with_suffix("").parts) for path in (*CORE, *APP)]
QT_FREE += ["app.cli.main"]


def without_qt(code: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", NO_QT + code, *arguments]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


def test_qt_is_out_of_reach_in_these_tests() -> None:
    assert "PySide6 is not installed here" in without_qt("import PySide6.QtCore").stderr


def test_everything_below_the_session_imports_without_qt() -> None:
    code = "import importlib\nfor name in sys.argv[1:]:\n    importlib.import_module(name)"
    done = without_qt(code, *QT_FREE)
    assert done.returncode == 0, done.stderr


def test_a_line_is_shortened_from_the_command_line_without_qt(mannequin: Path, tmp_path: Path) -> None:
    code = "from app.cli.main import main\nsys.exit(main(sys.argv[1:]))"
    done = without_qt(code, "solve", str(mannequin), "--line", "mid-bust=97%", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "report.json").read_text("utf-8"))
    assert 97.0 <= report["lines"]["mid-bust"]["reached_percent"] < 98.0
    assert abs(report["volume"]["error_percent"]) < 0.1
    before, after = read_scan(mannequin).mesh, read_scan(tmp_path / "body.ply").mesh
    assert np.array_equal(after.faces, before.faces)
    assert np.linalg.norm(after.vertices - before.vertices, axis=1).max() > 1.0
