"""Volumes of the zones of a region: what lines displaced, and what is taken up inside the body."""

from __future__ import annotations

from dataclasses import dataclass

from core.mechanics.iteration import SolverState
from core.pipeline.stages import RegionStages


@dataclass(frozen=True)
class ZoneVolume:
    """The volume of a zone ``name`` beside the original one.

    ``kept`` [1] is the share of the displaced volume that stays under the skin, ``change_ml`` [ml] what the
    zone gained under the skin, ``error_ml`` [ml] what it has beyond what it is to have.
    """

    name: str
    kept: float
    change_ml: float
    error_ml: float

    @property
    def taken_up_ml(self) -> float:
        """Return what is assumed to have moved inside the body [ml]; no skin shows it."""
        return self.error_ml - self.change_ml


def zone_volumes(stages: RegionStages, state: SolverState) -> tuple[ZoneVolume, ...]:
    """Return the volumes of the zones of a region in a state, none where zones are not held separately."""
    model, volume = stages.model, stages.model.volume
    if not volume.separate:
        return ()
    points = model.tensegric.expand(state.moved)
    gained = (volume.zone_volumes(points) - model.rest_zones) / 1000.0
    off = model.zone_errors(points, state.pressure.value) * volume.rest_volume / 1000.0
    figures = zip(stages.control.zone_names, volume.kept, gained, off, strict=True)
    return tuple(ZoneVolume(name, *map(float, numbers)) for name, *numbers in figures)
