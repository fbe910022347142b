"""Registration of a second scan by the skin outside the reshaped region: back, ribs, shoulders, belly (ours).

The two stand upright already, each by itself. Landmarks tell roughly how far apart they are; from a few
starts round there the still skin of the first is laid on the second, coarsely, and from the best one finely:
first along its own normals, then by all points that the second has there. Arms are left out, and what is held
otherwise counts little.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from core.analysis.calibration.robust_least_squares import PATCHES, normal_equations, robust_deviation
from core.analysis.calibration.surface_distance import ScanSurface, Surface, grid_cells, is_valid
from core.errors import LandmarkError, ScanError
from core.geometry.mesh import Faces, Flags, Floats, Mesh, Points, sample_surface
from core.landmarks.detect import find_landmarks
from core.landmarks.types import Landmarks
from core.messages import Length, Message
from core.pipeline.build import Stages
from core.progress import Progress, quiet
from core.scan.body import Body

_SAMPLE = 4000  # places at most that are strewn over it
_BELOW, _ABOVE, _BESIDE = 160.0, 60.0, 15.0  # how far the still skin reaches beyond the control mesh [mm]


MET = 5.0
"""Still skin that is this near to the second scan is met [mm]."""

LEAST_MET = 0.85
"""Less of the still skin than this met is another person, or another posture [1]."""

LEAST_SEEN = 0.4
"""Less of the still skin than this to compare with is too little to tell [1]."""

_COARSE = 700  # places that are laid on from every start

_STILL = ("side_left", "side_right", "armpit_left", "armpit_right", "back_centre", "back_centre_underbust",
          "front_centre_underbust", "waist_front", "hip_front", "neck_front", "neck_back")  # fmt: skip

_HEIGHTS = (0.0, -25.0, 25.0, -50.0, 50.0)  # starts above and below what landmarks tell [mm]

_TURNS = (0.0, -0.2, 0.2)  # and turned about the vertical [rad]

_KEPT = 0.7  # of the still skin, the nearest: the rest may be arms, or not there

_ROUNDS, _COARSE_ROUNDS, _POINT_ROUNDS, _STILL_STEP = 40, 7, 5, 1e-5

_FEWEST, _MOST_POINTS = 50, 60_000  # places that tell anything; points of the second scan that are asked

_SIZES = {"m": 1000.0, "inch": 25.4, "cm": 10.0, "mm": 1.0}


def static_faces(stages: Stages) -> Faces:
    """Return the triangles (m, 3) of the trunk's skin that no line moves."""
    mesh, control = stages.body.mesh, stages.control.mesh.vertices
    low, high = control.min(axis=0), control.max(axis=0)
    middle = mesh.vertices[mesh.faces].mean(axis=1)
    beside = (middle[:, 0] > low[0] - _BESIDE) & (middle[:, 0] < high[0] + _BESIDE)
    level = (middle[:, 2] > low[2] - _BELOW) & (middle[:, 2] < high[2] + _ABOVE)
    return np.asarray(mesh.faces[beside & level & ~_moves(stages)[mesh.faces].any(axis=1)])


def sample_surface_with_normals(mesh: Mesh, faces: Faces) -> tuple[Points, Points]:
    """Return places (k, 3) [mm] strewn over ``faces`` of a mesh, and the normals there."""
    areas = Mesh(mesh.vertices, faces).face_areas
    places, face = sample_surface(mesh.vertices, faces, areas, min(_SAMPLE, 4 * len(faces)))
    corners = mesh.vertex_normals[faces[face]].sum(axis=1)
    return places, corners / np.maximum(np.linalg.norm(corners, axis=1), 1e-12)[:, None]


def _moves(stages: Stages) -> Flags:
    moves = np.zeros(len(stages.body.mesh.vertices), dtype=bool)
    moves[stages.skin.vertices[: stages.skin.faces.count]] = True
    return moves


def static_surface(mesh: Mesh, faces: Faces) -> Surface:
    """Return the skin of ``faces`` (m, 3) of a mesh, for points to stand over."""
    used, corners = np.unique(faces, return_inverse=True)
    return Surface(mesh.vertices[used], mesh.vertex_normals[used], corners.reshape(-1, 3).T)


@dataclass(frozen=True, eq=False)
class Alignment:
    """Where the second scan lies on the first: ``matrix`` (4, 4) takes its frame to that of the first [mm].

    ``rms`` and ``most`` (at 95 %) [mm] are of the still skin that is met, whose share is ``met`` [1] of what
    there is skin for, ``seen`` [1] of all. ``covariance`` (6, 6) is of turns about x, y and z through
    ``middle`` (3,) [rad, mm] and of shifts [mm] along them.
    """

    matrix: Floats
    rms: float
    most: float
    met: float
    seen: float
    covariance: Floats
    middle: Points

    @property
    def rotation_deviations(self) -> Floats:
        """Return how unsure the rotation about x, y and z is, standard deviations (3,) [degrees]."""
        return np.asarray(np.degrees(np.sqrt(np.maximum(np.diag(self.covariance)[:3], 0.0))))

    @property
    def translation_deviations(self) -> Floats:
        """Return how unsure the place along x, y and z is, standard deviations (3,) [mm]."""
        return np.asarray(np.sqrt(np.maximum(np.diag(self.covariance)[3:], 0.0)))

    def transform(self, mesh: Mesh) -> Mesh:
        """Return a mesh of the second scan's frame in that of the first."""
        return mesh.moved(transform_points(self.matrix, mesh.vertices))


def transform_points(matrix: Floats, points: Points) -> Points:
    """Return points (k, 3) where a ``matrix`` (4, 4) takes them."""
    return np.asarray(points @ matrix[:3, :3].T + matrix[:3, 3])


def align(stages: Stages, worn: Body, progress: Progress = quiet) -> Alignment:
    """Lay ``worn`` on the body of ``stages``. Raises ScanError if it is no scan of the same still skin."""
    faces = static_faces(stages)
    places, normals = sample_surface_with_normals(stages.body.mesh, faces)
    _refuse_other_size(stages.body, worn)
    skin = ScanSurface(worn.mesh, worn.noise)
    progress("aligning", 0.1)
    there = _coarse(places, worn, _starts(stages, worn))
    progress("aligning", 0.5)
    there = _fine(skin, places, normals, there)
    progress("aligning", 0.7)
    found = _judged(skin, places, normals, there)
    _refuse_other_body(found)
    return refine_with_all_points(found, skin, static_surface(stages.body.mesh, faces))


def _starts(stages: Stages, worn: Body) -> Iterator[Floats]:
    """Yield matrices that take the first body's frame to the second's: near each other, by landmarks."""
    shift = _between(stages.landmarks, _landmarks(worn), stages.body.mesh, worn.mesh)
    middle = stages.control.mesh.vertices.mean(axis=0)
    for height in _HEIGHTS:
        for turn in _TURNS:
            matrix = rotation_about(np.array([0.0, 0.0, turn]), middle)
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


def rotation_about(angles: Floats, middle: Points) -> Floats:
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
            here = transform_points(matrix, few)
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
    matrix = rotation_about(step[:3], places.mean(axis=0))
    matrix[:3, 3] += step[3:]
    return matrix


def _fine(skin: ScanSurface, places: Points, normals: Points, matrix: Floats) -> Floats:
    """Return the matrix at which the gaps of the still skin, each by its weight, are least."""
    for _ in range(_ROUNDS):
        here, facing = transform_points(matrix, places), normals @ matrix[:3, :3].T
        gaps = skin.gaps(here, facing)
        seen = is_valid(gaps)
        if seen.sum() < _FEWEST:
            return matrix
        gaps, here, facing = gaps[seen], here[seen], facing[seen]
        equations = normal_equations(gaps, _slopes(here, facing), robust_deviation(gaps))
        step = equations.step()
        matrix = _stepped(step, here) @ matrix
        if _is_still(step, 10.0 * _STILL_STEP):  # all points set it right
            break
    return matrix


def _is_still(step: Floats, turn: float) -> bool:
    """Return whether a step (6,) turns by less than ``turn`` [rad], and shifts by as little."""
    return bool(np.abs(step[:3]).max() < turn and np.abs(step[3:]).max() < 100.0 * turn)


def refine_with_all_points(found: Alignment, skin: ScanSurface, ground: Surface) -> Alignment:
    """Return an alignment set right by the points of the second scan over the still ``ground``.

    Each of them counts, or each of very many: a scanner that gives more of them tells better where it stood.
    """
    every = max(1, int(np.ceil(len(skin.mesh.vertices) / _MOST_POINTS)))
    points, facing, matrix = skin.mesh.vertices[::every], skin.vertex_directions[::every], found.matrix
    for _ in range(_POINT_ROUNDS):
        here = transform_points(matrix, points)
        feet = ground.project(here, facing @ matrix[:3, :3].T, skin.noise)
        if len(feet.gaps) < _FEWEST:
            return found
        here = here[feet.rows]
        slopes, spread = -_slopes(here, feet.normals), robust_deviation(feet.gaps)
        step = normal_equations(feet.gaps, slopes, spread).step()
        matrix = _stepped(step, here) @ matrix
        if _is_still(step, _STILL_STEP):
            break
    # By their feet: noise would part points of one place, those outside from those inside.
    patches = [grid_cells(feet.interpolate(ground.places), size) for size in PATCHES]
    covariance = normal_equations(feet.gaps, slopes, spread, patches).covariance
    return replace(found, matrix=matrix, covariance=covariance, middle=here.mean(axis=0))


def _judged(skin: ScanSurface, places: Points, normals: Points, matrix: Floats) -> Alignment:
    here, facing = transform_points(matrix, places), normals @ matrix[:3, :3].T
    gaps = skin.gaps(here, facing)
    seen = is_valid(gaps)
    gaps, here, facing = gaps[seen], here[seen], facing[seen]
    if len(gaps) < _FEWEST:
        unsure = np.diag(np.full(6, np.inf))
        return Alignment(_back(matrix), np.inf, np.inf, 0.0, len(gaps) / len(seen), unsure, np.zeros(3))
    near = np.abs(gaps) < MET
    patches = [grid_cells(here, size) for size in PATCHES]
    equations = normal_equations(gaps, _slopes(here, facing), robust_deviation(gaps), patches)
    return Alignment(
        _back(matrix),
        float(np.sqrt(np.mean(gaps[near] ** 2))) if near.any() else np.inf,
        float(np.quantile(np.abs(gaps[near]), 0.95)) if near.any() else np.inf,
        float(near.mean()),
        float(seen.mean()),
        equations.covariance,
        transform_points(_back(matrix), here).mean(axis=0),
    )


def _back(matrix: Floats) -> Floats:
    return np.asarray(np.linalg.inv(matrix), dtype=np.float64)


def _refuse_other_size(body: Body, worn: Body) -> None:
    """Raise ScanError if one body is so much larger than the other that a unit must be wrong."""
    times = _extent(worn.mesh) / _extent(body.mesh)
    if 0.5 < times < 2.0:
        return
    raise ScanError(
        Message(
            "The fitting scan is {times} times as large as the first scan: it was read in {unit}.",
            times=f"{times:.2g}",
            unit=worn.pose.unit,
        ),
        Message("Set the unit of the fitting scan."),
    )


def _extent(mesh: Mesh) -> float:
    """Return how far round its axis a body reaches [mm]: the median, which arms do not matter to."""
    flat = mesh.vertices[:, :2]
    return float(np.median(np.linalg.norm(flat - np.median(flat, axis=0), axis=1)))


def _refuse_other_body(found: Alignment) -> None:
    if found.seen < LEAST_SEEN:
        raise ScanError(
            Message(
                "The fitting scan covers {seen} % of the unaffected skin; {least} % is required "
                "for registration.",
                seen=f"{100.0 * found.seen:.0f}",
                least=f"{100.0 * LEAST_SEEN:.0f}",
            ),
            Message("Include the back, the ribs and the shoulders in the scan."),
        )
    if found.met < LEAST_MET:
        raise ScanError(
            Message(
                "The fitting scan does not match the first scan: {met} % of the unaffected skin is within "
                "{mm}; {least} % is required.",
                met=f"{100.0 * found.met:.0f}",
                mm=Length(MET),
                least=f"{100.0 * LEAST_MET:.0f}",
            ),
            Message("Use a scan of the same person in the same posture and arm position."),
        )
