"""The stages of the lower trunk: landmarks, control mesh, binding and model."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from core.control_mesh.fit import ControlMesh
from core.control_mesh.lower_fit import fit_lower_mesh
from core.control_mesh.lower_template import LowerTemplate, read_lower_template
from core.deformation.blend_region import blend_weights
from core.deformation.incremental_normals import moving_faces
from core.document.design import Design
from core.document.line_notation import with_custom_lines
from core.document.lower_trunk import LowerTrunk
from core.errors import FitError, LandmarkError, UserError
from core.geometry.mesh import Points, frozen
from core.landmarks.lower_trunk.detect import find_lower_landmarks
from core.landmarks.lower_trunk.types import LowerLandmarks
from core.landmarks.manual import PlacedMark, in_mm
from core.landmarks.types import LOWER_NAMES, Landmarks
from core.pipeline.line_routes import line_routes
from core.pipeline.model_stages import bound, model_stages
from core.pipeline.stages import RegionStages, StageCache
from core.progress import Progress, quiet
from core.scan.body import Body

WAIST_ZONE = "waist"
"""The zone whose share of kept volume a design sets."""


@dataclass(frozen=True, eq=False)
class LowerStages(RegionStages):
    """The stages of the lower trunk, with its ``landmarks``. ``design`` is what is decided of it.

    ``bust_level`` [mm] is that of the body at rest.
    """

    landmarks: LowerLandmarks
    bust_level: float

    def bust_height(self, control_points: Points) -> float:
        """Return how high the bust points are at rest [mm]: the lower trunk does not move them."""
        return self.bust_level


def lower_stages(
    stage: StageCache, design: Design, lower: LowerTrunk, body: Body, bust: Landmarks, upper: ControlMesh
) -> LowerStages | UserError:
    """Return the stages of the lower trunk of a ``body``, by ``stage``, or why there are none.

    ``design`` is that of the region, see ``Design.lower_design``; ``upper`` is the control mesh of the bust,
    whose lowest rows the lower mesh joins. Raises LineError for lines that it cannot have.
    """
    detect = partial(detect_lower_landmarks, progress=stage.inside)
    landmarks = stage("find lower landmarks", detect, body, bust, design.placed)
    if isinstance(landmarks, UserError):
        return landmarks
    template = stage("read lower template", read_lower_template)
    fitted = stage("fit lower mesh", _fitted, template, body, landmarks, bust, upper, lower.belly_height)
    if isinstance(fitted, UserError):
        return fitted
    kept = stage("keep lower volumes", _keeping, fitted, lower.waist_kept)
    patch = stage("find lower patch", blend_weights, body.mesh, fitted)
    weights = design.weights, design.scaled_normals
    binding = stage("bind lower body", bound, body.mesh, fitted, patch.fade, *weights, None)
    middle = float(fitted.mesh.vertices[fitted.border_points, 0].mean())
    moving = stage("prepare lower normals", moving_faces, body.mesh, binding.moving, middle)
    control = stage("lay own lower lines", with_custom_lines, kept, design.own_lines)
    routes = stage("trace lower lines", line_routes, body.mesh, control, {}, {})
    model, balance, limit = model_stages(stage, "lower ", design, control, ({}, {}))
    made = control, fitted, patch, binding, moving
    return LowerStages(
        design, body, *made, {}, {}, routes, model, balance, limit, None, None, landmarks, bust.bust_level
    )


def detect_lower_landmarks(
    body: Body, bust: Landmarks, placed: tuple[PlacedMark, ...], progress: Progress = quiet
) -> LowerLandmarks | UserError:
    """Return the landmarks of the lower trunk, with those placed by hand, or why there are none."""
    own = tuple(mark for mark in placed if mark.name in LOWER_NAMES)
    try:
        return find_lower_landmarks(body, bust, in_mm(own, body.pose.file_to_mm), progress)
    except LandmarkError as problem:
        return problem.with_traceback(None)  # a value like any other: it is not tried anew at each build


def _fitted(
    template: LowerTemplate,
    body: Body,
    landmarks: LowerLandmarks,
    bust: Landmarks,
    upper: ControlMesh,
    belly_height: float,
) -> ControlMesh | UserError:
    level = bust.underbust_level
    try:
        return fit_lower_mesh(template, body, landmarks, upper, underbust=level, belly_height=belly_height)
    except FitError as problem:
        return problem.with_traceback(None)


def _keeping(control: ControlMesh, waist: float) -> ControlMesh:
    """Return a control mesh whose waist zone keeps a share of the volume that lines displace there [1]."""
    assert control.kept is not None
    at_waist = np.array(control.zone_names) == WAIST_ZONE
    return replace(control, kept=frozen(np.where(at_waist, waist, control.kept)))
