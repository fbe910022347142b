"""The self-test: it names what is broken by its line, goes on, and leaves the user's files alone."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import platformdirs
import pytest
from PIL import Image
from PySide6.QtCore import QSettings, qWarning
from PySide6.QtWidgets import QApplication

import app.report.pdf
import core.document.presets
from app.cli.commands import picture
from app.cli.commands.self_test import LINES, PARTS
from app.cli.self_test import core_checks as figures
from app.cli.self_test import fonts as letters
from app.cli.self_test import installation as program
from app.cli.self_test import outputs as papers
from app.cli.self_test.checks import Part, PartError, try_parts
from app.cli.self_test.fixture import Bench
from app.cli.self_test.message_capture import hearing
from app.cli.self_test.sandbox import PASSING, apart
from app.gui.theme.stylesheet import load_fonts
from core.errors import UserError
from core.pipeline.build import Stages

ROOT = Path(__file__).parents[3]


@pytest.fixture
def bench(tmp_path: Path, built: Callable[[str], Stages]) -> Bench:
    result = Bench(tmp_path)
    result.stages = built("mannequin")
    result.design = result.stages.design
    return result


def test_all_is_well_here_without_display_and_without_streams(tmp_path: Path) -> None:
    """As a windowed program of Windows it has neither; what it made and said lies in the folder."""
    code = (
        "import sys; sys.stdin = sys.stdout = sys.stderr = sys.__stdout__ = sys.__stderr__ = None; "
        "from app.cli.main import main; sys.exit(main(['self-test', '--out', sys.argv[1]]))"
    )
    homes = {f"XDG_{kind}_HOME": str(tmp_path / "user") for kind in ("CONFIG", "DATA", "STATE", "CACHE")}
    world = {name: value for name, value in os.environ.items() if not name.endswith("DISPLAY")}
    world = world | homes | {"QT_QPA_PLATFORM": "offscreen"}
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "out")], cwd=ROOT, env=world, check=False
    )
    lines = (tmp_path / "out" / LINES).read_text("utf-8").splitlines()
    assert [line for line in lines[:-1] if " ok " not in line] == []
    assert [line[2:20].rstrip() for line in lines[:-1]] == [part.name for part in PARTS]
    assert lines[-1].startswith("all is well")
    assert done.returncode == 0
    assert not [
        path for path in (tmp_path / "user").rglob("*") if "numba" not in str(path) and path.is_file()
    ]
    with Image.open(tmp_path / "out" / "window.png") as picture:
        assert picture.size == (1600, 1000)
        assert len(np.unique(np.asarray(picture.convert("RGB")).reshape(-1, 3), axis=0)) > 2000


def test_a_part_that_fails_hides_none_of_the_others() -> None:
    def refused(_: str) -> str:
        raise UserError("The disk is full.", "Make room.")

    heard: list[str] = []
    parts = [
        Part[str]("first", refused),
        Part[str]("second", lambda bench: f"looked at {bench}", ("first",)),
        Part[str]("third", lambda bench: str(1 // 0), ("second",)),
        Part[str]("fourth", lambda bench: bench.index("nowhere") and ""),
        Part[str]("fifth", lambda bench: "sound"),
    ]
    assert try_parts(parts, "bench", heard.append) == ["first", "second", "third", "fourth"]
    lines = "".join(heard).splitlines()
    assert [line.split(" (")[0].split(maxsplit=1)[1].strip() for line in lines] == [
        "FAILED  The disk is full. Make room.",
        "not tried: it needs first",
        "not tried: it needs second",
        "FAILED  ValueError: substring not found",
        "ok      sound",
    ]
    assert "test_self_test.py, line" in lines[3]
    assert heard[0].split() == ["first"], (
        "a part is named before it is tried: it may take the program with it"
    )


def test_what_is_only_printed_is_heard(qapp: QApplication, bench: Bench) -> None:
    """A fault in another thread, and a complaint of Qt, would pass unseen else."""

    def tear() -> None:
        raise ValueError("torn")

    hook = sys.excepthook
    with hearing() as bench.heard:
        bench.check_silence()
        thread = threading.Thread(target=tear)
        thread.start()
        thread.join()
        qWarning("a painter is still at work")
        with pytest.raises(PartError, match="ValueError: torn; Qt says: a painter is still at work"):
            bench.check_silence()
        bench.check_silence()
    assert sys.excepthook is hook


def test_every_part_needs_only_parts_before_it() -> None:
    names = [part.name for part in PARTS]
    assert len(set(names)) == len(names)
    for place, part in enumerate(PARTS):
        assert set(part.needs) <= set(names[:place])


def test_what_is_written_lies_apart_from_the_users_own_files(
    qapp: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    finds = ("MPLCONFIGDIR", "NUMBA_CACHE_DIR")
    for name in finds:
        monkeypatch.setenv(name, "elsewhere")
    own, before = QSettings().fileName(), dict(os.environ)
    with apart(tmp_path):
        assert all(Path(os.environ[name]).is_relative_to(tmp_path) for name in finds)
        places = [platformdirs.user_data_path("Busk"), platformdirs.user_state_path("Busk")]
        places += [Path(QSettings().fileName()), Path(tempfile.gettempdir())]
        QSettings().setValue("theme", "dark")
        QSettings().sync()
    assert all(place.is_relative_to(tmp_path) for place in places)
    assert Path(tempfile.gettempdir()) != tmp_path / PASSING
    assert (QSettings().fileName(), dict(os.environ)) == (own, before)
    assert QSettings().value("theme") is None


def test_a_system_that_does_not_let_it_be_apart_is_left_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(platformdirs, "user_state_path", lambda *_, **__: tmp_path / "elsewhere")
    with pytest.raises(UserError, match="not begun"), apart(tmp_path / "own"):
        pass


def test_what_is_not_shipped_is_named(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "3 presets" in program.shipped_files(bench)
    with monkeypatch.context() as patch:
        patch.setattr(core.document.presets, "built_in", lambda: core.document.presets.preset_of("{"))
        with pytest.raises(PartError, match="a preset cannot be read"):
            program.shipped_files(bench)
    monkeypatch.setattr(program, "is_frozen", lambda: True)
    monkeypatch.setattr(program, "_home", lambda: bench.folder)
    with pytest.raises(PartError, match="there is no guide"):
        program.guide(bench)


def test_type_without_its_letters_is_found_out(
    qapp: QApplication, bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    load_fonts()
    assert "drawn as letters" in letters.japanese(bench)
    shutil.copytree(ROOT / "resources" / "fonts", bench.folder / "fonts")
    (bench.folder / "fonts" / "NotoSansJP-Regular.otf").unlink()
    with monkeypatch.context() as patch:
        patch.setattr(letters.resources, "files", lambda _: bench.folder)
        with pytest.raises(PartError, match="letters are missing: "):
            letters.japanese(bench)
        assert "Inter" in letters.latin(bench)
    with monkeypatch.context() as patch:
        patch.setattr(letters, "_drawn", lambda _: b"box")
        with pytest.raises(PartError, match="boxes are drawn"):
            letters.japanese(bench)
    monkeypatch.setattr("app.gui.theme.stylesheet.load_fonts", lambda: ("Inter",))
    with pytest.raises(PartError, match="Noto Sans JP is not among"):
        letters.japanese(bench)


def test_files_that_are_not_what_they_should_be_are_found_out(
    qapp: QApplication, bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.report.images.render_images", lambda *_: iter(()))
    monkeypatch.setattr(papers, "in_one_go", lambda _: {})
    assert "sheet-ja.pdf of 2 pages" in papers.report(bench)
    write = app.report.pdf.write_pdf
    for spoil, said in (
        (lambda data: data[: len(data) // 2], "no whole PDF"),
        (lambda data: data.replace(b"/Type /Page\n", b"/Type /None\n", 1), "has 1 pages"),
        (lambda data: data.replace(b"Inter", b"Other"), "is not set in Inter"),
    ):

        def spoilt(path: Path, *told: object, spoil: Callable[[bytes], bytes] = spoil) -> None:
            write(path, *told)
            path.write_bytes(spoil(path.read_bytes()))

        monkeypatch.setattr(app.report.pdf, "write_pdf", spoilt)
        with pytest.raises(PartError, match=said):
            papers.report(bench)


def test_a_busy_machine_is_waited_for_and_what_never_comes_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    """With other work around, the processor gives the program a tenth of the time."""
    spent, given = [0.0], [0.1]

    def turn() -> None:
        spent[0] += 1.0

    clock = SimpleNamespace(
        monotonic=lambda: spent[0], process_time=lambda: given[0] * spent[0], sleep=lambda _: None
    )
    monkeypatch.setattr(picture, "time", clock)
    picture.wait_until(lambda: spent[0] > 1000.0, turn)
    for share in (1.0, 0.0):
        given[0] = share
        with pytest.raises(UserError, match="waited too long"):
            picture.wait_until(lambda: False, turn)


def test_a_solver_that_is_off_is_found_out(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "settled in" in figures.solver(bench)
    away = figures.BUST_POINT[0] + 9.0, *figures.BUST_POINT[1:]
    monkeypatch.setattr(figures, "BUST_POINT", away)
    with pytest.raises(PartError, match="bust_point_left lies"):
        figures.landmarks(bench)
    monkeypatch.setattr(figures.kernels, "warm", lambda: False)
    monkeypatch.setattr(figures.kernels, "state", lambda: "numpy: ImportError, llvmlite is broken")
    with pytest.raises(PartError, match="llvmlite is broken"):
        figures.compiled_loops(bench)
    monkeypatch.setattr(figures, "open_project", lambda _: None)
    with pytest.raises(PartError, match="as if it were whole"):
        figures.damaged_projects(bench)
