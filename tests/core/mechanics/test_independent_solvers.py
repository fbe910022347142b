"""The same answers on independent ways: general optimisers, root finders, turns, other people's volumes."""

from collections.abc import Callable

import numpy as np
import pytest
import trimesh
from models import LAWS, cable_force, law_of, line_force, pairs_of, settled, small, volume_slopes
from scipy.optimize import BFGS, NonlinearConstraint, minimize, root
from scipy.spatial import ConvexHull
from shapes import fitted, mid_bust, torso
from threadpoolctl import threadpool_limits

from app.research.sphere import sphere
from core.geometry.mesh import Mesh
from core.mechanics.exact_solution import solve_exact
from core.mechanics.iteration import LineTargets
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.options import ModelOptions
from core.mechanics.tensegrity import tensegrity_model
from core.mechanics.volume import volume_measure

RATIOS = (1.0, 0.85, 0.95)
LITRE = 1e6


def plain_energy(model: ConstrainedModel, points: np.ndarray, ratios: tuple[float, ...]) -> float:
    """The energy of the cables and of the lines, written down anew from the model's words."""
    tensegric, law = model.tensegric, model.options.member_law
    i, j = tensegric.cables.T
    span, rest, q = points[i] - points[j], tensegric.rest[i] - tensegric.rest[j], tensegric.density
    if law == "force-density":
        total = 0.5 * float(q @ ((span - rest) ** 2).sum(axis=1))
    elif law == "prestressed":
        here, there = np.linalg.norm(span, axis=1), np.linalg.norm(rest, axis=1)
        natural = (1.0 - model.options.prestress) * there
        pull = (there - natural) * np.einsum("ij,ij->i", rest, span - rest) / there
        total = float(q @ (0.5 * (here - natural) ** 2 - 0.5 * (there - natural) ** 2 - pull))
    else:
        total = cells_energy(model, points)
    pairs = pairs_of(model.segments.across)
    for (a, b), k, line in zip(pairs, model.segments.stiffness, model.owner, strict=True):
        natural = ratios[line] * np.linalg.norm(tensegric.rest[a] - tensegric.rest[b])
        total += 0.5 * k * (np.linalg.norm(points[a] - points[b]) - natural) ** 2
    return total


def cells_energy(model: ConstrainedModel, points: np.ndarray) -> float:
    """Half of each edge's density for each end's neighbourhood, without a rotation being made."""
    tensegric, total = model.tensegric, 0.0
    edges = np.concatenate([tensegric.cables, tensegric.fixed_edges])
    density = np.concatenate([tensegric.density, tensegric.held_density])
    for centre in np.unique(tensegric.cables):
        mine = (edges == centre).any(axis=1)
        other = edges[mine].sum(axis=1) - centre
        now, rest = points[centre] - points[other], tensegric.rest[centre] - tensegric.rest[other]
        weight = 0.5 * density[mine]
        u, stretch, vt = np.linalg.svd((weight[:, None] * now).T @ rest)
        stretch[2] *= np.sign(np.linalg.det(u @ vt))
        # The best rotation leaves |now|^2 + |rest|^2 less twice the sum of the singular values.
        total += 0.5 * float(weight @ ((now**2).sum(axis=1) + (rest**2).sum(axis=1))) - float(stretch.sum())
    return total


def plain_sides(model: ConstrainedModel, points: np.ndarray) -> np.ndarray:
    """The left and the right volume [litres], as determinants."""
    corners = (points - model.volume.centre)[model.volume.faces]
    each = np.linalg.det(corners) / 6.0
    return np.array([each[model.volume.zone == side].sum() for side in (0, 1)]) / LITRE


def placed(model: ConstrainedModel, flat: np.ndarray) -> np.ndarray:
    """All control points for the free coordinates in one row."""
    return model.tensegric.expand(flat.reshape(-1, 3))


def gradient_of(model: ConstrainedModel, ratios: tuple[float, ...]) -> Callable[[np.ndarray], np.ndarray]:
    """Minus the plain forces on the free points; for co-rotated cells those of the model."""

    def gradient(flat: np.ndarray) -> np.ndarray:
        points = placed(model, flat)
        force = line_force(model, points, ratios)[model.tensegric.free]
        if model.options.member_law == "co-rotated":
            return (model.tensegric.gradient(flat.reshape(-1, 3)) - force).ravel()
        return -(cable_force(model, points)[model.tensegric.free] + force).ravel()

    return gradient


@pytest.mark.parametrize("law", LAWS, ids=law_of)
def test_a_trust_region_optimiser_finds_the_same_place(law):
    model = small(law)
    wanted, free = plain_sides(model, model.tensegric.rest), model.tensegric.free
    volume = NonlinearConstraint(
        lambda flat: plain_sides(model, placed(model, flat)) - wanted,
        0.0,
        0.0,
        jac=lambda flat: volume_slopes(model, placed(model, flat))[:, free].reshape(2, -1) / LITRE,
        hess=BFGS(),
    )
    with threadpool_limits(1):
        found = minimize(
            lambda flat: plain_energy(model, placed(model, flat), RATIOS),
            np.zeros(3 * len(free)),
            jac=gradient_of(model, RATIOS),
            hess=BFGS(),
            constraints=volume,
            method="trust-constr",
            options={"gtol": 1e-8, "xtol": 1e-14, "maxiter": 2000},
        )
    exact = solve_exact(model, RATIOS)
    assert exact.is_converged
    np.testing.assert_allclose(found.x.reshape(-1, 3), exact.state.moved, atol=1e-6)


@pytest.mark.parametrize("law", LAWS, ids=law_of)
def test_a_sequential_optimiser_finds_the_same_place_with_a_held_line(law):
    model = small(ModelOptions(law.member_law, line_hold="held"), worn=("mid-bust",))
    bare = small(ModelOptions(law.member_law), worn=())
    ratios, line, free = (1.0, 0.93, 1.0), model.lines[1], model.tensegric.free
    wanted = plain_sides(model, model.tensegric.rest)

    def missing(flat):
        points = placed(model, flat)
        length = sum(np.linalg.norm(points[a] - points[b]) for a, b in pairs_of(line.across))
        return np.append(plain_sides(model, points) - wanted, length / line.rest_length - 0.93)

    def slopes(flat):
        points = placed(model, flat)
        rope = np.zeros_like(points)
        for a, b in pairs_of(line.across):
            way = (points[a] - points[b]) / np.linalg.norm(points[a] - points[b])
            rope[a] += way
            rope[b] -= way
        sides = volume_slopes(model, points)[:, free].reshape(2, -1) / LITRE
        return np.concatenate([sides, rope[free].reshape(1, -1) / line.rest_length])

    with threadpool_limits(1):
        found = minimize(
            lambda flat: plain_energy(bare, placed(bare, flat), ratios),
            np.zeros(3 * len(free)),
            jac=gradient_of(bare, ratios),
            constraints={"type": "eq", "fun": missing, "jac": slopes},
            method="SLSQP",
            options={"ftol": 1e-13, "maxiter": 1000},
        )
    exact = solve_exact(model, ratios)
    assert exact.is_converged
    np.testing.assert_allclose(found.x.reshape(-1, 3), exact.state.moved, atol=1e-6)


@pytest.mark.parametrize("law", LAWS, ids=law_of)
def test_a_root_finder_finds_the_same_place_under_a_sliding_line(law):
    """No energy describes it, but balance does: as many equations as unknowns, two of them pressures."""
    model = small(ModelOptions(law.member_law, line_contact="sliding"), worn=("mid-bust",))
    ratios, free, unit = (1.0, 0.95, 1.0), model.tensegric.free, model.pressure_unit
    wanted = plain_sides(model, model.tensegric.rest)

    def balance(unknown):
        flat, pressures = unknown[:-2], unknown[-2:] * unit
        points = placed(model, flat)
        slopes = volume_slopes(model, points)[:, free]
        n = slopes.sum(axis=0) / np.linalg.norm(slopes.sum(axis=0), axis=1)[:, None]
        line = line_force(model, points, ratios)[free]
        body = -gradient_of(small(law, worn=()), ratios)(flat).reshape(-1, 3)
        total = body + n * (line * n).sum(axis=1)[:, None] + np.tensordot(pressures, slopes, axes=1)
        return np.append(total.ravel(), 1e3 * (plain_sides(model, points) - wanted))

    found = root(balance, np.zeros(3 * len(free) + 2), method="hybr", options={"xtol": 1e-12})
    exact = solve_exact(model, ratios)
    assert exact.is_converged
    np.testing.assert_allclose(found.x[:-2].reshape(-1, 3), exact.state.moved, atol=1e-6)
    np.testing.assert_allclose(found.x[-2:] * unit, exact.pressures, rtol=1e-6)


@pytest.mark.parametrize("template", ["168", "120"])
@pytest.mark.parametrize("sample", ["mannequin", "person"])
def test_2000_turns_come_to_the_exact_answer(sample, template):
    """To 1e-6 mm, on real bodies; the slowest law on the smaller template alone."""
    for law in LAWS if template == "120" else LAWS[:2]:
        choice = ModelOptions(law.member_law, volume_of="both")
        model = constrained_model(fitted(sample, template), worn=["mid-bust"], mechanics=choice)
        ratios = mid_bust(model, 0.85)
        turned = settled(model, LineTargets(ratios), turns=2000, step=1e-9)
        exact = solve_exact(model, ratios)
        assert exact.is_converged
        np.testing.assert_allclose(turned.moved, exact.state.moved, atol=1e-6)


@pytest.mark.parametrize("volume_of", ["each", "both"])
def test_the_volume_that_is_kept_is_that_of_another_library(volume_of):
    """The patch is closed by a fan to the middle of its border, and trimesh told to measure that."""
    control = torso(skew=0.3)
    model = constrained_model(control, mechanics=ModelOptions(volume_of=volume_of))
    count, loop = len(control.mesh.vertices), control.border_points
    lid = np.stack([np.roll(loop, -1), loop, np.full(len(loop), count)], axis=1)
    faces = np.concatenate([control.mesh.faces, lid])

    def volume(points):
        whole = np.concatenate([points, [control.mesh.vertices[loop].mean(axis=0)]])
        return trimesh.Trimesh(whole, faces, process=False)

    rest = volume(model.tensegric.rest)
    assert rest.is_watertight
    assert rest.volume == pytest.approx(model.volume.rest_volume, rel=1e-12)
    balance = solve_exact(model, RATIOS)
    after = volume(model.tensegric.expand(balance.state.moved))
    assert after.volume == pytest.approx(rest.volume, rel=1e-12)
    assert np.abs(after.vertices - rest.vertices).max() > 3.0


@pytest.mark.parametrize("seed", range(4))
def test_the_volume_of_a_convex_body_is_that_of_its_hull(seed):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(30, 3))
    points = 80.0 * points / np.linalg.norm(points, axis=1)[:, None]
    hull = ConvexHull(points)
    outward = np.einsum(
        "ij,ij->i",
        np.cross(*(points[hull.simplices[:, k]] - points[hull.simplices[:, 0]] for k in (1, 2))),
        hull.equations[:, :3],
    )
    faces = np.where(outward[:, None] > 0.0, hull.simplices, hull.simplices[:, ::-1])
    measure = volume_measure(Mesh(points, faces), np.arange(30))
    assert measure.volume(points) == pytest.approx(hull.volume, rel=1e-12)
    ball = sphere(rings=9, spokes=14)
    model = tensegrity_model(ball, np.zeros(len(ball.vertices), dtype=bool))
    stretched = ball.vertices * rng.uniform(0.6, 1.4, 3) + rng.normal(size=3)
    measured = volume_measure(ball, model.free).volume(stretched)
    assert measured == pytest.approx(ConvexHull(stretched).volume, rel=1e-12)
