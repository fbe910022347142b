"""Derivatives by differences, and stages in which differences feel no round-off of single precision."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from core.deformation.tffd import Binding, bind
from core.pipeline.build import Stages
from core.pipeline.observables import BodyObservables
from core.pipeline.stages import RegionStages


def slope(values: Callable[[float], np.ndarray | float], step: float = 0.01) -> np.ndarray:
    """The derivative at 0, of fourth order."""
    one, two = (np.asarray(values(at)) - np.asarray(values(-at)) for at in (step, 2.0 * step))
    return np.asarray((8.0 * one - two) / (12.0 * step))


def doubled(stages: Stages) -> Stages:
    """The same stages with the body bound in double precision."""
    control, lower = stages.control, stages.lower
    binding = _bound(stages)
    below = stages.below if lower is None else replace(lower, binding=_bound(lower))
    watch = BodyObservables(binding, control, stages.landmarks)
    return replace(stages, binding=binding, watch=watch, below=below)


def _bound(stages: RegionStages) -> Binding:
    control = stages.control
    return bind(stages.body.mesh, control.mesh, stages.patch.fade, fixed=control.fixed)
