"""What t-FFD costs and how faithful it is: `python benchmarks/bench_tffd.py [scan ...]`, or the samples.

Times are medians on one thread, with compiled loops where numba is installed. For the shape, the free points
of the line row are pulled in by 4 mm: how far the body follows, which angle this adds between neighbouring
faces, and what moves outside the patch.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from core.control_mesh.fit import ControlMesh, fit_control_mesh
from core.control_mesh.template import read_template
from core.deformation.blend_region import blend_weights
from core.deformation.incremental_normals import moving_faces
from core.deformation.tffd import bind, deform, deform_moving
from core.geometry import kernels
from core.geometry.mesh import Floats, Mesh, Points
from core.landmarks.detect import find_landmarks
from core.scan.body import read_scan

SAMPLES = Path(__file__).parents[1] / "resources" / "samples"


def median_ms(work: Callable[[], object], rounds: int) -> float:
    seconds = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - start)
    return 1e3 * statistics.median(seconds)


def pulled_in(control: ControlMesh, row: int, by: float) -> Points:
    chosen = (control.row == row) & ~control.fixed
    points = control.mesh.vertices.copy()
    points[chosen] -= by * control.mesh.vertex_normals[chosen]
    return points


def added_angles(rest: Mesh, moved: Mesh) -> Floats:
    """Return by how much the faces turn against each other over the edges within the moved part [deg]."""
    touched = (moved.vertices != rest.vertices).any(axis=1)[rest.faces].any(axis=1)
    faces = rest.faces[touched]
    half = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    order = np.lexsort((half[:, 1], half[:, 0]))
    shared = np.flatnonzero((half[order][1:] == half[order][:-1]).all(axis=1))
    first, second = order[shared] // 3, order[shared + 1] // 3

    def angles(mesh: Mesh) -> Floats:
        normals = mesh.face_normals[touched]
        sine = np.linalg.norm(np.cross(normals[first], normals[second]), axis=1)
        return np.degrees(np.arctan2(sine, np.einsum("ij,ij->i", normals[first], normals[second])))

    return np.maximum(angles(moved) - angles(rest), 0.0)


def measure(path: str) -> None:
    body = read_scan(path)
    mesh = body.mesh
    control = fit_control_mesh(read_template("168"), body, find_landmarks(body))
    patch = blend_weights(mesh, control)
    patch_ms = median_ms(lambda: blend_weights(mesh, control), 5)
    print(
        f"{body.name}: {len(mesh.vertices)} vertices, {len(control.mesh.faces)} control triangles,", end=" "
    )
    print(f"patch by {patch.rule} in {patch_ms:.0f} ms {patch.reason}")
    points = pulled_in(control, 2, 4.0)
    for weights in ("paper", "smooth"):
        make = partial(bind, mesh, control.mesh, patch.fade, weights, fixed=control.fixed, single=True)
        bind_ms, binding = median_ms(make, 5), make()
        moved = deform(binding, points)
        moving = moving_faces(mesh, binding.moving)
        rows, places = len(binding.moving), moved[moving.vertices]
        columns = binding.operator.weights.size / rows
        angles = added_angles(mesh, mesh.moved(moved))
        way = np.linalg.norm(moved - mesh.vertices, axis=1)
        print(
            f"  {weights:6}  bind {bind_ms:4.0f} ms  {rows} rows of {columns:.1f}"
            f"  deform {median_ms(partial(deform_moving, binding, points), 50):.2f} ms"
            f"  normals {median_ms(partial(moving.normals, places), 50):.2f} ms"
            f"  volume {median_ms(partial(moving.volume_change, places), 50):.2f} ms\n"
            f"          follows {way.max() / 4.0:.2f}  leak {way[patch.fade == 0.0].max():.3f} mm"
            f"  angle +{angles.max():.1f}, 99.9 % under {np.quantile(angles, 0.999):.1f} deg"
            f"  volume {moving.volume_change(places) / 1e3:+.1f} cm3"
        )


if __name__ == "__main__":
    kernels.warm()
    with threadpool_limits(1):
        for argument in sys.argv[1:] or sorted(map(str, SAMPLES.glob("*.ply"))):
            measure(argument)
