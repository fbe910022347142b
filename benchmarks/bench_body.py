"""What the dense body costs in each frame: `python benchmarks/bench_body.py`, two minutes.

A sample of 33k vertices is refined to 330k and to 1M. Everything runs on one processor core, and in turns, so
that all share the machine's moods; medians of processor time, which other programs disturb less. What others
do: scipy with the same operator, row by row; all rows by all columns as one dense product; libigl and
Blender's Surface Deform, if they can be imported.
"""

from __future__ import annotations

import contextlib
import os
import statistics
import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from core.control_mesh.fit import ControlMesh, fit_control_mesh
from core.control_mesh.template import read_template
from core.deformation.blend_region import blend_weights
from core.deformation.incremental_normals import MovingFaces, moving_faces
from core.deformation.tffd import Binding, bind
from core.geometry import kernels
from core.geometry.mesh import Mesh, Points
from core.landmarks.detect import find_landmarks
from core.landmarks.types import Landmarks
from core.pipeline.observables import Tapes
from core.scan.body import read_scan

SAMPLE = Path(__file__).parents[1] / "resources" / "samples" / "mannequin.ply"
SIZES = {"33k": 0, "330k": 330_000, "1M": 1_000_000}
Work = Callable[[], object]


def medians(works: Mapping[str, Work], rounds: int) -> dict[str, float]:
    """Return the median [ms] of each work; all are done in turns, in any order, and once before."""
    order = np.random.default_rng(0)
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for work in works.values():
        work()
    for _ in range(rounds):
        for name in order.permutation(list(works)):
            work = works[name]
            start = time.process_time()
            work()
            seconds[name].append(time.process_time() - start)
    return {name: 1e3 * statistics.median(times) for name, times in seconds.items()}


def refined(mesh: Mesh, count: int) -> Mesh:
    """Return the mesh with ``count`` vertices: edges are halved, then some faces split at their centroids."""
    while 4 * len(mesh.vertices) < count:
        ends = np.sort(np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        edges, place = np.unique(ends, axis=0, return_inverse=True)
        a, b, c = mesh.faces.T
        x, y, z = len(mesh.vertices) + place.reshape(-1, 3).T
        faces = np.stack([[a, x, z], [x, b, y], [z, y, c], [x, y, z]]).transpose(0, 2, 1).reshape(-1, 3)
        mesh = Mesh(np.concatenate([mesh.vertices, mesh.vertices[edges].mean(axis=1)]), faces)
    more = count - len(mesh.vertices)
    if more <= 0:
        return mesh
    chosen = np.linspace(0, len(mesh.faces) - 1, more).astype(np.int64)
    a, b, c = mesh.faces[chosen].T
    new = len(mesh.vertices) + np.arange(more)
    split = np.stack([[a, b, new], [b, c, new], [c, a, new]]).transpose(0, 2, 1).reshape(-1, 3)
    middles = mesh.vertices[mesh.faces[chosen]].mean(axis=1)
    return Mesh(
        np.concatenate([mesh.vertices, middles]),
        np.concatenate([np.delete(mesh.faces, chosen, axis=0), split]),
    )


def pulled_in(control: ControlMesh) -> Points:
    points = control.mesh.vertices.copy()
    points[~control.fixed] -= 4.0 * control.mesh.vertex_normals[~control.fixed]
    return points


def updates(
    binding: Binding, double: Binding, moving: MovingFaces, tapes: Tapes, points: Points
) -> dict[str, Work]:
    """Give what is done in a frame, in the forms compared."""
    operator, wide = binding.operator, double.operator
    change, rest = binding.changes.of(points), moving.rest
    places = operator.apply(change, rest)
    rows = binding.operator.of_rows(np.arange(len(binding.moving)))
    dense = rows.toarray().astype(np.float32)
    single = change.astype(np.float32)
    tables = operator.weights, operator.starts, operator.columns

    def frame() -> None:
        now = operator.apply(binding.changes.of(points), rest)
        moving.normals(now)
        tapes(now)

    return {
        "t-FFD update": lambda: operator.apply(binding.changes.of(points), rest),
        "  in double precision": lambda: wide.apply(double.changes.of(points), rest),
        "  t-FFD in numpy": lambda: kernels.blend_plain(*tables, single, rest),
        "  scipy, row by row": lambda: binding.rest_moving + rows @ change,
        "  one dense product": lambda: binding.rest_moving + dense @ single,
        "normals": lambda: moving.normals(places),
        "  normals in numpy": lambda: kernels.normals_plain(places, moving.corners, moving.still),
        "volume, left and right": lambda: moving.side_volume_changes(places),
        "three girths": lambda: tapes(places),
        "whole frame": frame,
    }


def libigl(binding: Binding, moving: MovingFaces) -> dict[str, Work]:
    import igl  # noqa: PLC0415

    points, control, faces = np.array(binding.rest_moving), binding.changes.control, moving.corners.T.copy()
    corners, triangles, rest = np.array(control.vertices), np.array(control.faces), np.array(moving.rest)
    return {
        "libigl closest triangle": lambda: igl.point_mesh_squared_distance(points, corners, triangles),
        "libigl normals": lambda: igl.per_vertex_normals(rest, faces),
    }


def blender(binding: Binding, points: Points) -> dict[str, Work]:
    """Let Blender's Surface Deform move the same vertices, bound to the same control mesh."""
    import bpy  # noqa: PLC0415

    bpy.ops.wm.read_factory_settings(use_empty=True)
    objects = []
    for mesh in (binding.changes.control, binding.body):
        data = bpy.data.meshes.new("mesh")
        data.from_pydata(mesh.vertices.tolist(), [], mesh.faces.tolist())
        objects.append(bpy.data.objects.new("object", data))
        bpy.context.collection.objects.link(objects[-1])
    control, body = objects
    body.vertex_groups.new(name="patch").add(binding.moving.tolist(), 1.0, "REPLACE")
    bpy.context.view_layer.objects.active = body
    modifier = body.modifiers.new("deform", "SURFACE_DEFORM")
    modifier.target, modifier.vertex_group, modifier.use_sparse_bind = control, "patch", True
    bpy.ops.object.surfacedeform_bind(modifier="deform")
    if not modifier.is_bound:
        print("Blender could not bind the body")
        return {}
    shapes = [points.astype(np.float32).ravel(), binding.changes.control.vertices.astype(np.float32).ravel()]

    def update() -> None:
        shapes.reverse()
        control.data.vertices.foreach_set("co", shapes[0])
        control.data.update()
        bpy.context.view_layer.update()

    def without() -> None:
        modifier.show_viewport = False
        update()

    def with_it() -> None:
        modifier.show_viewport = True
        update()

    return {"Blender, Surface Deform": with_it, "  the same without it": without}


def others(binding: Binding, moving: MovingFaces, points: Points) -> dict[str, Work]:
    found: dict[str, Work] = {}
    for name, make in (
        ("libigl", lambda: libigl(binding, moving)),
        ("bpy (Blender)", lambda: blender(binding, points)),
    ):
        try:
            found |= make()
        except ImportError:
            print(f"{name} is not installed: skipped")
    return found


def measure(name: str, mesh: Mesh, control: ControlMesh, marks: Landmarks) -> None:
    once = {"patch": lambda: blend_weights(mesh, control)}
    fade = blend_weights(mesh, control).fade
    binding, double = (bind(mesh, control.mesh, fade, fixed=control.fixed, single=s) for s in (True, False))
    once["bind"] = lambda: bind(mesh, control.mesh, fade, fixed=control.fixed, single=True)
    moving = moving_faces(mesh, binding.moving)
    once["prepare faces"] = lambda: moving_faces(mesh, binding.moving)
    points = pulled_in(control)
    bust, under = marks.bust_level, marks.underbust_level
    tapes = Tapes(moving, [under, 0.5 * (under + bust), bust])
    operator = binding.operator
    columns, groups = operator.weights.size / len(binding.moving), len(operator.starts) - 1
    print(f"\n{name}: {len(mesh.vertices)} vertices, {moving.corners.shape[1]} faces change, ", end="")
    print(f"{len(binding.moving)} rows of {columns:.0f} columns in {groups} groups")
    block = np.ones(40_000_000, dtype=np.float32)
    target = np.empty_like(block)
    works = {"copy": lambda: np.copyto(target, block)} | updates(binding, double, moving, tapes, points)
    found = medians(works | others(binding, moving, points), 25 if len(mesh.vertices) < 500_000 else 11)
    found |= medians(once, 5 if len(mesh.vertices) < 100_000 else 3)
    bandwidth = 2e-6 * block.nbytes / found.pop("copy")
    read = operator.weights.nbytes + 2 * len(binding.moving) * 24 + 2 * moving.rest.nbytes
    floor = 1e-6 * read / bandwidth
    print(
        f"  memory {bandwidth:.1f} GB/s: the {1e-6 * read:.1f} MB of an update take {floor:.3f} ms at least"
    )
    ours = found["t-FFD update"]
    for work, took in found.items():
        print(f"  {work:27}{took:9.3f} ms{took / floor:8.1f} of that{took / ours:8.1f} of the update")


def main() -> None:
    with contextlib.suppress(AttributeError):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    start = time.perf_counter()
    kernels.warm()
    print(f"loops: {kernels.state()}, ready in {time.perf_counter() - start:.1f} s")
    body = read_scan(str(SAMPLE))
    marks = find_landmarks(body)
    control = fit_control_mesh(read_template("168"), body, marks)
    with threadpool_limits(1):
        for name, count in SIZES.items():
            measure(name, refined(body.mesh, count), control, marks)


if __name__ == "__main__":
    main()
