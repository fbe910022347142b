"""Stages from a design to a model that can be solved; a stage with equal inputs is reused."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, Literal, TypeVar

import numpy as np

from core.control_mesh.back_length import Back, back_of
from core.control_mesh.fit import ControlMesh, control_mesh_at, fit_control_mesh
from core.control_mesh.halved import halved
from core.control_mesh.straps import Tail
from core.control_mesh.template import read_template
from core.deformation.blend_region import BlendRegion, blend_weights
from core.deformation.changes import CarriedChanges, FrameChanges
from core.deformation.incremental_normals import MovingFaces, moving_faces
from core.deformation.tffd import Binding, Weights, bind, movable_border_triangles
from core.document.cup import Cup
from core.document.design import Design, ScanSource
from core.document.line_notation import with_custom_lines
from core.document.storage.project_file import ScanFile, read_scan_file
from core.errors import FitError, LandmarkError, LineError, TissueError, UserError
from core.geometry.mesh import Floats, Mesh, Points, frozen
from core.landmarks.detect import FINDING, find_landmarks
from core.landmarks.manual import PLACED, PlacedMark, in_mm
from core.landmarks.types import Landmark, Landmarks
from core.mechanics.condensed_tissue import CondensedTissue
from core.mechanics.cup_parts import CupPart
from core.mechanics.gain_limit import gain_limit
from core.mechanics.iteration import LineTargets, Observables
from core.mechanics.model import ConstrainedModel, constrained_model
from core.mechanics.newton import Equilibrium
from core.mechanics.options import ModelOptions
from core.messages import LineName, Message
from core.pipeline.cup_parts import CupLayout
from core.pipeline.elastic_model import solve_elastic_model
from core.pipeline.line_routes import LineRoute, line_routes, strap_tails
from core.pipeline.observables import BodyObservables
from core.progress import Progress, quiet
from core.scan.body import Body, ImplausibleScanError, body_of
from core.scan.edited_body import KEEP_MORE, NO_BUST, apply_edits
from core.scan.source import UNEDITED
from core.tissue.condensed import TissueResponse, condense, with_moved_points
from core.tissue.solid import DENSITY as CONDENSED_DENSITY

SHARES = {
    "read scan": 0.46,
    "edit scan": 0.04,
    "find landmarks": 0.1,
    "fit control mesh": 0.1,
    "bind body": 0.1,
}
"""What part of the time of a build the slow stages take, roughly."""

PARTS = {
    "reading": (0.0, 0.15),
    "rebuilding the surface": (0.15, 0.3),
    "repairing": (0.3, 0.4),
    "finding up and front": (0.4, 0.45),
    "closing holes": (0.45, 0.46),
    "calming the skin": (0.46, 0.5),
    "find landmarks": (0.5, 0.6),
    "tissue": (0.72, 0.74),
}
"""Where each part of the first stages begins and ends, as shares of the time of a build, roughly."""

UNKNOWN = (0.0, 0.5)
"""The same for any other part of reading and editing a scan."""


GAIN_SHARE = 0.97
"""The default conventional gain in parts of the limit at rest: just calm, so that excess makes it vibrate."""

T = TypeVar("T")
Memo = Mapping[str, tuple[tuple[Any, ...], Any]]


@dataclass(frozen=True, eq=False)
class Stages:
    """The results that a design leads to before any turn is made.

    ``fitted`` is the control mesh whose points own lines are named by, which ``control`` may have halved.
    ``backs`` complete the lines of the template to whole bands, ``tails`` own lines to straps; ``routes`` are
    where all of them run at rest. ``tissue`` is what the solid under the skin answers, where the model has
    one. ``balance`` is the exact answer where the elastics of lines were fitted to it. ``gain`` is the
    conventional gain in force, ``gain_limit`` the one at which it begins to vibrate at rest (probe units
    [1]); ``seconds`` what each stage took when it was last made; ``memo`` holds each stage's inputs and
    result for reuse.
    """

    design: Design
    scan: ScanFile
    body: Body
    landmarks: Landmarks
    control: ControlMesh
    fitted: ControlMesh
    patch: BlendRegion
    binding: Binding
    moving: MovingFaces
    watch: BodyObservables
    backs: Mapping[str, Back]
    tails: Mapping[str, Tail]
    routes: Mapping[str, LineRoute]
    model: ConstrainedModel
    balance: Equilibrium | None
    gain_limit: float
    tissue: TissueResponse | None
    seconds: Mapping[str, float]
    memo: Memo

    @property
    def gain(self) -> float:
        """Return the conventional gain in force [probe units]."""
        return GAIN_SHARE * self.gain_limit if self.design.gain is None else self.design.gain

    @cached_property
    def rest_marks(self) -> Observables:
        """Return the observables of the original body."""
        return self.watch(self.control.mesh.vertices)

    def cup_layout(self, cup: Cup) -> CupLayout:
        """Return where cups lie on this body. Raises LineError on a net of cables."""
        return _cup_layout(cup, self.fitted, self.control, self.tissue)

    def shape(self, control_points: Points) -> tuple[Points, Points]:
        """Return places [mm] and normals [1] of ``moving.vertices``, each of shape (r, 3).

        ``control_points`` have shape (n, 3) [mm].
        """
        places = self.binding.places(control_points, self.moving.rest)
        return places, self.moving.normals(places)

    def body_change(self, control_points: Points) -> Floats:
        """Return the volumes that the body's left and right have gained since rest, shape (2,) [mm^3]."""
        return DenseVolumeChange(self.binding, self.moving)(control_points)


@dataclass(frozen=True, eq=False)
class DenseVolumeChange:
    """Tells what the body's left and right have gained [mm^3], (2,), when it follows the control points."""

    binding: Binding
    moving: MovingFaces

    def __call__(self, control_points: Points) -> Floats:
        """Return it for control points, shape (n, 3) [mm]."""
        places = self.binding.places(control_points, self.moving.rest)
        return self.moving.side_volume_changes(places)


class IncompleteBuildError(UserError):
    """A ``body`` was read, and no bust found on it or no control mesh laid: it can be shown and corrected.

    ``kind``: one that is "refused" is shown as it lies in its file, one that is "unsure" may stand otherwise,
    and one of "landmarks" lacks those alone. ``landmarks`` by name were found, or at least placed;
    ``seconds`` and ``memo`` are those of the stages that were made, as in ``Stages``.
    """

    def __init__(self, problem: UserError, body: Body, design: Design, stage: _StageCache) -> None:
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


class _StageCache:
    """Makes stages in order, taking each from the previous build if its inputs are the same."""

    def __init__(self, previous: Stages | IncompleteBuildError | None, progress: Progress) -> None:
        self._old: Memo = previous.memo if previous else {}
        self._old_seconds: Mapping[str, float] = previous.seconds if previous else {}
        self._progress = progress
        self._done = 0.0
        self.memo: dict[str, tuple[tuple[Any, ...], Any]] = {}
        self.seconds: dict[str, float] = {}

    def __call__(self, name: str, make: Callable[..., T], *inputs: Any) -> T:
        begun, self._done = self._done, self._done + SHARES.get(name, 0.02)
        known = self._old.get(name)
        if known is not None and _same(known[0], inputs):
            self.memo[name], self.seconds[name] = known, self._old_seconds[name]
            return known[1]  # type: ignore[no-any-return]
        self._progress(name, begun)
        start = time.perf_counter()
        result = make(*inputs)
        self.seconds[name] = time.perf_counter() - start
        self.memo[name] = (inputs, result)
        return result

    def former(self, name: str) -> Any:
        """Return what a stage made in the previous build, or None."""
        return self._old[name][1] if name in self._old else None

    def landmarks(self, body: Body, design: Design) -> Mapping[str, Landmark]:
        """Return what was found before it went wrong; of landmarks those at least that were placed."""
        if "find landmarks" in self.memo:
            found: Landmarks = self.memo["find landmarks"][1]
            return found.points
        placed = in_mm(design.placed, body.pose.file_to_mm)
        return {name: Landmark(name, place, 1.0, PLACED, by_hand=True) for name, place in placed.items()}

    def inside(self, what: str, share: float) -> None:
        """Hear how far a part of one of the first stages is."""
        start, end = PARTS.get(what, UNKNOWN)
        self._progress(what, start + share * (end - start))


def _same(old: tuple[Any, ...], new: tuple[Any, ...]) -> bool:
    # Arrays are never changed in place: the same array is the same input, without a look at its figures.
    return all(a is b or (not isinstance(a, np.ndarray) and a == b) for a, b in zip(old, new, strict=True))


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
    stage = _StageCache(previous, progress)
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


def _stages(
    stage: _StageCache,
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
    binding = stage("bind body", _bound, body.mesh, control, patch.fade, *weights, tissue)
    middle = float(control.mesh.vertices[control.border_points, 0].mean())
    moving = stage("prepare normals", moving_faces, body.mesh, binding.moving, middle)
    watch = stage("watch body", BodyObservables, binding, control, landmarks)
    backs = stage("measure bands", _backs, body, control)
    laid = stage("lay own lines", with_custom_lines, fitted, design.own_lines)
    if tissue is not None:
        laid = stage("halve own lines", halved, laid, body.smoothed)
    tails = stage("lead straps", strap_tails, body.mesh, laid, design.own_lines, backs)
    routes = stage("trace lines", line_routes, body.mesh, laid, backs, tails)
    lengths = (*({name: part.length for name, part in each.items()} for each in (backs, tails)),)
    solid = None
    if tissue is not None:
        solid = stage("dress solid", solid_tissue, fitted, control, tissue, design.model_options, cups)
    chosen = design.active_lines(), design.model_options, design.line_stiffnesses()
    model, balance = stage("build model", _model, laid, *lengths, *chosen, solid), None
    # A held line has its length, whatever it is made of.
    if design.active_elastics() and design.line_hold == "spring":
        change = stage("follow body", DenseVolumeChange, binding, moving) if design.dense_volume else None
        model, balance = _with_elastics(stage, design, model, change)
    limit = stage("probe gain", gain_limit, model)
    made_of = scan, body, landmarks, control, fitted, patch, binding, moving, watch
    return Stages(
        design, *made_of, backs, tails, routes, model, balance, limit, tissue, stage.seconds, stage.memo
    )


def _fitted(
    stage: _StageCache, design: Design, body: Body, landmarks: Landmarks, control_points: Points | None
) -> ControlMesh:
    template = stage("read template", read_template, design.template)
    if control_points is None:
        return stage("fit control mesh", fit_control_mesh, template, body, landmarks, design.line_height)
    return stage("place control mesh", control_mesh_at, template, control_points)


def _tissue(
    stage: _StageCache, design: Design, body: Mesh, fitted: ControlMesh, near: Stages | None
) -> tuple[ControlMesh, TissueResponse | None]:
    """Return the control mesh, halved where the tissue is solid, and what that answers."""
    if design.tissue != "solid":
        return fitted, None
    control = stage("halve control mesh", halved, fitted, body)
    if near is not None and near.tissue is not None:
        return control, stage("condense tissue", with_moved_points, near.tissue, near.control, control)
    condensed = partial(_condensed, progress=stage.inside)
    return control, stage("condense tissue", condensed, body, fitted, control)


def _with_elastics(
    stage: _StageCache, design: Design, model: ConstrainedModel, change: DenseVolumeChange | None
) -> tuple[ConstrainedModel, Equilibrium]:
    made = design.lines, design.active_elastics(), design.tissue_stiffness, design.line_stiffnesses()
    solve = partial(solve_elastic_model, former=stage.former("fit elastics"))
    fitted = stage("fit elastics", solve, model, *made, change)
    return fitted.model, fitted.balance


def line_targets(design: Design, stages: Stages) -> LineTargets:
    """Return what the design asks of the solver."""
    return LineTargets(
        tuple(design.ratio(line.name) for line in stages.model.lines), design.volume, stages.gain
    )


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
    try:
        return find_landmarks(body, in_mm(placed, body.pose.file_to_mm), progress)
    except LandmarkError as problem:
        if not body.cut or placed:
            raise
        raise LandmarkError(NO_BUST, KEEP_MORE) from problem


def _bound(
    body: Mesh,
    control: ControlMesh,
    fade: Floats,
    weights: Weights,
    scaled_normals: bool,
    tissue: TissueResponse | None,
) -> Binding:
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
