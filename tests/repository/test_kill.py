"""A program that is killed while it edits and saves leaves nothing broken, and loses the last moment only."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

FILE = Path(__file__).parents[2] / "benchmarks" / "kill_test.py"


def test_kills_lose_the_last_moment_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spec = importlib.util.spec_from_file_location("kill_test", FILE)
    assert spec is not None
    assert spec.loader is not None
    kills = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(kills)
    for kind in ("STATE", "DATA", "CONFIG"):
        monkeypatch.setenv(f"XDG_{kind}_HOME", str(tmp_path / kind))
    # Soon, while the scan is written for the first time, and later, while edits are kept again and again.
    outcomes = [kills.kill_once(tmp_path, after) for after in (0.1, 0.4, 3.0, 3.3)]
    while not any(each.rescued for each in outcomes[2:]) and len(outcomes) < 8:
        outcomes.append(kills.kill_once(tmp_path, 3.3))  # chance had all of it saved by hand just before
    assert [sentence for each in outcomes for sentence in each.broken] == []
    # Thirty seconds are promised with ten between edit and copy; here it is a fifth of one.
    assert all(each.lost < each.worked / 2 for each in outcomes[2:])
    assert any(each.rescued for each in outcomes[2:]), "saving alone would lose more"
