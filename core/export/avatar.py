"""The reshaped body as an avatar for apparel CAD, with the seams of a garment as named lines on it."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import numpy as np

from core.errors import UserError
from core.export.units_and_axes import GLTF, FileSpace, space_of
from core.files.atomic_write import atomic_path
from core.geometry.closest_point import barycentric, nearest_faces
from core.geometry.mesh import Mesh, Points
from core.messages import Message
from core.pattern.seam_curves import SeamCurve

AVATAR_FORMATS = ("obj", *GLTF)

BODY = "body"
"""The name of the body in the file; seams have their own names."""

OBJ_SPACE = FileSpace("mm", "y-up")
"""An OBJ names no unit. Source: CLO asks for y up (support-connect.clo-set.com, Creating Avatar)."""


def seam_lines(curves: Iterable[SeamCurve], skin: Mesh, worn: Points) -> dict[str, Points]:
    """Return seams drawn on ``skin``, (k, 3) [mm] by name, carried to the vertices ``worn`` (n, 3)."""
    found = {}
    for curve in curves:
        face, foot = nearest_faces(skin, curve.points, skin.centroid_tree)
        corners = skin.faces[face]
        shares = barycentric(skin.vertices[corners], foot)
        found[curve.name] = np.asarray(np.einsum("kc,kcx->kx", shares, worn[corners]))
    return found


def write_avatar(
    path: str | os.PathLike[str], body: Mesh, seams: Mapping[str, Points], kind: str = ""
) -> None:
    """Write ``body`` [mm] and ``seams`` by name, (k, 3) [mm], as OBJ or GLB by ``kind`` or the suffix, y up.

    An OBJ is in mm: group ``body`` of triangles, and a group of one line for each seam. A GLB is in m, as
    the format wants: a mesh and line segments with these names. Raises UserError for another kind or a path
    that cannot be written.
    """
    kind = kind or avatar_kind(path)
    check_kind(kind)
    named = {_name(name): points for name, points in seams.items()}
    data = _glb(body, named) if kind in GLTF else "\n".join(_obj_lines(body, named)).encode("ascii")
    with atomic_path(Path(path)) as partial:
        partial.write_bytes(data)


def avatar_kind(path: str | os.PathLike[str]) -> str:
    """Return the kind of a file by its suffix, in small letters without the dot."""
    return Path(path).suffix.lower().lstrip(".")


def check_kind(kind: str) -> None:
    """Raise UserError for a kind that is none of AVATAR_FORMATS."""
    if kind not in AVATAR_FORMATS:
        raise UserError(
            Message(".{kind} files are not supported for export.", kind=kind),
            Message("Choose one of: {choices}.", choices=", ".join(AVATAR_FORMATS)),
        )


def _name(name: str) -> str:
    """Return a name without blanks, which end a name in an OBJ."""
    return re.sub(r"[^\w.-]+", "_", name, flags=re.ASCII).strip("_") or "seam"


def _obj_lines(body: Mesh, seams: Mapping[str, Points]) -> Iterator[str]:
    yield f"# body and seams, {OBJ_SPACE.unit}, y up"
    yield f"o {BODY}"
    yield f"g {BODY}"
    for x, y, z in OBJ_SPACE.places(body.vertices).tolist():
        yield f"v {x:.4f} {y:.4f} {z:.4f}"
    for x, y, z in OBJ_SPACE.normals(body.vertex_normals).tolist():
        yield f"vn {x:.4f} {y:.4f} {z:.4f}"
    for corners in (body.faces + 1).tolist():
        yield "f " + " ".join(f"{corner}//{corner}" for corner in corners)
    count = len(body.vertices)
    for name, points in seams.items():
        yield f"o {name}"
        yield f"g {name}"
        for x, y, z in OBJ_SPACE.places(points).tolist():
            yield f"v {x:.4f} {y:.4f} {z:.4f}"
        yield "l " + " ".join(str(count + at + 1) for at in range(len(points)))
        count += len(points)
    yield ""


def _glb(body: Mesh, seams: Mapping[str, Points]) -> bytes:
    import trimesh  # noqa: PLC0415 (it takes long to load, and is needed here alone)

    space = space_of("glb")
    shape = trimesh.Trimesh(
        space.places(body.vertices),
        body.faces,
        vertex_normals=space.normals(body.vertex_normals),
        process=False,
    )
    scene = trimesh.Scene()
    scene.add_geometry(shape, node_name=BODY, geom_name=BODY)
    for name, points in seams.items():
        line = trimesh.path.entities.Line(np.arange(len(points)))
        path = trimesh.path.Path3D([line], space.places(points), process=False)
        scene.add_geometry(path, node_name=name, geom_name=name)
    return bytes(scene.export(file_type="glb", include_normals=True))
