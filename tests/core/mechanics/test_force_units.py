"""What a unit of the model's stiffness is in newtons: a stretched net, and the formulas of lattices."""

import numpy as np
import pytest
from models import LAWS, law_of

from core.geometry.mesh import Mesh
from core.mechanics.force_units import net_stiffness, newtons_per_unit
from core.mechanics.model import assemble
from core.mechanics.options import ModelOptions
from core.mechanics.tensegrity import TensegrityModel, tensegrity_model
from core.mechanics.volume import volume_measure

SIDE = 7.0


def lattice(count: int, side: float = SIDE) -> Mesh:
    """A rhombus of count x count equilateral triangle pairs, a little way in front of the origin."""
    i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
    points = np.stack([(i + 0.5 * j) * side, np.full(i.shape, -50.0), j * side * np.sqrt(0.75)], axis=-1)
    at = np.arange((count + 1) ** 2).reshape(count + 1, count + 1)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[1:, :-1], at[:-1, 1:], at[1:, 1:]))
    faces = np.concatenate([np.stack([a, b, c], 1), np.stack([b, d, c], 1)])
    return Mesh(points.reshape(-1, 3), faces)


def net(mesh: Mesh, mechanics: ModelOptions | None = None) -> TensegrityModel:
    """The net of a mesh of which every point is free."""
    return tensegrity_model(mesh, np.zeros(len(mesh.vertices), dtype=bool), mechanics)


def model_of(mesh, mechanics=None):
    tensegric = net(mesh, mechanics)
    volume = volume_measure(mesh, tensegric.free, np.ones(len(mesh.faces), dtype=np.int64))
    return assemble(tensegric, (), volume, ())


def stretch_energy(count, mechanics, angle, strain=1e-4):
    """Twice the energy of a lattice stretched in one direction of its plane, over the strain squared."""
    mesh = lattice(count)
    u = np.array([np.cos(angle), 0.0, np.sin(angle)])
    moved = strain * (mesh.vertices @ u)[:, None] * u
    return 2.0 * net(mesh, mechanics).energy(moved) / strain**2


@pytest.mark.parametrize("law", LAWS, ids=law_of)
@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 2])
def test_a_stretched_net_of_equilateral_triangles_answers_with_the_stiffness_told(law, angle):
    # The border's cables count in full: the second difference over the size leaves what each rhombus adds.
    sizes = [stretch_energy(count, law, angle) for count in (5, 6, 7)]
    per_rhombus = (sizes[0] - 2.0 * sizes[1] + sizes[2]) / 2.0
    rhombus = SIDE**2 * np.sqrt(0.75)
    told = net_stiffness(model_of(lattice(6), law))
    assert per_rhombus / rhombus == pytest.approx(told, rel=1e-3)


def test_the_stiffness_of_lattices_has_its_known_values():
    assert net_stiffness(model_of(lattice(4))) == pytest.approx(np.sqrt(3.0), rel=1e-12)
    # Cables that hardly pull at rest are nearly plain springs: 3 sqrt(3) / 4 at held width.
    plain = ModelOptions(member_law="prestressed", prestress=0.1)
    assert net_stiffness(model_of(lattice(4), plain)) == pytest.approx(
        0.9 * 0.75 * np.sqrt(3.0) + 0.1 * np.sqrt(3.0), rel=1e-12
    )
    assert net_stiffness(model_of(lattice(9, 31.0))) == pytest.approx(np.sqrt(3.0), rel=1e-12)


def test_newtons_follow_the_tissue(built):
    model = built("mannequin").model
    assert newtons_per_unit(model, 530.0) == pytest.approx(0.53 / net_stiffness(model), rel=1e-12)
    assert newtons_per_unit(model, 1060.0) == pytest.approx(2.0 * newtons_per_unit(model, 530.0), rel=1e-12)


def test_a_mesh_like_the_sample_s_is_near_the_lattice(built):
    # Uneven triangles make a net stiffer than sqrt(3), by no more than they are uneven.
    assert np.sqrt(3.0) < net_stiffness(built("mannequin").model) < 1.2 * np.sqrt(3.0)
