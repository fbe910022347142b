"""Sensitivity of an exact answer to the stiffness of lines, chest and tissue, and to prestress (ours)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from core.geometry.mesh import Floats, Indices
from core.mechanics.condensed_tissue import CondensedTissue
from core.mechanics.sensitivity import Rates, Sensitivities
from core.mechanics.tensegrity import TensegrityModel

_NEAR = 1e-6  # of the elongation, for the slope of a curve of straight pieces

Kept = Callable[[Rates], Rates]
"""What rates become where more is held than the balance itself holds."""


class CurvedSecant(Protocol):
    """What is asked of an elastic."""

    def secant(self, elongation: float) -> float:
        """Return force over elongation [N]."""


@dataclass(frozen=True, eq=False)
class Changes:
    """What each of p settings does to the lines, both (lines, p).

    ``stiffer`` is the change of the logarithm of each line's stiffness, of an elastic at the same elongation
    and length; ``ratios`` that of its length.
    """

    stiffer: Floats
    ratios: Floats


@dataclass(frozen=True, eq=False)
class StiffnessRates:
    """What ``Changes`` do: ``moved`` (3 f, p) [mm], and ``pulls`` (s, p), that of each segment's tension.

    Tensions are in the model's unit.
    """

    moved: Floats
    pulls: Floats


def by_stiffness(answer: Sensitivities, lines: Indices) -> Rates:
    """Return the rates by the logarithm of the stiffness of ``lines`` (p,); of held lines none."""
    potential = answer.potential
    return answer.by_forces(answer.by_line(potential.pulls(answer.place.lengths), lines))


def stiffness_rates(
    answer: Sensitivities,
    changes: Changes,
    elastics: Mapping[int, CurvedSecant],
    ratios: Floats,
    kept: Kept = lambda r: r,
    beside: Floats | None = None,
) -> StiffnessRates:
    """Return what ``changes`` do to a balance; ``elastics`` by the number of their line follow their curves.

    ``ratios`` (lines,) are the lengths of the lines. ``kept`` see ``Kept``. ``beside`` (3 f, p) [mm] is how
    the points move with what the settings do to other things than lines, if to any.
    """
    model = answer.potential.model
    every = np.arange(len(model.lines))
    longer, stiffer = kept(answer.by_ratio(every)).moved, kept(by_stiffness(answer, every)).moved
    made = [line for line in elastics if line in set(model.acting_lines.tolist())]
    stiff = changes.stiffer.copy()
    other = np.zeros((len(longer), stiff.shape[1])) if beside is None else beside
    if made and not len(answer.potential.held_lines):
        natural = ratios[made] * np.array([model.lines[line].rest_length for line in made])
        elongation = model.sums(answer.potential.stretch(answer.place.lengths))[made] / natural
        stretch = answer.stretch_slopes(made) / natural[:, None]
        bend = np.array([_bend(elastics[line], at) for line, at in zip(made, elongation, strict=True)])
        own = changes.ratios[made] / ratios[made, None]
        given = stretch @ (stiffer @ changes.stiffer + longer @ changes.ratios + other)
        right = bend[:, None] * (given - (answer.taut_shares[made] + elongation)[:, None] * own) - own
        system = np.eye(len(made)) - bend[:, None] * (stretch @ stiffer[:, made])
        stiff[made] += np.linalg.solve(system, right)
    moved = stiffer @ stiff + longer @ changes.ratios + other
    return StiffnessRates(moved, _pulls(answer, moved, stiff, changes.ratios))


def _bend(elastic: CurvedSecant, elongation: float) -> float:
    """Return how the logarithm of an elastic's secant changes with its elongation [1]."""
    low, high = (elastic.secant(elongation + step) for step in (-_NEAR, _NEAR))
    return float(np.log(high / low)) / (2.0 * _NEAR)


def _pulls(answer: Sensitivities, moved: Floats, stiff: Floats, ratios: Floats) -> Floats:
    """Return what becomes of the tension of each segment that springs, shape (s, p)."""
    potential, place = answer.potential, answer.place
    model = potential.model
    along = place.spans / place.lengths[:, None]
    steps = np.stack(
        [np.sum(along * (model.segments.signs @ column.reshape(-1, 3)), axis=1) for column in moved.T], axis=1
    )
    natural = model.tapes_at_rest[:, None] * ratios[model.owner]
    taut = potential.tape * potential.taut(place.lengths)
    tension = potential.tape * potential.stretch(place.lengths)
    return np.asarray(taut[:, None] * (steps - natural) + tension[:, None] * stiff[model.owner])


def d_ground(answer: Sensitivities, ground: Floats) -> Rates:
    """Return the rates by ``ModelOptions.firm_chest`` [mm / 1].

    ``ground`` (f,) ties each free point to its rest where that is 1; see ``firm_ground``.
    """
    return answer.by_forces((ground[:, None] * answer.place.moved).reshape(-1, 1))


def d_prestress(answer: Sensitivities) -> Rates:
    """Return the rates by ``ModelOptions.prestress`` [mm / 1]; 0 under laws that know none."""
    tissue = answer.potential.model.tensegric
    cables = tissue.cable_springs if isinstance(tissue, TensegrityModel) else None
    if cables is None:
        return answer.by_forces(np.zeros((answer.place.gradient.size, 1)))
    spans, lengths = cables.spans(answer.place.moved)
    shorter = (cables.stiffness * cables.rest_lengths / lengths)[:, None] * spans
    at_rest = cables.stiffness[:, None] * cables.rest_spans  # the force that balances them there
    return answer.by_forces(cables.sum(shorter - at_rest).reshape(-1, 1))


def d_sag(answer: Sensitivities) -> Rates:
    """Return the rates by the logarithm of ``ModelOptions.sag``, at the stiffness that lines have [mm].

    The shear modulus of a solid goes with 1 / sag, its weight does not.
    """
    solid = answer.potential.model.tensegric
    assert isinstance(solid, CondensedTissue)
    return answer.by_forces(-(solid.firmer @ answer.place.moved.ravel()).reshape(-1, 1))


def d_tissue(prestress: float) -> float:
    """Return how the logarithm of what a net of prestressed cables resists with goes with it [1].

    See ``net_stiffness``: an elastic of so many newtons is softer beside a stiffer net.
    """
    return 1.0 / (3.0 + prestress)
