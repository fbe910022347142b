"""Compare the model with reference cases: error, rise of the bust points, and limits of both."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from importlib import resources
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from core.analysis.model_check.reference_case import STANDING, ReferenceCase
from core.deformation.tffd import deform
from core.document.design import Design, ScanSource
from core.document.lines import CustomLine
from core.errors import UserError
from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Flags, Floats, Points
from core.mechanics.condensed_tissue import CondensedTissue
from core.mechanics.model import assemble
from core.messages import Message
from core.pipeline.build import Stages, build, solid_tissue
from core.pipeline.solve import NoEquilibriumError, exact_equilibrium
from core.tissue.condensed import TissueResponse

ERROR_LIMITS = {"weight": 0.15, "sling": 0.25, "mid-bust": 0.40, "cup": 0.30, "other": 0.40}
"""Largest error by kind of case, as rms of the difference over rms of the reference [1]; ours."""

RISE_LIMIT_MM, RISE_LIMIT = 0.5, 0.15
"""Largest error of the mean rise round a bust point: the larger of both, the latter of the reference [1]."""

DISC_MM = 20.0
"""Nodes nearer to a bust point than this make up its disc: single nodes under a band are less certain."""

MOVABLE_MM = 6.0
"""Nodes further than this from skin that can move are not compared."""

SAME_MM = 1e-9
"""Control points that are no further apart are the same, stored by fits on two machines."""

NO_WEIGHT = Message("This model has no weight: it does not respond to gravity.")
NO_CUPS = Message("This model has no cups.")


@dataclass(frozen=True)
class Rise:
    """The mean rise of the nodes round a bust point by the ``model`` and by the ``reference`` [mm]."""

    model: float
    reference: float

    @property
    def passed(self) -> bool:
        """Return whether both are near enough."""
        return abs(self.model - self.reference) <= max(RISE_LIMIT_MM, RISE_LIMIT * abs(self.reference))


@dataclass(frozen=True)
class CaseComparison:
    """How far the model is from a reference case.

    ``rms_mm`` is that of the difference, ``reference_rms_mm`` that of the reference; ``left`` and ``right``
    are the rises round the bust points, ``largest_mm`` is the largest difference of a node and
    ``largest_at`` its place [mm]. Of the nodes ``compared`` are, and ``left_out`` are not.
    """

    case: str
    kind: str
    rms_mm: float
    reference_rms_mm: float
    left: Rise
    right: Rise
    largest_mm: float
    largest_at: tuple[float, ...]
    compared: int
    left_out: int
    notes: tuple[Message, ...] = ()

    @property
    def ratio(self) -> float:
        """Return the error: the rms of the difference over that of the reference [1]."""
        return self.rms_mm / self.reference_rms_mm

    @property
    def limit(self) -> float:
        """Return the largest error allowed [1]."""
        return ERROR_LIMITS[self.kind]

    @property
    def passed(self) -> bool:
        """Return whether error and rises are within their limits."""
        return self.ratio <= self.limit and self.left.passed and self.right.passed


def check_model(
    cases: Iterable[ReferenceCase], design: Design, bodies: Path | None = None
) -> Iterator[CaseComparison]:
    """Compare the model of ``design`` with each case; its scan, template and lines are those of the case.

    Bodies are looked for beside the case, among the samples, then in the folder ``bodies``. Raises UserError
    if one is not found, or a case cannot be solved.
    """
    former = stages = None
    for each in cases:
        former = case = each if former is None else _on_points_of(each, former)
        stages = case_stages(case, design, body_file(case, bodies), stages)
        yield compare(case, stages)


def _on_points_of(case: ReferenceCase, former: ReferenceCase) -> ReferenceCase:
    """Return ``case`` on the very control points of ``former`` if these are its: stages know them again."""
    own, points = case.control_points, former.control_points
    alike = own.shape == points.shape and np.abs(own - points).max() < SAME_MM
    return replace(case, control_points=points) if alike else case


def body_file(case: ReferenceCase, bodies: Path | None = None) -> Path:
    """Return the file of the body of a case. Raises UserError if there is none."""
    folders = [case.folder, Path(str(resources.files("resources") / "samples")), *filter(None, [bodies])]
    for folder in folders:
        if (folder / case.body).is_file():
            return folder / case.body
    raise UserError(
        Message(
            "The body {file} of the reference case {case} was not found.", file=case.body, case=case.name
        ),
        Message("Put the file beside the case, or specify its folder: --bodies FOLDER."),
    )


def case_stages(case: ReferenceCase, design: Design, body: Path, previous: Stages | None = None) -> Stages:
    """Return the stages of ``design`` on a case: its body, its control mesh, lines and cups.

    The control mesh is the stored one, so that no difference comes from another fit. A net has no cups.
    """
    # A file beside a case needs no recognition: its unit and axes are those of the case.
    scan = ScanSource(str(body), unit="mm", up="+z", front="-y")
    cup = case.cup if design.tissue == "solid" else None
    design = replace(design, scan=scan, template=case.template, cup=cup)
    for number, points in enumerate(case.lines, 1):
        line = CustomLine(f"reference {number}", points)
        design = design.with_custom_line(line).with_line(line.name, case.ratio)
    stages = build(design, previous, control_points=case.control_points)
    return stages if stages.tissue is None else _on_solid(case, stages, stages.tissue)


def _on_solid(case: ReferenceCase, stages: Stages, tissue: TissueResponse) -> Stages:
    """Return stages whose solid has the modulus, the gravity and the newtons of the lines of a case."""
    model, sag = stages.model, tissue.rise / case.shear_modulus_kpa
    options = replace(stages.design.model_options, sag=sag)
    assert isinstance(model.tensegric, CondensedTissue)
    cups = model.tensegric.cups
    solid = solid_tissue(stages.fitted, stages.control, tissue, options, cups, case.gravity)
    own = {
        line.name: case.line_stiffness_n / (solid.mean_stiffness * line.spacing)
        for line in model.lines
        if line.name in stages.design.active_lines()
    }
    made = assemble(solid, model.lines, model.volume, stages.design.active_lines(), own)
    return replace(stages, model=made, balance=None)


def control_displacement(case: ReferenceCase, stages: Stages) -> tuple[Points, tuple[Message, ...]]:
    """Return how far the model moves the control points in a case, (c, 3) [mm], and what it leaves out.

    Raises NoEquilibriumError. The net has neither weight nor cups.
    """
    balance = exact_equilibrium(stages)
    if not balance.is_converged:
        raise NoEquilibriumError(stages.design)
    moved = stages.model.tensegric.expand(balance.state.moved) - stages.control.mesh.vertices
    lacking = {NO_WEIGHT: case.gravity != STANDING, NO_CUPS: case.cup is not None}
    return moved, tuple(note for note, lacks in lacking.items() if lacks and stages.tissue is None)


def compare(case: ReferenceCase, stages: Stages) -> CaseComparison:
    """Compare the model with a case at its nodes. Raises UserError."""
    moved, notes = control_displacement(case, stages)
    used = _movable(case, stages)
    rest, reference = case.rest[used], case.displacement[used]
    model = _at_nodes(stages, moved, rest)
    off = np.linalg.norm(model - reference, axis=1)
    left, right = (_rise(case, rest, model, reference, at) for at in case.bust_points)
    return CaseComparison(
        case.name,
        case.kind,
        _rms(off),
        _rms(np.linalg.norm(reference, axis=1)),
        left,
        right,
        float(off.max()),
        tuple(rest[off.argmax()].tolist()),
        len(rest),
        len(case.rest) - len(rest),
        notes,
    )


def _rise(case: ReferenceCase, rest: Points, model: Points, reference: Points, bust_point: Floats) -> Rise:
    """Return the mean rises of the nodes ``rest`` round a bust point, all (n, 3) [mm]. Raises UserError."""
    disc = np.linalg.norm(rest - bust_point, axis=1) < DISC_MM
    if not disc.any():
        raise UserError(
            Message("The reference case {case} has no nodes near a bust point.", case=case.name),
            Message("Choose another case."),
        )
    return Rise(float(model[disc, 2].mean()), float(reference[disc, 2].mean()))


def _movable(case: ReferenceCase, stages: Stages) -> Flags:
    """Return which nodes of a case are near skin that can move, (n,). Raises UserError if few are."""
    tree = cKDTree(stages.binding.rest_moving)
    used = np.asarray(tree.query(case.rest)[0] <= MOVABLE_MM)
    if 2 * int(used.sum()) < len(used) or not case.displacement[used].any():
        raise UserError(
            Message(
                "The nodes of the reference case {case} are not on the skin of {file}.",
                case=case.name,
                file=case.body,
            ),
            Message("Check that the file is the body on which this case was computed."),
        )
    return used


def _at_nodes(stages: Stages, moved: Points, nodes: Points) -> Points:
    """Return how far ``nodes`` of the skin, (n, 3) [mm], move when control points are ``moved``, (n, 3)."""
    body, binding = stages.body.mesh, stages.binding
    shift = deform(binding, stages.control.mesh.vertices + moved) - body.vertices
    faces, places = nearest_faces(body, nodes)
    corners = body.faces[faces]
    weights = barycentric(body.vertices[corners], places)
    return np.asarray(np.einsum("kc,kcx->kx", weights, shift[corners]))


def _rms(lengths: Floats) -> float:
    return float(np.sqrt(np.mean(lengths**2)))
