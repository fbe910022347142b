"""The control mesh: the template fitted to a body, so that its points lie on the skin (paper section 2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from core.control_mesh.embedding import EmbeddedCurve, Grid
from core.control_mesh.fitting_frame import FittingFrame, fit_frame
from core.control_mesh.fold_rows import Crease, find_creases
from core.control_mesh.lower_template import trunk_grid
from core.control_mesh.projection import project_border, project_interior, project_line
from core.control_mesh.quality import FitQuality, measure_fit
from core.control_mesh.relaxation import relax
from core.control_mesh.template import Template
from core.control_mesh.validation import Faults, find_mesh_faults
from core.errors import FitError
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points
from core.landmarks.types import Landmarks
from core.messages import Message, SideName
from core.scan.body import Body

MOST_HOLES = 0.5
"""A scan that lacks more than this part of a breast, or of all that the template lies on, is refused."""

BUST, LOWER = "bust", "lower"
"""The regions that a control mesh may cover."""

LINE_HEIGHTS = (0.25, 0.75)
"""Where the line row may run between fold (0) and bust point (1)."""


@dataclass(frozen=True, eq=False)
class ControlMesh:
    """The template on a body: control points at rest and triangles, wound outward.

    ``fixed`` (n,) tells the points that do not move; ``row`` and ``column`` (n,) are their places in the
    template, column 0 the centre, positive the subject's left. ``paths`` are the control points of each named
    line from right (-x) to left, a closed one from its first point round to this; ``embedded`` the vertices
    of lines that run between control points; ``apexes`` those at the foremost places of both sides,
    (left, right): the bust points, in the lower region the buttock points. ``borders`` are the border loops
    in order, each (b,), ``warnings`` what the user should know of the fit, ``quality`` its figures.
    ``anchored`` (n,) are points at which bands are held in space though the skin may move there, if there are
    any.

    ``region`` is "bust" or "lower". Where the template tells it, ``zone`` (m,) is the number of each
    triangle's zone in ``zone_names``, ``kept`` [1] the part of its displaced volume that each zone keeps, and
    ``depth`` (n,) [mm] that of the tissue under each point. ``inner_points`` are points far from the borders
    beside the apexes, one in each part that a flood from these might not reach.
    """

    mesh: Mesh
    fixed: Flags
    row: Indices
    column: Indices
    paths: Mapping[str, tuple[int, ...]]
    apexes: tuple[int, int]
    borders: tuple[Indices, ...]
    warnings: tuple[Message, ...]
    quality: FitQuality | None = None
    embedded: Mapping[str, EmbeddedCurve] = field(default_factory=dict)
    anchored: Flags | None = None
    region: str = BUST
    zone: Indices | None = None
    zone_names: tuple[str, ...] = ()
    kept: Floats | None = None
    depth: Floats | None = None
    inner_points: tuple[int, ...] = ()

    @property
    def bust_points(self) -> tuple[int, int]:
        """Return the control points at the bust points, (left, right). Raises ValueError in the lower one."""
        if self.region != BUST:
            raise ValueError(f"a control mesh of region {self.region}, not {BUST}")
        return self.apexes

    @property
    def seeds(self) -> tuple[int, ...]:
        """Return points from which all that the control mesh covers is reached without crossing a border."""
        return *self.apexes, *self.inner_points

    @property
    def border_points(self) -> Indices:
        """Return the points of all borders, loop after loop, (b,)."""
        return np.concatenate([np.empty(0, dtype=np.int64), *self.borders])

    @property
    def held(self) -> Flags:
        """Return the points at which lines are held in space, (n,): those that are anchored or fixed."""
        return self.fixed if self.anchored is None else self.anchored | self.fixed

    @property
    def grid(self) -> Grid:
        """Return rows, columns and triangles of the points; of legs none."""
        if self.region == LOWER:
            return trunk_grid(self.row, self.column, self.mesh.faces)
        return Grid(self.row, self.column, self.mesh.faces)

    def upper_end(self, name: str) -> Floats:
        """Return the weights of the control points, (n,), of the last vertex of a line."""
        if name in self.embedded:
            return np.asarray(self.embedded[name].weights[[-1]].toarray()[0])
        return np.asarray(np.arange(len(self.row)) == self.paths[name][-1], dtype=np.float64)

    @property
    def line_names(self) -> tuple[str, ...]:
        """Return the names of all lines, those through control points first."""
        return *self.paths, *self.embedded


def fit_control_mesh(
    template: Template, body: Body, landmarks: Landmarks, line_height: float = 0.5
) -> ControlMesh:
    """Fit ``template`` to ``body`` so that its rows follow the breasts (paper section 2; the recipe is ours).

    ``line_height`` [1] is where the mid-bust line runs on the skin between fold (0) and bust point (1).
    Raises FitError if no sound mesh lies on this body with these landmarks.
    """
    _refuse_line_height(line_height)
    ground = fit_frame(template, body.smoothed, landmarks)
    outline, holes = project_border(ground, landmarks)
    creases, lacking, holed = find_creases(ground, outline, landmarks)
    lost = [*lacking, *holed]
    tries: list[_Candidate] = []
    while True:
        tries += _candidates(ground, outline, creases, holed, line_height, lost)
        best = min(tries, key=lambda one: one.weight)
        faulty = template.faces[tries[-1].faults.any | tries[-1].half_way.any]
        blamed = set(template.column[faulty].ravel().tolist()) & set(creases)
        if best.sound or not blamed:
            break
        # below the bust point a landmark tells of the fold: that column gives its fold up last
        shallowest = min(blamed, key=lambda at: (abs(at) == template.bust_column, creases[at].depth))
        del creases[shallowest]
        lost = [*lost, shallowest]
    holes = holes | best.holes
    _refuse_holes(template, holes)
    _refuse_folded(int(best.faults.folded.sum()))
    quality = measure_fit(best.mesh, ground.skin, *_off_landmarks(template, best.mesh, landmarks))
    warnings = [*_fold_warnings(best.lost), *_arm_warning(ground), *_hole_warning(int(holes.sum()))]
    return replace(
        control_mesh_at(template, best.mesh.vertices),
        warnings=(*warnings, *quality.warnings),
        quality=quality,
    )


def _refuse_line_height(line_height: float) -> None:
    low, high = LINE_HEIGHTS
    if not low <= line_height <= high:
        raise FitError(
            Message("The mid-bust line height {height} is out of range.", height=f"{line_height:g}"),
            Message("Enter a value from {low} to {high}.", low=f"{low:g}", high=f"{high:g}"),
        )


def _refuse_folded(count: int) -> None:
    if count:
        raise FitError(
            Message("Folded triangles in the control mesh on this body: {count}.", count=count),
            Message("Correct the bust points and inframammary folds, or choose the other template."),
        )


@dataclass(frozen=True, eq=False)
class _Candidate:
    """One way to lay the template, where it has no skin, and in which columns it ``lost`` the fold.

    ``faults`` are its own, ``half_way`` those that it has when the line row runs half way: they choose among
    the ways to lay, so that the line height moves the line row alone.
    """

    mesh: Mesh
    faults: Faults
    half_way: Faults
    holes: Flags
    lost: list[int]

    @property
    def weight(self) -> tuple[int, ...]:
        """Return how bad it is: to be compared."""
        return int(self.faults.folded.sum()), *self.half_way.weight, *self.faults.weight

    @property
    def sound(self) -> bool:
        """Return whether nothing else needs to be tried."""
        return not (self.faults.folded.any() or self.half_way.any.any())


def _candidates(
    ground: FittingFrame,
    outline: Points,
    creases: Mapping[int, Crease],
    holed: list[int],
    line_height: float,
    lost: list[int],
) -> list[_Candidate]:
    """Lay all points, eased where triangles are pointed; where that brings faults, eased less and less.

    All but the line row is eased as if that ran half way, so that it alone moves with ``line_height``.
    """
    template = ground.template
    fold, line, bust = (template.row_of(rule) for rule in ("fold", "line", "bust point"))
    laid, holes = project_interior(ground, outline, creases, holed)
    laid[line], holes[line] = project_line(ground, laid, creases, 0.5)
    level, upright = _free_ways(template, creases)
    found = []
    smoothest = relax(laid, template.faces, ground.skin, level, upright)
    for share in (1.0,) if smoothest is laid else (1.0, 0.75, 0.5, 0.25, 0.0):
        way = smoothest if share == 1.0 else laid + share * (smoothest - laid)
        off = (way != laid).any(axis=2) & (share < 1.0)
        way[off] = ground.skin.project(way[off]) if off.any() else way[off]
        mesh, half_way = _evaluate(ground, way)
        faults = half_way
        if line_height != 0.5:
            points = way.copy()
            points[line], holes[line] = project_line(ground, laid, creases, line_height)
            shift = way[[fold, bust]] - laid[[fold, bust]]
            along = shift[0] + line_height * (shift[1] - shift[0])
            slid = along.any(axis=1)
            points[line, slid] = ground.skin.project(points[line, slid] + along[slid])
            only = (np.arange(len(points)) == line)[:, None]
            smooth = relax(points, template.faces, ground.skin, level & only, upright & only)
            judged = [_evaluate(ground, smooth), _evaluate(ground, points)]
            mesh, faults = min(judged, key=lambda one: one[1].weight)
        found.append(_Candidate(mesh, faults, half_way, holes, lost))
        if found[-1].sound:
            break
    return found


def _evaluate(ground: FittingFrame, points: Points) -> tuple[Mesh, Faults]:
    """Return the control mesh at ``points``, shape (rows, columns, 3) [mm], and what is at fault with it."""
    template = ground.template
    mesh = Mesh(points.reshape(-1, 3), template.faces)
    return mesh, find_mesh_faults(mesh, ground.skin, template.row == template.row_of("fold"))


def _free_ways(template: Template, creases: Mapping[int, Crease]) -> tuple[Flags, Flags]:
    """Return which points may slide along their row, and which along their column, shape (rows, columns).

    The bust points and the centre column stay, the bust row stays level, folds stay folds, and the line keeps
    its height under the bust points.
    """
    shape = len(template.rows), 2 * template.half + 1
    column, row = template.column.reshape(shape), template.row.reshape(shape)
    bust, fold, line = (row == template.row_of(rule) for rule in ("bust point", "fold", "line"))
    level = (column != 0) & (np.abs(column) < template.half)
    below = np.abs(column) == template.bust_column
    level &= ~(bust & below)
    sharp = [number for number in creases if template.columns[abs(number)].fold == "crease"]
    return level, ~bust & ~(fold & np.isin(column, sharp)) & ~(line & below)


def _off_landmarks(template: Template, mesh: Mesh, landmarks: Landmarks) -> tuple[Flags, float, float]:
    """Return which points are in the fold row, (n,), and how far bust points and folds are off [mm]."""
    fold = template.row == template.row_of("fold")
    bust_off, fold_off = 0.0, 0.0
    for side, sign in (("left", 1), ("right", -1)):
        column = sign * template.bust_column
        bust, below = (
            mesh.vertices[template.point(template.row_of(rule), column)] for rule in ("bust point", "fold")
        )
        bust_off = max(bust_off, float(np.linalg.norm(bust - landmarks.position(f"bust_point_{side}"))))
        fold_off = max(fold_off, abs(float(below[2] - landmarks.position(f"fold_{side}")[2])))
    return fold, bust_off, fold_off


def _refuse_holes(template: Template, holes: Flags) -> None:
    free = template.free.reshape(holes.shape)
    column = template.column.reshape(holes.shape)
    sides = [holes[free & (sign * column > 0)].mean() for sign in (1, -1)]
    if max(sides) > MOST_HOLES or holes.mean() > MOST_HOLES:
        raise FitError(
            Message(
                "The scan is incomplete: no surface at {missing} of {all} control points.",
                missing=int(holes.sum()),
                all=holes.size,
            ),
            Message(
                "Fill the holes in the scan, or open a scan that extends from the ribs to the collarbones."
            ),
        )


def _hole_warning(count: int) -> list[Message]:
    if count == 0:
        return []
    return [
        Message(
            "The scan has holes at {count} control points: their positions are interpolated from "
            "adjacent points and the opposite side.",
            count=count,
        )
    ]


def _arm_warning(ground: FittingFrame) -> list[Message]:
    if ground.torso.armpit >= max(ground.torso.left.bust, ground.torso.right.bust):
        return []
    return [Message("The arms touch the body below the bust points: the sides of the mesh may cover an arm.")]


def _fold_warnings(lost: list[int]) -> list[Message]:
    sides = [side for side, sign in (("left", 1), ("right", -1)) if any(sign * number > 0 for number in lost)]
    return [
        Message(
            "The inframammary fold of the {side} breast is only partly detectable: the height of "
            "some control points is estimated.",
            side=SideName(side),
        )
        for side in sides
    ]


def control_mesh_at(template: Template, points: Points) -> ControlMesh:
    """Return the control mesh of a template with its control points at ``points``, shape (n, 3) [mm]."""
    mesh = Mesh(points, template.faces)
    bust = template.row_of("bust point")
    left, right = (template.point(bust, sign * template.bust_column) for sign in (1, -1))
    return ControlMesh(
        mesh,
        template.fixed,
        template.row,
        template.column,
        template.paths,
        (left, right),
        mesh.boundary_loops[:1],
        (),
    )
