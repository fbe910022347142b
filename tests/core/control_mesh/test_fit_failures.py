"""What the user is told when a control mesh cannot be fitted, or only with a makeshift."""

import numpy as np
import pytest
from fit_bodies import analytic_body, analytic_landmarks, body_of, hanging, landmarks_at, sample_of

from core.control_mesh.fit import fit_control_mesh
from core.control_mesh.template import TEMPLATES, read_template
from core.control_mesh.validation import agreement, bends, corner_angles
from core.deformation.blend_region import blend_weights
from core.deformation.tffd import bind, deform
from core.errors import FitError
from core.geometry.mesh import Mesh
from core.mechanics.exact_solution import solve_exact
from core.mechanics.model import constrained_model


@pytest.fixture(scope="module", params=TEMPLATES)
def template(request):
    return read_template(request.param)


def without(mesh, place, radius):
    """The mesh with a round hole."""
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    return Mesh(mesh.vertices, mesh.faces[np.linalg.norm(middle - place, axis=1) > radius])


def test_small_hole_is_bridged_and_said(template):
    body, places = sample_of("mannequin")
    whole = fit_control_mesh(template, body, landmarks_at(places))
    point = template.point(0, template.half - 1)
    holed = body_of(without(body.mesh, whole.mesh.vertices[point], 9.0))
    control = fit_control_mesh(template, holed, landmarks_at(places))
    assert any("holes at 1 control points" in str(warning) for warning in control.warnings)
    neighbours = control.mesh.vertices[[point - 1, point + 1]]
    np.testing.assert_allclose(control.mesh.vertices[point], neighbours.mean(axis=0))
    others = np.arange(len(template.row)) != point
    np.testing.assert_allclose(control.mesh.vertices[others], whole.mesh.vertices[others], atol=1e-6)


def test_hole_in_a_fold_is_said(template):
    body, places = sample_of("mannequin")
    whole = fit_control_mesh(template, body, landmarks_at(places))
    below_fold = whole.mesh.vertices[template.point(1, template.bust_column)] - (0.0, 0.0, 20.0)
    holed = body_of(without(body.mesh, below_fold, 12.0))
    control = fit_control_mesh(template, holed, landmarks_at(places))
    assert any("The inframammary fold of the left breast" in str(warning) for warning in control.warnings)
    assert not any("right breast" in str(warning) for warning in control.warnings)


def test_large_hole_is_refused(template):
    body, places = sample_of("mannequin")
    holed = body_of(without(body.mesh, places["bust_point_left"], 110.0))
    with pytest.raises(FitError, match=r"no surface at \d+ of"):
        fit_control_mesh(template, holed, landmarks_at(places))


def cut_off(mesh, low, high):
    z = mesh.vertices[mesh.faces][:, :, 2]
    return body_of(Mesh(mesh.vertices, mesh.faces[(z.min(axis=1) > low) & (z.max(axis=1) < high)]))


def test_low_neck_lowers_the_upper_rows(template):
    body, places = sample_of("mannequin")
    top = places["bust_point_left"][2] + 110.0
    control = fit_control_mesh(template, cut_off(body.mesh, 0.0, top), landmarks_at(places))
    assert control.mesh.vertices[:, 2].max() < top
    assert corner_angles(control.mesh).min() > 8.0


@pytest.mark.parametrize(("low", "high"), [(290.0, 999.0), (270.0, 999.0), (0.0, 400.0), (255.0, 420.0)])
def test_collar_keeps_to_what_the_scan_shows(template, low, high):
    body, places = sample_of("mannequin")
    control = fit_control_mesh(template, cut_off(body.mesh, low, high), landmarks_at(places))
    whole = fit_control_mesh(template, body, landmarks_at(places))
    points = control.mesh.vertices
    assert points[:, 2].max() < high
    assert control.quality.smallest_angle > 12.0
    assert control.quality.crossings == 0
    bust = list(control.bust_points)
    np.testing.assert_allclose(points[bust], whole.mesh.vertices[bust], atol=0.3)


@pytest.mark.parametrize(
    ("low", "high", "why"),
    [(320.0, 999.0, "ends at the breasts"), (0.0, 370.0, r"ends \d+ mm above the bust points")],
)
def test_scan_that_shows_too_little_is_refused(template, low, high, why):
    body, places = sample_of("mannequin")
    with pytest.raises(FitError, match=why):
        fit_control_mesh(template, cut_off(body.mesh, low, high), landmarks_at(places))


def test_bust_point_on_the_wrong_side_is_refused(template):
    body, places = sample_of("mannequin")
    wrong = places | {"bust_point_left": places["bust_point_right"]}
    with pytest.raises(FitError, match="left bust point"):
        fit_control_mesh(template, body, landmarks_at(wrong))


@pytest.mark.parametrize("part", [0.2, 0.8, float("nan")])
def test_line_height_out_of_range_is_refused(template, part):
    body, places = sample_of("mannequin")
    with pytest.raises(FitError, match="line height"):
        fit_control_mesh(template, body, landmarks_at(places), part)


@pytest.mark.parametrize("sag", [1.3, 2.0])
def test_breast_that_hangs_too_low_is_never_folded_over(template, sag):
    body, landmarks = hanging(sag)
    control = fit_control_mesh(template, body, landmarks)
    assert control.quality.crossings == 0
    assert control.quality.largest_bend < 130.0
    assert corner_angles(control.mesh).min() > 12.0
    bridged = agreement(control.mesh, body.mesh).min() <= 0.3
    assert bridged == any(
        "bridges part of an inframammary fold" in str(warning) for warning in control.warnings
    )
    assert control.warnings


@pytest.mark.parametrize("sag", [1.5, 2.0])
def test_body_reshapes_sanely_where_the_control_mesh_bridges_a_fold(template, sag):
    body, landmarks = hanging(sag)
    control = fit_control_mesh(template, body, landmarks)
    assert agreement(control.mesh, body.mesh).min() < 0.0  # some triangles do face backward
    fade = blend_weights(body.mesh, control)
    assert fade.rule == "flood"
    binding = bind(body.mesh, control.mesh, fade.fade, fixed=control.fixed)
    model = constrained_model(control, worn=frozenset(["mid-bust"]))
    ratios = tuple(0.97 if line.name == "mid-bust" else 1.0 for line in model.lines)
    answer = solve_exact(model, ratios)
    shaped = body.mesh.moved(deform(binding, model.tensegric.expand(answer.state.moved)))
    assert answer.is_converged
    moved = np.linalg.norm(shaped.vertices - body.mesh.vertices, axis=1)
    assert 1.0 < moved.max() < 4.0
    assert moved[fade.fade == 0.0].max() == 0.0
    assert (bends(shaped)[2] - bends(body.mesh)[2]).max() < 6.0  # no spike
    assert (shaped.face_normals * body.mesh.face_normals).sum(axis=1).min() > 0.95
    apex = body.mesh.vertices.mean(axis=0)
    grown = shaped.enclosed_volume(apex) - body.mesh.enclosed_volume(apex)
    assert abs(grown) < 0.005 * control.mesh.enclosed_volume(
        control.mesh.vertices[control.border_points].mean(axis=0)
    )


def test_breast_that_cannot_be_followed_is_refused(template):
    with pytest.raises(FitError, match="Folded triangles"):
        fit_control_mesh(template, *hanging(5.0))


def test_column_that_spoils_the_mesh_gives_up_its_fold_and_says_so(template):
    body, landmarks = hanging(sag=1.2)
    control = fit_control_mesh(template, body, landmarks)
    assert any("is only partly detectable" in str(warning) for warning in control.warnings)
    assert agreement(control.mesh, body.mesh).min() > 0.3
    assert corner_angles(control.mesh).min() > 8.0


def test_body_without_folds_says_so(template):
    control = fit_control_mesh(template, body_of(analytic_body(bump=0.0)), analytic_landmarks())
    assert len(control.warnings) == 2
    assert all("is only partly detectable" in str(warning) for warning in control.warnings)
