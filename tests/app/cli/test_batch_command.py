"""``busk batch`` does every body once: of hostile folders, on any number of workers, and after every kill."""

from __future__ import annotations

import gzip
import json
import os
import random
import shutil
import signal
import subprocess
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

import psutil
import pytest
from batch_tools import csv_rows, lasting, parquet_rows, run_batch, start_batch, summary
from damaged_files import damaged_file
from pdf_tools import Pdf

from app.cli.commands.batch import noticed_interrupts
from app.cli.main import BAD_INPUT, INTERRUPTED, main
from app.cli.output import DONE, NOT_CONVERGED
from core.document.design import Design, ScanSource
from core.document.document import Document
from core.document.lines import ActiveLine
from core.document.storage.project_file import ScanFile, save_project
from core.landmarks.manual import placed_mark
from core.measurements.table import measures
from core.pipeline.build import build

pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals and links are those of POSIX")
LINES = ["--line", "mid-bust=-20mm", "--elastic", "mid-bust=plush 12"]
DAMAGED = 12


def hostile_folder(folder: Path, person: Path, mannequin: Path) -> tuple[set[str], set[str]]:
    """Fill a folder with good and bad scans, and return the names of both."""
    good = {"anna.ply": person, "名前.ply": mannequin, "имя ü.ply": person, "a=b,'\n.ply": mannequin}
    for name, file in good.items():
        shutil.copy(file, folder / name)
    (folder / "packed.ply.gz").write_bytes(gzip.compress(person.read_bytes(), 1))
    bad, data = {"empty.ply", "junk.obj", "missing.ply", "pipe.ply", "self.ply"}, person.read_bytes()
    (folder / "empty.ply").write_bytes(b"")
    (folder / "junk.obj").write_text("nothing")
    (folder / "missing.ply").symlink_to("nowhere.ply")
    (folder / "self.ply").symlink_to("self.ply")
    (folder / "circle").symlink_to(folder, target_is_directory=True)
    os.mkfifo(folder / "pipe.ply")
    chance = random.Random(1)
    for number in range(DAMAGED):
        _, content = damaged_file(chance, {"scan.ply": data[: len(data) - 20_000 * (number % 2)]})
        (folder / f"damaged{number}.ply").write_bytes(content)
    return {*good, "packed.ply.gz"}, bad


@pytest.fixture(scope="module")
def hostile(tmp_path_factory: pytest.TempPathFactory, person: Path, mannequin: Path) -> Path:
    folder = tmp_path_factory.mktemp("hostile")
    good, bad = hostile_folder(folder, person, mannequin)
    (folder / "names.json").write_text(json.dumps([sorted(good), sorted(bad)]))
    return folder


@pytest.fixture(scope="module")
def on_two(hostile: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, int, str]:
    """The results of the hostile folder on two workers, the exit code and what was printed."""
    out = tmp_path_factory.mktemp("two") / "out"
    code, printed, _ = run_batch(hostile, *LINES, "--out", out, "--workers", "2", "--json", "--body")
    return out, code, printed


def test_every_good_body_is_done_and_every_bad_one_has_a_sentence(
    hostile: Path, on_two: tuple[Path, int, str]
) -> None:
    out, code, _ = on_two
    good, bad = map(set, json.loads((hostile / "names.json").read_text()))
    rows = {os.path.basename(row["scan"]): row for row in parquet_rows(out)}
    assert len(rows) == len(parquet_rows(out)) == len(good | bad) + DAMAGED
    assert {rows[name]["state"] for name in good} == {"done"}
    assert {rows[name]["state"] for name in bad} == {"refused"}
    assert all(row["message"].endswith(".") for row in rows.values() if row["state"] != "done")
    assert code == NOT_CONVERGED
    states = Counter(row["state"] for row in rows.values())
    assert {state: count for state, count in summary(out)["states"].items() if count} == states
    assert (out / rows["anna.ply"]["body_file"]).is_file()


def test_the_tables_agree(on_two: tuple[Path, int, str]) -> None:
    out = on_two[0]
    table, rows = {row["scan"]: row for row in parquet_rows(out)}, csv_rows(out)
    assert len(rows) == len(table)
    for row in rows:
        if row["state"] == "done" and "\\n" not in row["scan"]:
            assert float(row["bust_mm"]) == table[row["scan"]]["bust_mm"]
    assert [row["scan"] for row in rows] == sorted(row["scan"] for row in rows)


def test_progress_is_printed_as_json(on_two: tuple[Path, int, str]) -> None:
    events = [json.loads(line) for line in on_two[2].splitlines()]
    assert events[-1]["event"] == "summary"
    assert {event["event"] for event in events[:-1]} == {"progress"}
    assert events[-2]["done"] == events[-2]["total"] == events[-1]["rows"]


def test_results_do_not_depend_on_workers_nor_on_shipping(
    hostile: Path, on_two: tuple[Path, int, str], tmp_path: Path
) -> None:
    words = [hostile / "anna.ply", hostile / "名前.ply", hostile / "junk.obj"]
    run_batch(*words, *LINES, "--out", tmp_path, "--workers", "1", "--ship", "--body")
    for name in ("pictures", "bodies"):
        files = sorted((tmp_path / name).iterdir())
        assert len(files) == 2
        assert all(file.read_bytes() == (on_two[0] / name / file.name).read_bytes() for file in files)
    whole = {row["scan"]: lasting(row) for row in parquet_rows(on_two[0])}
    rows = parquet_rows(tmp_path)
    assert len(rows) == 3
    for row in rows:
        assert lasting(row) == whole[row["scan"]]


def test_a_project_is_a_body_with_its_landmarks_and_has_a_report(person: Path, tmp_path: Path) -> None:
    scans, out = tmp_path / "scans", tmp_path / "out"
    scans.mkdir()
    moved = placed_mark("bust_point_left=85,-270,255")
    design = Design(ScanSource("anna.ply"), placed=(moved,), customer="Anna")
    scan = ScanFile("anna.ply", person.read_bytes())
    save_project(scans / "anna.busk", Document.single(design), scan, None)
    shutil.copy(person, scans)
    words = ["--line", "mid-bust=95%", "--out", out, "--workers", "1", "--report", "ja"]
    code, _, _ = run_batch(scans, *words)
    rows = {os.path.basename(row["scan"]): row for row in parquet_rows(out)}
    assert code == DONE
    assert set(rows) == {"anna.busk", "person.ply"}
    stages = build(replace(design, scan=ScanSource(str(person))))
    placed = measures(stages.body.smoothed, stages.landmarks)
    assert rows["anna.busk"]["bust_mm"] == placed["bust_girth"].value != rows["person.ply"]["bust_mm"]
    assert "Anna" in Pdf(out / rows["anna.busk"]["report_file"]).text()


def test_a_project_and_a_preset_are_variants(person: Path, tmp_path: Path) -> None:
    project = tmp_path / "mine.busk"
    scan = ScanFile("anna.ply", person.read_bytes())
    design = Design(ScanSource("anna.ply"), lines=(ActiveLine("mid-bust", 0.95),), customer="Anna")
    save_project(project, Document.single(design), scan, None)
    designs = ["--design", project, "--design", "girdle"]
    code, printed, _ = run_batch(person, *designs, "--out", tmp_path / "out", "--workers", "1")
    rows = {row["variant"]: row for row in parquet_rows(tmp_path / "out")}
    assert set(rows) == {"mine", "Girdle"}
    assert rows["mine"]["set_mid-bust_percent"] == 95.0
    assert rows["mine"]["set_waist_percent"] is None
    assert "2 done" in printed
    assert code == DONE
    assert "Anna" not in (tmp_path / "out" / "design.json").read_text("utf-8")


def started(out: Path, parts: int, *words: str | Path) -> subprocess.Popen[bytes]:
    """Start a run, and return when some parts are written."""
    process = start_batch(*words, "--out", out)
    before = len(list((out / "results.parquet").glob("part-*.parquet")))
    while len(list((out / "results.parquet").glob("part-*.parquet"))) < before + parts:
        assert process.poll() is None
        time.sleep(0.02)
    return process


def test_kills_lose_no_body_and_double_none(person: Path, mannequin: Path, tmp_path: Path) -> None:
    scans, out, count = tmp_path / "scans", tmp_path / "out", 16
    scans.mkdir()
    for number in range(count):
        data = (person, mannequin)[number % 2].read_bytes()
        (scans / f"{number:02}.ply").write_bytes(data + bytes([number]))  # no two are equal
    words = (scans, *LINES, "--workers", "2")
    command = started(out, 1, *words)
    command.kill()
    command.communicate()
    kept = {row["scan"]: lasting(row) for row in parquet_rows(out)}
    assert 0 < len(kept) < count
    command = started(out, 1, *words)
    workers = psutil.Process(command.pid).children(recursive=True)
    killed = [each for each in workers if "body_process" in " ".join(each.cmdline())][:1]
    killed += [each for each in workers if "spawn_main" in " ".join(each.cmdline())][:1]
    for each in killed:
        each.kill()
    command.communicate(timeout=200)
    rows = parquet_rows(out)
    assert len(rows) == len({row["scan"] for row in rows}) == len(csv_rows(out)) == count
    lost = [row for row in rows if row["state"] != "done"]
    assert len(lost) <= 1, "a body whose process was killed is a row; a worker's bodies are done again"
    assert kept.items() <= {row["scan"]: lasting(row) for row in rows}.items(), "nothing is done twice"
    assert run_batch(*words, "--out", out, "--retry")[0] == DONE
    assert summary(out)["states"]["done"] == count


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_an_interrupt_that_a_finalizer_drops_is_not_lost() -> None:
    class Dropping:
        def __del__(self) -> None:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(0)  # here the exception is raised, and ignored

    former = signal.getsignal(signal.SIGINT)
    with noticed_interrupts() as check:
        check()
        each = Dropping()
        del each
        with pytest.raises(KeyboardInterrupt):
            check()
    assert signal.getsignal(signal.SIGINT) is former


def test_an_interrupted_run_ends_with_what_is_there(person: Path, tmp_path: Path) -> None:
    scans, out = tmp_path / "scans", tmp_path / "out"
    scans.mkdir()
    for number in range(100):
        (scans / f"{number:02}.ply").write_bytes(person.read_bytes() + bytes([number]))
    command = started(out, 1, scans, *LINES, "--workers", "1")
    children = psutil.Process(command.pid).children(recursive=True)
    os.killpg(command.pid, signal.SIGINT)  # as a terminal does
    printed, errors = command.communicate(timeout=60)
    assert command.returncode == INTERRUPTED
    assert b"Traceback" not in errors
    assert b"written to" in printed
    assert summary(out)["interrupted"]
    assert len(parquet_rows(out)) == len(csv_rows(out)) == summary(out)["rows"] < 100
    assert not psutil.wait_procs(children, timeout=20)[1], "no process is left"


def test_another_design_and_wrong_words_are_refused(
    person: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["batch", str(person), "--line", "nothing=95%", "--out", str(out)]) == BAD_INPUT
    assert "is not a line" in capsys.readouterr().err
    assert main(["batch", str(person), "--design", "no such", "--out", str(out)]) == BAD_INPUT
    assert main(["batch", str(person), "--workers", "0", "--out", str(out)]) == BAD_INPUT
    assert main(["batch", str(tmp_path / "*.ply"), "--out", str(out)]) == BAD_INPUT
    assert not out.exists()


def test_a_scheduler_that_does_not_answer_is_named(
    person: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT", "100ms")
    address = "tcp://127.0.0.1:1"
    code, _, errors = run_batch(person, *LINES, "--out", tmp_path, "--scheduler", address)
    assert code == BAD_INPUT
    assert f"The scheduler {address} does not answer" in errors
