"""Torn, coarse and degenerate skins: tables stay small, nothing but a refusal comes out."""

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from core.errors import LandmarkError, ScanError
from core.geometry.level_outlines import Pieces, radii, ring
from core.geometry.mesh import Mesh
from core.geometry.plane_sections import hull_corners, hull_perimeter, hull_slopes
from core.landmarks.anchor import ABOVE, find_anchor
from core.landmarks.breast_profiles import LONGEST, profiles
from core.landmarks.chest import Pole, find_poles
from core.landmarks.nipple import breast_patch
from core.landmarks.torso.arm_removal import necks
from core.landmarks.torso.contour_classification import GAP, _linked, limbs
from core.landmarks.torso.cross_sections import Level, scan_torso
from core.measurements.girths import skin_ring, tape_ring
from core.scan.body import body_of, read_scan
from core.scan.reconstruction.isosurface import distinct
from core.scan.repair.holes import MOST, find_holes, frame_of

PERSON = Path(__file__).parents[3] / "resources" / "samples" / "person.ply"


def megabytes(work):
    """Do some work; return the most memory that it takes at a time [MB]."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1] / 1e6
    finally:
        tracemalloc.stop()


def shreds(count, seed=0, size=300.0):
    """Return short open segments strewn over a level, and the edges that their ends lie on."""
    chance = np.random.default_rng(seed)
    start = np.column_stack([chance.uniform(-size, size, (count, 2)), np.zeros(count)])
    return np.stack([start, start + np.array([3.0, 0.0, 0.0])], axis=1), np.arange(2 * count).reshape(-1, 2)


def test_an_outline_of_many_metres_takes_no_table_of_all_pairs():
    segments, ids = shreds(4000)
    rows, _ = ring(segments, ids)
    assert 0 < len(rows) <= 200
    closed = segments[:, 0, :2]
    wound = np.concatenate([closed, closed[:1]])
    assert megabytes(lambda: necks(wound, np.zeros(2))) < 64.0


def test_the_nearest_ends_are_joined_first():
    along = np.array([[0.0, 3.0], [40.0, 43.0], [13.0, 5.0], [14.0, 30.0]])  # the third runs backwards
    segments = np.zeros((4, 2, 3))
    segments[:, :, 0] = along
    rows, starts = ring(segments, np.arange(8).reshape(4, 2))
    assert rows.tolist() == [0, 2, 3, 1]
    assert starts[:, 0].tolist() == [0.0, 5.0, 14.0, 40.0]


def test_ranges_are_linked_over_small_gaps_alone():
    chance = np.random.default_rng(1)
    for _ in range(200):
        low = chance.uniform(-500.0, 500.0, 12)
        high = low + chance.uniform(0.0, 60.0, 12)
        near, before = np.zeros(12, dtype=bool), None
        reach = [-30.0, 30.0]
        while before is None or (near != before).any():
            before = near
            near = (low <= reach[1] + GAP) & (high >= reach[0] - GAP)
            reach = [low[near].min(initial=reach[0]), high[near].max(initial=reach[1])]
        assert (_linked(low, high, -30.0, 30.0) == near).all()


def test_many_loose_pieces_on_a_level_make_no_table_of_all_pairs():
    count = 3000
    spot = np.random.default_rng(2).uniform(-200.0, 200.0, (2 * count, 2))
    pieces = Pieces(spot, spot + 2.0, np.repeat([0, 1], count), np.ones(2 * count, dtype=bool))
    heights = np.array([0.0, 5.0])
    assert megabytes(lambda: limbs(pieces, np.array([0, count]), heights, 0.0)) < 64.0


def test_the_frame_of_a_long_border_takes_little():
    turn = np.linspace(0.0, 2.0 * np.pi, 6000, endpoint=False)
    border = np.column_stack([90.0 * np.cos(turn), 40.0 * np.sin(turn), 0.0 * turn])
    assert megabytes(lambda: frame_of(border)) < 16.0
    assert frame_of(border)[1] == pytest.approx([180.0, 80.0, 0.0], abs=1e-6)
    assert np.isfinite(frame_of(border[:2])[0]).all()


def test_a_profile_through_a_torn_skin_ends():
    count = 4000
    chance = np.random.default_rng(3)
    middle = np.column_stack([np.zeros(count), chance.uniform(-20.0, 20.0, count), np.zeros(count)])
    middle[:, 2] = np.sort(chance.uniform(-300.0, 5.0, count))[::-1]
    corners = middle[:, None] + [[-60.0, 0.0, 0.0], [60.0, 0.0, 0.0], [60.0, 9.0, 0.0]]
    torn = Mesh(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    bundle = profiles(torn, np.zeros(3), -300.0)
    assert max(len(profile.points) for profile in bundle) <= LONGEST


def test_what_lies_on_a_line_has_no_convex_outline():
    line = np.column_stack([np.arange(9.0), 2.0 * np.arange(9.0), np.zeros(9)])
    for places in (line, line[:2], line[:0], np.repeat(line[:1], 6, axis=0)):
        assert len(hull_corners(places[:, :2])) == 0
        assert hull_perimeter(places) == 0.0
        assert not hull_slopes(places).any()
        level = Level(0.0, np.stack([places, places], axis=1))
        assert len(tape_ring(level)) == len(skin_ring(level)) == 0
        assert level.longest_straight == 0.0


def test_points_on_the_border_of_the_search_for_poles_are_inside():
    trunk = scan_torso(read_scan(PERSON).smoothed)
    anchor = find_anchor(trunk)
    down = anchor.z + 60.0  # so small heights have more digits than their distance from the anchor
    trunk = replace(trunk, z=trunk.z - down, samples=trunk.samples - [0.0, 0.0, down])
    levels = -60.0 - np.arange(100) / 97.0
    edges = np.nextafter(levels + ABOVE, -np.inf)
    rounded = np.flatnonzero(edges - levels >= ABOVE)[0]
    anchor, z = replace(anchor, z=float(levels[rounded])), trunk.samples[:, 2].copy()
    z[np.abs(z - edges[rounded]) < 2.0] = edges[rounded]
    trunk = replace(trunk, samples=np.column_stack([trunk.samples[:, :2], z]))
    left, right = find_poles(trunk, anchor)
    assert left.position[0] > right.position[0]


def test_a_breast_of_a_few_points_is_refused():
    corners = np.array([[0.0, -100.0, 0.0], [90.0, -100.0, 0.0], [0.0, -100.0, 90.0]])
    place = np.array([0.0, -100.0, 0.0])
    for vertices in (corners, 1000.0 + corners):
        with pytest.raises(LandmarkError, match="surface of a breast is missing"):
            breast_patch(Mesh(vertices, np.array([[0, 1, 2]])), Pole(place, 20.0, True, place, 1.0))


@pytest.mark.parametrize("shape", ["0 0 0", "0 0 {k}", "{k}e-200 {j}e-200 0"])
def test_triangles_without_an_area_are_refused(shape):
    corners = "".join(f"v {shape.format(k=k, j=k % 7)}\n" for k in range(60))
    faces = "".join(f"f {k} {k + 1} {k + 2}\n" for k in range(1, 59))
    for told in ({}, {"unit": "mm", "up": "+z", "front": "-y"}):
        with pytest.raises(ScanError):
            body_of("flat.obj", (corners + faces).encode(), **told)


def test_equal_points_are_one():
    chance = np.random.default_rng(5)
    points = chance.integers(0, 6, (500, 3)).astype(float) - 3.0
    points[::7] *= -1.0  # some zeros with a sign
    found = distinct(points)
    assert len(found) == len(np.unique(points, axis=0)) == len(np.unique(found, axis=0))
    assert distinct(found) is found


def test_loose_triangles_are_no_holes_and_the_longest_holes_are_told():
    spots = 10.0 * np.arange(1200)[:, None, None] * np.array([1.0, 0.0, 0.0])
    loose = Mesh(
        (spots + np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [0.0, 0.0, 3.0]])).reshape(-1, 3),
        np.arange(3600).reshape(-1, 3),
    )
    assert find_holes(loose) == ()
    squares = spots + np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 0.0, 3.0], [0.0, 0.0, 3.0]])
    squares[7] *= 1.0 + np.array([0.0, 0.0, 1.0])
    halves = (4 * np.arange(1200)[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])).reshape(-1, 3)
    holes = find_holes(Mesh(squares.reshape(-1, 3), halves))
    assert len(holes) == MOST
    assert max(holes[0].length, holes[0].width) == pytest.approx(6.0)


def test_triangles_right_through_the_body_are_refused():
    count = 30_000
    foot = np.random.default_rng(6).uniform(-150.0, 150.0, (count, 3)) * [1.0, 1.0, 0.0]
    rise = np.array([[0.0, 0.0, 0.0], [0.3, 0.2, 0.0], [0.0, 0.0, 600.0]])
    needles = Mesh((foot[:, None] + rise).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    with pytest.raises(LandmarkError, match="cross the inside of the body"):
        scan_torso(needles)


def test_the_reach_of_many_segments_is_worked_out_in_parts(monkeypatch):
    chance = np.random.default_rng(7)
    segments = np.concatenate([chance.uniform(-200.0, 200.0, (500, 2, 2)), np.zeros((500, 2, 1))], axis=2)
    level, centre = chance.integers(0, 3, 500), np.zeros((3, 2))
    whole = radii(segments, level, centre)
    monkeypatch.setattr("core.geometry.level_outlines.BLOCK", 37)
    assert np.array_equal(radii(segments, level, centre), whole, equal_nan=True)
