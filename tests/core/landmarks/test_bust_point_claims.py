"""Claims about the bust that chance or damage puts to the test: flat bodies, noise, holes near a fold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_array, diags_array
from scipy.sparse.linalg import spsolve

from core.errors import LandmarkError
from core.landmarks.anchor import find_anchor
from core.landmarks.breast_profiles import OFFSETS, OWN, Profile
from core.landmarks.inframammary_fold import trace
from core.landmarks.lower_breast import CREASE
from core.landmarks.torso.cross_sections import scan_torso
from core.landmarks.types import CERTAIN
from core.landmarks.warnings import landmark_warnings
from tests.core.landmarks.test_landmarks import SIDES, found, landmarks_of, part, sample


def test_a_body_that_is_too_flat_is_refused_for_that():
    mesh = sample("mannequin")
    with pytest.raises(LandmarkError, match="trunk depth is implausible"):
        landmarks_of(mesh.moved(mesh.vertices * [1.0, 0.5, 1.0]))


def test_smooth_breasts_that_are_alike_point_alike_whatever_the_noise():
    mesh = sample("mannequin")
    rough = np.random.default_rng(1).normal(0.0, 0.8, (len(mesh.vertices), 1))
    noisy = landmarks_of(mesh.moved(mesh.vertices + mesh.vertex_normals * rough))
    left, right = (noisy.position(f"bust_point_{side}") for side in SIDES)
    assert left * [-1.0, 1.0, 1.0] == pytest.approx(right, abs=0.4)  # one by one they are 1.5 mm apart


def test_a_hole_below_a_fold_that_shows_leaves_it_in_place_and_less_sure():
    mesh, whole = sample("mannequin"), found("mannequin").points["fold_left"]
    below = (mesh.vertices - whole.position + [0.0, 0.0, 45.0]) * [1.0, 0.3, 1.0]
    centre = mesh.vertices[np.argmin(np.linalg.norm(below, axis=1))]
    away = np.linalg.norm(mesh.vertices[mesh.faces].mean(axis=1) - centre, axis=1)
    fold = landmarks_of(part(mesh, away > 12.0)).points["fold_left"]
    assert fold.rule == CREASE
    assert np.linalg.norm(fold.position - whole.position) < 1.0
    assert 0.0 < fold.confidence < 0.6 * whole.confidence


def test_a_fold_keeps_near_its_course_where_noise_is_sharper():
    arc = np.arange(120.0)
    crease = 0.03 * np.exp(-0.5 * ((arc - 50.0) / 4.0) ** 2)
    spike = 0.14 * np.exp(-0.5 * (arc - 56.0) ** 2)
    bundle = [
        Profile(
            np.stack([0.0 * arc + x, 0.0 * arc, 50.0 - arc], axis=1),
            crease + spike * (k == OWN),
            arc > -1.0,
            True,
        )
        for k, x in enumerate(OFFSETS)
    ]
    run = trace(bundle, 0.0)
    assert run.curve[run.own, 2] == pytest.approx(0.0, abs=3.0)


def test_a_breast_that_was_taken_away_wholly_leaves_the_other_where_it_is():
    mesh, whole = sample("person"), found("person")
    v, pole = mesh.vertices, whole.position("bust_point_right")
    ellipse = ((v - pole - [0.0, 0.0, 30.0]) / [95.0, 200.0, 130.0]) ** 2
    inner = (ellipse.sum(axis=1) < 1.0) & (v[:, 1] < pole[1] + 130.0) & (v[:, 0] < -12.0)
    weights = vertex_neighbours(mesh)
    flat = v.copy()
    flat[inner] = spsolve(weights[inner][:, inner].tocsc(), -(weights[inner][:, ~inner] @ v[~inner]))
    seen = landmarks_of(mesh.moved(flat))  # a membrane over the chest: only ribs are left to stand out
    (said,) = (each.message for each in landmark_warnings(seen) if "right" in str(each.message))
    assert str(said).startswith("No breast protrusion on the right side")
    assert np.linalg.norm(seen.position("bust_point_left") - whole.position("bust_point_left")) < 2.0
    assert seen.points["bust_point_left"].confidence > CERTAIN
    assert seen.points["bust_point_right"].confidence < 0.2
    assert seen.bust_level == pytest.approx(whole.position("bust_point_left")[2], abs=2.0)


def test_a_chin_over_the_chest_is_no_bust():
    trunk, above = scan_torso(sample("mannequin")), found("mannequin").bust_level + 60.0
    forward = [200.0 * np.clip((z - above) / 60.0, 0.0, 1.0) for z in (trunk.samples[:, 2], trunk.z)]
    samples = trunk.samples - np.outer(forward[0], [0.0, 1.0, 0.0])
    stooping = replace(trunk, samples=samples, front=trunk.front - forward[1])
    assert find_anchor(stooping).z == find_anchor(trunk).z  # the middle comes forward too


def vertex_neighbours(mesh):
    """The graph Laplacian of a mesh, shape (n, n)."""
    ends = np.concatenate([mesh.faces[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
    ones = np.ones(2 * len(ends))
    rows, columns = np.concatenate([ends.T, ends.T[::-1]], axis=1)
    graph = csr_array((ones, (rows, columns)), shape=(len(mesh.vertices),) * 2)
    return diags_array(graph.sum(axis=1)).tocsr() - graph
