"""A second scan is laid on the first by the skin that no line moves: back, ribs, shoulders, belly (ours).

The two stand upright already, each by itself. Landmarks tell roughly how far apart they are; from a few
starts round there the still skin of the first is laid on the second, coarsely, and from the best one finely.
Arms are left out, and what is held otherwise counts little.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from core.body import Body
from core.errors import LandmarkError, ScanError
from core.landmark import Landmarks
from core.landmarks import find_landmarks
from core.mesh import Flags, Floats, Mesh, Points, strewn
from core.pipeline import Stages
from core.progress import Progress, quiet
from core.worn_scan.gap import WornSkin, cells, known
from core.worn_scan.least_squares import PATCHES, normal, spread_of

MET = 5.0
"""Still skin that is this near to the second scan is met [mm]."""

LEAST_MET = 0.85
"""Less of the still skin than this met is another person, or another posture [1]."""

LEAST_SEEN = 0.4
"""Less of the still skin than this to compare with is too little to tell [1]."""

_SAMPLE, _COARSE = 4000, 700
_BELOW, _ABOVE, _BESIDE = 160.0, 60.0, 15.0  # how far the still skin reaches beyond the control mesh [mm]
_STILL = ("side_left", "side_right", "armpit_left", "armpit_right", "back_centre", "back_centre_underbust",
          "front_centre_underbust", "waist_front", "hip_front", "neck_front", "neck_back")  # fmt: skip
_HEIGHTS = (0.0, -25.0, 25.0, -50.0, 50.0)  # starts above and below what landmarks tell [mm]
_TURNS = (0.0, -0.2, 0.2)  # and turned about the vertical [rad]
_KEPT = 0.7  # of the still skin, the nearest: the rest may be arms, or not there
_ROUNDS, _COARSE_ROUNDS, _STILL_STEP = 40, 7, 1e-5
_SIZES = {"m": 1000.0, "inch": 25.4, "cm": 10.0, "mm": 1.0}


@dataclass(frozen=True, eq=False)
class Alignment:
    """Where the second scan lies on the first: ``matrix`` (4, 4) takes its frame to that of the first [mm].

    ``rms`` and ``most`` (at 95 %) [mm] are of the still skin that is met, whose share is ``met`` [1] of what
    there is skin for, ``seen`` [1] of all. ``turns`` (3,) [degrees] and ``shifts`` (3,) [mm] are how unsure
    the rotation about, and the place along, x, y and z are: standard deviations.
    """

    matrix: Floats
    rms: float
    most: float
    met: float
    seen: float
    turns: Floats
    shifts: Floats

    def laid(self, mesh: Mesh) -> Mesh:
        """Return a mesh of the second scan's frame in that of the first."""
        return mesh.moved(moved(self.matrix, mesh.vertices))


def moved(matrix: Floats, points: Points) -> Points:
    """Return points (k, 3) where a ``matrix`` (4, 4) takes them."""
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def align(stages: Stages, worn: Body, progress: Progress = quiet) -> Alignment:
    """Lay ``worn`` on the body of ``stages``. Raises ScanError if it is no scan of the same still skin."""
    places, normals = still_skin(stages)
    _refuse_other_size(stages.body, worn)
    skin = WornSkin(worn.mesh)
    progress("aligning", 0.1)
    there = _coarse(places, worn, _starts(stages, worn))
    progress("aligning", 0.5)
    there = _fine(skin, places, normals, there)
    progress("aligning", 0.9)
    found = _judged(skin, places, normals, there)
    _refuse_other_body(found)
    return found


def still_skin(stages: Stages) -> tuple[Points, Points]:
    """Return places (k, 3) [mm] strewn over the trunk's skin that no line moves, and its normals there."""
    mesh, control = stages.body.mesh, stages.control.mesh.vertices
    low, high = control.min(axis=0), control.max(axis=0)
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    beside = (middle[:, 0] > low[0] - _BESIDE) & (middle[:, 0] < high[0] + _BESIDE)
    level = (middle[:, 2] > low[2] - _BELOW) & (middle[:, 2] < high[2] + _ABOVE)
    kept = np.flatnonzero(beside & level & ~_moves(stages)[mesh.faces].any(axis=1))
    faces, areas = mesh.faces[kept], mesh.face_areas[kept]
    places, face = strewn(mesh.vertices, faces, areas, min(_SAMPLE, 4 * len(faces)))
    corners = mesh.vertex_normals[faces[face]].sum(axis=1)
    return places, corners / np.maximum(np.linalg.norm(corners, axis=1), 1e-12)[:, None]


def _moves(stages: Stages) -> Flags:
    moves = np.zeros(len(stages.body.mesh.vertices), dtype=bool)
    moves[stages.moving.vertices[: stages.moving.count]] = True
    return moves


def _starts(stages: Stages, worn: Body) -> Iterator[Floats]:
    """Yield matrices that take the first body's frame to the second's: near each other, by landmarks."""
    shift = _between(stages.landmarks, _landmarks(worn), stages.body.mesh, worn.mesh)
    middle = stages.control.mesh.vertices.mean(axis=0)
    for height in _HEIGHTS:
        for turn in _TURNS:
            matrix = turned(np.array([0.0, 0.0, turn]), middle)
            matrix[:3, 3] += shift + np.array([0.0, 0.0, height])
            yield matrix


def _landmarks(worn: Body) -> Landmarks | None:
    try:
        return find_landmarks(worn)
    except LandmarkError:
        return None


def _between(first: Landmarks, second: Landmarks | None, body: Mesh, worn: Mesh) -> Points:
    """Return about how far the second lies from the first, shape (3,) [mm]."""
    if second is not None:
        names = [name for name in _STILL if name in first.points and name in second.points]
        if len(names) > 2:
            ways = [second.position(name) - first.position(name) for name in names]
            return np.asarray(np.median(ways, axis=0))
    return np.asarray(np.median(worn.vertices, axis=0) - np.median(body.vertices, axis=0))


def turned(angles: Floats, middle: Points) -> Floats:
    """Return the matrix (4, 4) that turns by the vector ``angles`` (3,) [rad] about a ``middle`` (3,)."""
    angle = float(np.linalg.norm(angles))
    x, y, z = angles / angle if angle > 0.0 else angles
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    matrix[:3, 3] = middle - matrix[:3, :3] @ middle
    return matrix


def _coarse(places: Points, worn: Body, starts: Iterator[Floats]) -> Floats:
    """Return the matrix that lays few of the places best on the vertices of the second scan."""
    few = places[:: max(1, len(places) // _COARSE)]
    vertices, normals = worn.mesh.vertices, worn.mesh.vertex_normals
    tree = cKDTree(vertices)
    best, least = np.eye(4), np.inf
    for start in starts:
        matrix = start
        for _ in range(_COARSE_ROUNDS):
            here = moved(matrix, few)
            at = tree.query(here)[1]
            facing = normals[at]
            ahead = np.einsum("ij,ij->i", here - vertices[at], facing)
            away = np.linalg.norm(here - vertices[at], axis=1)
            kept = away <= np.quantile(away, _KEPT)
            slopes = _slopes(here[kept], facing[kept])
            step = np.linalg.lstsq(slopes.T @ slopes, -slopes.T @ ahead[kept], rcond=1e-12)[0]
            matrix = _stepped(step, here) @ matrix
        score = float(np.sort(away)[: int(_KEPT * len(away))].mean())
        if score < least:
            best, least = matrix, score
    return best


def _slopes(places: Points, normals: Points) -> Floats:
    """Return how gaps change with turns [rad] about the middle of ``places`` and shifts [mm], (k, 6)."""
    return np.concatenate([np.cross(places - places.mean(axis=0), normals), normals], axis=1)


def _stepped(step: Floats, places: Points) -> Floats:
    matrix = turned(step[:3], places.mean(axis=0))
    matrix[:3, 3] += step[3:]
    return matrix


def _fine(skin: WornSkin, places: Points, normals: Points, matrix: Floats) -> Floats:
    """Return the matrix at which the gaps of the still skin, each by its weight, are least."""
    for _ in range(_ROUNDS):
        here, facing = moved(matrix, places), normals @ matrix[:3, :3].T
        gaps = skin.gaps(here, facing)
        seen = known(gaps)
        if seen.sum() < 50:
            return matrix
        gaps, here, facing = gaps[seen], here[seen], facing[seen]
        equations = normal(gaps, _slopes(here, facing), spread_of(gaps))
        step = equations.step()
        matrix = _stepped(step, here) @ matrix
        if np.abs(step[:3]).max() < _STILL_STEP and np.abs(step[3:]).max() < 100.0 * _STILL_STEP:
            break
    return matrix


def _judged(skin: WornSkin, places: Points, normals: Points, matrix: Floats) -> Alignment:
    here, facing = moved(matrix, places), normals @ matrix[:3, :3].T
    gaps = skin.gaps(here, facing)
    seen = known(gaps)
    gaps, here, facing = gaps[seen], here[seen], facing[seen]
    if len(gaps) < 50:
        return Alignment(_back(matrix), np.inf, np.inf, 0.0, len(gaps) / len(seen), *_UNSURE)
    near = np.abs(gaps) < MET
    patches = [cells(here, size) for size in PATCHES]
    equations = normal(gaps, _slopes(here, facing), spread_of(gaps), patches)
    unsure = np.sqrt(np.maximum(np.diag(equations.covariance), 0.0))
    return Alignment(
        _back(matrix),
        float(np.sqrt(np.mean(gaps[near] ** 2))) if near.any() else np.inf,
        float(np.quantile(np.abs(gaps[near]), 0.95)) if near.any() else np.inf,
        float(near.mean()),
        float(seen.mean()),
        np.degrees(unsure[:3]),
        unsure[3:],
    )


def _back(matrix: Floats) -> Floats:
    return np.asarray(np.linalg.inv(matrix), dtype=np.float64)


_UNSURE = (np.full(3, np.inf), np.full(3, np.inf))


def _refuse_other_size(body: Body, worn: Body) -> None:
    """Raise ScanError if one body is so much larger than the other that a unit must be wrong."""
    times = _extent(worn.mesh) / _extent(body.mesh)
    if 0.5 < times < 2.0:
        return
    raise ScanError(
        f"The worn scan is {times:.2g} times as large as the first one: it was read in {worn.pose.unit}.",
        "Tell its unit.",
    )


def _extent(mesh: Mesh) -> float:
    """Return how far round its axis a body reaches [mm]: the median, which arms do not matter to."""
    flat = mesh.vertices[:, :2]
    return float(np.median(np.linalg.norm(flat - np.median(flat, axis=0), axis=1)))


def _refuse_other_body(found: Alignment) -> None:
    if found.seen < LEAST_SEEN:
        raise ScanError(
            f"The worn scan shows {100.0 * found.seen:.0f} % of the skin that no line moves; "
            f"{100.0 * LEAST_SEEN:.0f} % are needed to lay it on the first.",
            "Scan the back, the ribs and the shoulders too.",
        )
    if found.met < LEAST_MET:
        raise ScanError(
            f"The worn scan does not fit the first: {100.0 * found.met:.0f} % of the skin that no line moves "
            f"lies within {MET:.0f} mm of it, {100.0 * LEAST_MET:.0f} % are needed.",
            "Take a scan of the same person in the same posture, arms as before.",
        )
