"""Two designs are compared on the bodies that both have, whatever their files are called."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from graded_runs import UNDER, made_row, made_rows, run_of

from app.batch.compare_files import BODIES, write_comparison
from app.batch.compare_page import compare_page, sentences
from app.batch.compared_designs import LIFT, PRESSURE, VOLUME, DesignComparison, compared_designs
from core.errors import UserError

PRESSED = "pressure_max_under-bust_kpa"


def changed(row: dict[str, Any], **values: Any) -> dict[str, Any]:
    return {**row, **values}


@pytest.fixture
def found(tmp_path: Path) -> DesignComparison:
    rows = [made_row(at, 1, 1) for at in range(6)]
    other = [
        changed(rows[0], scan="moved/000.ply", lift_left_mm=14.0, **{PRESSED: 1.5}),
        changed(rows[1], lift_left_mm=14.0, **{PRESSED: 3.0}),
        changed(rows[2], lift_left_mm=2.0, volume_error_percent=1.5),
        changed(rows[3], verdict="bad"),
        {"scan": "004.ply", "scan_sha256": "content 4", "variant": "one", "state": "refused"},
    ]
    return compared_designs(run_of(tmp_path / "a", rows), run_of(tmp_path / "b", other))


def test_bodies_are_matched_by_content(found: DesignComparison) -> None:
    assert found.scans == ("000.ply", "001.ply", "002.ply", "003.ply")
    assert found.unmatched.second == ("004.ply", "005.ply")
    assert found.unmatched.first == found.unmatched.both == ()


def test_changes_are_second_minus_first(found: DesignComparison) -> None:
    assert found.change(LIFT).tolist() == pytest.approx([2.0, 2.0, -4.0, 0.0])
    assert found.change(PRESSURE).tolist() == pytest.approx([-0.5, 1.0, 0.0, 0.0])
    assert found.change(VOLUME).tolist() == pytest.approx([0.0, 0.0, 1.0, 0.0]), "of absolute errors"
    assert found.differences[UNDER].equal == 4
    assert found.verdict_counts.tolist() == [[3, 0, 1], [0, 0, 0], [0, 0, 0]]


def test_the_sentence_counts_bodies_with_more_lift_at_no_more_pressure(found: DesignComparison) -> None:
    text = " ".join(sentences(found))
    assert "more at no more pressure on 1 of 4 bodies (25 %)" in text
    assert "better on 1, worse on 1 and equal on 1; on 1 both" in text


def test_files_and_page_hold_every_body_once(found: DesignComparison, tmp_path: Path) -> None:
    write_comparison(tmp_path, found)
    with open(tmp_path / BODIES, newline="", encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert [row["scan"] for row in rows] == list(found.scans)
    assert [row["lift_and_pressure"] for row in rows] == ["better", "mixed", "worse", "same"]
    assert float(rows[1]["difference_lift_mm"]) == 2.0
    page = compare_page(found)
    assert all(page.count(f"<td>{scan}</td>") == 1 for scan in found.scans)
    assert "nan" not in page.lower()


def test_a_run_compared_with_itself_has_no_difference(tmp_path: Path) -> None:
    run = run_of(tmp_path, made_rows(12))
    found = compared_designs(run, run)
    assert not np.any(found.change(LIFT))
    assert all(each.equal == each.count == 12 for each in found.differences.values())
    assert found.tradeoff.same.all()
    assert compare_page(found).count("<figure>") == 1, "no distribution where nothing changes"


def test_runs_on_other_bodies_are_refused(tmp_path: Path) -> None:
    one, other = made_rows(3), [{**row, "scan_sha256": f"x{row['scan']}"} for row in made_rows(3)]
    with pytest.raises(UserError, match="No body has results of both"):
        compared_designs(run_of(tmp_path / "a", one), run_of(tmp_path / "b", other))


def test_designs_without_pressure_are_compared_by_the_rest(tmp_path: Path) -> None:
    rows = [{**row, PRESSED: None} for row in made_rows(3)]
    run = run_of(tmp_path, rows)
    found = compared_designs(run, run)
    assert PRESSURE not in found.differences
    assert found.tradeoff.count == 0
    assert "no body has both" in " ".join(sentences(found))
    assert "nan" not in compare_page(found).lower()


def test_runs_in_folders_of_one_name_are_told_apart(tmp_path: Path) -> None:
    spring, autumn = (run_of(tmp_path / season / "results", made_rows(3)) for season in ("spring", "autumn"))
    first, second = compared_designs(spring, autumn).names
    assert "spring" in first
    assert "autumn" in second
