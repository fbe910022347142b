"""Files for clusters: the job for Slurm runs with a stand-in for srun, the manifests name what there is."""

from __future__ import annotations

import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from batch_tools import ROOT, parquet_rows
from distributed.cli.dask_scheduler import main as scheduler
from distributed.cli.dask_worker import main as worker

CLUSTER = ROOT / "packaging" / "cluster"


def program(path: Path, text: str) -> None:
    path.write_text(f"#!/bin/bash\n{text}\n")
    path.chmod(0o700)


def settings_in(folder: Path) -> dict[str, str]:
    printed = subprocess.check_output(
        [sys.executable, CLUSTER / "certificates.py", folder], text=True, timeout=60
    )
    return dict(line.split("=", 1) for line in printed.splitlines())


@pytest.mark.skipif(shutil.which("bash") is None, reason="the job is a script for bash")
def test_the_job_for_slurm_runs_encrypted_and_leaves_nothing(person: Path, tmp_path: Path) -> None:
    program(tmp_path / "srun", 'while [[ $1 == --* ]]; do shift; done; exec "$@"')
    (tmp_path / "work").mkdir()
    busk = tmp_path / "busk"
    tools = busk / ".venv" / "bin"
    tools.mkdir(parents=True)
    program(tools / "python", f'exec {sys.executable} "$@"')
    program(tools / "busk", f'echo "$@" >{tmp_path}/words; exec {sys.executable} -m app "$@"')
    (busk / "packaging").symlink_to(ROOT / "packaging")
    words = [person, "--line", "mid-bust=95%", "--out", tmp_path / "out"]
    own = {"BUSK": busk, "BUSK_WORK": tmp_path / "work", "PATH": f"{tmp_path}:{os.environ['PATH']}"}
    subprocess.run(
        ["bash", CLUSTER / "slurm.sh", *words],
        env={**os.environ, "PYTHONPATH": str(ROOT), **{name: str(value) for name, value in own.items()}},
        check=True,
        timeout=300,
    )
    assert [row["state"] for row in parquet_rows(tmp_path / "out")] == ["done"]
    assert "--scheduler tls://" in (tmp_path / "words").read_text()
    assert list((tmp_path / "work").iterdir()) == []


def test_certificates_are_their_owners_alone(tmp_path: Path) -> None:
    (tmp_path / "tls").mkdir(mode=0o755)
    (tmp_path / "tls" / "key.pem").write_text("former")
    settings_in(tmp_path / "tls")
    assert {stat.S_IMODE(file.stat().st_mode) for file in (tmp_path / "tls").iterdir()} == {0o600}
    assert stat.S_IMODE((tmp_path / "tls").stat().st_mode) == 0o700


def test_the_manifests_name_settings_and_options_that_there_are(tmp_path: Path) -> None:
    parts: list[dict[str, Any]] = list(yaml.safe_load_all((CLUSTER / "kubernetes.yaml").read_text("utf-8")))
    values = next(part["data"] for part in parts if part["metadata"]["name"] == "busk-dask")
    expected = settings_in(tmp_path / "tls")
    assert {name: Path(value).name for name, value in values.items()} == {
        name: Path(value).name for name, value in expected.items()
    }
    commands = [
        container["command"]
        for part in parts
        if part["kind"] in ("Deployment", "Job")
        for container in part["spec"]["template"]["spec"]["containers"]
    ]
    known = {"distributed.cli.dask_scheduler": scheduler, "distributed.cli.dask_worker": worker}
    for command in commands[:2]:
        known[command[2]].make_context(command[2], [*command[3:]])
    assert "--scheduler tls://busk-scheduler:8786" in commands[2][-1]
    service = next(part for part in parts if part["kind"] == "Service")
    assert service["spec"]["ports"] == [{"port": 8786}]
