"""Numbers of a body are those of the single commands, to the last bit; what is lost is a row."""

from __future__ import annotations

import json
import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from app.batch.batch_design import BatchDesign, batch_design
from app.batch.body_worker import BodyWorker, Limits
from app.batch.engine import Run
from app.batch.one_body import compute_row
from app.batch.schema import columns_of
from app.cli.main import main
from app.i18n.catalog import using_language
from app.presenters.english_text import shown_text
from core.document.design import Design, ScanSource

LINES, ELASTICS = ["under-bust=94%", "mid-bust=-20mm"], ["mid-bust=plush 12"]
OPTIONS = [*(word for line in LINES for word in ("--line", line)), "--elastic", ELASTICS[0]]
DESIGN = batch_design("one", Design(ScanSource("")), LINES, ELASTICS, [])


def setup_of(*designs: BatchDesign) -> str:
    return Run(designs, 1).setup


def request(scan: Path, variant: int = 0) -> dict[str, Any]:
    return {"scan": scan.name, "file": str(scan), "variant": variant, "name": "one"}


@pytest.fixture(scope="module")
def worker() -> Iterator[BodyWorker]:
    worker = BodyWorker(setup_of(DESIGN), Limits())
    yield worker
    worker.close()


@pytest.fixture(scope="module")
def row(person: Path, worker: BodyWorker) -> dict[str, Any]:
    return worker.compute(request(person))


def printed(words: list[str], capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    capsys.readouterr()
    main(words)
    values: dict[str, Any] = json.loads(capsys.readouterr().out)
    return values


def test_the_numbers_are_those_of_solve(row: dict[str, Any], person: Path, tmp_path: Path) -> None:
    main(["solve", str(person), *OPTIONS, "--out", str(tmp_path)])
    report = json.loads((tmp_path / "report.json").read_text("utf-8"))
    assert row["volume_error_percent"] == report["volume"]["error_percent"]
    assert row["solver_state"] == report["state"]
    assert row["verdict"] == report["assessment"]["level"]
    marks = report["marks"]
    for side in ("left", "right"):
        key = f"bust_point_{side}_above_lowest_mm"
        assert row[f"lift_{side}_mm"] == pytest.approx(marks["final"][key] - marks["rest"][key], abs=1e-9)
    for line in ("under-bust", "mid-bust"):
        assert row[f"set_{line}_percent"] == report["lines"][line]["set_percent"]
        assert row[f"reached_{line}_mm"] == report["lines"][line]["reached_mm"]


def test_the_numbers_are_those_of_cut_pressure_and_measure(
    row: dict[str, Any], person: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cuts = {each["line"]: each for each in printed(["cut", str(person), *OPTIONS, "--json"], capsys)["rows"]}
    pressed = printed(["pressure", str(person), *OPTIONS, "--json"], capsys)["rows"]
    measured = printed(["measure", str(person), "--json"], capsys)["measures"]
    assert row["cut_length_mid-bust_mm"] == cuts["mid-bust"]["cut_mm"]
    assert row["tension_mid-bust_n"] == cuts["mid-bust"]["tension_n"]
    for each in pressed:
        assert row[f"pressure_max_{each['line']}_kpa"] == each["max_kpa"]
        assert row[f"pressure_mean_{each['line']}_kpa"] == each["mean_kpa"]
    assert row["bust_mm"] == measured["bust_girth"]["before"]
    assert row["underbust_mm"] == measured["underbust_girth"]["before"]


def test_a_row_has_the_columns_of_its_design_alone(row: dict[str, Any]) -> None:
    assert set(row) <= {each.name for each in columns_of([DESIGN])}
    assert row["state"] == "done"
    assert row["band_jp"]
    assert row["cup_us"]


def test_a_variant_after_another_has_the_same_numbers(person: Path) -> None:
    other = batch_design("two", Design(ScanSource("")), ["mid-bust=90%"], [], [])
    first = compute_row(DESIGN, person)
    assert compute_row(other, person, first.stages).row == compute_row(other, person).row


def test_targets_give_the_lengths_that_target_finds(person: Path, capsys: pytest.CaptureFixture[str]) -> None:
    design = batch_design("one", Design(ScanSource("")), ["mid-bust=97%"], [], ["out=-3mm"])
    row = compute_row(design, person).row
    words = ["target", str(person), "--line", "mid-bust=97%", "--target", "out=-3mm", "--json"]
    found = printed(words, capsys)
    assert row["set_mid-bust_percent"] == found["lines"]["mid-bust"]["set_percent"]
    missed = abs(found["figures"]["out"]["reached_mm"] + 3.0)
    assert row["target_miss_mm"] == pytest.approx(missed, abs=1e-9)


def test_a_body_without_a_solution_is_refused_with_what_is_known(person: Path) -> None:
    design = batch_design("one", Design(ScanSource("")), ["mid-bust=1mm"], [], [])
    row = compute_row(design, person).row
    assert row["state"] == "refused"
    assert row["message"]
    assert row["bust_mm"] > 0.0
    assert row["cup_jp"]


def test_a_file_that_is_no_body_is_refused(tmp_path: Path, worker: BodyWorker) -> None:
    (tmp_path / "a.ply").write_bytes(b"ply\nnothing")
    for scan in (tmp_path / "a.ply", tmp_path / "none.ply", tmp_path):
        row = worker.compute(request(scan))
        assert row["state"] == "refused"
        assert row["message"].endswith(".")


@pytest.mark.skipif(os.name == "nt", reason="names are texts there")
def test_a_name_that_is_no_text_is_escaped_in_the_sentence(tmp_path: Path, worker: BodyWorker) -> None:
    (tmp_path / os.fsdecode(b"\xff.ply")).write_bytes(b"nothing")
    row = worker.compute({**request(tmp_path / os.fsdecode(b"\xff.ply")), "scan": "\\xff.ply"})
    assert row["state"] == "refused"
    assert all(value.encode() for value in row.values() if isinstance(value, str)), (
        "Parquet holds no other text"
    )


def test_too_little_time_or_memory_is_a_row_and_the_next_body_is_computed(person: Path) -> None:
    for limits, state, word in (
        (Limits(0.01), "timeout", "0.01 s"),
        (Limits(memory_mb=1.0), "crashed", "memory"),
    ):
        worker = BodyWorker(setup_of(DESIGN), limits)
        for _ in range(2 if state == "timeout" else 1):
            row = worker.compute(request(person))
            assert row["state"] == state
            assert word in row["message"]
            assert row["scan_sha256"]
        assert worker.process_id is None, "what was lost has ended"


def test_a_process_that_is_killed_is_a_row_and_the_next_body_is_computed(
    person: Path, worker: BodyWorker, row: dict[str, Any]
) -> None:
    def kill() -> None:
        while worker.process_id is None:
            time.sleep(0.01)
        os.kill(worker.process_id, signal.SIGKILL)

    worker.close()
    killer = threading.Thread(target=kill)
    killer.start()
    lost = worker.compute(request(person))
    killer.join()
    assert (lost["state"], lost["scan"]) == ("crashed", person.name)
    again = worker.compute(request(person))
    assert again["volume_error_percent"] == row["volume_error_percent"]


def test_a_process_that_ends_between_two_bodies_costs_none(tmp_path: Path, worker: BodyWorker) -> None:
    (tmp_path / "a.ply").write_bytes(b"nothing")
    assert worker.compute(request(tmp_path / "a.ply"))["state"] == "refused"
    assert worker._process is not None
    worker._process.kill()
    worker._process.wait(20)
    assert worker.compute(request(tmp_path / "a.ply"))["state"] == "refused"


def test_a_process_that_cannot_start_is_named_as_such(person: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.batch.body_worker._PROCESS", "app.no_such_module")
    row = BodyWorker(setup_of(DESIGN), Limits()).compute(request(person))
    assert (row["state"], row["scan_sha256"] != "") == ("crashed", True)
    assert "could not be started" in row["message"]


@pytest.mark.skipif(os.name == "nt", reason="signals are those of POSIX")
def test_rows_of_lost_bodies_are_shown_in_the_language_in_use(person: Path) -> None:
    row = BodyWorker(setup_of(DESIGN), Limits(0.01)).compute(request(person))
    with using_language("ja"):
        assert shown_text(row["message"]).startswith("0.01 秒")
