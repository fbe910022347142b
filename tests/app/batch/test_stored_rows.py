"""Results are read from their CSV file as they were computed, and designs from theirs."""

from __future__ import annotations

from pathlib import Path

import pytest
from batch_tools import parquet_rows

from app.batch.batch_design import batch_design, content_key
from app.batch.design_file import is_design_file, read_designs, stored_key, write_designs
from app.batch.schema import DESIGN
from app.batch.store import ResultStore
from app.batch.stored_rows import has_results, read_results, scan_file, written_file
from core.document.design import Design, ScanSource
from core.errors import UserError

DESIGNS = [
    batch_design("bra", Design(ScanSource("")), ["mid-bust=-20mm"], ["mid-bust=plush 12"], []),
    batch_design("other", Design(ScanSource("")), [], [], ["lift=+5"]),
]


def test_rows_are_those_of_the_table(tmp_path: Path) -> None:
    store = ResultStore(tmp_path, DESIGNS)
    known = {"scan_sha256": "d", "variant": "bra", "state": "done", "bust_mm": 881.123456789012}
    store.add([{"scan": "a,'\n.ply", **known}, {"scan": "=b.ply", **known, "message": "-5 is “odd”."}])
    store.add([{"scan": scan, **known} for scan in (" =c.ply", "＝d.ply")])
    store.flush()
    assert has_results(tmp_path)
    designs, rows = read_results(tmp_path)  # while the run goes on
    assert content_key(designs) == content_key(DESIGNS)
    table = parquet_rows(tmp_path)
    assert [row["bust_mm"] for row in rows] == [row["bust_mm"] for row in table]
    assert [row["scan"] for row in rows[1:]] == ["=b.ply", " =c.ply", "＝d.ply"]
    assert rows[1]["lift_left_mm"] is None
    store.close()


def test_a_row_that_is_being_written_is_left_out_and_the_last_of_a_scan_counts(tmp_path: Path) -> None:
    store = ResultStore(tmp_path, DESIGNS)
    for state in ("crashed", "done"):
        store.add([{"scan": "a.ply", "scan_sha256": "d", "variant": "bra", "state": state}])
        store.flush()
    store.close()
    with open(tmp_path / "results.csv", "a", encoding="utf-8") as file:
        file.write("b.ply,d,bra")
    assert [row["state"] for row in read_results(tmp_path)[1]] == ["done"]


def test_what_is_no_result_is_refused_with_a_sentence(tmp_path: Path) -> None:
    assert not has_results(tmp_path)
    (tmp_path / DESIGN).write_text("[]")
    assert stored_key(tmp_path) is None
    assert not is_design_file(str(tmp_path / DESIGN))
    with pytest.raises(UserError, match="cannot be read"):
        read_results(tmp_path)


def test_designs_are_read_as_they_were_written(tmp_path: Path) -> None:
    path = tmp_path / DESIGN
    write_designs(path, DESIGNS, private=True)
    assert is_design_file(str(path))
    assert read_designs(path) == DESIGNS
    assert stored_key(tmp_path) == content_key(DESIGNS)


def test_a_relative_scan_is_searched_above_the_results(tmp_path: Path) -> None:
    scan = tmp_path / "scans" / "a.ply"
    scan.parent.mkdir()
    scan.touch()
    folder = tmp_path / "results" / "bra"
    folder.mkdir(parents=True)
    assert scan_file(folder, "scans/a.ply") == scan
    assert scan_file(folder, str(scan)) == scan
    assert scan_file(folder, "scans/b.ply") is None


@pytest.mark.parametrize(
    "name",
    ["", "/etc/a.pdf", "../a.pdf", "reports/../../a.pdf", "reports/a.desktop", "bodies/a.pdf", "a.pdf"],
)
def test_no_file_of_another_place_is_opened(tmp_path: Path, name: str) -> None:
    assert written_file(tmp_path, "report", "reports/a-1.pdf") == tmp_path / "reports" / "a-1.pdf"
    assert written_file(tmp_path, "report", name) is None
