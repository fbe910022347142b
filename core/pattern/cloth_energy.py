"""Elastic work of a cloth that is laid flat: its value, slope and curvature in each triangle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from core.geometry.mesh import Floats
from core.pattern.plane_maps import rotations


class ClothLike(Protocol):
    """What flattening needs of a cloth.

    ``stiffness`` across, down and in shear, in any one unit; ``poisson`` [1]; ``ease`` across and down [1],
    by how much more cloth is stretched when worn than its strain shows.
    """

    @property
    def stiffness(self) -> tuple[float, float, float]: ...  # noqa: D102

    @property
    def poisson(self) -> float: ...  # noqa: D102

    @property
    def ease(self) -> tuple[float, float]: ...  # noqa: D102


def stiffness_matrix(cloth: ClothLike) -> Floats:
    """Return what makes stresses of the strains xx, yy, xy, (3, 3); work counts that of xy twice."""
    across, down, shear = cloth.stiffness
    coupling = cloth.poisson * np.sqrt(across * down)
    return np.array([[across, coupling, 0.0], [coupling, down, 0.0], [0.0, 0.0, 2.0 * shear]])


@dataclass(frozen=True, eq=False)
class ClothState:
    """Each of m triangles of cloth: flat by worn lengths, and the work of it.

    ``stretch`` (m, 3): S = J R^T, symmetric, xx, yy and xy in the axes of the cloth [1], where J is the
    gradient of the flat places and R the rotation nearest to it (``cosine``, ``sine``). ``stress`` (m, 3)
    is the slope of the work density by S.
    """

    cosine: Floats
    sine: Floats
    stretch: Floats
    stress: Floats

    @classmethod
    def of(cls, jacobian: Floats, stiffness: Floats) -> ClothState:
        """Return the state at ``jacobian`` (m, 2, 2); ``stiffness`` (m, 3, 3)."""
        c, s = rotations(jacobian)
        (a, b), (d, e) = jacobian.transpose(1, 2, 0)
        stretch = np.stack([a * c - b * s, d * s + e * c, a * s + b * c], axis=1)
        strain = stretch - [1.0, 1.0, 0.0]
        return cls(c, s, stretch, (stiffness @ strain[..., None])[..., 0])

    @property
    def density(self) -> Floats:
        """Return the work by area, (m,).

        kx/2 (Sxx - 1)^2 + ky/2 (Syy - 1)^2 + nu sqrt(kx ky) (Sxx - 1)(Syy - 1) + 2 g Sxy^2.
        """
        return np.asarray(
            0.5 * (self.stress * (self.stretch - [1.0, 1.0, 0.0]) * [1.0, 1.0, 2.0]).sum(axis=1)
        )

    def slope(self) -> Floats:
        """Return the slope of the density by D = dJ R^T, (m, 2, 2).

        The rotation turns with J: dS = D - dr S E with E = [[0, -1], [1, 0]] and dr = (Dyx - Dxy) / tr S.
        """
        x, y, xy = self.stress.T
        couple = self._couple / self._trace
        return np.stack([np.stack([x, xy - couple], axis=1), np.stack([xy + couple, y], axis=1)], axis=1)

    @property
    def _trace(self) -> Floats:
        return np.asarray(self.stretch[:, 0] + self.stretch[:, 1])

    @property
    def _couple(self) -> Floats:
        """Return what turns the cloth towards its axes; 0 for one that is alike in all directions."""
        (x, y, xy), (sx, sy, sxy) = self.stress.T, self.stretch.T
        return np.asarray((y - x) * sxy + xy * (sx - sy))

    def curvature(self, stiffness: Floats) -> Floats:
        """Return the second derivative of the density by D as (xx, xy, yx, yy), (m, 4, 4)."""
        trace = np.maximum(self._trace, 1e-9)
        (sx, sy, sxy), (x, y, xy) = self.stretch.T, self.stress.T
        turn = np.array([0.0, -1.0, 1.0, 0.0]) / trace[:, None]
        rows = np.zeros((len(trace), 3, 4))
        rows[:, 0] = [1.0, 0.0, 0.0, 0.0] - sxy[:, None] * turn
        rows[:, 1] = [0.0, 0.0, 0.0, 1.0] + sxy[:, None] * turn
        rows[:, 2] = [0.0, 0.5, 0.5, 0.0] + 0.5 * (sx - sy)[:, None] * turn
        work = stiffness * np.array([1.0, 1.0, 2.0])[:, None]
        pull = np.stack([-xy, x, -y, xy], axis=1)
        pull += (2.0 * self._couple / trace)[:, None] * [1.0, 0.0, 0.0, 1.0]
        pull += (x - y)[:, None] * rows[:, 2] + xy[:, None] * (rows[:, 1] - rows[:, 0])
        bend = turn[:, :, None] * pull[:, None]
        return np.asarray(rows.transpose(0, 2, 1) @ work @ rows - 0.5 * (bend + bend.transpose(0, 2, 1)))
