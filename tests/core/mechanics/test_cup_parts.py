"""Parts of cups: hand values, and derivatives against differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from core.geometry.mesh import Floats, Points
from core.mechanics.cup_parts import CupCloth, CupContact, CupPart, SmoothSurface, Underwire
from core.mechanics.springs import springs

CHANCE = np.random.default_rng(5)


def bowl(radius: float) -> tuple[Points, Points]:
    """Return even places and outward normals on the front half of a ball."""
    number = np.arange(300) + 0.5
    height, turn = 1.0 - 2.0 * number / 300.0, np.pi * (1.0 + 5.0**0.5) * number
    out = np.stack([np.sqrt(1.0 - height**2) * np.cos(turn), height, np.sqrt(1.0 - height**2) * np.sin(turn)])
    front = out.T[out[1] < 0.2]
    return radius * front, front


def contact() -> CupContact:
    nodes, normals = bowl(60.0)
    points = nodes[normals[:, 1] < -0.4][::6]
    return CupContact(np.arange(len(points)), 1.1 * points, points, SmoothSurface(nodes, normals, 8.0), 2.0)


def cloth() -> CupCloth:
    rest = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 0.0, 10.0], [0.0, 2.0, 10.0]])
    strips = springs(rest, np.arange(4), np.array([[0, 1], [1, 2], [2, 3], [3, 0]]), np.full(4, 3.0))
    return CupCloth(strips, 0.9 * strips.rest_lengths)


def wire() -> Underwire:
    turn = np.linspace(0.0, np.pi, 9)
    rest = 50.0 * np.stack([np.cos(turn), 0.2 * np.sin(turn), -np.sin(turn)], axis=1)
    return Underwire(np.arange(9), rest, 0.1 * rest * [1.0, 0.0, 0.0], 3.0)


def second(part: CupPart, moved: Points, clip: bool = False) -> Floats:
    figures, at = part.figures(moved, clip), part.entries
    whole = sparse.coo_array((at.value * figures[at.source], (at.row, at.column)), (moved.size, moved.size))
    return whole.toarray()


@pytest.mark.parametrize("part", [contact(), cloth(), wire()], ids=["contact", "cloth", "wire"])
def test_derivatives_are_those_of_the_energy(part):
    count = len(part.rest) if not isinstance(part, CupCloth) else 4
    here, way = CHANCE.normal(size=(2, count, 3))
    step = 1e-4
    ahead, behind = here + step * way, here - step * way
    slope = (part.energy(ahead) - part.energy(behind)) / (2.0 * step)
    assert np.sum(part.gradient(here) * way) == pytest.approx(slope, rel=1e-6)
    bend = (part.gradient(ahead) - part.gradient(behind)).ravel() / (2.0 * step)
    assert np.abs(second(part, here) @ way.ravel() - bend).max() < 1e-6 * np.abs(bend).max()


def test_a_surface_pushes_what_lies_outside_inward_and_leaves_the_rest_alone():
    part = contact()
    inside = 0.9 * part.target - part.rest
    assert part.energy(inside) == 0.0
    assert not part.gradient(inside).any()
    on_it = part.target - part.rest
    assert np.abs(part.gradient(on_it)).max() < 1e-12
    out = 1.05 * part.target - part.rest  # 3 mm of a ball of 60
    push = -part.gradient(out)
    assert np.linalg.norm(push, axis=1) == pytest.approx(np.full(len(push), 6.0), rel=0.1)
    inward = -part.target / np.linalg.norm(part.target, axis=1)[:, None]
    assert (np.einsum("ij,ij->i", push, inward) > 0.98 * np.linalg.norm(push, axis=1)).all()
    assert not part.contacts(inside).any()
    assert part.contacts(out).any(axis=1).all()


def test_an_iteration_answers_to_a_millimetre_of_a_far_gap_and_to_a_near_one_as_it_is():
    part = contact()
    near, far = 1.01 * part.target - part.rest, 1.2 * part.target - part.rest
    assert np.array_equal(part.limited_gradient(near), part.gradient(near))
    assert np.linalg.norm(part.limited_gradient(far), axis=1) == pytest.approx(np.full(len(far), 2.0))


def test_cloth_pulls_by_hooke_and_never_pushes():
    part = cloth()
    moved = np.zeros((4, 3))
    assert part.tensions(moved) == pytest.approx(0.1 * 3.0 * part.strips.rest_lengths)
    shrunk = -0.2 * part.strips.across.T @ part.strips.rest_spans / 4.0
    assert (part.tensions(shrunk) < part.tensions(moved)).all()
    loose = CupCloth(part.strips, 1.3 * part.strips.rest_lengths)
    assert loose.energy(moved) == 0.0
    assert not second(loose, moved).any()


def test_a_wire_follows_the_body_as_a_whole_but_keeps_its_form():
    part = wire()
    moved = part.shape + np.array([3.0, -2.0, 5.0]) + np.cross([0.1, 0.2, -0.05], part.rest)
    assert part.energy(moved) == pytest.approx(0.0, abs=1e-9)
    assert part.forces(np.zeros((9, 3))).sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-9)
    assert part.energy(np.zeros((9, 3))) > 1.0  # it is wider than the root
    for side in (0, -1):  # and spreads its ends
        assert part.forces(np.zeros((9, 3)))[side, 0] * part.rest[side, 0] > 0.0
