"""The calmed skin: noise is told as what it is, smoothed without shrinking, and giants are thinned."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from shapes import SAMPLES

from core.geometry.mesh import Mesh
from core.scan.body import read_scan
from core.scan.repair.denoise import GIANT, decimate, denoise, estimate_noise
from core.scan.repair.editable_mesh import EditableMesh


@pytest.fixture(scope="module")
def person():
    return read_scan(SAMPLES / "person.ply").mesh


@pytest.fixture(scope="module")
def giant():
    ball = trimesh.creation.icosphere(subdivisions=7, radius=150.0)
    return Mesh(ball.vertices, ball.faces)


def rough(mesh, noise, seed=0):
    return mesh.moved(mesh.vertices + np.random.default_rng(seed).normal(0.0, noise, mesh.vertices.shape))


def off(mesh, sound):
    """How far vertices lie over those of the sound skin they came from."""
    return np.einsum("ij,ij->i", mesh.vertices - sound.vertices, sound.vertex_normals)


@pytest.mark.parametrize("noise", [0.3, 1.0, 2.0])
def test_noise_is_told_on_fine_and_on_coarse_triangles(person, noise):
    for mesh in (person, decimate(person, 12.0), decimate(person, 20.0)):
        assert estimate_noise(rough(mesh, noise)) == pytest.approx(noise, abs=0.12 + 0.08 * noise)


@pytest.mark.parametrize("cell", [0.0, 10.0, 14.0, 20.0])
def test_curvature_on_coarse_triangles_is_not_taken_for_noise(person, cell):
    mesh = decimate(person, cell) if cell else person
    assert estimate_noise(mesh) < 0.1
    assert denoise(mesh) is mesh


def test_noise_is_smoothed_and_the_body_does_not_shrink(person):
    for noise in (0.6, 1.2):
        noisy = rough(person, noise)
        calm = denoise(noisy)
        assert off(calm, person).std() < 0.5 * noise
        assert abs(off(calm, person).mean()) < 0.03


def test_a_turn_commutes_with_calming(person):
    noisy = rough(person, 0.8)
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    calm, turned = denoise(noisy), denoise(noisy.moved(noisy.vertices @ turn.T + 900.0))
    assert np.allclose((turned.vertices - 900.0) @ turn, calm.vertices, atol=1e-8)


@pytest.mark.parametrize("noise", [0.0, 0.4])
def test_a_giant_is_thinned_on_its_surface_and_stays_closed(giant, noise):
    assert len(giant.faces) > GIANT
    calm = denoise(rough(giant, noise))
    assert len(calm.faces) < 0.6 * len(giant.faces)
    radius = np.linalg.norm(calm.vertices, axis=1)
    assert abs(radius.mean() - 150.0) < 0.05
    assert radius.std() < 0.02 + 0.3 * noise
    sides = EditableMesh(calm.vertices, calm.faces).sides
    assert (sides.count != 2).mean() < 0.001


def test_thinning_keeps_sheets_apart_that_lie_on_each_other():
    sheet = trimesh.creation.box((100, 100, 1)).subdivide_to_size(1.0)
    thin = decimate(Mesh(sheet.vertices, sheet.faces), 3.5)
    inner = np.abs(thin.vertices[:, :2]).max(axis=1) < 45.0
    assert np.allclose(np.abs(thin.vertices[inner, 2]), 0.5)
    assert {-1.0, 1.0} == set(np.sign(thin.vertices[inner, 2]))
