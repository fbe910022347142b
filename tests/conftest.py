"""What every test shares: the sample bodies, and a house in which the user's own settings are not touched."""

from __future__ import annotations

import atexit
import gc
import os
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache, lru_cache, partialmethod, wraps
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from coarse_bodies import coarse_body
from dead_process import pytest_testnodedown  # noqa: F401 (pytest finds it here)
from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot
from small_project import write_project
from threadpoolctl import threadpool_limits

import core.scan.body
from app.gui.theme.stylesheet import apply_theme
from app.i18n.catalog import use_language
from app.i18n.lengths import use_unit
from app.presenters.samples import sample_design
from app.rendering.ambient_occlusion import bake_occlusion
from core.analysis.uncertainty.input_uncertainty import default_uncertainty
from core.document.design import Design, ScanSource
from core.document.lines import ActiveLine
from core.garment.elastic_library import find_elastic
from core.pipeline import build as pipeline
from core.pipeline.build import Stages, build

SAMPLES = Path(__file__).parent.parent / "resources" / "samples"
PATIENCE_MS = 90_000
SPARING = ("collect", "freeze", "unfreeze")
SPARING_NOTHING = SimpleNamespace(**vars(gc) | dict.fromkeys(SPARING, lambda *_: None))


gc.disable()  # modules and tests that are collected are no garbage; what tests leave is collected after each


def display_of_its_own() -> None:
    """Open a virtual display for one of several test processes: others' windows would take the keyboard."""
    shown, told = os.pipe()
    command = f"Xvfb -displayfd {told} -screen 0 2600x1500x24 -noreset".split()
    server = subprocess.Popen(command, pass_fds=[told], stderr=subprocess.DEVNULL)
    atexit.register(server.terminate)
    os.close(told)
    with os.fdopen(shown) as number:
        os.environ["DISPLAY"] = f":{number.readline().strip()}"


if "PYTEST_XDIST_WORKER" in os.environ and os.environ.get("QT_QPA_PLATFORM") == "xcb":
    display_of_its_own()

os.environ.setdefault("QT_API", "pyside6")
os.environ.setdefault("PYQTGRAPH_QT_LIB", "PySide6")
if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")


for _wait in ("waitUntil", "waitSignal", "waitSignals", "waitExposed", "waitActive"):
    # Nothing is waited for in vain: a limit is for what hangs, not for a machine with other work.
    setattr(QtBot, _wait, partialmethod(getattr(QtBot, _wait), timeout=PATIENCE_MS))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run the files that take longest first: processes that share the files end together."""
    items.sort(key=lambda item: "/end_to_end/" not in item.nodeid)


@pytest.fixture(scope="session", autouse=True)
def own_folders() -> Iterator[None]:
    """Settings, data and logs of this session go to a folder that is gone afterwards."""
    with pytest.MonkeyPatch.context() as patch, tempfile.TemporaryDirectory() as folder:
        for kind in ("CONFIG", "DATA", "STATE", "CACHE"):
            patch.setenv(f"XDG_{kind}_HOME", str(Path(folder) / kind.lower()))
        yield


@pytest.fixture(scope="module", autouse=True)
def old_things_are_no_garbage() -> None:
    """What lives on between two files, mostly libraries, is not looked through after each test."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope="module", autouse=True)
def nothing_inherited() -> Iterator[None]:
    """A file of tests finds no work, backups or tables of another: which ran before it is left to chance."""
    yield
    for folder in ("STATE", "DATA"):
        for each in (Path(os.environ[f"XDG_{folder}_HOME"]) / "Busk").glob("*"):
            if each.is_dir() and each.name != "log":
                shutil.rmtree(each)


@pytest.fixture(autouse=True)
def garbage_in_this_thread(request: pytest.FixtureRequest) -> Iterator[None]:
    """Python looks for garbage in the tests' thread alone: in a solver's it would destroy Qt objects."""
    gc.disable()
    yield
    searched = "qapp" not in request.fixturenames or "empty_house" in request.fixturenames
    gc.collect(0 if searched else 2)


@pytest.fixture(scope="session", autouse=True)
def one_blas_thread() -> Iterator[None]:
    """As in the solver's thread: two make the wide matrices of a sphere many times slower."""
    with threadpool_limits(1):
        yield


@pytest.fixture(scope="session", autouse=True)
def stages_made_once() -> Iterator[None]:
    """Of the way from a file to a fitted model each stage is made once for equal inputs: they are frozen."""
    with pytest.MonkeyPatch.context() as patch:
        for name in (
            "body_of",
            "detect_landmarks",
            "read_template",
            "fit_control_mesh",
            "halved",
            "_condensed",
            "blend_weights",
            "_backs",
        ):
            patch.setattr(pipeline, name, remembered(getattr(pipeline, name)))
        yield


def remembered(make: Callable[..., Any]) -> Callable[..., Any]:
    """Keep the last results of ``make``; a test that replaces how bodies are stood up gets its own."""

    @lru_cache(maxsize=16)
    def kept(_: object, *inputs: object, **told: object) -> object:
        return make(*inputs, **told)

    @wraps(make)
    def again(*inputs: object, progress: object = None, **told: object) -> object:
        return kept(core.scan.body.estimate_pose, *inputs, **told)

    return again


shading = remembered(bake_occlusion)
"""The soft shadows of a body, computed once."""


@pytest.fixture(scope="session")
def fine_mannequin() -> Path:
    """The sample body on which the program opens, with all its vertices: a smooth, watertight scan."""
    return SAMPLES / "mannequin.ply"


@pytest.fixture(scope="session")
def mannequin(fine_mannequin: Path) -> Path:
    """The same as the tests of a folder read it; where nothing is measured, on a fifth of its vertices."""
    return fine_mannequin


@pytest.fixture(scope="session")
def person() -> Path:
    """The sample body with the shape of a person: soft, uneven, with a deep fold."""
    return SAMPLES / "person.ply"


@pytest.fixture(scope="session")
def finely_built() -> Callable[[str], Stages]:
    """The stages of a sample body with its mid-bust line at 97 %, built once for all tests."""
    return cache(lambda sample: _with_mid_bust(SAMPLES / f"{sample}.ply"))


@pytest.fixture(scope="session")
def coarsely_built(coarse_samples: Callable[[str], Path]) -> Callable[[str], Stages]:
    """The same on a fifth of its vertices."""
    return cache(lambda sample: _with_mid_bust(coarse_samples(sample)))


def _with_mid_bust(file: Path) -> Stages:
    return build(Design(ScanSource(str(file)), lines=(ActiveLine("mid-bust", 0.97),)))


@pytest.fixture(scope="session")
def built(finely_built: Callable[[str], Stages]) -> Callable[[str], Stages]:
    """The stages on which the tests of a folder look; where nothing is measured, the coarse ones."""
    return finely_built


@pytest.fixture(scope="session")
def qapp_cls() -> type[QApplication]:
    """The application of the tests is that of the program."""
    from app.gui.application import Application  # noqa: PLC0415 (not every test brings Qt along)

    return Application


@pytest.fixture(autouse=True)
def english_in_millimetres() -> Iterator[None]:
    """Bring back English and millimetres after a test that used others."""
    yield
    use_language("en")
    use_unit("mm")


@pytest.fixture
def light_theme(qapp: QApplication) -> Iterator[None]:
    """Apply the light theme."""
    apply_theme(qapp, dark=False)
    yield
    qapp.setStyleSheet("")


@pytest.fixture
def own_data(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Keep elastics, presets and size tables of the user in a folder of this test."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))


@pytest.fixture
def few_elastics(monkeypatch: pytest.MonkeyPatch) -> None:
    """Offer the elastics that tests name alone: the effect of each is computed for a chooser."""
    named = ("strap 15", "strap 20", "picot 10", "plush 12", "plush 18", "power-net 80")
    few = tuple(find_elastic(each) for each in named)
    monkeypatch.setattr("core.garment.elastic_library.built_in", lambda: few)


@pytest.fixture
def landmarks_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Assume landmarks without uncertainty: a fit for each takes too long for a test of the window."""
    known = replace(default_uncertainty(), landmark_mm=0.0, unsure_landmark_mm=0.0)
    monkeypatch.setattr("core.analysis.uncertainty.estimate.default_uncertainty", lambda: known)


@pytest.fixture
def opened_as_in_the_program() -> None:
    """A first start opens the sample whose bust is lifted."""


@pytest.fixture
def limits_sought() -> None:
    """The length limits of lines are computed as soon as a design is built."""


@pytest.fixture
def on_solid() -> None:
    """A scan opens on solid tissue."""


@pytest.fixture
def first_tour() -> None:
    """A first start begins the tour."""


@pytest.fixture
def fine_samples() -> None:
    """Samples are opened on all their vertices."""


@pytest.fixture
def spared_as_in_the_program() -> Iterator[None]:
    """What a window spares the search for garbage it gives back when it is closed, with all libraries."""
    yield
    gc.collect()
    gc.freeze()  # as each file begins


@pytest.fixture(scope="session")
def coarse_samples(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Return the file of a sample body on a fifth of its vertices, made once."""
    folder = tmp_path_factory.mktemp("coarse")
    return cache(lambda name: coarse_body(name, folder))


@pytest.fixture(scope="session")
def coarse_sample(coarse_samples: Callable[[str], Path]) -> Design:
    """The design on the mannequin with which the windows of tests begin."""
    design = sample_design()
    return replace(design, scan=replace(design.scan, path=str(coarse_samples("mannequin"))))


@pytest.fixture
def empty_house(
    request: pytest.FixtureRequest,
    qapp: QApplication,
    monkeypatch: pytest.MonkeyPatch,
    coarse_sample: Design,
    coarse_samples: Callable[[str], Path],
) -> Iterator[None]:
    """Nothing of a window lives on after a test: no thread of ours, no window; its settings are fresh.

    A first start opens the mannequin with a short glued line, which most tests are about, samples open
    without cups, and no tour begins: with ``opened_as_in_the_program`` all is as the user sees it. Samples
    are on a fifth of their vertices, with ``fine_samples`` on all. The soft shadows of a body are computed
    once. Scans open on the net of the paper, which takes a tenth of the time; with ``on_solid`` they do as
    the user sees it.
    How sure figures are is not worked out where a test does not ask: it takes half a minute of a processor;
    nor are length limits but with ``limits_sought``.
    Frames come seldom, as on a slow machine: most of a test's time would go into ones that nobody looks at.
    """
    if "spared_as_in_the_program" not in request.fixturenames:
        # Else all libraries would be looked through three times after each window, and not only what it left.
        monkeypatch.setattr("app.gui.session.gc_control.gc", SPARING_NOTHING)
    if "fine_samples" not in request.fixturenames:
        monkeypatch.setattr("app.presenters.samples.sample_path", coarse_samples)
    if "opened_as_in_the_program" not in request.fixturenames:
        opened = sample_design() if "fine_samples" in request.fixturenames else coarse_sample
        monkeypatch.setattr("app.gui.startup.dressed_sample", lambda: opened)
        monkeypatch.setattr("app.gui.features.project.controller.dressed_sample", sample_design)
    if not {"opened_as_in_the_program", "on_solid"}.intersection(request.fixturenames):
        monkeypatch.setattr("app.gui.session.session.new_design", Design)
    if not {"opened_as_in_the_program", "first_tour"}.intersection(request.fixturenames):
        monkeypatch.setattr("app.gui.tour.Tour.begin_when_settled", lambda _: None)
    monkeypatch.setattr("app.gui.viewport.view_area.bake_occlusion", shading)
    monkeypatch.setattr("app.gui.features.uncertainty.controller.PAUSE", 10**8)
    if "limits_sought" not in request.fixturenames:
        monkeypatch.setattr(
            "app.gui.features.lines.limits_controller.LimitsController._begin", lambda _: None
        )
    monkeypatch.setattr("core.pipeline.live_solver._SLICE", 0.1)
    QSettings().clear()
    yield
    gc.collect()
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("busk")]
    assert not [widget for widget in QApplication.topLevelWidgets() if type(widget).__name__ == "MainWindow"]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A small project in a folder of its own."""
    return write_project(tmp_path)
