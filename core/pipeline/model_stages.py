"""Stages that every region has: binding of the body, the model with its elastics, what is asked of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numpy as np

from core.control_mesh.fit import ControlMesh
from core.deformation.changes import CarriedChanges, FrameChanges
from core.deformation.tffd import Binding, Weights, bind, movable_border_triangles
from core.document.design import Design
from core.errors import FitError, LineError
from core.geometry.mesh import Floats, Mesh
from core.mechanics.condensed_tissue import CondensedTissue
from core.mechanics.gain_limit import gain_limit
from core.mechanics.iteration import LineTargets
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.newton import Equilibrium
from core.mechanics.options import ModelOptions
from core.messages import LineName, Message
from core.pipeline.elastic_model import solve_elastic_model
from core.pipeline.stages import DenseVolumeChange, RegionStages, StageCache
from core.tissue.condensed import TissueResponse


def bound(
    body: Mesh,
    control: ControlMesh,
    fade: Floats,
    weights: Weights,
    scaled_normals: bool,
    tissue: TissueResponse | None,
) -> Binding:
    """Return how the ``body`` follows control points where ``fade`` (v,) says so, or their ``tissue``."""
    if tissue is None:
        return _bind(body, control, fade, weights, scaled_normals)
    return _bind_to_tissue(body, control, fade, tissue)


def _bind(body: Mesh, control: ControlMesh, fade: Floats, weights: Weights, scaled_normals: bool) -> Binding:
    loose = len(movable_border_triangles(control.mesh, control.fixed))
    if loose:
        raise FitError(
            Message("Movable triangles at the border of the control mesh: {count}.", count=loose),
            Message("Choose a template with two fixed outer rings of points."),
        )
    # Single precision is exact to 1e-4 mm here, far below what a scan resolves, and read in half the time.
    return bind(
        body,
        control.mesh,
        fade,
        weights,
        scaled_normals=scaled_normals,
        fixed=control.fixed,
        single=True,
    )


def _bind_to_tissue(body: Mesh, control: ControlMesh, fade: Floats, tissue: TissueResponse) -> Binding:
    within = np.flatnonzero(fade > 0.0)
    follow = np.zeros_like(fade)
    follow[within] = tissue.fade(body.vertices[within])
    to_skin = bind(body, tissue.skin, follow, fixed=tissue.still, single=True)
    assert isinstance(to_skin.changes, FrameChanges)
    free = np.flatnonzero(~control.fixed)
    carried = CarriedChanges(to_skin.changes, control.mesh.vertices, free, tissue.nodes, tissue.carried)
    return replace(to_skin, changes=carried)


def model_stages(
    stage: StageCache,
    where: str,
    design: Design,
    control: ControlMesh,
    lengths: tuple[Mapping[str, float], Mapping[str, float]],
    solid: CondensedTissue | None = None,
    change: DenseVolumeChange | None = None,
) -> tuple[ConstrainedModel, Equilibrium | None, float]:
    """Return the model of a region, its answer if elastics were fitted to it, and its gain limit [1].

    ``where`` sets names of stages apart, ``lengths`` [mm] are those of backs and tails of lines, ``change``
    tells the volume of the body where that is to be kept. Raises LineError for lines that it cannot have.
    """
    worn, mechanics, own = design.active_lines(), design.model_options, design.line_stiffnesses()
    model = stage(f"build {where}model", _model, control, *lengths, worn, mechanics, own, solid)
    balance = None
    # A held line has its length, whatever it is made of.
    if design.active_elastics() and design.line_hold == "spring":
        name = f"fit {where}elastics"
        solve = partial(solve_elastic_model, former=stage.former(name))
        made = design.lines, design.active_elastics(), design.tissue_stiffness, own
        fitted = stage(name, solve, model, *made, change)
        model, balance = fitted.model, fitted.balance
    return model, balance, stage(f"probe {where}gain", gain_limit, model)


def _model(
    control: ControlMesh,
    backs: Mapping[str, float],
    tails: Mapping[str, float],
    worn: frozenset[str],
    mechanics: ModelOptions,
    own_stiffness: Mapping[str, float],
    solid: CondensedTissue | None,
) -> ConstrainedModel:
    unknown = sorted(worn - set(control.line_names))
    if unknown:
        raise LineError(
            Message("There is no line '{line}'.", line=LineName(unknown[0])),
            Message("Available lines: {lines}.", lines=", ".join(control.line_names)),
        )
    if solid is not None and mechanics.line_contact == "sliding":
        raise LineError(
            Message("Sliding lines cannot be computed on solid tissue."),
            Message("Choose bonded lines, or the net as tissue."),
        )
    return constrained_model(
        control,
        worn=worn,
        back_lengths=backs,
        tail_lengths=tails,
        mechanics=mechanics,
        own_stiffness=own_stiffness,
        solid=solid,
    )


def line_targets(design: Design, stages: RegionStages) -> LineTargets:
    """Return what the design asks of the solver."""
    return LineTargets(
        tuple(design.ratio(line.name) for line in stages.model.lines), design.volume, stages.gain
    )
