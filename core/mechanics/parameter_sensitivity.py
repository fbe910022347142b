"""How an exact answer moves with the tissue: its tie to the chest, the prestress of its cables (ours).

Each enters the balance by a force that its change alone makes; the rest is the linear system that
``sensitivity`` solves. For stiffness and lengths of lines see ``stiffness_sensitivity``.
"""

from __future__ import annotations

import numpy as np

from core.geometry.mesh import Floats
from core.mechanics.sensitivity import Rates, Sensitivities


def d_ground(answer: Sensitivities, ground: Floats) -> Rates:
    """Return the rates by ``ModelOptions.firm_chest`` [mm / 1].

    ``ground`` (f,) ties each free point to its rest where that is 1; see ``firm_ground``.
    """
    return answer.by_forces((ground[:, None] * answer.place.moved).reshape(-1, 1))


def d_prestress(answer: Sensitivities) -> Rates:
    """Return the rates by ``ModelOptions.prestress`` [mm / 1]; 0 under laws that know none."""
    cables = answer.potential.model.tensegric.cable_springs
    if cables is None:
        return answer.by_forces(np.zeros((answer.place.gradient.size, 1)))
    spans, lengths = cables.spans(answer.place.moved)
    shorter = (cables.stiffness * cables.rest_lengths / lengths)[:, None] * spans
    at_rest = cables.stiffness[:, None] * cables.rest_spans  # the force that balances them there
    return answer.by_forces(cables.sum(shorter - at_rest).reshape(-1, 1))


def d_tissue(prestress: float) -> float:
    """Return how the logarithm of what a net of prestressed cables resists with goes with it [1].

    See ``net_stiffness``: an elastic of so many newtons is softer beside a stiffer net.
    """
    return 1.0 / (3.0 + prestress)
