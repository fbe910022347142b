"""From a curve drawn on the skin to own lines: which region it is in, one band over both, both sides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from core.control_mesh.embedding import locate_on_grid
from core.control_mesh.fit import ControlMesh
from core.control_mesh.path_snapping import Snapped, snap
from core.control_mesh.skin_projection import SurfaceProjector, locate_on_mesh
from core.document.design import Design
from core.document.free_lines import HANGS, FreeCurve, free_curve
from core.document.line_notation import mirror_image, path_cells, template_of
from core.document.lines import BUST, LOWER, CustomLine, partner_of
from core.errors import LineError
from core.geometry.mesh import Flags, Floats, Mesh, Points
from core.geometry.plane_sections import resample
from core.messages import LineName, Message

Laid = Mapping[str, Snapped | FreeCurve]
"""A curve as it is laid on the control mesh of each region that it runs over."""

_FINE = 2.0  # a curve is assigned to regions in steps of this length [mm]
_TIE = 2.0  # a place is in both regions if it is as near to both meshes as this [mm]
_FAR = 15.0  # a curve that is so much nearer to the other mesh has come back to it [mm]


def lay_curve(
    skin: Mesh,
    meshes: Mapping[str, ControlMesh],
    pieces: Sequence[Points],
    closed: bool = False,
    *,
    snapped: bool = False,
    pulling: bool = False,
) -> Laid:
    """Return how a curve on the ``skin`` is laid on control ``meshes``, by region: as it is, or ``snapped``.

    See ``free_curve`` and ``snap``. Raises LineError.
    """
    laid: dict[str, Snapped | FreeCurve] = {}
    for region, parts in parts_by_region(meshes, pieces, closed).items():
        if snapped:
            curve = np.concatenate(parts)
            laid[region] = snap(meshes[region], curve[:-1] if closed else curve, closed, pulling=pulling)
        else:
            laid[region] = free_curve(skin, meshes[region], parts, closed)
    return laid


def lines_of(name: str, laid: Laid) -> tuple[CustomLine, ...]:
    """Return the own lines that a curve is, the bust's first: parts of one band if there are two."""
    lines = []
    for region in (each for each in (BUST, LOWER) if each in laid):
        found, is_part = laid[region], region == LOWER and BUST in laid
        points, places = (found.path, ()) if isinstance(found, Snapped) else ((), found.places)
        own, upper = (_below(name), name) if is_part else (name, "")
        lines.append(CustomLine(own, points, found.closed, places, region=region, continues=upper))
    return tuple(lines)


def both_sides(name: str, laid: Laid, template: str) -> tuple[CustomLine, ...]:
    """Return the own lines that a curve and its mirror image are, or those of one that is its own image.

    ``template`` is the name of that of the bust.
    """
    one = lines_of(name, laid)
    at = sum(column for line in one for _, column in path_cells(line, template_of(line.region, template)))
    sides = ("left", "right") if at > 0.0 else ("right", "left")
    lines = lines_of(f"{name} {sides[0]}", laid)
    others = tuple(mirrored_line(line, template) for line in lines)
    if all(_stops(line) == _stops(other) for line, other in zip(lines, others, strict=True)):
        return one
    return (*lines, *others) if sides[0] == "left" else (*others, *lines)


def _stops(line: CustomLine) -> set[object]:
    return {*line.points, *line.places}


def mirrored_line(line: CustomLine, template: str) -> CustomLine:
    """Return the partner on the other side that mirrors a line; ``template`` is the name of the bust's."""
    image = mirror_image(line, template_of(line.region, template), partner_of(line.name))
    return replace(image, continues=partner_of(line.continues))


def with_new_path(design: Design, after: Sequence[CustomLine]) -> Design:
    """Return the design with own lines led elsewhere, and linked partners that mirror them likewise.

    Raises LineError if a line would come into another region.
    """
    before = {line.name: line for line in design.own_lines}
    if any(line.name not in before or before[line.name].region != line.region for line in after):
        raise LineError(
            Message("The new path of {line} is in another region.", line=LineName(after[0].name)),
            Message("Draw a new line instead."),
        )
    for line in after:
        partner = before.get(partner_of(line.name))
        linked = partner is not None and partner.name in design.linked_lines(line.name)
        design = design.with_custom_line(line)
        if linked and mirrored_line(before[line.name], design.template) == partner:
            design = design.with_custom_line(mirrored_line(line, design.template))
    return design


def _below(name: str) -> str:
    """Return the name of the part below the bust of a line."""
    side = next((f" {each}" for each in ("left", "right") if name.endswith(f" {each}")), "")
    return f"{name.removesuffix(side)} lower{side}"


def parts_by_region(
    meshes: Mapping[str, ControlMesh], pieces: Sequence[Points], closed: bool = False
) -> dict[str, list[Points]]:
    """Return the part of a curve that is laid in each region, in ``pieces`` (k, 3) [mm] from bend to bend.

    A curve that could pull in both regions is cut where it leaves the control mesh of the bust; any other is
    all in the region where more of it can pull, or is. ``closed`` ones are not cut. Raises LineError for a
    curve that goes to and fro between regions.
    """
    if len(meshes) == 1:
        return {region: list(pieces) for region in meshes}
    fine = [resample(piece, _FINE) if len(piece) > 1 else piece for piece in pieces]
    curve = np.concatenate(fine)
    off = {region: _distances(control.mesh, curve) for region, control in meshes.items()}
    nearer = off[BUST] - off[LOWER]
    owned = {BUST: nearer < _TIE, LOWER: nearer > -_TIE}
    pulling = {region: owned[region] & _movable(control, curve) for region, control in meshes.items()}
    if closed or not all(pulls.any() for pulls in pulling.values()):
        most = max(meshes, key=lambda region: (pulling[region].sum(), owned[region].sum()))
        return {most: list(pieces)}
    at, order = _best_cut(nearer)
    first, last = _cut(fine, at)
    return dict(zip(order, (first, last), strict=True))


def _best_cut(nearer: Floats) -> tuple[int, tuple[str, str]]:
    """Return where a curve is cut best between two regions, and the regions of both parts in order.

    ``nearer`` (k,) [mm] is how much nearer each of its points is to the mesh below than to that of the bust.
    Raises LineError if a part of it is far away on the wrong side.
    """
    before = np.concatenate([[0.0], np.cumsum(nearer)])
    at = {True: int(before.argmin()), False: int(before.argmax())}  # beginning on the bust, or below
    from_bust = (
        before[at[True]] - (before[-1] - before[at[True]])
        < (before[-1] - before[at[False]]) - (before[at[False]])
    )
    cut = at[bool(from_bust)]
    sign = 1.0 if from_bust else -1.0
    if max((sign * nearer[:cut]).max(initial=0.0), (-sign * nearer[cut:]).max(initial=0.0)) > _FAR:
        raise LineError(
            Message("The line crosses between bust and waist more than once."),
            Message("Draw a separate line for each part."),
        )
    return cut, (BUST, LOWER) if from_bust else (LOWER, BUST)


def _distances(mesh: Mesh, points: Points) -> Floats:
    """Return how far places, (k, 3) [mm], are from a mesh, (k,) [mm]."""
    return np.asarray(np.linalg.norm(SurfaceProjector(mesh).project(points) - points, axis=1))


def _movable(control: ControlMesh, points: Points) -> Flags:
    """Return which places of the skin, (k, 3) [mm], hang on free points of a control mesh, (k,)."""
    found = locate_on_mesh(control.mesh, control.grid, points)
    corners, weights = locate_on_grid(control.grid, found.cells)
    return np.asarray(found.inside & ((weights * ~control.fixed[corners]).sum(axis=1) > HANGS))


def _cut(pieces: Sequence[Points], at: int) -> tuple[list[Points], list[Points]]:
    """Return the pieces of a curve up to its point ``at``, counted through all pieces, and those from it."""
    first: list[Points] = []
    last: list[Points] = []
    for piece in pieces:
        if at >= len(piece):
            first.append(piece)
        elif at <= 0:
            last.append(piece)
        else:
            first.append(piece[: at + 1])
            last.append(piece[at:])
        at -= len(piece)
    return [each for each in first if len(each) > 1], [each for each in last if len(each) > 1]
