"""The workflows of the forge: they ask for little, and name what is there."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
WORKFLOWS = {path.name: path for path in sorted((ROOT / ".github" / "workflows").glob("*.yml"))}
PARSED = {name: yaml.safe_load(path.read_text("utf-8")) for name, path in WORKFLOWS.items()}
JOBS = [(name, key, job) for name, flow in PARSED.items() for key, job in flow["jobs"].items()]
STEPS = [(f"{name}: {key}", step) for name, key, job in JOBS for step in job["steps"]]
SCRIPTS = [(where, step["run"]) for where, step in STEPS if "run" in step]


def test_there_are_workflows_for_tests_and_for_three_systems():
    assert set(PARSED) == {"package.yml", "test.yml"}
    assert {key for name, key, _ in JOBS if name == "package.yml"} == {"linux", "windows", "macos", "draft"}
    # YAML takes the bare word "on" for yes.
    assert all({"name", "jobs", "permissions", True} <= flow.keys() for flow in PARSED.values())


def test_they_may_read_and_only_the_draft_may_write():
    assert [flow["permissions"] for flow in PARSED.values()] == [{"contents": "read"}] * len(PARSED)
    told = {key: job["permissions"] for _, key, job in JOBS if "permissions" in job}
    assert told == {"draft": {"contents": "write"}}
    assert "secrets." not in "".join(path.read_text("utf-8") for path in WORKFLOWS.values())
    draft = PARSED["package.yml"]["jobs"]["draft"]
    assert draft["if"] == "startsWith(github.ref, 'refs/tags/v')"
    assert set(draft["needs"]) == {"linux", "windows", "macos"}
    assert all(
        "--draft" in line for _, script in SCRIPTS for line in script.splitlines() if "release create" in line
    )


def test_actions_are_those_of_the_forge_by_major_version():
    used = [step["uses"] for _, step in STEPS if "uses" in step]
    assert used
    assert [name for name in used if not re.fullmatch(r"actions/[a-z-]+@v\d+", name)] == []
    assert all("uses" in step or "run" in step for _, step in STEPS)
    checkouts = [step for _, step in STEPS if step.get("uses", "").startswith("actions/checkout")]
    assert all(step["with"]["persist-credentials"] is False for step in checkouts)


@pytest.mark.parametrize(("where", "script"), SCRIPTS, ids=[where for where, _ in SCRIPTS])
def test_a_script_names_targets_and_files_that_are_there(where, script):
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
    assert set(re.findall(r"^make ([a-z-]+)", script, re.MULTILINE)) - targets == set()
    files = re.findall(r"(?:packaging|tests|docs)/[\w./-]+|requirements\.lock", script)
    assert [name for name in files if not (ROOT / name).exists()] == []


@pytest.mark.skipif(not shutil.which("bash"), reason="needs bash")
def test_bash_can_read_every_script():
    shells = [step.get("shell") for _, step in STEPS if "run" in step]
    for (where, script), shell in zip(SCRIPTS, shells, strict=True):
        if shell != "pwsh":
            assert "${{" not in script, f"{where}: what others write into a name would be run; use env"
            read = subprocess.run(["bash", "-n"], input=script, capture_output=True, text=True, check=False)
            assert (read.returncode, read.stderr) == (0, ""), where


def test_every_system_asks_the_installed_program():
    for key in ("linux", "windows", "macos"):
        said = "\n".join(step.get("run", "") for step in PARSED["package.yml"]["jobs"][key]["steps"])
        assert "self-test" in said
        assert "packaging/compare_numbers.py --program" in said
        assert ".venv/bin/busk self-test" not in said


def test_the_draft_holds_what_has_a_bill_of_materials_and_nothing_else():
    uploads = [step["with"] for _, step in STEPS if step.get("uses", "").startswith("actions/upload")]
    assert all(each["if-no-files-found"] == "error" for each in uploads)
    billed = [each["name"] for each in uploads if "-bill." in each["path"]]
    draft = PARSED["package.yml"]["jobs"]["draft"]["steps"]
    taken = [step["with"] for step in draft if step.get("uses", "").startswith("actions/download")]
    assert [each.get("name") for each in taken] == billed, "without a name all are taken"
    sums = [set(re.findall(r"SHA256SUMS[\w-]*", each["path"])) for each in uploads if each["name"] in billed]
    assert sums == [set(re.findall(r"SHA256SUMS[\w-]*", draft[-1]["run"]))]
