"""A program that is killed while it edits and saves leaves nothing broken, and loses the last moment only."""

from __future__ import annotations

import importlib.util
import random
import sys
from pathlib import Path

import pytest

FILE = Path(__file__).parent.parent / "benchmarks" / "kill_test.py"


def test_five_kills_lose_the_last_moment_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spec = importlib.util.spec_from_file_location("kill_test", FILE)
    assert spec is not None
    assert spec.loader is not None
    kills = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(kills)
    for kind in ("STATE", "DATA", "CONFIG"):
        monkeypatch.setenv(f"XDG_{kind}_HOME", str(tmp_path / kind))
    chance = random.Random(3)
    outcomes = [kills.kill_once(tmp_path, 0.8 * chance.random()) for _ in range(5)]
    assert [sentence for each in outcomes for sentence in each.broken] == []
    # Thirty seconds are promised with ten between edit and copy; here it is a fifth of one.
    assert max(each.lost for each in outcomes) < 20.0
    assert sum(each.lost > 0.0 for each in outcomes) > 0, "it was killed in the middle of work"
