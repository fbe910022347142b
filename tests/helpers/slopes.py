"""Derivatives by differences, and stages in which differences feel no round-off of single precision."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from core.deformation.tffd import bind
from core.pipeline.build import Stages
from core.pipeline.observables import BodyObservables


def slope(values: Callable[[float], np.ndarray | float], step: float = 0.01) -> np.ndarray:
    """The derivative at 0, of fourth order."""
    one, two = (np.asarray(values(at)) - np.asarray(values(-at)) for at in (step, 2.0 * step))
    return np.asarray((8.0 * one - two) / (12.0 * step))


def doubled(stages: Stages) -> Stages:
    """The same stages with the body bound in double precision."""
    control = stages.control
    binding = bind(stages.body.mesh, control.mesh, stages.patch.fade, fixed=control.fixed)
    return replace(stages, binding=binding, watch=BodyObservables(binding, control, stages.landmarks))
