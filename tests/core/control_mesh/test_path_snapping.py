"""A drawn curve becomes the path of control points that it follows, and says how far it is off that path."""

from itertools import pairwise

import numpy as np
import pytest
from shapes import fitted

from core.control_mesh.fit import ControlMesh
from core.control_mesh.path_snapping import directed_edges, max_deviation, resampled, snap
from core.control_mesh.template import read_template
from core.document.line_notation import mirrored, ready_made_lines
from core.errors import LineError

TEMPLATE = read_template("168")
KNOWN = {
    line.name: line for kind in ("straps", "slings", "rings") for line in ready_made_lines(TEMPLATE)[kind]
}


def control() -> ControlMesh:
    return fitted("mannequin")


def points() -> np.ndarray:
    return control().mesh.vertices


def wavy(path: tuple[int, ...], amplitude: float) -> np.ndarray:
    """The polyline through control points, swaying by so much between and at them [mm]."""
    curve = resampled(points()[list(path)])
    turn = np.linspace(0.0, 9.0, len(curve))[:, None] + np.arange(3) / 3.0
    return curve + amplitude * np.sin(2.0 * np.pi * turn) / np.sqrt(1.5)


@pytest.mark.parametrize("amplitude", [0.0, 6.0])
@pytest.mark.parametrize("name", [*KNOWN, *TEMPLATE.lines])
def test_a_curve_along_a_known_path_gives_that_path(name: str, amplitude: float) -> None:
    line = KNOWN.get(name)
    path, closed = (line.path, line.closed) if line else (control().paths[name], False)
    curve = wavy(tuple(path), amplitude)
    found = snap(control(), curve[:-1] if closed else curve, closed)
    assert (*found.path, *found.path[:1] * closed) == tuple(path)
    assert found.closed == closed
    assert 0.5 * amplitude <= found.deviation <= amplitude + 2.0, (
        "points 4 mm apart cut corners by up to 2 mm"
    )


def test_a_curve_drawn_from_its_other_end_gives_the_same_path_backwards() -> None:
    path = KNOWN["sling left"].points
    assert snap(control(), wavy(path, 4.0)[::-1]).path == path[::-1]


def test_a_path_goes_along_edges() -> None:
    edges = {tuple(edge) for edge in directed_edges(control().mesh.faces).tolist()}
    random = np.random.default_rng(4)
    for _ in range(12):
        corners = points()[random.choice(np.flatnonzero(~control().fixed), 4, replace=False)]
        path = snap(control(), corners + random.normal(0.0, 4.0, corners.shape)).path
        assert all(step in edges for step in pairwise(path))


def test_the_distance_is_the_largest_from_the_curve_to_the_path() -> None:
    corners = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [100.0, 100.0, 0.0]])
    assert max_deviation(np.array([[50.0, 3.0, 4.0], [104.0, -3.0, 0.0]]), corners) == pytest.approx(5.0)
    assert max_deviation(np.array([[100.0, 130.0, 40.0]]), corners) == pytest.approx(50.0)


def test_what_lies_outside_the_control_mesh_is_told_by_the_distance() -> None:
    down = points()[KNOWN["strap left"].points[0]] + np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, -200.0], 20)
    assert snap(control(), down).deviation > 100.0


def test_a_line_that_cannot_move_finds_the_nearest_path_that_can() -> None:
    still = control().paths["under-bust"]
    curve = wavy(tuple(still), 2.0)
    assert not snap(control(), curve).is_movable
    moved = snap(control(), curve, pulling=True)
    assert moved.is_movable
    assert not any(control().fixed[list(step)].all() for step in pairwise(moved.path))
    strap = KNOWN["strap left"].points
    assert snap(control(), points()[list(strap)], pulling=True).path == strap, (
        "what can pull stays where it is"
    )


def test_a_curve_that_is_too_short_is_refused() -> None:
    start = points()[48]
    with pytest.raises(LineError, match="no length"):
        snap(control(), np.stack([start, start]))
    with pytest.raises(LineError, match="too short"):
        snap(control(), np.stack([start, start + np.array([5.0, 0.0, 0.0])]))


def test_a_path_is_mirrored_to_the_other_side() -> None:
    for kind in ready_made_lines(TEMPLATE).values():
        left, right = kind
        assert mirrored(left.points, TEMPLATE) == right.points
        assert mirrored(mirrored(left.points, TEMPLATE), TEMPLATE) == left.points
