"""Maps of the body: values that can be worked out by hand, and promises on the samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from shapes import mid_bust, run, tent_model, torso

from app.research.sphere import sphere
from core.geometry.mesh import Mesh
from core.geometry.mirror_plane import MIRROR, SideComparison, mirror_plane
from core.mechanics.iteration import LineTargets
from core.mechanics.model import constrained_model
from core.pipeline.build import Stages
from core.pipeline.surface_fields import StrainOnBody, line_forces, normal_displacement, strains

BALL = sphere(rings=31, spokes=64)


def test_a_ball_that_swells_by_3_mm_has_moved_by_3_mm_everywhere() -> None:
    normals = BALL.vertices / 100.0
    values = normal_displacement(BALL.vertices, normals, 1.03 * BALL.vertices)
    assert values == pytest.approx(3.0)
    turned = BALL.vertices @ np.array([[0.999, -0.0447, 0.0], [0.0447, 0.999, 0.0], [0.0, 0.0, 1.0]])
    assert (
        np.abs(normal_displacement(BALL.vertices, normals, turned)).max() < 0.11
    )  # along the skin: no way outward


def test_a_triangle_has_the_strains_that_it_was_given() -> None:
    rest = Mesh([[0.0, 0.0, 5.0], [30.0, 0.0, 5.0], [10.0, 20.0, 5.0]], [[0, 1, 2]])
    turn = np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]])
    stretched = rest.vertices * [1.10, 0.95, 1.0]
    assert strains(rest, stretched @ turn.T + 7.0) == pytest.approx(np.array([[-0.05, 0.10]]))
    sheared = rest.vertices @ np.array([[1.0, 0.0, 0.0], [0.2, 1.0, 0.0], [0.0, 0.0, 1.0]])
    exact = np.linalg.svd([[1.0, 0.2], [0.0, 1.0]], compute_uv=False)
    assert strains(rest, sheared) == pytest.approx(exact[None, ::-1] - 1.0)
    assert strains(rest, rest.vertices) == pytest.approx(0.0, abs=1e-7)


def test_strain_is_carried_to_the_body_and_fades_with_it() -> None:
    control = torso()
    middles = control.mesh.vertices[control.mesh.faces].mean(axis=1) + 3.0 * control.mesh.face_normals
    fade = np.where(np.arange(len(middles)) % 2, 0.5, 1.0)
    carried = StrainOnBody(control, middles, fade)
    assert carried(1.08 * control.mesh.vertices) == pytest.approx(0.08 * fade)
    local = control.mesh.vertices.copy()
    local[control.bust_points[0]] += [0.0, -10.0, 0.0]
    values = carried(local)
    assert middles[values.argmax()] == pytest.approx(local[control.bust_points[0]], abs=45.0)
    assert (values >= 0.0).all()


def test_pulls_are_shares_of_the_strongest_segment() -> None:
    model = tent_model()
    points = model.tensegric.rest.copy()
    assert line_forces(model, points, (1.0,) * len(model.lines)) == {
        line.name: pytest.approx(0.0) for line in model.lines if line.constrains
    }
    found = line_forces(model, points, (0.9,) * len(model.lines))
    by_hand = np.concatenate([0.1 * model.segments.stiffness * model.segments.rest_lengths])
    assert np.concatenate(list(found.values())) == pytest.approx(by_hand / by_hand.max())


def test_held_lines_have_no_pull_of_a_spring() -> None:
    model = constrained_model(torso(), mechanics=replace(tent_model().options, line_hold="held"))
    assert line_forces(model, model.tensegric.rest, mid_bust(model, 0.95)) == {}


def test_the_pull_on_a_short_line_is_even_on_both_sides() -> None:
    model = constrained_model(torso(), worn=["mid-bust"])
    state, _ = run(model, LineTargets(mid_bust(model, 0.93), "adaptive", 0.0), 150)
    (share,) = line_forces(model, model.tensegric.expand(state.moved), mid_bust(model, 0.93)).values()
    assert share.max() == pytest.approx(1.0)
    assert share == pytest.approx(share[::-1], abs=5e-3)  # turns go from one side to the other
    assert (share > 0.0).all()


# -- left and right


def two_halves(dent: float = 0.0) -> Mesh:
    """A ball that is its own mirror image at x = 12 mm, but for a dent in its left side."""
    points = BALL.vertices + np.array([12.0, 0.0, 0.0])
    side = np.exp(-(((points - [12.0 + 60.0, -80.0, 0.0]) / 25.0) ** 2).sum(axis=1))
    return Mesh(points - dent * side[:, None] * BALL.vertices / 100.0, BALL.faces)


def test_a_mirrored_body_is_even_everywhere() -> None:
    mesh = two_halves()
    every = np.ones(len(mesh.vertices), dtype=bool)
    assert mirror_plane(mesh, every, 9.0) == pytest.approx(12.0, abs=1e-6)
    sides = SideComparison(mesh, np.arange(len(mesh.vertices)), 12.0)
    assert sides.protrusion_difference(mesh.vertices, mesh.vertex_normals) == pytest.approx(0.0, abs=1e-9)


def test_a_dent_in_one_side_shows_on_both_with_opposite_signs() -> None:
    mesh = two_halves(4.0)
    left, right = (
        int(np.abs(mesh.vertices - [12.0 + x, -80.0, 0.0]).sum(axis=1).argmin()) for x in (57.5, -60.0)
    )
    sides = SideComparison(mesh, np.array([left]), 12.0)
    off = sides.protrusion_difference(mesh.vertices, mesh.vertex_normals)
    assert off[left] == pytest.approx(-4.0, abs=0.35)
    assert off[right] == pytest.approx(4.0, abs=0.35)
    assert {left, right} <= set(sides.rows.tolist()) or left in sides.rows
    assert np.abs(off[mesh.vertices[:, 1] > 20.0]).max() < 0.05


def test_the_middle_does_not_heed_the_breasts_nor_how_an_arm_hangs() -> None:
    mesh = two_halves(20.0)
    still = mesh.vertices[:, 1] > -40.0
    assert mirror_plane(mesh, still, 5.0) == pytest.approx(12.0, abs=0.05)


def test_what_has_no_counterpart_has_no_answer() -> None:
    mesh = two_halves()
    kept = (mesh.vertices[mesh.faces][..., 0] < 60.0).all(axis=1)
    used, faces = np.unique(mesh.faces[kept], return_inverse=True)
    cut = Mesh(mesh.vertices[used], faces.reshape(-1, 3))
    off = SideComparison(cut, np.empty(0, dtype=np.int64), 12.0).protrusion_difference(
        cut.vertices, cut.vertex_normals
    )
    assert np.isnan(off[cut.vertices[:, 0].argmin()])
    assert off[cut.vertices[:, 1].argmin()] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("name", "uneven"), [("mannequin", False), ("person", True)])
def test_the_samples_differ_as_they_were_made_to(
    name: str, uneven: bool, built: Callable[[str], Stages]
) -> None:
    stages = built(name)
    body, moving = stages.body.mesh, stages.moving
    middle = mirror_plane(body, stages.patch.fade == 0.0, moving.middle)
    assert middle == pytest.approx(0.0, abs=0.3)
    sides = SideComparison(body, moving.vertices, middle)
    off = sides.protrusion_difference(body.vertices, body.vertex_normals)[moving.vertices]
    assert (np.nanmax(np.abs(off)) > 5.0) == uneven
    flipped = Mesh(body.vertices * MIRROR, body.faces[:, ::-1])
    other = SideComparison(flipped, moving.vertices, -middle).protrusion_difference(
        flipped.vertices, flipped.vertex_normals
    )
    assert other[moving.vertices] == pytest.approx(off, abs=1e-6, nan_ok=True)
