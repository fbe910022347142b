"""The solid of soft tissue: what must hold of its mesh, of its elements and of its answers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import Delaunay

from core.geometry.mesh import Mesh
from core.tissue.skin_patch import SkinPatch, coarse_mesh
from core.tissue.solid import _POINTS, DENSITY, EARTH, TissueSolid, _shape_slopes, tissue_solid
from core.tissue.tetrahedra import layered_tetrahedra
from core.tissue.wall_film import DEPTH, wall_film

RADIUS, HEIGHT = 70.0, 40.0


def disk(rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points in a disk of radius 1 and triangles that face up."""
    points, faces = [(0.0, 0.0)], []
    for ring in range(1, rings + 1):
        turn = 2.0 * np.pi * np.arange(6 * ring) / (6 * ring)
        points += [(ring / rings * np.cos(angle), ring / rings * np.sin(angle)) for angle in turn]
    places = np.array(points)
    faces = Delaunay(places).simplices.astype(np.int64)
    a, b, c = (places[faces[:, k]] for k in range(3))
    down = (b - a)[:, 0] * (c - a)[:, 1] < (b - a)[:, 1] * (c - a)[:, 0]
    faces[down] = faces[down][:, ::-1]
    return places, faces


def breast(rings: int = 5) -> SkinPatch:
    """Return a dome that faces -y, on a level rim that lies over fixed control points."""
    flat, faces = disk(rings)
    away = np.hypot(*flat.T)
    out = HEIGHT * np.maximum(1.0 - (away / 0.8) ** 2, 0.0)
    skin = Mesh(np.stack([RADIUS * flat[:, 0], -out, RADIUS * flat[:, 1]], axis=1), faces)
    assert skin.vertex_normals[0] @ (0.0, -1.0, 0.0) > 0.9
    return SkinPatch(skin, away > 0.9)


@pytest.fixture(scope="module")
def tissue() -> TissueSolid:
    return tissue_solid(breast(), 0.5)


def test_the_film_of_a_level_rim_is_a_plane_inward_of_it() -> None:
    wall = wall_film(breast(), 12.0)
    assert wall[:, 1] == pytest.approx(12.0, abs=1e-9)


def test_tetrahedra_fill_the_space_between_wall_and_skin() -> None:
    patch = breast()
    cells = layered_tetrahedra(patch.mesh, wall_film(patch), 3)
    assert cells.volumes().min() > 0.0
    base = -patch.mesh.area_vectors[:, 1].sum()
    assert cells.volumes().sum() == pytest.approx(patch.mesh.enclosed_volume() + DEPTH * base, rel=1e-9)


def test_a_wall_in_front_of_the_skin_is_refused() -> None:
    patch = breast()
    with pytest.raises(ValueError, match="crosses"):
        layered_tetrahedra(patch.mesh, patch.mesh.vertices - [0.0, 5.0, 0.0])


def test_the_weight_of_all_nodes_is_that_of_the_volume(tissue: TissueSolid) -> None:
    weight = tissue.cells.volumes().sum() * DENSITY * EARTH
    assert tissue.weights.sum() == pytest.approx(weight, rel=1e-12)


def test_a_linear_motion_strains_as_the_material_says(tissue: TissueSolid) -> None:
    stiffness, divergence, _ = tissue._tangent()
    cells = tissue.cells
    nodes = np.concatenate([cells.corners, cells.corners[cells.edges].mean(axis=1)])
    slope = np.array([[0.0, 0.2, 0.0], [0.0, 0.0, 0.0], [0.0, 0.1, 0.0]])  # shear: no change of volume
    motion = (nodes @ slope.T).ravel()
    strain = 0.5 * (slope + slope.T)
    energy = 1e-3 * tissue.shear_modulus * (strain**2).sum() * cells.volumes().sum()
    assert 0.5 * motion @ stiffness @ motion == pytest.approx(energy, rel=1e-10)
    assert np.abs(divergence @ motion).max() < 1e-9
    swelling = (nodes @ (0.01 * np.eye(3))).ravel()
    assert (divergence @ swelling).sum() == pytest.approx(0.03 * cells.volumes().sum(), rel=1e-10)


def test_a_turn_and_a_shift_of_all_nodes_strain_nothing(tissue: TissueSolid) -> None:
    stiffness, _, _ = tissue._tangent()
    cells = tissue.cells
    nodes = np.concatenate([cells.corners, cells.corners[cells.edges].mean(axis=1)])
    for motion in (np.cross([0.3, -0.2, 0.5], nodes), np.tile([1.0, 2.0, 3.0], (len(nodes), 1))):
        assert np.abs(stiffness @ motion.ravel()).max() < 1e-9


def at_nodes(tissue: TissueSolid, moved: np.ndarray) -> np.ndarray:
    """Return displacements of the free coordinates (m,) at all nodes, (nodes, 3) [mm]."""
    motion = np.zeros(3 * tissue.cells.node_count)
    motion[tissue.free] = moved
    return motion.reshape(-1, 3)


def test_without_weight_the_breast_rises_and_keeps_its_volume(tissue: TissueSolid) -> None:
    motion = at_nodes(tissue, tissue.solved(tissue.weight_loads()[:, 2:])[0][:, 0])
    assert not motion[tissue.fixed].any()
    skin = tissue.cells.skin
    top = motion[len(tissue.cells.corners) - len(skin.vertices) : len(tissue.cells.corners)]
    rise = top[np.argmin(skin.vertices[:, 1])]
    assert rise[2] > 5.0
    assert abs(rise[0]) < 0.05 * rise[2]
    swept = np.einsum("ij,ij->", skin.area_vectors, top[skin.faces].mean(axis=1))
    assert abs(swept) < 0.003 * tissue.cells.volumes().sum()


def test_answers_are_symmetric_and_go_with_softness(tissue: TissueSolid) -> None:
    places = tissue.cells.skin.vertices[[0, 3, 9]]
    rows = tissue.cells.skin_rows(places)
    assert rows.sum(axis=1) == pytest.approx(1.0)
    loads = np.kron(rows.toarray(), np.eye(3))[:, tissue.free].T
    moved, pressure = tissue.solved(loads)
    compliance = loads.T @ moved
    assert compliance == pytest.approx(compliance.T, rel=1e-6, abs=1e-9)
    assert np.linalg.eigvalsh(compliance).min() > 0.0
    soft, same = TissueSolid(tissue.cells, tissue.fixed, 0.25, tissue.density).solved(loads)
    assert soft == pytest.approx(2.0 * moved, rel=1e-6, abs=1e-12)
    assert same == pytest.approx(pressure, rel=1e-6, abs=1e-9)


def test_stresses_of_weight_are_the_slope_of_the_tangent_of_a_neo_hookean_solid() -> None:
    """The energy's second derivative at the known shape, by differences of its exact gradient."""
    tissue = tissue_solid(breast(3), 0.5)
    moved, pressure = (each[:, 0] for each in tissue.solved(-tissue.weight_loads()[:, 2:]))
    rng, step, size = np.random.default_rng(5), 1e-4, 1e-3
    way = at_nodes(tissue, rng.normal(size=moved.shape))
    nodes = np.concatenate([tissue.cells.corners, tissue.cells.corners[tissue.cells.edges].mean(axis=1)])

    def slope(share: float) -> np.ndarray:
        before = nodes - share * at_nodes(tissue, moved)
        ahead, behind = (
            forces(tissue, before, nodes + sign * step * way, share * pressure) for sign in (1, -1)
        )
        return (ahead - behind) / (2.0 * step)

    expected = (slope(size) - slope(-size)) / (2.0 * size)
    added = tissue.prestress(moved, pressure) @ way.ravel()[tissue.free]
    assert np.abs(added - expected).max() < 1e-3 * np.abs(expected).max()


def forces(tissue: TissueSolid, before: np.ndarray, after: np.ndarray, pressure: np.ndarray) -> np.ndarray:
    """Return what a neo-Hookean solid resists with on the free coordinates, moved from one shape to another.

    Energy per volume before: mu / 2 (tr F^T F - 3) - mu ln det F - p (det F - 1).
    """
    cells, shear = tissue.cells, 1e-3 * tissue.shear_modulus
    found = np.zeros((cells.node_count, 3))
    for point in _POINTS:
        slopes = _shape_slopes(point)
        one, two = (
            np.einsum("tac,ai->tci", shape[cells.nodes], slopes[:, 1:] - slopes[:, :1])
            for shape in (before, after)
        )
        change = two @ np.linalg.inv(one)
        grown = np.linalg.det(change)
        inward = np.linalg.inv(change).transpose(0, 2, 1)
        push = pressure[cells.nodes[:, :4]] @ point * grown + shear
        stress = shear * change - push[:, None, None] * inward
        by_before = np.linalg.inv(one).transpose(0, 2, 1) @ (slopes[:, 1:] - slopes[:, :1]).T
        weight = np.linalg.det(one) / 24.0
        np.add.at(found, cells.nodes, np.einsum("t,tci,tia->tac", weight, stress, by_before))
    return found.ravel()[tissue.free]


def test_more_layers_and_points_change_the_rise_little() -> None:
    rises = []
    for rings, layers in ((5, 2), (8, 3)):
        solid = tissue_solid(breast(rings), 0.5, layers=layers)
        rows = solid.cells.skin_rows(np.array([[0.0, -HEIGHT, 0.0]]))
        rises.append((rows @ at_nodes(solid, solid.solved(solid.weight_loads()[:, 2:])[0][:, 0]))[0, 2])
    assert rises[0] == pytest.approx(rises[1], rel=0.05)


def test_a_coarse_mesh_keeps_the_border_and_is_one_disk() -> None:
    fine = breast(24).mesh
    coarse = coarse_mesh(fine, 15.0)
    assert len(coarse.boundary_loops) == 1
    assert len(coarse.vertices) - len(coarse.edges) + len(coarse.faces) == 1
    ends = coarse.vertices[coarse.edges]
    length = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    assert 10.0 < np.median(length) < 20.0
    assert np.abs(np.hypot(*coarse.vertices[coarse.boundary_loops[0]][:, ::2].T) - RADIUS).max() < 1e-9
