"""Newtons per unit of the model's stiffness.

The model's cables have relative stiffness and no unit. As a net they resist stretching like a membrane; if
skin and tissue are said to resist with so many N/m, one unit becomes so many N/mm (ours; see
docs/explanation/forces.md).
"""

from __future__ import annotations

import numpy as np

from core.mechanics.model import ConstrainedModel
from core.mechanics.tensegrity import TensegrityModel


def net_stiffness(model: ConstrainedModel) -> float:
    """Return what the net of cables resists a stretch in one direction with, per strain and width.

    In units of the model's stiffness, the mean over directions, the width held; sqrt(3) for equilateral
    triangles under the law of force densities. The scale of the mesh does not matter.
    """
    tensegric = model.tensegric
    assert isinstance(tensegric, TensegrityModel)
    corners = model.tensegric.rest[model.volume.faces]
    sides = corners - np.roll(corners, 1, axis=1)
    area = 0.5 * float(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum())
    first, second = tensegric.rest[tensegric.cables].transpose(1, 0, 2)
    # Densities are one number over the lengths: half of q l^2 of each side belongs to each triangle.
    scale = float(np.mean(tensegric.density * np.linalg.norm(first - second, axis=1)))
    along = 0.5 * scale * float(np.linalg.norm(sides, axis=2).sum()) / area
    tension = tensegric.mechanics.prestress if tensegric.mechanics.member_law == "prestressed" else 1.0
    return along * (3.0 / 8.0 + tension / 8.0)


def newtons_per_unit(model: ConstrainedModel, tissue_stiffness: float) -> float:
    """Return what one unit of the model's stiffness is [N/mm] on a tissue of so many N/m.

    A solid has newtons of its own.
    """
    if model.options.tissue == "solid":
        return 1.0
    return tissue_stiffness / 1000.0 / net_stiffness(model)
