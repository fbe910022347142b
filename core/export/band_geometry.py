"""Lines as they are worn: smooth curves on the body, and flat strips to be cut."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.deformation.tffd import deform
from core.errors import LineError
from core.garment.curve_smoothing import USUAL_WIDTH, CentreLine, LocalPlanes, centre_line
from core.garment.cut_list import CutRow, cut_list
from core.geometry.mesh import Floats, Points
from core.geometry.plane_sections import arc_length
from core.mechanics.constraint_lines import Line
from core.messages import EMPTY, ElasticName, Length, Message, length_of
from core.pipeline.build import Stages
from core.pipeline.line_routes import NO_BACK
from core.pipeline.stages import RegionStages

SIDE_SEAM, LEFT = Message("right side, seam"), Message("left side")
CENTRE, BACK, SEAM = Message("centre front"), Message("centre back"), Message("seam allowance")
UPPER, LOWER = Message("upper end"), Message("lower end")
EDGE, SHOULDER, SEWN = Message("upper edge"), Message("shoulder"), Message("back, at the under-bust band")
"""What the marks of a strip are called: a band that goes round begins and ends at the right side."""

AS_WORN = Message("length on body: an elastic is cut shorter")
"""What is said of a strip of which no elastic is chosen."""

NOT_TO_CUT = Message("DO NOT CUT")
"""What is printed across such a strip."""

_TO_CUT = Message(
    "cut from {elastic}, including {allowance} seam allowance; length on body {worn}, elongation {stretch} %"
)
_FRONT_TO_CUT = Message(
    "front part only, cut from {elastic}, including {allowance} seam allowance; length on body "
    "{worn}, elongation {stretch} %"
)


@dataclass(frozen=True, eq=False)
class LineCurve:
    """A worn line on the body: ``front`` from the subject's right to the left, ``back`` on round the back.

    Shapes (k, 3) [mm]. Without a back, (0, 3), the line is its front part; a closed one ends where it begins.
    """

    name: str
    title: str
    front: Points
    back: Points

    @property
    def parts(self) -> dict[str, Points]:
        """Return the front by "front", the back by "back" if there is one."""
        return {"front": self.front} | ({"back": self.back} if len(self.back) else {})

    @property
    def length(self) -> float:
        """Return how long the whole curve is [mm]."""
        return sum(float(arc_length(part)[-1]) for part in self.parts.values())


@dataclass(frozen=True)
class Strip:
    """A band laid flat, ``length`` by ``width`` [mm], to be cut or as it is worn: ``note`` says which.

    ``marks`` are places along it by distance from its beginning [mm], with what lies there. ``to_cut`` is
    False for one as it is worn, which is no pattern piece.
    """

    name: str
    title: str
    length: float
    width: float
    marks: tuple[tuple[float, Message], ...] = ()
    note: Message = EMPTY
    to_cut: bool = True


def worn_regions(stages: Stages, region_points: Sequence[Points]) -> list[tuple[RegionStages, Points]]:
    """Return the regions in which lines are worn, with their control points [mm].

    Raises LineError if there is none.
    """
    pairs = zip(stages.regions, region_points, strict=True)
    worn = [(region, points) for region, points in pairs if region.design.active_lines()]
    if not worn:
        raise _no_lines()
    return worn


def line_curves(
    stages: RegionStages, control_points: Points, titles: Mapping[str, str], widths: Mapping[str, float]
) -> tuple[LineCurve, ...]:
    """Return the worn lines on the body as ``control_points``, (n, 3) [mm], shape it, in the model's order.

    ``titles`` and ``widths`` [mm] by name; a wide band lies straighter. Raises LineError if none is worn.
    """
    mesh = stages.body.mesh
    surface, moves = LocalPlanes(mesh), deform(stages.binding, control_points) - mesh.vertices
    curves = []
    for line in _worn(stages):
        route, width = stages.routes[line.name], widths.get(line.name, USUAL_WIDTH)
        laid = centre_line(route.path, surface, route.back, width, drawn=route.drawn, sewn=route.sewn)
        places = laid.points + surface.displacement_weights(laid.points) @ moves
        curves.append(LineCurve(line.name, titles.get(line.name, line.name), *_halves(places, laid)))
    return tuple(curves)


def strips(
    stages: RegionStages, control_points: Points, titles: Mapping[str, str], widths: Mapping[str, float]
) -> tuple[Strip, ...]:
    """Return the worn lines as flat strips: as they are to be cut, or as worn where no elastic is chosen.

    Marks lie at both sides, where front part and back cross the centre, at the ends of an open line, and
    where seams begin. Raises LineError if none is worn.
    """
    cuts = {row.line: row for row in cut_list(stages, control_points).rows}
    flat = []
    for line in _worn(stages):
        worn = Strip(
            line.name,
            titles.get(line.name, line.name),
            line.length(control_points) + line.back_length,
            widths.get(line.name, USUAL_WIDTH),
            _marks(stages, line, control_points),
            AS_WORN,
            to_cut=False,
        )
        flat.append(_cut(worn, cuts[line.name]))
    return tuple(flat)


def _cut(worn: Strip, row: CutRow) -> Strip:
    """Return a strip as it is to be cut, marks where they lie unstretched; as worn if that is not known."""
    if row.cut_mm is None or row.elongation is None or row.allowance_mm is None:
        return worn
    seam, shrunk = 0.5 * row.allowance_mm, (row.cut_mm - row.allowance_mm) / worn.length
    marks = [(seam + at * shrunk, what) for at, what in worn.marks]
    if seam > 0.0:
        marks += [(at, SEAM) for at in (seam, row.cut_mm - seam) if all(abs(at - k) > 1e-6 for k, _ in marks)]
    part = _FRONT_TO_CUT if row.front_only else _TO_CUT
    note = part.fill(
        elastic=ElasticName(row.elastic),
        allowance=length_of(row.allowance_mm),
        worn=Length(worn.length, 1),
        stretch=f"{100.0 * row.elongation:.0f}",
    )
    width = row.width_mm or worn.width
    return replace(worn, length=row.cut_mm, width=width, marks=tuple(sorted(marks)), note=note, to_cut=True)


def _worn(stages: RegionStages) -> Sequence[Line]:
    worn = [line for line in stages.model.lines if line.name in stages.design.active_lines()]
    if not worn:
        raise _no_lines()
    return worn


def _no_lines() -> LineError:
    return LineError(Message("No active lines."), Message("Set a line length first."))


def _halves(places: Points, laid: CentreLine) -> tuple[Points, Points]:
    """Return front part and back of a curve, which meet at both ends."""
    if not laid.closed:
        return places, NO_BACK
    front = laid.part >= 0
    if front.all():
        return np.concatenate([places, places[:1]]), NO_BACK
    first = int(np.flatnonzero(front & ~np.roll(front, 1))[0])
    places, last = np.roll(places, -first, axis=0), int(front.sum()) - 1
    return places[: last + 1], np.concatenate([places[last:], places[:1]])


def _marks(stages: RegionStages, line: Line, control_points: Points) -> tuple[tuple[float, Message], ...]:
    middle = float(stages.control.mesh.vertices[stages.control.border_points, 0].mean())
    places, back = line.places(control_points), stages.backs.get(line.name)
    s = arc_length(places)
    end = float(s[-1])
    marks = [(at, CENTRE) for at in _crossings(places[:, 0] - middle, s)]
    if line.back_length > 0.0:
        behind = []
        if back is not None and len(back.path) > 1:  # from the left end round to the right
            along = arc_length(back.path)
            shares = [at / float(along[-1]) for at in _crossings(back.path[:, 0] - middle, along)]
            behind = [(end + share * line.back_length, BACK) for share in shares]
        marks = [(0.0, SIDE_SEAM), *marks, (end, LEFT), *behind, (end + line.back_length, SIDE_SEAM)]
    elif line.tail_length > 0.0:
        tail = stages.tails[line.name]
        marks = [(0.0, LOWER), *marks, (end, EDGE), (end + tail.top, SHOULDER), (end + tail.length, SEWN)]
    elif not line.closed:
        names = (UPPER, LOWER) if places[0, 2] > places[-1, 2] else (LOWER, UPPER)
        marks = [(0.0, names[0]), *marks, (end, names[1])]
    return tuple(marks)


def _crossings(side: Floats, s: Floats) -> list[float]:
    """Return where ``side``, (k,), changes its sign along ``s``, (k,) [mm]."""
    k = np.flatnonzero((side[:-1] < 0.0) != (side[1:] < 0.0))
    share = side[k] / (side[k] - side[k + 1])
    return [float(at) for at in s[k] + share * (s[k + 1] - s[k])]
