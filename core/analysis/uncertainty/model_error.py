"""Error of the model itself: an unknown load on both breasts, as large as reference comparisons show (ours).

What a model neglects acts like forces that it does not know, and its own equilibrium carries them to all
places: the volume stays as it is kept, bonded lines resist, and what is fixed stays. Compared with an
independent finite-element model (``core.analysis.model_check``) the errors of both breasts mirror each other,
so one load acts on both; its three directions are independent.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from core.analysis.uncertainty.input_uncertainty import InputUncertainty
from core.analysis.uncertainty.parameters import UncertainParameter
from core.analysis.uncertainty.perturbed_solutions import PerturbedSolutions
from core.deformation.tffd import deform_moving
from core.geometry.mesh import Floats, Points
from core.measurements.uncertain_value import MODEL

DIRECTIONS = {"outward": np.eye(3)[0], "forward": -np.eye(3)[1], "up": np.eye(3)[2]}
"""Directions of the load on the left breast; the right one has the mirrored load."""

_STILL = 1e-9  # a breast whose skin moves no further is not reshaped [mm]


def model_errors(trials: PerturbedSolutions, assumed: InputUncertainty) -> tuple[UncertainParameter, ...]:
    """Return the parameters of the model error; none where no breast is reshaped.

    One standard deviation moves the control point of a breast that yields most by ``model_error_mm``.
    Raises NoEquilibriumError.
    """
    if trials.is_bare:
        return ()
    amplitudes = model_error_mm(trials, assumed)
    if not amplitudes.any():
        return ()
    shifts = _shifts(trials, amplitudes)
    return tuple(UncertainParameter(MODEL, 1.0, name, shift=shift) for name, shift in shifts)


def model_error_mm(trials: PerturbedSolutions, assumed: InputUncertainty) -> Floats:
    """Return the standard deviation of a place of the left and of the right breast, (2,) [mm].

    A share of the rms motion of its skin, at least a floor; 0 for a breast that is not reshaped.
    """
    binding = trials.base.binding
    rest = binding.rest_moving
    moved = deform_moving(binding, trials.points) - rest
    middle = trials.base.control.mesh.vertices[trials.base.control.border_points, 0].mean()
    left = rest[:, 0] > middle
    rms = np.array([np.sqrt(np.mean(np.sum(moved[side] ** 2, axis=1))) for side in (left, ~left)])
    share, least = assumed.of_model(trials.base.design.tissue)
    return np.where(rms > _STILL, np.maximum(share * rms, least), 0.0)


def _shifts(trials: PerturbedSolutions, amplitudes: Floats) -> Iterator[tuple[str, Points]]:
    """Yield each direction and how far control points move by one standard deviation, (n, 3) [mm]."""
    control, answer = trials.base.control, trials.equilibrium
    free = trials.base.model.tensegric.free
    columns = control.column[free]
    for name, direction in DIRECTIONS.items():
        shift = np.zeros_like(trials.points)
        for amplitude, side in zip(amplitudes, (1, -1), strict=True):
            load = np.where((side * columns > 0)[:, None], direction * (side, 1.0, 1.0), 0.0)
            rates = answer.kept(answer.solution.by_forces(-load.reshape(-1, 1)))
            moved = rates.moved.reshape(-1, 3)
            shift[free] += amplitude / np.linalg.norm(moved, axis=1).max() * moved
        # The loads of both breasts overlap: the larger amplitude is that of both together.
        yield name, shift * (amplitudes.max() / np.linalg.norm(shift, axis=1).max())
