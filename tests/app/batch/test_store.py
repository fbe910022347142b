"""The output folder holds each row once, whatever happens, and never rows of another design."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from batch_tools import csv_rows, parquet_rows, summary

from app.batch.batch_design import batch_design
from app.batch.store import ResultStore
from core.document.design import Design, ScanSource
from core.errors import UserError

Opened = Callable[..., ResultStore]
DESIGN = batch_design("one", Design(ScanSource("")), ["mid-bust=95%"], [], [])
OTHER = batch_design("one", Design(ScanSource("")), ["mid-bust=90%"], [], [])


def row(scan: str, digest: str = "d", state: str = "done", **values: Any) -> dict[str, Any]:
    return {"scan": scan, "scan_sha256": digest, "variant": "one", "state": state, **values}


def unlisted(scan: str) -> bool:
    return False


@pytest.fixture
def opened(tmp_path: Path) -> Opened:
    def make(*designs: Any, **options: Any) -> ResultStore:
        return ResultStore(tmp_path / "out", designs or [DESIGN], **options)

    return make


def written(store: ResultStore, *rows: dict[str, Any]) -> None:
    store.add(rows)
    store.flush()


def test_rows_are_kept_to_the_bit_and_sorted_at_the_end(opened: Opened, tmp_path: Path) -> None:
    store, value = opened(), 0.1 + 0.2
    written(store, row("b", bust_mm=value), row("a", message='=1+1, "x"\n'))
    written(store, row("c", volume_error_percent=-1.25e-07))
    store.finish(["a", "b", "c"], 1.0, interrupted=False)
    store.close()
    assert {each["scan"]: each["bust_mm"] for each in parquet_rows(tmp_path / "out")}["b"] == value
    rows = csv_rows(tmp_path / "out")
    assert [each["scan"] for each in rows] == ["a", "b", "c"]
    assert float(rows[1]["bust_mm"]) == value
    assert rows[2]["volume_error_percent"] == "-1.25e-07"
    assert rows[0]["message"].startswith("'="), "no spreadsheet computes a text"
    assert summary(tmp_path / "out")["states"] == {"done": 3, "refused": 0, "crashed": 0, "timeout": 0}


def test_what_is_there_is_not_done_again(opened: Opened) -> None:
    store = opened()
    written(store, row("a", "1"), row("b", "2", "timeout"), row("c", "", "refused"))
    store.close()
    store = opened()
    assert store.is_done("a", "1", "one", unlisted)
    assert not store.is_done("a", "other content", "one", unlisted)
    assert not store.is_done("a", "1", "another variant", unlisted)
    assert store.is_done("b", "2", "one", unlisted)
    assert not store.is_done("b", "2", "one", unlisted, retry=True)
    assert not store.is_done("c", "", "one", unlisted), "it may be readable now"
    store.close()


def test_a_scan_that_was_moved_is_known_by_its_content_once(opened: Opened) -> None:
    store = opened()
    written(store, row("old/a", "1"))
    assert not store.is_done("copy", "1", "one", {"old/a"}.__contains__)
    assert store.is_done("new/a", "1", "one", unlisted)
    assert not store.is_done("new/b", "1", "one", unlisted), "there is one row, and these are two scans"
    written(store, row("old/c", "3", "timeout"))
    assert not store.is_done("new/c", "3", "one", unlisted, retry=True)
    store.close()


def test_a_row_replaces_the_former_one_of_its_scan(opened: Opened, tmp_path: Path) -> None:
    store = opened()
    written(store, row("a", "1", "timeout"), row("b", "2"))
    written(store, row("c", "3", "crashed"))
    written(store, row("a", "1"), row("c", "3"))
    store.finish([], 1.0, interrupted=False)
    store.close()
    for rows in (parquet_rows(tmp_path / "out"), csv_rows(tmp_path / "out")):
        assert sorted((each["scan"], each["state"]) for each in rows) == [
            ("a", "done"), ("b", "done"), ("c", "done"),
        ]  # fmt: skip


def test_results_of_another_design_are_refused_or_removed(opened: Opened, tmp_path: Path) -> None:
    store = opened()
    written(store, row("a"))
    store.close()
    own = tmp_path / "out" / "notes.txt"
    own.write_text("mine")
    with pytest.raises(UserError, match="results of another design"):
        opened(OTHER)
    assert len(parquet_rows(tmp_path / "out")) == 1
    store = opened(OTHER, restart=True)
    assert store.is_empty
    assert not parquet_rows(tmp_path / "out")
    assert own.read_text() == "mine"
    store.close()


def test_results_of_another_version_are_named_as_such(opened: Opened, tmp_path: Path) -> None:
    store = opened()
    written(store, row("a"))
    store.close()
    file = tmp_path / "out" / "design.json"
    values = json.loads(file.read_text("utf-8"))
    file.write_text(json.dumps({**values, "busk_version": "0.1", "key": "other"}))
    with pytest.raises(UserError, match="another version"):
        opened()


@pytest.mark.parametrize("restart", [False, True])
def test_files_of_others_are_not_replaced(opened: Opened, tmp_path: Path, restart: bool) -> None:
    out = tmp_path / "out"
    out.mkdir()
    files = {"index.html": "my page", "design.json": "{}", "results.csv": "a,b"}
    for name, text in files.items():
        (out / name).write_text(text)
    with pytest.raises(UserError, match=r"other files named like results: results\.csv, design\.json, index"):
        opened(restart=restart)
    assert {name: (out / name).read_text() for name in files} == files


def test_a_restart_that_was_killed_can_be_repeated(opened: Opened, tmp_path: Path) -> None:
    store = opened()
    written(store, row("a"))
    store.finish(["a"], 1.0, interrupted=False)
    store.close()
    removed: list[str] = []

    def unlink(path: Path, missing_ok: bool = False) -> None:
        removed.append(path.name)
        if len(removed) == killed:
            raise KeyboardInterrupt
        os.unlink(path)

    killed = 5
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Path, "unlink", unlink)
        with pytest.raises(KeyboardInterrupt):
            opened(OTHER, restart=True)
    opened(OTHER, restart=True).close()


@pytest.mark.parametrize("name", ["lock", "results.parquet"])
def test_a_place_that_cannot_be_written_has_a_sentence(opened: Opened, tmp_path: Path, name: str) -> None:
    place = tmp_path / "out" / name
    place.parent.mkdir()
    place.mkdir() if name == "lock" else place.write_bytes(b"")
    with pytest.raises(UserError, match="cannot be written"):
        opened()


@pytest.mark.parametrize("data", [b"nothing", b""])
def test_a_damaged_part_has_a_sentence(opened: Opened, tmp_path: Path, data: bytes) -> None:
    store = opened()
    written(store, row("a"))
    store.close()
    (part,) = (tmp_path / "out" / "results.parquet").iterdir()
    part.write_bytes(data)
    with pytest.raises(UserError, match="damaged"):
        opened()
    opened(restart=True).close()


def test_one_run_at_a_time_writes_to_a_folder(opened: Opened) -> None:
    store = opened()
    with pytest.raises(UserError, match="Another run"):
        opened()
    store.close()
    opened().close()


def test_a_csv_file_that_was_cut_off_is_made_again(opened: Opened, tmp_path: Path) -> None:
    store = opened()
    written(store, row("a"), row("b"))
    store.close()
    table = tmp_path / "out" / "results.csv"
    table.write_bytes(table.read_bytes()[:-20])
    opened().close()
    assert [each["scan"] for each in csv_rows(tmp_path / "out")] == ["a", "b"]
