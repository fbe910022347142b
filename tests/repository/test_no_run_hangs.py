"""A test that never ends, or a process that dies, ends the run with a failure: nothing waits for ever."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PASSES = "def test_it(): pass\n"
DIES = "import os\ndef test_it(): os.abort()\n"
HANGS = "import time\ndef test_it(): time.sleep(1000)\n"
DIES_EARLY = f"import os\nif os.environ['PYTEST_XDIST_WORKER'] == 'gw1': os.abort()\n{PASSES}"


@pytest.fixture
def folder(tmp_path):
    """A project with our settings, and no tests."""
    (tmp_path / "tests").mkdir()
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    shutil.copy(ROOT / "tests" / "helpers" / "dead_process.py", tmp_path / "tests" / "conftest.py")
    return tmp_path


def run(folder, files, *options):
    for name, text in files.items():
        (folder / "tests" / f"test_{name}.py").write_text(text)
    command = [sys.executable, "-m", "pytest", "-n", "2", "--dist", "loadfile", "-p", "no:cacheprovider"]
    own = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    return subprocess.run(
        [*command, *options], check=False, cwd=folder, env=own, capture_output=True, text=True, timeout=600
    )


def test_a_run_ends_in_which_one_process_dies_and_one_hangs(folder):
    """Each process is dealt two files at once, so that both leave some behind."""
    files = {"a": DIES, "b": HANGS, "c": PASSES, "d": PASSES, "e": PASSES}
    done = run(folder, files, "-o", "faulthandler_timeout=1")
    assert done.returncode == 1, done.stdout
    for name in "ab":
        assert f"crashed while running 'tests/test_{name}.py::test_it'" in done.stdout
    assert "Timeout (0:00:01)!" in done.stderr + done.stdout, "where it hangs is told"


def test_a_process_that_dies_before_its_first_test_is_a_failure(folder):
    assert run(folder, {"a": DIES_EARLY, "b": PASSES}).returncode == 1
