"""Results that are missing, damaged or of another version are refused with a sentence."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from graded_runs import UNDER, made_row, made_rows, run_of, write_run

from app.batch.results import read_results, with_mean_sides
from core.errors import UserError


def test_values_are_read_back_to_the_bit(tmp_path: Path) -> None:
    rows = [{**made_row(at, 0, 0), UNDER: 0.1 + 0.2 * at} for at in range(3)]
    rows[1][UNDER] = None
    found = run_of(tmp_path, rows)
    assert found.numbers(UNDER)[2] == rows[2][UNDER]
    assert np.isnan(found.numbers(UNDER)[1])
    assert np.isnan(found.numbers("no such column")).all()
    assert found.units[UNDER] == "mm"


def test_sides_are_one_column_with_their_mean(tmp_path: Path) -> None:
    left, right = "cut_length_strap left_mm", "cut_length_strap right_mm"
    rows = [{**made_row(at, 0, 0), left: 300.0, right: 310.0} for at in range(2)]
    rows[1][right] = None
    found = with_mean_sides(run_of(tmp_path, rows))
    assert {left, right}.isdisjoint(found.units)
    assert found.numbers("cut_length_strap_mm")[0] == 305.0
    assert np.isnan(found.numbers("cut_length_strap_mm")[1])
    assert found.units[UNDER] == "mm"
    assert found.numbers(UNDER)[0] == rows[0][UNDER]


def test_folders_without_results_are_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("nothing")
    for folder in (tmp_path / "absent", tmp_path, tmp_path / "file"):
        with pytest.raises(UserError, match="holds no results"):
            read_results(folder)
    with pytest.raises(UserError, match="holds no rows"):
        read_results(write_run(tmp_path / "empty", []))


@pytest.mark.parametrize("damage", ["cut", "text", "empty"])
def test_a_damaged_part_is_refused(tmp_path: Path, damage: str) -> None:
    write_run(tmp_path, made_rows(5))
    (part,) = (tmp_path / "results.parquet").glob("part-*.parquet")
    data = part.read_bytes()
    part.write_bytes({"cut": data[: len(data) // 2], "text": b"nothing", "empty": b""}[damage])
    with pytest.raises(UserError, match="damaged"):
        read_results(tmp_path)


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"schema_version": 1, "designs": 3}'])
def test_a_damaged_design_is_refused(tmp_path: Path, text: str) -> None:
    write_run(tmp_path, made_rows(5))
    (tmp_path / "design.json").write_text(text)
    with pytest.raises(UserError, match="damaged"):
        read_results(tmp_path)


def test_another_version_and_unknown_variants_are_refused(tmp_path: Path) -> None:
    write_run(tmp_path, made_rows(5))
    file = tmp_path / "design.json"
    values = json.loads(file.read_text("utf-8"))
    file.write_text(json.dumps({**values, "schema_version": 99}))
    with pytest.raises(UserError, match="another version"):
        read_results(tmp_path)
    file.write_text(json.dumps({**values, "designs": [{"name": "other"}]}))
    with pytest.raises(UserError, match="does not name all variants"):
        read_results(tmp_path)
