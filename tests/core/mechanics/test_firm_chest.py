"""The firm chest: points over thin tissue are tied to their rest, those of the breast hardly."""

import numpy as np
import pytest
from models import settled, small
from scipy.optimize import minimize
from shapes import fitted, mid_bust, run, tent, torso

from core.mechanics.exact_solution import solve_exact
from core.mechanics.gain_limit import gain_limit
from core.mechanics.iteration import LineTargets
from core.mechanics.model import constrained_model
from core.mechanics.options import ModelOptions
from core.mechanics.tensegrity import tensegrity_model, tissue_depth

FIRM = ModelOptions(firm_chest=0.1)
SAMPLES = ("mannequin", "person")


def test_the_film_under_a_tent_is_flat():
    mesh, fixed = tent(height=3.0)
    model = tensegrity_model(mesh, fixed)
    # The four ridges meet above the middle of their feet: there the film passes, and the tip's normal is up.
    np.testing.assert_allclose(tissue_depth(model, mesh), [3.0], atol=1e-12)


def test_a_tent_is_tied_by_hand():
    mesh, fixed = tent(height=36.0)
    free, firm = (tensegrity_model(mesh, fixed, ModelOptions(firm_chest=beta)) for beta in (0.0, 0.3))
    # 36 mm deep: 0.3 times the mean stiffness times (40 / (36 + 4)) squared.
    np.testing.assert_allclose(firm.ground, 0.3 * free.mean_stiffness)
    np.testing.assert_allclose(firm.stiffness, 1.3 * free.stiffness)
    lift = np.array([[1.0, -2.0, 3.0]])
    assert firm.energy(lift) - free.energy(lift) == pytest.approx(0.5 * 0.3 * free.mean_stiffness * 14.0)


def test_the_film_is_the_least_of_its_energy():
    """A general optimiser lays the film: cables without length of their own between the fixed points."""
    control = torso(skew=0.3)
    model = tensegrity_model(control.mesh, control.fixed)

    def energy(flat):
        points = model.rest.copy()
        points[model.free] = flat.reshape(-1, 3)
        spans = points[model.cables[:, 0]] - points[model.cables[:, 1]]
        force = np.zeros_like(points)
        np.add.at(force, model.cables[:, 0], model.density[:, None] * spans)
        np.subtract.at(force, model.cables[:, 1], model.density[:, None] * spans)
        return 0.5 * float(model.density @ (spans * spans).sum(axis=1)), force[model.free].ravel()

    options = {"maxiter": 20000, "maxfun": 40000, "ftol": 1e-16, "gtol": 1e-10}
    film = minimize(energy, model.rest[model.free].ravel(), jac=True, method="L-BFGS-B", options=options)
    away = film.x.reshape(-1, 3) - model.rest[model.free]
    by_normal = np.einsum("ij,ij->i", away, control.mesh.vertex_normals[model.free])
    np.testing.assert_allclose(tissue_depth(model, control.mesh), np.abs(by_normal), atol=1e-4)


@pytest.mark.parametrize("sample", SAMPLES)
def test_tissue_is_nowhere_less_than_none_and_deepest_at_the_bust_points(sample):
    control = fitted(sample)
    model = tensegrity_model(control.mesh, control.fixed)
    depth = dict(zip(model.free.tolist(), tissue_depth(model, control.mesh), strict=True))
    assert min(depth.values()) >= 0.0
    deepest = sorted(depth.values())[-6:]
    for bust_point in control.bust_points:
        assert depth[bust_point] >= deepest[0]
    # A point whose neighbours are all fixed but one hardly stands out: the film touches the fixed points.
    centre = [at for at in depth if control.column[at] == 0]
    assert max(depth[at] for at in centre) < 0.5 * deepest[-1]


def test_the_film_touches_fixed_points():
    """Points of a flat patch lie in the film of its border, however few are free."""
    control = torso()
    flat = control.mesh.moved(control.mesh.vertices * [1.0, 0.0, 1.0])
    depth = tissue_depth(tensegrity_model(flat, control.fixed), flat)
    np.testing.assert_allclose(depth, 0.0, atol=1e-10)


@pytest.mark.parametrize("law", ["force-density", "prestressed", "co-rotated"])
def test_a_firm_chest_is_balanced_at_rest_and_turns_come_to_the_exact_answer(law):
    model = small(ModelOptions(law, firm_chest=0.1, volume_of="both"), worn=("mid-bust",))
    state, _ = run(model, LineTargets((1.0,) * 3), 100)
    assert np.abs(state.moved).max() < 1e-10
    ratios = (1.0, 0.9, 1.0)
    exact = solve_exact(model, ratios)
    assert exact.is_converged
    np.testing.assert_allclose(settled(model, LineTargets(ratios)).moved, exact.state.moved, atol=1e-8)


@pytest.mark.parametrize("sample", SAMPLES)
@pytest.mark.parametrize("contact", ["glued", "sliding"])
def test_the_sternum_moves_less_on_a_firm_chest(sample, contact):
    control = fitted(sample)
    sternum = (control.column == 0) & ~control.fixed
    moves = []
    for firm in (0.0, 0.02, 0.1):
        choice = ModelOptions(firm_chest=firm, line_contact=contact)
        model = constrained_model(control, worn=["mid-bust"], mechanics=choice)
        points = model.tensegric.expand(solve_exact(model, mid_bust(model, 0.95)).state.moved)
        moves.append(np.linalg.norm(points - model.tensegric.rest, axis=1)[sternum].max())
    assert moves[0] > moves[1] > moves[2]
    assert moves[2] < 0.7 * moves[0]


@pytest.mark.parametrize("template", ["168", "120"])
@pytest.mark.parametrize("sample", SAMPLES)
def test_the_gain_limit_is_lower_on_a_firm_chest(sample, template):
    control = fitted(sample, template)
    soft, firm = (
        gain_limit(constrained_model(control, worn=["mid-bust"], mechanics=choice))
        for choice in (ModelOptions(), FIRM)
    )
    assert 1.0 < firm < 0.95 * soft
