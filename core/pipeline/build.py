"""Stages from a design to a model that can be solved; a stage with equal inputs is reused."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise
from typing import Literal

import numpy as np

from core.control_mesh.back_length import Back, back_of
from core.control_mesh.fit import ControlMesh, control_mesh_at, fit_control_mesh
from core.control_mesh.halved import halved
from core.control_mesh.straps import Tail
from core.control_mesh.template import read_template
from core.deformation.blend_region import blend_weights
from core.deformation.incremental_normals import moving_faces
from core.document.cup import Cup
from core.document.design import Design, ScanSource
from core.document.line_notation import with_custom_lines
from core.document.lines import BUST
from core.document.storage.project_file import ScanFile, read_scan_file
from core.errors import FitError, LandmarkError, LineError, TissueError, UserError
from core.geometry.mesh import Mesh, Points, frozen
from core.landmarks.detect import FINDING, find_landmarks
from core.landmarks.manual import PlacedMark, in_mm
from core.landmarks.types import LOWER_NAMES, Landmark, Landmarks
from core.mechanics.condensed_tissue import CondensedTissue
from core.mechanics.constraint_lines import Line
from core.mechanics.cup_parts import CupPart
from core.mechanics.iteration import Observables
from core.mechanics.options import ModelOptions
from core.messages import Message
from core.pipeline.cup_parts import CupLayout
from core.pipeline.line_routes import LineRoute, line_routes, strap_tails
from core.pipeline.lower_region import LowerStages, lower_stages
from core.pipeline.model_stages import bound, model_stages
from core.pipeline.observables import BodyObservables
from core.pipeline.skin import MovingSkin, alone, joined
from core.pipeline.stages import DenseVolumeChange, Memo, RegionStages, StageCache
from core.progress import Progress, quiet
from core.scan.body import Body, ImplausibleScanError, body_of
from core.scan.edited_body import KEEP_MORE, NO_BUST, apply_edits
from core.scan.source import UNEDITED
from core.tissue.condensed import TissueResponse, condense, with_moved_points
from core.tissue.solid import DENSITY as CONDENSED_DENSITY


@dataclass(frozen=True, eq=False)
class Stages(RegionStages):
    """The results that a design leads to before any turn is made.

    ``skin`` is what all regions move. ``below`` is the lower trunk, if the design has it, or why there is
    none. ``seconds`` is what each stage took when it was last made; ``memo`` holds each stage's inputs and
    result for reuse.
    """

    watch: BodyObservables
    scan: ScanFile
    landmarks: Landmarks
    skin: MovingSkin
    seconds: Mapping[str, float]
    memo: Memo
    below: LowerStages | UserError | None = None

    @property
    def lower(self) -> LowerStages | None:
        """Return the stages of the lower trunk, if the design has it and the scan shows it."""
        return self.below if isinstance(self.below, LowerStages) else None

    @property
    def lower_problem(self) -> UserError | None:
        """Return why there is no lower trunk though the design has it."""
        return self.below if isinstance(self.below, UserError) else None

    @property
    def regions(self) -> tuple[RegionStages, ...]:
        """Return the stages of each region, the bust first."""
        return (self,) if self.lower is None else (self, self.lower)

    @cached_property
    def region_rows(self) -> tuple[slice, ...]:
        """Return which rows belong to each region where the control points of all are one array."""
        ends = np.cumsum([0, *(len(region.control.mesh.vertices) for region in self.regions)]).tolist()
        return tuple(slice(start, end) for start, end in pairwise(ends))

    @cached_property
    def rest_points(self) -> Points:
        """Return the control points of all regions at rest, the bust's first, (n, 3) [mm]."""
        return np.concatenate([region.control.mesh.vertices for region in self.regions])

    def at_lengths(self, design: Design) -> Stages:
        """Return the same stages, asked for the lengths of another ``design``: nothing is built anew."""
        lower = self.lower
        below = self.below if lower is None else replace(lower, design=design.lower_design)
        return replace(self, design=design, below=below)

    def region_of(self, name: str) -> RegionStages:
        """Return the stages of the region that a line belongs to."""
        lower = self.lower
        return lower if lower is not None and name in lower.control.line_names else self

    @property
    def lines(self) -> tuple[Line, ...]:
        """Return the lines of all regions, those of the bust first."""
        return tuple(line for region in self.regions for line in region.model.lines)

    @cached_property
    def all_landmarks(self) -> Mapping[str, Landmark]:
        """Return the landmarks of all regions, by name."""
        return {**self.landmarks.points, **(self.lower.landmarks.points if self.lower else {})}

    @property
    def drawn_lines(self) -> tuple[Line, ...]:
        """Return the lines that are drawn on the body: below the bust those worn, or own ones."""
        if self.lower is None:
            return self.model.lines
        below = self.lower.design
        shown = below.active_lines() | {line.name for line in below.own_lines}
        return (*self.model.lines, *(line for line in self.lower.model.lines if line.name in shown))

    @property
    def all_routes(self) -> Mapping[str, LineRoute]:
        """Return where the lines of all regions run at rest, by name."""
        return {name: route for region in self.regions for name, route in region.routes.items()}

    def bust_height(self, control_points: Points) -> float:
        """Return how high the bust points are in the mean [mm]."""
        return float(self.watch.bust_points(control_points)[:, 2].mean())

    @cached_property
    def rest_marks(self) -> Observables:
        """Return the observables of the original body."""
        return self.watch(self.control.mesh.vertices)

    def cup_layout(self, cup: Cup) -> CupLayout:
        """Return where cups lie on this body. Raises LineError on a net of cables."""
        return _cup_layout(cup, self.fitted, self.control, self.tissue)


class IncompleteBuildError(UserError):
    """A ``body`` was read, and no bust found on it or no control mesh laid: it can be shown and corrected.

    ``kind``: one that is "refused" is shown as it lies in its file, one that is "unsure" may stand otherwise,
    and one of "landmarks" lacks those alone. ``landmarks`` by name were found, or at least placed;
    ``seconds`` and ``memo`` are those of the stages that were made, as in ``Stages``.
    """

    def __init__(self, problem: UserError, body: Body, design: Design, stage: StageCache) -> None:
        super().__init__(problem.message, problem.hint)
        self.body = body
        self.design = design
        self.landmarks = stage.landmarks(body, design)
        self.seconds: Mapping[str, float] = stage.seconds
        self.memo: Memo = stage.memo
        told = body.pose.is_certain or (
            design.scan.up and design.scan.front
        )  # then asking again tells no more
        self.kind: Literal["refused", "unsure", "landmarks"] = "landmarks" if told else "unsure"
        if isinstance(problem, ImplausibleScanError):
            self.kind = "refused"


def build(
    design: Design,
    previous: Stages | IncompleteBuildError | None = None,
    progress: Progress = quiet,
    *,
    control_points: Points | None = None,
    near: Stages | None = None,
) -> Stages:
    """Build everything that precedes solving ``design``; ``progress`` receives the name of each new stage.

    ``previous`` is the last result, whole or incomplete; stages with equal inputs are reused. The control
    mesh is fitted, unless its ``control_points`` (n, 3) [mm] are known. The tissue is condensed, unless its
    landmarks lie ``near`` those of other stages, whose tissue then serves. Raises the UserError of the stage
    that fails, or Cancelled; ``previous`` then remains valid.
    """
    stage = StageCache(previous, progress)
    try:
        source = replace(design.scan, edits=UNEDITED)
        scan, body = stage("read scan", partial(_read_upright, progress=stage.inside), source)
    except ImplausibleScanError as refusal:
        stuck = IncompleteBuildError(refusal, refusal.body, design, stage)
    else:
        try:
            body = stage("edit scan", partial(apply_edits, progress=stage.inside), body, design.scan.edits)
            return _stages(stage, design, scan, body, control_points, near)
        except (LandmarkError, FitError) as problem:
            stuck = IncompleteBuildError(problem, body, design, stage)
    # Raised out here it has no context: what the window keeps would keep all that was read and tried.
    raise stuck


def of_bust_alone(stages: Stages) -> Stages:
    """Return the stages without the lower trunk, for what asks nothing of it."""
    return stages if stages.design.lower is None else build(replace(stages.design, lower=None), stages)


def _stages(
    stage: StageCache,
    design: Design,
    scan: ScanFile,
    body: Body,
    control_points: Points | None,
    near: Stages | None,
) -> Stages:
    landmarks = stage(FINDING, partial(detect_landmarks, progress=stage.inside), body, design.placed)
    fitted = _fitted(stage, design, body, landmarks, control_points)
    control, tissue = _tissue(stage, design, body.smoothed, fitted, near)
    cups = () if design.cup is None else stage("place cups", _cups, design.cup, fitted, control, tissue)
    patch = stage("find patch", blend_weights, body.mesh, control)
    weights = design.weights, design.scaled_normals
    binding = stage("bind body", bound, body.mesh, control, patch.fade, *weights, tissue)
    middle = float(control.mesh.vertices[control.border_points, 0].mean())
    moving = stage("prepare normals", moving_faces, body.mesh, binding.moving, middle)
    watch = stage("watch body", BodyObservables, binding, control, landmarks)
    backs = stage("measure bands", _backs, body, control)
    own = design.lines_of(BUST)
    laid = stage("lay own lines", with_custom_lines, fitted, own)
    if tissue is not None:
        laid = stage("halve own lines", halved, laid, body.smoothed)
    tails = stage("lead straps", strap_tails, body.mesh, laid, own, backs)
    routes = stage("trace lines", line_routes, body.mesh, laid, backs, tails)
    lengths = _lengths(backs), _lengths(tails)
    solid = None
    if tissue is not None:
        solid = stage("dress solid", solid_tissue, fitted, control, tissue, design.model_options, cups)
    change = stage("follow body", DenseVolumeChange, binding, moving) if design.dense_volume else None
    model, balance, limit = model_stages(stage, "", design, laid, lengths, solid, change)
    built = design, body, control, fitted, patch, binding, moving, backs, tails, routes
    solved = model, balance, limit, tissue, watch
    skin, lower = alone(moving, binding), _lower(stage, design, body, landmarks, fitted)
    if isinstance(lower, LowerStages):
        skin = stage("join regions", joined, (moving, binding), (lower.moving, lower.binding))
    return Stages(*built, *solved, scan, landmarks, skin, stage.seconds, stage.memo, lower)


def _lower(
    stage: StageCache, design: Design, body: Body, landmarks: Landmarks, fitted: ControlMesh
) -> LowerStages | UserError | None:
    if design.lower is None:
        return None
    return lower_stages(stage, design.lower_design, design.lower, body, landmarks, fitted)


def _fitted(
    stage: StageCache, design: Design, body: Body, landmarks: Landmarks, control_points: Points | None
) -> ControlMesh:
    template = stage("read template", read_template, design.template)
    if control_points is None:
        return stage("fit control mesh", fit_control_mesh, template, body, landmarks, design.line_height)
    return stage("place control mesh", control_mesh_at, template, control_points)


def _tissue(
    stage: StageCache, design: Design, body: Mesh, fitted: ControlMesh, near: Stages | None
) -> tuple[ControlMesh, TissueResponse | None]:
    """Return the control mesh, halved where the tissue is solid, and what that answers."""
    if design.tissue != "solid":
        return fitted, None
    control = stage("halve control mesh", halved, fitted, body)
    if near is not None and near.tissue is not None:
        return control, stage("condense tissue", with_moved_points, near.tissue, near.control, control)
    condensed = partial(_condensed, progress=stage.inside)
    return control, stage("condense tissue", condensed, body, fitted, control)


def read_body(source: ScanSource, progress: Progress = quiet) -> tuple[ScanFile, Body]:
    """Return a scan as it came and the body read from it, edited.

    Raises ScanError, ProjectError, LandmarkError or Cancelled.
    """
    scan, body = _read_upright(source, progress)
    return scan, apply_edits(body, source.edits, progress)


def _read_upright(source: ScanSource, progress: Progress) -> tuple[ScanFile, Body]:
    scan = read_scan_file(source, progress)
    told = {"unit": source.unit, "up": source.up, "front": source.front}
    return scan, body_of(scan.name, scan.data, **told, progress=progress)


def detect_landmarks(body: Body, placed: tuple[PlacedMark, ...], progress: Progress = quiet) -> Landmarks:
    """Return the landmarks of a body, with those placed by hand. Raises LandmarkError, Cancelled."""
    of_bust = [mark for mark in placed if mark.name not in LOWER_NAMES]
    try:
        return find_landmarks(body, in_mm(of_bust, body.pose.file_to_mm), progress)
    except LandmarkError as problem:
        if not body.cut or of_bust:
            raise
        raise LandmarkError(NO_BUST, KEEP_MORE) from problem


def _lengths(parts: Mapping[str, Back] | Mapping[str, Tail]) -> dict[str, float]:
    return {name: part.length for name, part in parts.items()}


def _backs(body: Body, control: ControlMesh) -> dict[str, Back]:
    return {name: back_of(body.smoothed, control, name) for name in control.paths}


def _condensed(
    body: Mesh, coarse: ControlMesh, fine: ControlMesh, progress: Progress = quiet
) -> TissueResponse:
    """Return what the tissue answers. Raises TissueError on a scan without room for it, Cancelled."""
    try:
        return condense(body, coarse, fine, progress)
    except ValueError as problem:
        raise TissueError(
            Message("Solid tissue cannot be computed: the scan has holes or deep folds at the breasts."),
            Message("Fill the holes at the Scan step, or choose the net as tissue."),
        ) from problem


def _cup_layout(
    cup: Cup, fitted: ControlMesh, control: ControlMesh, tissue: TissueResponse | None
) -> CupLayout:
    if tissue is None:
        raise LineError(
            Message("Cups cannot be computed on the net as tissue."),
            Message("Choose solid tissue, or remove the cups."),
        )
    return CupLayout(cup, fitted, control, tissue.depth)


def _cups(
    cup: Cup, fitted: ControlMesh, control: ControlMesh, tissue: TissueResponse | None
) -> tuple[CupPart, ...]:
    """Return the parts of cups. Raises LineError on a net of cables, and for cups that hold too little."""
    return _cup_layout(cup, fitted, control, tissue).parts()


GRAVITY = {
    "standing": (0.0, 0.0, -1.0),
    "leaning": (0.0, -0.5, -(0.75**0.5)),
    "lying": (0.0, 1.0, 0.0),
    "unloaded": (0.0, 0.0, 0.0),
}
"""Gravity in each posture, in the axes of the body [g]."""


def solid_tissue(
    fitted: ControlMesh,
    control: ControlMesh,
    tissue: TissueResponse,
    mechanics: ModelOptions,
    cups: tuple[CupPart, ...] = (),
    gravity: tuple[float, ...] | None = None,
) -> CondensedTissue:
    """Return the solid under a ``control`` mesh, as soft as its sag tells, in the parts of ``cups``.

    ``fitted`` is the mesh that ``control`` has halved, whose edges tell the strain. ``gravity`` [g] is that
    of its posture unless it is told.
    """
    stiffness, firmer = tissue.stiffness_at(tissue.shear_modulus(mechanics.sag))
    change = np.subtract(gravity or GRAVITY[mechanics.posture], GRAVITY["standing"])
    heavier = mechanics.density / CONDENSED_DENSITY  # and as much stiffer, if it sags as far
    free = np.flatnonzero(~control.fixed)
    edges = fitted.mesh.edges
    return CondensedTissue(
        control.mesh.vertices,
        free,
        edges[~control.fixed[edges].all(axis=1)],
        frozen(heavier * stiffness),
        frozen(heavier * firmer),
        frozen(heavier * (tissue.weight @ change).reshape(-1, 3)),
        mechanics,
        cups,
    )
