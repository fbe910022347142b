"""Files that the window exports: pictures drawn between events, work that is left, disks that are full."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
import pyvista as pv
from export_tools import choose, opened, saved_as, told, written
from PIL import Image
from PySide6.QtWidgets import QApplication
from window_tools import Script, run_bodiless, run_undrawn, settled

import app.gui.features.export.controller
import app.rendering.offscreen
from app.gui.main_window import MainWindow
from core.deformation.tffd import deform

pytestmark = pytest.mark.usefixtures("empty_house")


def test_a_turntable_is_drawn_between_events_and_can_be_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "anna.gif"
    saved_as(monkeypatch, path)
    monkeypatch.setattr(app.rendering.offscreen, "LONGEST", 300)
    made: list[Any] = []
    studio_of = app.rendering.offscreen.OffscreenRenderer.__enter__
    leave = app.rendering.offscreen.OffscreenRenderer.__exit__
    monkeypatch.setattr(
        app.rendering.offscreen.OffscreenRenderer,
        "__enter__",
        lambda each: made.append(each) or studio_of(each),
    )
    monkeypatch.setattr(
        app.rendering.offscreen.OffscreenRenderer,
        "__exit__",
        lambda each, *how: made.remove(each) or leave(each, *how),
    )

    def script(window: MainWindow) -> Script:
        yield settled(window)
        sheet = opened(window, "turntable")
        choose(sheet, "format", "gif")
        choose(sheet, "frames", "12")
        choose(sheet, "size", "480x540")
        yield told(sheet)
        sheet.save.click()
        assert QApplication.activeModalWidget() is None, "the work in hand is seen, and its way out"
        yield lambda: window.status._job_name.text() == "Rendering anna.gif…"
        shares: list[float] = []
        for _ in range(4):  # the window answers between the pieces
            job = window.progress_controller._shown_job()
            shares.append(job.share or 0.0)
            yield lambda seen=shares[-1], job=job: (job.share or 0.0) > seen
        assert len(made) == 1
        window.actions_.cancel.trigger()
        assert made == [], "what was drawn with is given back at once"
        assert not window.actions_.cancel.isEnabled()
        yield lambda: not window.jobs.at_work()
        assert list(tmp_path.iterdir()) == []
        assert window.notices.notice() is None
        opened(window).save.click()
        yield written(window)
        assert window.notices.notice().sentence == "anna.gif saved."
        assert made == []

    run_undrawn([], script)
    with Image.open(path) as picture:
        assert (picture.n_frames, picture.size) == (12, (480, 540))


def test_a_window_is_closed_while_a_turntable_is_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    saved_as(monkeypatch, tmp_path / "anna.webp")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        opened(window, "turntable").save.click()
        yield lambda: window.status._job_name.text() == "Rendering anna.webp…"

    assert run_bodiless([], script) == 0
    assert list(tmp_path.iterdir()) == []


def test_a_picture_shows_what_the_view_shows_on_no_ground(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "anna.png"
    saved_as(monkeypatch, path)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        window.view.viewport.set_view("left")
        for count, bands in enumerate(("", "none")):
            sheet = opened(window, "picture")
            for key, value in {"size": "1000x1125", "ground": "clear", "bands": bands}.items():
                choose(sheet, key, value)
            sheet.save.click()
            yield written(window)
            window.notices.clear()
            path.rename(tmp_path / f"{count}.png")

    run_undrawn([], script)
    worn, bare = (pv.read_texture(tmp_path / f"{count}.png").to_array() for count in range(2))
    assert worn.shape == (1125, 1000, 4)
    assert (worn[..., 3] == 0).mean() > 0.3
    changed = (abs(worn[..., :3].astype(int) - bare[..., :3]).max(axis=2) > 40).mean()
    assert 0.005 < changed < 0.2, "the bands are left out, and nothing else"


def test_a_full_disk_leaves_what_stood_there_and_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    def script(window: MainWindow) -> Script:
        yield settled(window)
        for what in ("body", "lines", "flat", "measures", "turns", "control"):
            sheet = opened(window, what)
            yield told(sheet)
            path = tmp_path / what / f"a.{window.export_controller._choices.kind(what)}"
            path.parent.mkdir()
            path.write_text("what stood there")
            saved_as(monkeypatch, path)
            with monkeypatch.context() as patch:
                patch.setattr(os, "fsync", full)
                sheet.save.click()
                yield written(window)
            notice = window.notices.notice()
            assert (notice.tone, notice.hint) == ("bad", "Choose another folder or free up disk space."), what
            stands = [(each.name, each.read_text()) for each in path.parent.iterdir()]
            assert stands == [(path.name, "what stood there")]
            window.notices.clear()

    run_bodiless([], script)


def test_a_series_does_not_take_the_place_of_another_unasked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    saved_as(monkeypatch, tmp_path / "anna.png")
    (tmp_path / "anna-07.png").write_text("another series")
    asked: list[str] = []
    monkeypatch.setattr(
        app.gui.features.export.controller, "ask", lambda _, question, *__: asked.append(question) or ""
    )

    def script(window: MainWindow) -> Script:
        yield settled(window)
        sheet = opened(window, "turntable")
        choose(sheet, "format", "png")
        sheet.save.click()
        assert asked == ["anna-07.png already exists. Replace it?"]
        assert QApplication.activeModalWidget() is sheet
        assert not any(job.waited for job in window.jobs.at_work())
        sheet.reject()

    run_bodiless([], script)
    assert [each.read_text() for each in tmp_path.iterdir()] == ["another series"]


def test_a_body_is_written_as_it_is_when_the_dialog_closes(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "anna.ply"
    said: list[str] = []

    def script(window: MainWindow) -> Script:
        yield settled(window)

        def place(*_: Any) -> str:
            """Answer once the run that was under way has come to rest behind the dialog."""
            while not window.is_settled():
                QApplication.processEvents()
            return str(path)

        monkeypatch.setattr(app.gui.features.export.controller, "ask_save", place)
        show = window.notices.show_notice
        monkeypatch.setattr(
            window.notices,
            "show_notice",
            lambda tone, *how, **more: said.append(how[0]) or show(tone, *how, **more),
        )
        window.session.commit_line("mid-bust", "Mid-bust", 0.93)
        assert not window.is_settled()
        window.actions_.export.trigger()
        yield written(window)
        stages, points = window.session.frame.stages, window.session.frame.control_points
        away = pv.read(path).points - deform(stages.binding, points)
        assert abs(away).max() < 0.01
        assert said == ["anna.ply saved, in mm, z-up."], "nothing is under way any more"

    run_bodiless([str(mannequin)], script)


def test_two_exports_do_not_share_a_name(
    mannequin: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "anna.obj"
    saved_as(monkeypatch, path)

    def script(window: MainWindow) -> Script:
        yield settled(window)
        desk = window.export_controller
        assert desk._ask_and_write("body", "body")
        assert desk._ask_and_write("control", "control") is None
        assert window.notices.notice().sentence == "anna.obj is still being written."
        yield lambda: not window.jobs.at_work()
        assert len(pv.read(path).points) == len(window.session.frame.stages.body.mesh.vertices)
        assert desk._ask_and_write("control", "control")
        yield lambda: not window.jobs.at_work()
        assert len(pv.read(path).points) == len(window.session.frame.stages.control.mesh.vertices)

    run_bodiless([str(mannequin)], script)
