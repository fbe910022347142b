"""The gain limit: above which conventional gain the model vibrates, known before the first turn (ours)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import sparse
from scipy.sparse import linalg as sparse_linalg

from core.members.band import Entries, Operator
from core.members.springs import stretch_blocks
from core.mesh import Floats, unit
from core.model import ConstrainedModel


def gain_limit(model: ConstrainedModel) -> float:
    """Return the conventional gain above which small volume errors flip and grow (ours; probe units [1]).

    A turn is linear for small moves: it moves the points by M^-1 (P a - H d), M being the lower triangle of
    the stiffness, H its true value and a the direction of the volume force. On the brink the displacement d
    flips from turn to turn, so that 2 M d - H d = P a, and its volume calls forth the very pressure that made
    it. The tension of held lines, which also changes from turn to turn, is left out.
    """
    a = model.rest_gradient
    cables, lines = _double_lower_less_true(model)
    if model.mechanics.line_contact == "sliding":
        n = unit(a)
        across = sparse.csr_array(sparse.block_diag([np.outer(v, v) for v in n], format="csr"))
        lines = sparse.csr_array(across @ lines)
    d = sparse_linalg.spsolve(sparse.csc_array(cables + lines), a.ravel())
    return model.probe / abs(float(a.ravel() @ d))


def _double_lower_less_true(model: ConstrainedModel) -> tuple[sparse.csr_array, sparse.csr_array]:
    """Return 2 M - H at rest for the cables and for the lines, both of shape (3 f, 3 f)."""
    tensegric, segments = model.tensegric, model.segments
    rest = np.zeros((len(tensegric.free), 3))
    figures = [np.ones(1), *tensegric.hessian_figures(rest, False)]
    true = sum_of(tensegric.hessian_entries, figures, rest.size)
    u = segments.rest_spans / segments.rest_lengths[:, None]
    blocks = stretch_blocks(u, segments.stiffness, np.zeros(len(u)))
    line_true = sum_of([segments.entries], [blocks.ravel()], rest.size)
    return (
        sparse.csr_array(2.0 * _lower(tensegric.stiffness) - true),
        sparse.csr_array(2.0 * _lower(model.line_laplacian) - line_true),
    )


def _lower(stiffness: Operator) -> sparse.csr_array:
    return sparse.csr_array(sparse.kron(sparse.tril(sparse.csr_array(stiffness)), np.eye(3)))


def sum_of(parts: Sequence[Entries], figures: Sequence[Floats], size: int) -> sparse.csr_array:
    """Return the matrix (size, size) that ``figures`` make with the entries of ``parts``."""
    pieces = [
        (part.value * of[part.source], part.row, part.column) for part, of in zip(parts, figures, strict=True)
    ]
    value, row, column = (np.concatenate(column) for column in zip(*pieces, strict=True))
    return sparse.csr_array((value, (row, column)), shape=(size, size))
