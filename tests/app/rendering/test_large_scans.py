"""What opening a scan must not do in the window's thread, whatever its size."""

from __future__ import annotations

import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

import core.scan.body
from app.presenters.scan import scan_view
from app.rendering import render_mesh as skin_module
from app.rendering.body_actor import BodyPartActor
from app.rendering.prepare import prepare_scene
from app.rendering.render_mesh import render_mesh
from core.document.design import Design, ScanSource
from core.geometry.mesh import Mesh
from core.pipeline import build as pipeline
from core.progress import Cancelled
from core.scan.body import read_scan
from core.scan.repair import denoise as calm

ROOT = Path(__file__).parents[3]
BALL = pv.Sphere(radius=100.0, theta_resolution=60, phi_resolution=60)


@pytest.fixture
def ball() -> Mesh:
    return Mesh(BALL.points, BALL.regular_faces)


def test_what_a_scene_looks_up_was_worked_out_where_the_skin_was_prepared(ball, scene, monkeypatch):
    render_mesh(ball)  # as the solver's thread does
    monkeypatch.setattr(skin_module, "cKDTree", _refuse)
    monkeypatch.setattr(skin_module, "box_of", _refuse)
    scene.show_body(ball)
    scene.frame_all()
    assert np.allclose(scene.carried_points(ball.vertices[:3]), ball.vertices[:3])


def test_a_body_whose_moving_vertices_are_known_is_parted_once(ball, scene, monkeypatch):
    made = []
    real = BodyPartActor.__init__
    monkeypatch.setattr(BodyPartActor, "__init__", lambda *a: made.append(a[3]) or real(*a))
    upper = np.flatnonzero(ball.vertices[:, 2] > 20.0)
    scene.show_body(ball, upper)
    scene.move_body(upper, ball.vertices[upper] + 1.0, ball.vertex_normals[upper])
    assert made == ["body", "body that moves"]
    assert np.allclose(scene.body.points[upper], ball.vertices[upper] + 1.0)


def test_the_tree_holds_the_vertices_of_the_body_alone(mannequin):
    body = read_scan(mannequin).mesh
    assert len(render_mesh(body).source) > len(body.vertices)  # the rims of its plates are doubled
    assert render_mesh(body).tree.n == len(body.vertices)


def test_the_holes_that_are_listed_were_looked_for_where_the_skin_was_prepared(built, monkeypatch):
    stages = built("mannequin")
    fresh = replace(stages, body=replace(stages.body))
    prepare_scene(fresh)
    monkeypatch.setattr(core.scan.body, "find_holes", _refuse)
    assert scan_view(fresh.design.scan, fresh.body).edits is not None


def test_preparing_a_body_tells_how_far_it_is_and_can_be_stopped(ball):
    heard = []
    render_mesh(Mesh(ball.vertices, ball.faces), lambda _, share: heard.append(share))
    assert len(heard) > 8
    assert heard == sorted(heard)
    for times in range(8):
        with pytest.raises(Cancelled):
            render_mesh(Mesh(ball.vertices, ball.faces), _stop_after(times))


def test_thinning_a_giant_skin_tells_how_far_it_is_and_can_be_stopped(ball, monkeypatch):
    monkeypatch.setattr(calm, "GIANT", 1000)
    heard = []
    rough = ball.moved(ball.vertices + np.random.default_rng(3).normal(0.0, 1.0, ball.vertices.shape))
    calm.denoise(rough, lambda _, share: heard.append(share))
    assert len(heard) > 5
    assert heard == sorted(heard)
    with pytest.raises(Cancelled):
        calm.denoise(rough, _stop_after(3))


def test_each_long_step_of_understanding_a_scan_asks_whether_to_go_on(mannequin):
    heard = []
    read_scan(mannequin, progress=lambda what, share: heard.append((what, share)))
    count = {what: sum(each == what for each, _ in heard) for what, _ in heard}
    assert count["finding up and front"] >= 4
    assert count["closing holes"] >= 2
    heard.clear()
    calm.denoise(read_scan(mannequin).mesh, lambda what, share: heard.append((what, share)))
    assert len(heard) >= 6
    assert [share for _, share in heard] == sorted(share for _, share in heard)


def test_a_skin_without_plates_has_the_normals_of_the_body(ball):
    normals = render_mesh(ball).mesh.vertex_normals
    assert normals is ball.vertex_normals


def test_a_build_that_is_cancelled_stops_while_the_skin_is_calmed(mannequin, monkeypatch):
    fresh = replace(read_scan(mannequin))  # what other tests have read may be calm already
    monkeypatch.setattr(pipeline, "body_of", lambda *_, **__: fresh)
    heard = []

    def hear(what, share):
        heard.append((what, share))
        if [each for each, _ in heard].count(calm.CALMING) == 2:
            raise Cancelled

    with pytest.raises(Cancelled):
        pipeline.build(Design(ScanSource(str(mannequin))), progress=hear)
    shares = [share for _, share in heard]
    assert shares == sorted(shares)


def test_the_window_starts_without_what_only_some_commands_need():
    rare = ("trimesh", "numba", "app.research", "app.cli.commands.picture", "pandas", "IPython")
    rare += ("pyvistaqt",)
    code = (
        f"import sys, app.gui.startup, app.gui.main_window; print(*[n for n in {rare} if n in sys.modules])"
    )
    told = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert told.stdout.split() == []


def _stop_after(times):
    left = iter(range(times))

    def stop(what, share):
        if next(left, None) is None:
            raise Cancelled

    return stop


def _refuse(*_: object) -> None:
    raise AssertionError(f"worked out in {threading.current_thread().name}")
