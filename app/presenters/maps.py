"""Describe maps and sections: kinds, colours, ranges and values; keep the whole body of a frame."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import zip_longest

import numpy as np

from app.i18n.catalog import number, tr
from app.i18n.lengths import length, shown_value
from app.presenters.bust_shift import (
    BustShift,
    BustStep,
    bust_sentence,
    forward_text,
    step_text,
    uncertainties_of,
)
from app.presenters.pressure import limit_marks
from app.rendering.palette import MAP_AMOUNT, MAP_LESS, MAP_MORE
from app.rendering.vertex_colors import Ramp
from core.garment.cup_fit import WornCups
from core.garment.pressure import mmhg, pressure_limits
from core.garment.pressure_list import PressureList
from core.geometry.mesh import Floats, Indices, Mesh, Points
from core.geometry.mirror_plane import SideComparison, mirror_plane
from core.measurements.uncertain_value import OutputUncertainties
from core.mechanics.mesh_quality import STRAIN_RANGE, STRAINED_RANGE
from core.pipeline.build import Stages
from core.pipeline.live_solver import Frame
from core.pipeline.model_stages import line_targets
from core.pipeline.surface_fields import (
    StrainOnBody,
    carrier,
    line_forces,
    normal_displacement,
)

LINE_MAPS = ("pull", "pressure")
"""Maps that lie on the bands; that of the pressure lies on the skin below cups too."""

MAPS = ("displacement", "strain", "sides", "worn", *LINE_MAPS)
"""Maps in the order in which a key goes through them, the first one first seen."""

OF_BUST = ("worn", "pressure")
"""Maps that have values on the skin of the bust alone."""

BOTH_WAYS = ("displacement", "sides", "worn")
"""Maps whose values go both ways from zero, all of them lengths."""

_LEAST = {"sides": 5.0, "worn": 5.0, "pressure": 5.0}  # no map shows less [mm, kPa]; both limits are seen
LEAST_OF_CUPS = 3.0
"""Cups press softly on much of the skin: of both limits only the first is always seen [kPa]."""

_ROUND = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)


def map_kinds() -> list[MapKind]:
    """Return the maps that can be chosen, in words."""
    return [*_skin_maps(), *_comparison_maps(), *_line_maps()]


def _skin_maps() -> list[MapKind]:
    return [
        MapKind(
            "displacement",
            tr("Displacement"),
            "mm",
            tr("Shows the displacement of the skin along its original normal: outward (+) or inward (−)."),
            tr("+ outward  − inward"),
            both_ways=True,
        ),
        MapKind(
            "strain",
            tr("Strain"),
            "%",
            tr(
                "Shows the maximum strain of the control mesh: principal strain of its "
                "triangles, averaged at each control point and interpolated on the skin. The verdict "
                "uses the edges of the control mesh, whose strain can be higher."
            ),
            strain_note(),
            marks=strain_marks(),
        ),
    ]


def strain_marks() -> tuple[Mark, ...]:
    """Return the limits of strain as marks on a legend: strain [%], tone and word."""
    strained, overstrained = (100.0 * (longest - 1.0) for _, longest in (STRAINED_RANGE, STRAIN_RANGE))
    return (strained, "warn", tr("strained")), (overstrained, "bad", tr("overstrained"))


def strain_note() -> str:
    """Return the note below the legend of strain: its limits, which can be beyond the range."""
    strained, overstrained = (number(limit, 0) for limit, _, _ in strain_marks())
    words = tr("Of the control mesh. Strained from {strained} %, overstrained from {overstrained} %.")
    return words.format(strained=strained, overstrained=overstrained)


def _comparison_maps() -> list[MapKind]:
    return [
        MapKind(
            "sides",
            tr("Symmetry"),
            "mm",
            tr(
                "Shows the protrusion of each side beyond the mirror image of the other side. The symmetry "
                "plane is the best fit to the trunk without the breasts."
            ),
            tr("+ protrudes beyond the other side"),
            both_ways=True,
        ),
        MapKind(
            "worn",
            tr("Residuals (prediction − scan)"),
            "mm",
            tr(
                "Shows the position of the predicted skin in front of (+) or behind (−) the skin "
                "of the fitting scan."
            ),
            tr("+ predicted further out than measured"),
            both_ways=True,
        ),
    ]


def _line_maps() -> list[MapKind]:
    return [
        MapKind(
            "pull",
            tr("Line tension"),
            "%",
            tr(
                "Shows the tension along the active lines, in % of the maximum. Tensions in N "
                "are in the cut list."
            ),
            tr("of maximum"),
            digits=0,
        ),
        MapKind(
            "pressure",
            tr("Contact pressure"),
            "kPa",
            _pressure_tip(),
            tr("Bands, and skin below cups. Dashed: across hollows."),
            marks=limit_marks(),
        ),
    ]


def _pressure_tip() -> str:
    limits = pressure_limits()
    amber, red = (
        f"{number(kpa, 0)} kPa ({number(mmhg(kpa), 0)} mmHg)" for kpa in (limits.amber_kpa, limits.red_kpa)
    )
    return tr(
        "Shows the contact pressure of the bands on the skin: tension divided by width and "
        "radius of curvature; and that of cups, on the skin. 1 kPa is 7.5 mmHg. Marks: snug from {amber}, "
        "too tight from {red}. "
        "Estimate: tissue yields, and sensors measure lower values."
    ).format(amber=amber, red=red)


def pressure_note(listed: PressureList | None, stale: bool) -> str:
    """Return the first note below the legend of pressure; ``stale`` values belong to a former shape."""
    if listed is None:
        return tr("Computed when the solver has converged.")
    if stale:
        return tr("For the previous shape; recomputed when the solver has converged.")
    if not listed.worn and listed.highest is None:
        return tr("No active line with known tension presses on the skin.")
    return ""


def bridge_text(off: float) -> str:
    """Return the note on a place where a band bridges a hollow, ``off`` the skin [mm]."""
    return tr("bridges a hollow, {length} off the skin").format(length=length(off, 0))


def ramp_of(name: str, low: float, high: float, clay: str) -> Ramp:
    """Return the colours of a map between two values; zero is the colour "#rrggbb" of the body's material."""
    if name in BOTH_WAYS:
        return Ramp((*MAP_LESS, clay, *MAP_MORE), low, high, clay)
    return Ramp((clay, *MAP_AMOUNT), low, high, clay)


def automatic_range(name: str, values: Floats, least: float = 0.0) -> tuple[float, float]:
    """Return the range that holds all values, up to a round number; it holds ``least``, or some default."""
    if name == "pull":
        return 0.0, 100.0
    seen = np.abs(values[np.isfinite(values)])
    one = 1.0 / shown_value(1.0, "mm" if name in BOTH_WAYS else "")  # of the unit in which it is written
    high = one * rounded_up(max(float(seen.max(initial=0.0)), least or _LEAST.get(name, 1.0)) / one)
    return (-high, high) if name in BOTH_WAYS else (0.0, high)


def rounded_up(value: float) -> float:
    """Return the next round number that is not below ``value`` > 0."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(unit * power for unit in _ROUND if unit * power >= value * (1.0 - 1e-9))


def section_text(axis: str, side: str, move: BustShift, spread: OutputUncertainties | None = None) -> str:
    """Return how far the bust points went, in words; a plane across x has that of its ``side`` alone."""
    if axis != "x":
        return bust_sentence(move, uncertainties_of(spread))
    offs = uncertainties_of(spread, side)
    if side == "left":
        return tr("Bust point left: {shift}").format(shift=step_text(move.left, offs))
    return tr("Bust point right: {shift}").format(shift=step_text(move.right, offs))


def sides_text(axis: str, pairs: Sequence[tuple[Floats, Floats]]) -> str:
    """Return how far the foremost places of two sides are apart, in words; a pair is (other, this) [mm]."""
    steps = [this - other for other, this in pairs]
    if axis == "x" and len(steps) == 1:
        way = step_text(BustStep(float(steps[0][1]), float(steps[0][0])))
        return tr("Apex, relative to the other side: {shift}").format(shift=way)
    if axis == "z" and len(steps) == 2:
        way = forward_text(-float(steps[0][1]))
        return tr("Apex left, relative to right: {shift}").format(shift=way)
    return ""


Mark = tuple[float, str, str]
"""A limit that is marked on the bar: value, tone and word."""


@dataclass(frozen=True)
class MapKind:
    """A map that can be chosen: title, unit, what it means, in words a tooltip long, and a line below.

    ``both_ways``: its values go both ways from zero, and so does its range. ``marks`` are limits on its
    bar: value, tone and word.
    """

    name: str
    title: str
    unit: str
    tip: str
    note: str
    digits: int = 1
    both_ways: bool = False
    marks: tuple[Mark, ...] = ()


def _meshes(stages: Stages) -> tuple[object, ...]:
    """Return all that a state of a body is laid on."""
    return stages.skin.faces, *(mesh for each in stages.regions for mesh in (each.control, each.patch))


class BodyState:
    """``places`` [mm] and ``normals`` [1] of all vertices, (n, 3), follow the frames of one body and fit."""

    def __init__(self, frame: Frame) -> None:
        self.stages: Stages = frame.stages
        self.rest: Mesh = frame.stages.body.mesh
        self.places: Points = self.rest.vertices.copy()
        self.normals: Points = self.rest.vertex_normals.copy()
        self.follow(frame)

    def belongs_to(self, frame: Frame) -> bool:
        """Return whether a frame is of the same body and fit."""
        old, new = self.stages, frame.stages
        return all(a is b for a, b in zip_longest(_meshes(old), _meshes(new)))

    def follow(self, frame: Frame) -> None:
        """Set the frame; ``belongs_to`` must hold."""
        self.frame, self.stages = frame, frame.stages
        rows = frame.stages.skin.vertices
        self.places[rows], self.normals[rows] = frame.points, frame.normals

    @cached_property
    def box(self) -> tuple[Points, Points]:
        """Return the lowest and the highest coordinates of the body at rest, (3,) [mm]."""
        return self.rest.vertices.min(axis=0), self.rest.vertices.max(axis=0)

    @cached_property
    def sides(self) -> SideComparison:
        """Return the left side over the mirrored right one."""
        stages = self.stages
        still = np.all([region.patch.fade == 0.0 for region in stages.regions], axis=0)
        middle = mirror_plane(self.rest, still, stages.moving.middle)
        return SideComparison(self.rest, stages.skin.vertices, middle)

    @cached_property
    def _strains(self) -> list[StrainOnBody]:
        return [
            StrainOnBody(each.control, each.moving.rest, each.patch.fade[each.moving.vertices])
            for each in self.stages.regions
        ]

    def _strain(self) -> Floats:
        """Return the strain of skin at the moving vertices of all regions, (r,) [1]."""
        strains = np.zeros(len(self.stages.skin.vertices))
        for strain, rows, points in zip(
            self._strains, self.stages.skin.rows, self.frame.region_points, strict=True
        ):
            strains[rows] += strain(points)
        return strains

    @cached_property
    def _rest_normals(self) -> Points:
        return self.rest.vertex_normals[self.stages.skin.vertices]

    def rows(self, name: str) -> Indices:
        """Return the vertices at which the values of a map change from frame to frame, (k,)."""
        if name == "sides":
            return self.sides.rows
        return (self.stages.moving if name in OF_BUST else self.stages.skin).vertices

    def values(self, name: str) -> Floats:
        """Return the values of a map of the body at ``rows`` [mm, %], (k,); NaN where there is none."""
        if name == "displacement":
            return normal_displacement(self.stages.skin.faces.rest, self._rest_normals, self.frame.points)
        if name == "strain":
            return 100.0 * self._strain()
        if name == "pressure":
            return self._cup_pressures()
        return self.sides.protrusion_difference(self.places, self.normals, self.sides.rows)

    @cached_property
    def _sides_at_rest(self) -> Floats:
        return self.sides.protrusion_difference(self.rest.vertices, self.rest.vertex_normals)

    def at_rest(self, name: str) -> Floats:
        """Return the values of a map at all vertices of the body at rest, (n,); they are the caller's own."""
        if name == "sides":
            return self._sides_at_rest.copy()
        return np.full(len(self.rest.vertices), np.nan if name == "worn" else 0.0)

    def lies_on_skin(self, name: str) -> bool:
        """Return whether a map has values on the skin of this body."""
        return name not in LINE_MAPS or (name == "pressure" and self.stages.design.cup is not None)

    def _cup_pressures(self) -> Floats:
        """Return the pressures of the cups at the moving vertices, (r,) [kPa]."""
        kpa = WornCups(self.stages).fit(self.frame.control_points).kpa
        return self._carry(kpa)

    @cached_property
    def _carry(self) -> Callable[[Floats], Floats]:
        stages = self.stages
        places, fade = stages.moving.rest, stages.patch.fade[stages.moving.vertices]
        return carrier(stages.control.mesh, places, fade)

    def pulls(self) -> dict[str, Floats]:
        """Return how the segments of the worn lines pull, by line, each (k,) [%]."""
        ratios = line_targets(self.stages.design, self.stages).ratios
        found = line_forces(self.stages.model, self.frame.control_points, ratios)
        return {name: 100.0 * share for name, share in found.items()}
