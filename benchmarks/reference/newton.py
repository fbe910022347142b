"""Newton's method with a line search, and its continuation in a load.

Source: natural monotonicity test, Deuflhard (2004), Newton Methods for Nonlinear Problems, section 3.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from core.geometry.mesh import Floats, Indices

STEPS = 40
"""Newton steps before a load step counts as failed."""

STILL = 1e-9
"""Newton ends when the next step moves no node further than this [mm]."""

SHORTEST = 1.0 / 64.0
"""Smallest part of a Newton step, and of the load, that is tried [1]."""

Residual = Callable[[Floats], Floats]
Tangent = Callable[[Floats], sparse.csr_array]


class NoBalanceError(ArithmeticError):
    """Newton's method found no balance."""


def factorised(matrix: sparse.csr_array) -> SuperLU:
    """Return the factors of a matrix whose pattern is symmetric, without pivoting."""
    return splu(
        matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )


def solve(residual: Residual, tangent: Tangent, start: Floats, free: Indices) -> Floats:
    """Return unknowns near ``start`` (n,) whose residual is 0 in the rows ``free``; others keep their values.

    Raises NoBalanceError after too many steps, or where any would turn a tetrahedron inside out.
    """
    unknowns = start
    force = residual(unknowns)[free]
    for _ in range(STEPS):
        factors = factorised(tangent(unknowns)[free][:, free])
        step = -factors.solve(force)
        if np.abs(step).max() < STILL:
            return _added(unknowns, free, step)
        unknowns, force = _searched(residual, factors, unknowns, free, step)
    raise NoBalanceError("too many Newton steps")


def _searched(
    residual: Residual, factors: SuperLU, unknowns: Floats, free: Indices, step: Floats
) -> tuple[Floats, Floats]:
    """Return the unknowns after the longest part of ``step`` that shortens the next, and their residual.

    Where skin meets a cup none may, as the cup was not yet in the tangent: then it is the longest possible.
    """
    share, length = 1.0, np.linalg.norm(step)
    longest: tuple[Floats, Floats] | None = None
    while share >= SHORTEST:
        trial = _added(unknowns, free, share * step)
        try:
            force = residual(trial)[free]
        except ValueError:
            share /= 2.0
            continue
        if np.linalg.norm(factors.solve(force)) <= (1.0 - share / 4.0) * length + STILL:
            return trial, force
        longest = longest or (trial, force)
        share /= 2.0
    if longest is None:
        raise NoBalanceError("every part of a Newton step turns a tetrahedron inside out")
    return longest


def _added(unknowns: Floats, rows: Indices, step: Floats) -> Floats:
    moved = unknowns.copy()
    moved[rows] += step
    return moved


def follow(solved: Callable[[float, Floats], Floats], start: Floats, steps: int) -> Floats:
    """Return the unknowns at load 1 from those at load 0; ``solved`` returns those at a load from near ones.

    Starts with ``steps`` load steps, halves those that fail and doubles them after success; raises
    NoBalanceError at the shortest.
    """
    load, step, unknowns = 0.0, 1.0 / steps, start
    while load < 1.0:
        following = min(load + step, 1.0) if load + step < 1.0 - 1e-9 else 1.0
        try:
            unknowns = solved(following, unknowns)
        except NoBalanceError:
            step /= 2.0
            if step < SHORTEST / steps:
                raise
            continue
        load, step = following, min(2.0 * step, 1.0 / steps)
    return unknowns
