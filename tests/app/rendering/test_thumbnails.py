"""Small pictures of how a body may stand, and the curve of a landmark in the view."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from app.rendering.scene import Scene
from app.rendering.thumbnail import option_thumbnails, orientation_options, render_thumbnail
from core.geometry.mesh import Mesh
from core.messages import EMPTY
from core.scan.body import read_scan
from core.scan.orientation.pose import Pose

CLAY = (200, 150, 120)


def box(wide: float, deep: float, high: float) -> Mesh:
    """A box with outward faces."""
    shape = pv.Box((0.0, wide, 0.0, deep, 0.0, high), quads=False)
    return Mesh(np.asarray(shape.points, dtype=np.float64), np.asarray(shape.regular_faces))


def test_a_box_fills_its_part_of_the_picture_and_nothing_else() -> None:
    picture = render_thumbnail(box(100.0, 40.0, 200.0), np.eye(3), (60, 100), CLAY)
    seen = picture[..., 3] > 127
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    assert np.ptp(rows) + 1 == pytest.approx(92, abs=2)
    assert np.ptp(columns) + 1 == pytest.approx(46, abs=2)
    assert seen[rows[0] : rows[-1], columns[0] : columns[-1]].all(), "no pixel of the body stays empty"


def test_the_near_side_is_seen_and_light_comes_from_the_front() -> None:
    front = render_thumbnail(box(100.0, 40.0, 200.0), np.eye(3), (60, 100), CLAY)
    back = render_thumbnail(box(100.0, 40.0, 200.0), np.diag([-1.0, -1.0, 1.0]), (60, 100), CLAY)
    above = render_thumbnail(
        box(100.0, 40.0, 200.0), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), (60, 100), CLAY
    )
    assert np.array_equal(front[..., 3] > 127, back[..., 3] > 127), "a box looks the same from behind"
    assert np.flatnonzero(above[..., 3].any(axis=1)).size < 40, "from above it is low"


def test_four_ways_are_offered_as_the_scan_would_be_told_them() -> None:
    turn = np.eye(4)
    turn[:3, :3] = 10.0 * np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    pose = Pose("cm", "+y", "+x", turn, False, EMPTY, 0.1)
    offered = orientation_options(pose)
    assert {way.up for way in offered} == {"+y"}
    fronts = [way.front for way in offered]
    assert fronts[0] == "+x"
    assert fronts[3] == "-x"
    assert set(fronts[1:3]) == {"+z", "-z"}
    for way in offered:
        file_to_body = way.rotation @ (turn[:3, :3] / 10.0)
        assert np.linalg.det(file_to_body) == pytest.approx(1.0)
        assert file_to_body[2] == pytest.approx([0.0, 1.0, 0.0])


def test_a_way_askew_is_told_by_its_numbers() -> None:
    c, s = np.cos(0.3), np.sin(0.3)
    turn = np.eye(4)
    turn[:3, :3] = [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]
    way = orientation_options(Pose("mm", "+z", "-y", turn, False, EMPTY, 0.1))[0]
    assert [float(x) for x in way.up.split(",")] == pytest.approx([0.0, s, c], abs=1e-4)
    assert way.axes == ("+z", "-y")


def test_the_picture_of_a_body_has_its_front_first(mannequin: Path) -> None:
    body = read_scan(mannequin)
    painted = option_thumbnails(replace(body, pose=replace(body.pose, is_certain=False)), (60, 80), CLAY)
    assert len(painted) == 4
    assert painted[0][0].axes == (body.pose.up, body.pose.front)
    for (_, picture), (_, other) in combinations(painted, 2):
        assert (picture[..., 3] > 127).any()
        assert not np.array_equal(picture, other), "each way looks its own"
    assert all(picture.shape == (80, 60, 4) for _, picture in painted)


def test_a_curve_is_drawn_and_taken_away() -> None:
    plotter = pv.Plotter(off_screen=True, window_size=[200, 200])
    scene = Scene(plotter)
    scene.show_body(box(100.0, 40.0, 200.0))
    curve = np.array([[50.0, 0.0, 20.0], [50.0, 0.0, 100.0], [50.0, 0.0, 100.0], [50.0, 0.0, 180.0]])
    scene.show_trace(curve)
    assert "trace" in plotter.actors
    scene.set_dark(True)
    scene.show_trace(curve[:1])
    assert "trace" not in plotter.actors
    scene.show_trace(np.empty((0, 3)))
    plotter.close()
