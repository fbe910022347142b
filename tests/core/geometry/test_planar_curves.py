"""A body cut along its axes: curves, how far they are apart, apexes, and what is written of them."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.research.sphere import sphere
from core.errors import UserError
from core.export.mesh import write_profile
from core.geometry.mesh import Mesh
from core.geometry.planar_curves import Plane, Slicer, apexes, mirrored, nearest, protrusion
from core.pipeline.build import Stages


def tube(radius: float = 100.0) -> Mesh:
    """An upright tube from z = 0 to 200 mm, open at both ends."""
    turn, z = np.meshgrid(np.arange(180) * np.pi / 90.0, np.arange(0.0, 204.0, 4.0), indexing="ij")
    points = np.stack([radius * np.sin(turn), -radius * np.cos(turn), z], axis=2).reshape(-1, 3)
    a = (np.arange(180)[:, None] * 51 + np.arange(50)).ravel()
    b = (a + 51) % len(points)
    return Mesh(points, np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)]))


def test_a_tube_is_cut_in_a_circle_and_in_two_straight_lines() -> None:
    mesh = tube()
    (circle,) = Slicer(mesh, Plane("z", 90.0)).curves(mesh.vertices)
    assert np.hypot(*circle.places.T) == pytest.approx(100.0, abs=0.02)
    assert np.array_equal(circle.places[0], circle.places[-1])
    assert (circle.normals * circle.places).sum(axis=1) == pytest.approx(100.0, rel=1e-3)  # outward
    front, back = sorted(Slicer(mesh, Plane("x", 60.0)).curves(mesh.vertices), key=lambda c: -c.places[0, 0])
    assert front.places[:, 0] == pytest.approx(80.0, abs=0.05)  # forward is across, to the right
    assert back.places[:, 0] == pytest.approx(-80.0, abs=0.05)
    assert sorted(front.places[[0, -1], 1]) == pytest.approx([0.0, 200.0])
    assert front.normals[:, 0] == pytest.approx(0.8, abs=0.02) or (front.normals[:, 0] > 0.99).all()


def test_flat_places_go_into_space_and_back() -> None:
    for axis, place in (("x", (7.0, -3.0, 5.0)), ("y", (7.0, -3.0, 5.0)), ("z", (7.0, -3.0, 5.0))):
        plane = Plane(axis, place["xyz".index(axis)])
        assert plane.in_space(plane.flat(np.array([place]))) == pytest.approx(np.array([place]))


def test_curves_tell_how_far_skin_stands_out_with_its_sign() -> None:
    before = Slicer(tube(), Plane("z", 90.0))
    rest = before.curves(tube().vertices)
    for radius, gap in ((103.0, 3.0), (96.0, -4.0)):
        foot = nearest(before.curves(tube(radius).vertices), np.array([0.0, -150.0]))
        assert foot is not None
        assert foot.place == pytest.approx([0.0, -radius], abs=0.05)
        found = protrusion(foot, rest)
        assert found is not None
        assert found[0] == pytest.approx([0.0, -100.0], abs=0.1)
        assert found[1] == pytest.approx(gap, abs=0.02)
    assert nearest((), np.zeros(2)) is None
    assert Slicer(tube(), Plane("z", 900.0)).curves(tube().vertices) == ()


def test_apexes_are_the_foremost_places_within_the_box() -> None:
    mesh = sphere(rings=61, spokes=120)  # of radius 100, about the origin
    low, high = np.array([-90.0, -110.0, -50.0]), np.array([90.0, 10.0, 50.0])
    plane = Plane("x", 20.0)
    (apex,) = apexes(plane, Slicer(mesh, plane).curves(mesh.vertices), low, high, 0.0)
    assert apex == pytest.approx([np.sqrt(9600.0), 0.0], abs=1.5)
    level, way = Plane("z", 10.0), np.array([110.0, 0.0, 0.0])
    pair = Mesh(
        np.concatenate([mesh.vertices - way, mesh.vertices + way]),
        np.concatenate([mesh.faces, mesh.faces + len(mesh.vertices)]),
    )
    found = apexes(level, Slicer(pair, level).curves(pair.vertices), low - way, high + way, 0.0)
    assert found[0] == pytest.approx([110.0, -np.sqrt(9900.0)], abs=1.5)  # the subject's left first
    assert found[1] == pytest.approx([-110.0, -np.sqrt(9900.0)], abs=1.5)
    assert apexes(Plane("y", 0.0), Slicer(mesh, Plane("y", 0.0)).curves(mesh.vertices), low, high, 0.0) == []


def test_the_other_side_is_mirrored_about_the_middle() -> None:
    mesh, plane = tube(), Plane("z", 90.0)
    shifted = Slicer(mesh, plane).curves(mesh.vertices + np.array([8.0, 0.0, 0.0]))
    (other,) = mirrored(plane, shifted, 3.0)
    centre = 0.5 * (other.places.min(axis=0) + other.places.max(axis=0))
    assert centre == pytest.approx([-2.0, 0.0], abs=1e-9)  # 8 mm mirrored at 3 mm
    assert ((other.places - centre) * other.normals).sum(axis=1) == pytest.approx(100.0, rel=1e-3)


def test_a_cut_of_the_sample_passes_through_its_bust_point(built: Callable[[str], Stages]) -> None:
    stages = built("mannequin")
    bust = stages.landmarks.position("bust_point_left")
    for axis in "xyz":
        plane = Plane(axis, float(bust["xyz".index(axis)]))
        curves = Slicer(stages.body.mesh, plane).curves(stages.body.mesh.vertices)
        foot = nearest(curves, plane.flat(bust[None])[0])
        assert foot is not None
        assert np.linalg.norm(foot.place - plane.flat(bust[None])[0]) < 0.5


def test_curves_are_written_in_space(tmp_path: Path) -> None:
    plane = Plane("x", 60.0)
    curves = Slicer(tube(), plane).curves(tube().vertices)
    write_profile(tmp_path / "cut.csv", plane, {"before": curves, "after": curves[:1]})
    with open(tmp_path / "cut.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["body", "curve", "x_mm", "y_mm", "z_mm"]
    assert {(row["body"], row["curve"]) for row in rows} == {("before", "1"), ("before", "2"), ("after", "1")}
    assert len(rows) == sum(len(curve.places) for curve in (*curves, curves[0]))
    assert {float(row["x_mm"]) for row in rows} == {60.0}
    written = [[float(row[f"{a}_mm"]) for a in "xyz"] for row in rows if row["body"] == "after"]
    assert np.array(written) == pytest.approx(plane.in_space(curves[0].places), abs=6e-4)
    with pytest.raises(UserError):
        write_profile(tmp_path / "nowhere" / "cut.csv", plane, {})
