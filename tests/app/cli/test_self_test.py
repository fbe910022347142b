"""The self-test: it names what is broken by its line, continues, and leaves the user's files alone."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import platformdirs
import pytest
from PIL import Image
from PySide6.QtCore import QSettings, qWarning
from PySide6.QtWidgets import QApplication

import core.garment.presets
from app.cli.commands import picture
from app.cli.commands.self_test import LINES, PARTS
from app.cli.self_test import checks, window
from app.cli.self_test.parts import (
    TEMPORARY,
    Part,
    PartError,
    SelfTestFixture,
    captured_faults,
    isolated,
    try_parts,
)
from app.gui.theme.stylesheet import load_fonts
from core.errors import UserError
from core.messages import Message
from core.pipeline.build import Stages

ROOT = Path(__file__).parents[3]


@pytest.fixture
def bench(tmp_path: Path, finely_built: Callable[[str], Stages]) -> SelfTestFixture:
    result = SelfTestFixture(tmp_path)
    result.stages = finely_built("mannequin")
    return result


def test_all_checks_pass_without_display_and_without_streams(tmp_path: Path) -> None:
    """As a windowed program of Windows it has neither; its lines are in the folder."""
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
    *lines, _ = (tmp_path / "out" / LINES).read_text("utf-8").splitlines()
    assert [line for line in lines if " ok " not in line] == []
    assert [line[2:18].rstrip() for line in lines] == [part.name for part in PARTS]
    assert done.returncode == 0
    assert not [
        path for path in (tmp_path / "user").rglob("*") if "numba" not in str(path) and path.is_file()
    ]
    with Image.open(tmp_path / "out" / "window.png") as image:
        assert image.size == (1600, 1000)
        assert len(image.convert("RGB").getcolors(1600 * 1000)) > 2000


def test_a_failed_part_hides_none_of_the_others() -> None:
    def refused(_: str) -> str:
        raise UserError(Message("The disk is full."), Message("Make room."))

    written: list[str] = []
    parts = [
        Part[str]("first", refused),
        Part[str]("second", lambda bench: f"checked {bench}", ("first",)),
        Part[str]("third", lambda bench: str(1 // 0), ("second",)),
        Part[str]("fourth", lambda bench: bench.index("nowhere") and ""),
        Part[str]("fifth", lambda bench: "sound"),
    ]
    assert try_parts(parts, "bench", written.append) == ["first", "second", "third", "fourth"]
    lines = "".join(written).splitlines()
    assert [line.split()[1].strip(":") for line in lines] == ["FAILED", "skipped", "skipped", "FAILED", "ok"]
    assert "The disk is full. Make room." in lines[0]
    assert "test_self_test.py, line" in lines[3]
    assert written[0].split() == ["first"], "a part is named before it runs: it may end the program"


def test_faults_that_are_only_printed_are_captured(qapp: QApplication, bench: SelfTestFixture) -> None:
    def tear() -> None:
        raise ValueError("torn")

    hook = sys.excepthook
    with captured_faults() as bench.faults:
        bench.check_faults()
        thread = threading.Thread(target=tear)
        thread.start()
        thread.join()
        qWarning("a painter is still at work")
        with pytest.raises(PartError, match=r"ValueError: torn; .*a painter is still at work"):
            bench.check_faults()
        bench.check_faults()
    assert sys.excepthook is hook


def test_every_part_needs_only_parts_before_it() -> None:
    names = [part.name for part in PARTS]
    assert len(set(names)) == len(names)
    for place, part in enumerate(PARTS):
        assert set(part.needs) <= set(names[:place])


def test_files_are_written_apart_from_those_of_the_user(
    qapp: QApplication, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    caches = ("MPLCONFIGDIR", "NUMBA_CACHE_DIR")
    for name in caches:
        monkeypatch.setenv(name, "elsewhere")
    own, before = QSettings().fileName(), dict(os.environ)
    with isolated(tmp_path):
        assert all(Path(os.environ[name]).is_relative_to(tmp_path) for name in caches)
        places = [platformdirs.user_data_path("Busk"), platformdirs.user_state_path("Busk")]
        places += [Path(QSettings().fileName()), Path(tempfile.gettempdir())]
        QSettings().setValue("theme", "dark")
        QSettings().sync()
    assert all(place.is_relative_to(tmp_path) for place in places)
    assert Path(tempfile.gettempdir()) != tmp_path / TEMPORARY
    assert (QSettings().fileName(), dict(os.environ)) == (own, before)
    assert QSettings().value("theme") is None


def test_without_isolation_the_self_test_does_not_start(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(platformdirs, "user_state_path", lambda *_, **__: tmp_path / "elsewhere")
    with pytest.raises(UserError), isolated(tmp_path / "own"):
        pytest.fail("it has started")


def test_a_missing_file_is_named(bench: SelfTestFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "13 presets" in checks.shipped_files(bench)
    with monkeypatch.context() as patch:
        patch.setattr(core.garment.presets, "built_in", lambda: core.garment.presets.preset_of("{"))
        with pytest.raises(PartError, match=r"^presets "):
            checks.shipped_files(bench)
    monkeypatch.setattr(checks, "is_frozen", lambda: True)
    monkeypatch.setattr(checks, "_count", lambda *_: 0)
    monkeypatch.setattr(checks, "_home", lambda: bench.folder)
    with pytest.raises(PartError, match="guide"):
        checks.shipped_files(bench)


def test_missing_fonts_are_found(
    qapp: QApplication, bench: SelfTestFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    load_fonts()
    assert "Noto Sans JP" in window.fonts(bench)
    with monkeypatch.context() as patch:
        patch.setattr(window, "_rendered", lambda _: b"box")
        with pytest.raises(PartError, match="placeholder boxes"):
            window.fonts(bench)
    monkeypatch.setattr("app.gui.theme.stylesheet.load_fonts", lambda: ("Inter",))
    with pytest.raises(PartError, match="Noto Sans JP is not among"):
        window.fonts(bench)


def test_a_spoilt_report_is_found(bench: SelfTestFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = b"%PDF- /FontName /Inter /FontName /NotoSansJP /Image %%EOF"
    for spoilt, problem in (
        (whole, ""),
        (whole.replace(b"Inter", b"Other"), "does not use Inter"),
        (whole.replace(b"/Image", b""), "has no pictures"),
    ):
        monkeypatch.setattr(
            window, "run_command", lambda *words, data=spoilt: Path(words[-1]).write_bytes(data)
        )
        if not problem:
            assert window.report(bench)
            continue
        with pytest.raises(PartError, match=problem):
            window.report(bench)


def test_a_busy_machine_is_waited_for_but_not_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
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
        with pytest.raises(UserError):
            picture.wait_until(lambda: False, turn)


def test_wrong_landmarks_and_loops_are_found(bench: SelfTestFixture, monkeypatch: pytest.MonkeyPatch) -> None:
    assert checks.solver(bench)
    away = checks.BUST_POINT[0] + 9.0, *checks.BUST_POINT[1:]
    monkeypatch.setattr(checks, "BUST_POINT", away)
    with pytest.raises(PartError, match="bust_point_left"):
        checks.landmarks(bench)
    monkeypatch.setattr(checks.kernels, "warm", lambda: False)
    monkeypatch.setattr(checks.kernels, "state", lambda: "numpy: ImportError, llvmlite is broken")
    with pytest.raises(PartError, match="llvmlite is broken"):
        checks.compiled_loops(bench)
