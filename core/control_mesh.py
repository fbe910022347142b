"""The control mesh: the template fitted to a body, so that its points lie on the skin (paper section 2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.body import Body
from core.calm import calmed
from core.errors import FitError
from core.fit_check import faulty_faces
from core.landmark import Landmarks
from core.laying import Ground, bridged, find_creases, lay_outline, lay_rest, survey_ground
from core.mesh import Flags, Floats, Indices, Mesh, Points
from core.template import Template
from core.torso import cropped
from core.trunk import trunk_levels

AROUND = 40.0
"""The skin within this of a level is calmed before it is measured there [mm]."""

LINE_HEIGHTS = (0.25, 0.75)
"""Where the line row may run between fold (0) and bust point (1)."""


@dataclass(frozen=True, eq=False)
class ControlMesh:
    """The template on a body: control points at rest and triangles, wound outward.

    ``fixed`` (n,) tells the points that do not move; ``row`` and ``column`` (n,) are their places in the
    template, column 0 the centre, positive the subject's left. ``paths`` are the control points of each named
    line from right (-x) to left; ``bust_points`` those at the bust points, (left, right). ``border`` (b,) is
    the border loop in order, ``warnings`` what the user should know of the fit.
    """

    mesh: Mesh
    fixed: Flags
    row: Indices
    column: Indices
    paths: Mapping[str, tuple[int, ...]]
    bust_points: tuple[int, int]
    border: Indices
    warnings: tuple[str, ...]


def fit_control_mesh(
    template: Template, body: Body, landmarks: Landmarks, line_height: float = 0.5
) -> ControlMesh:
    """Lay ``template`` on ``body`` so that its rows follow the breasts (paper section 2; the recipe is ours).

    ``line_height`` [1] is where the mid-bust line runs on the skin between fold (0) and bust point (1).
    Raises FitError if no sound mesh lies on this body with these landmarks.
    """
    low, high = LINE_HEIGHTS
    if not low <= line_height <= high:
        raise FitError(f"The line height {line_height:g} is out of range.", f"Choose {low:g} to {high:g}.")
    ground = survey_ground(template, body.mesh, landmarks)
    outline, holes = bridged(lay_outline(ground, landmarks))
    creases, lacking = find_creases(ground, outline, landmarks)
    warnings = [_without_fold(template, number) for number in lacking] + _arm_warning(ground)
    while True:
        points, more_holes = bridged(lay_rest(ground, outline, creases, line_height))
        _refuse_holes(points)
        mesh = Mesh(points.reshape(-1, 3), template.faces)
        faulty = faulty_faces(mesh, ground.front, template.row == template.row_of("fold"))
        if not faulty.any():
            return _control_mesh(template, mesh, warnings + _hole_warning(holes + more_holes))
        blamed = set(template.column[template.faces[faulty]].ravel().tolist()) & set(creases)
        if not blamed:
            raise FitError(
                f"{faulty.sum()} triangles of the control mesh would be flat or folded on this body.",
                "Correct the bust points and folds, or choose the other template.",
            )
        shallowest = min(blamed, key=lambda number: creases[number].depth)
        del creases[shallowest]
        warnings.append(_without_fold(template, shallowest))


def _refuse_holes(points: Points) -> None:
    missing = int(np.isnan(points[..., 0]).sum())
    if missing:
        raise FitError(
            f"The scan has no skin where {missing} of the {points[..., 0].size} control points must lie.",
            "Close the holes of the scan, or open one that reaches from the ribs to the collarbones.",
        )


def _hole_warning(count: int) -> list[str]:
    if count == 0:
        return []
    return [f"The scan has holes at {count} control points: they lie straight between their neighbours."]


def _arm_warning(ground: Ground) -> list[str]:
    if ground.torso.armpit >= max(ground.torso.left.bust, ground.torso.right.bust):
        return []
    return ["The arms touch the body below the bust points: the sides of the mesh may lie on an arm."]


def _without_fold(template: Template, number: int) -> str:
    side = "left" if number > 0 else "right"
    place = template.columns[abs(number)].meaning
    return (
        f"No fold under the {side} breast could be followed in the column '{place}': its height is estimated."
    )


def _control_mesh(template: Template, mesh: Mesh, warnings: list[str]) -> ControlMesh:
    bust = template.row_of("bust point")
    left, right = (template.point(bust, sign * template.bust_column) for sign in (1, -1))
    return ControlMesh(
        mesh,
        template.fixed,
        template.row,
        template.column,
        template.paths,
        (left, right),
        mesh.boundary_loops[0],
        tuple(warnings),
    )


def back_length(body_mesh: Mesh, control: ControlMesh, path_name: str) -> float:
    """Return the way round the back from one end of a line to the other, along the skin [mm].

    It lies level at the mean height of both ends, without the arms; a hole of the scan is bridged straight.
    With the front part it makes the whole band. Raises FitError if there is no torso at that height.
    """
    path = control.paths[path_name]
    right, left = control.mesh.vertices[path[0]], control.mesh.vertices[path[-1]]
    z = 0.5 * (right[2] + left[2])
    band = cropped(body_mesh, np.abs(body_mesh.vertices[:, 2] - z) < AROUND)
    level = trunk_levels(calmed(band), [z])[0] if len(band.faces) else None
    if level is None or len(level.segments) == 0:
        raise FitError(
            f"The scan has no back at the height of the {path_name} line.",
            "Open a scan of a whole upper body.",
        )
    axis = 0.5 * (level.points.min(axis=0) + level.points.max(axis=0))[:2]
    ends = np.array([right[:2], left[:2]]) - axis
    # The ends take part as segments without length, so that a hole next to them is bridged too.
    segments = np.concatenate([level.segments[:, :, :2] - axis, np.repeat(ends[:, None], 2, axis=1)])
    start, end = _behind(ends).tolist()
    return _length_between(segments, start, end)


def _behind(places: Points) -> Floats:
    """Return the azimuth about the axis, 0 straight back, positive the subject's left, shape (...) [rad]."""
    return np.asarray(np.arctan2(places[..., 0], places[..., 1]))


def _length_between(segments: Points, start: float, end: float) -> float:
    """Return the length of the segments, shape (s, 2, 2) [mm], between two azimuths [rad], with gaps."""
    azimuth = _behind(segments)
    order = np.argsort(azimuth, axis=1)
    azimuth = np.take_along_axis(azimuth, order, axis=1)
    segments = np.take_along_axis(segments, order[:, :, None], axis=1)
    inside = (azimuth[:, 1] >= start) & (azimuth[:, 0] <= end) & (np.ptp(azimuth, axis=1) < np.pi)
    azimuth, segments = azimuth[inside], segments[inside]
    span = np.maximum(azimuth[:, 1] - azimuth[:, 0], 1e-12)
    share = (np.minimum(azimuth[:, 1], end) - np.maximum(azimuth[:, 0], start)) / span
    length = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    return float((length * np.clip(share, 0.0, 1.0)).sum()) + _gaps(azimuth, segments)


def _gaps(azimuth: Floats, segments: Points) -> float:
    """Return the summed width of the gaps between segments (s, 2, 2) [mm] with azimuths (s, 2) [rad]."""
    order = np.argsort(azimuth[:, 0])
    azimuth, segments = azimuth[order], segments[order]
    last = np.maximum.accumulate(azimuth[:, 1])
    reached = np.maximum.accumulate(np.where(azimuth[:, 1] == last, np.arange(len(last)), 0))
    gap = np.flatnonzero(azimuth[1:, 0] > last[:-1] + 1e-9)
    return float(np.linalg.norm(segments[gap + 1, 0] - segments[reached[gap], 1], axis=1).sum())
