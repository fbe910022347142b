"""Coloured scans of every kind, made by hand: the house of ``scan_files``, red in front and blue behind."""

import base64
import io
import json
from pathlib import Path

import numpy as np
from PIL import Image
from scan_files import CORNERS, POINTS, TRIANGLES, gltf, rows

from core.scan.readers.registry import read_raw

SAMPLE = Path(__file__).parents[2] / "resources" / "samples" / "mannequin.ply"

RED, BLUE = (200, 40, 20), (10, 60, 220)
COLOURS = np.array([RED if y == 0 else BLUE for _, y, _ in CORNERS], dtype=np.uint8)
MTL = b"newmtl skin\nKd 1 1 1\nmap_Kd -s 1 1 1 skin.png\n"

_HEAD = "ply\nformat {order} 1.0\nelement vertex 10\n{axes}{tints}element face 16\n{corners}end_header\n"


def picture(kind="PNG"):
    """An image whose left half is red and whose right half is blue."""
    pixels = np.zeros((8, 16, 3), dtype=np.uint8)
    pixels[:, :8], pixels[:, 8:] = RED, BLUE
    out = io.BytesIO()
    Image.fromarray(pixels).save(out, kind, quality=95)
    return out.getvalue()


def coloured_ply(real=False, order="ascii", prefix=""):
    tints = "".join(
        f"property {'float' if real else 'uchar'} {prefix}{c}\n" for c in ("red", "green", "blue")
    )
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    corners = "property list uchar int vertex_indices\n"
    head = _HEAD.format(order=order, axes=axes, tints=tints, corners=corners).encode()
    values = COLOURS / 255 if real else COLOURS
    if order == "ascii":
        body = rows(np.hstack([POINTS, values]), "{:.6g}") + rows([(3, *each) for each in TRIANGLES])
        return head + body.encode()
    vertices = np.zeros(10, [("place", "<f4", 3), ("tint", "<f4" if real else "u1", 3)])
    vertices["place"], vertices["tint"] = POINTS, values
    faces = np.zeros(16, [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, TRIANGLES
    return head + vertices.tobytes() + faces.tobytes()


def painted_sample():
    """Return the sample as PLY, its left side red and its right side blue."""
    scan = read_raw(SAMPLE.name, SAMPLE.read_bytes())
    vertices = np.zeros(len(scan.vertices), [("place", "<f8", 3), ("tint", "u1", 3)])
    vertices["place"], vertices["tint"] = scan.vertices, np.where(scan.vertices[:, :1] > 0.0, RED, BLUE)
    faces = np.zeros(len(scan.faces), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, scan.faces
    properties = [f"property double {axis}" for axis in "xyz"]
    properties += [f"property uchar {channel}" for channel in ("red", "green", "blue")]
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}", *properties]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    return "\n".join(head).encode() + vertices.tobytes() + faces.tobytes()


def coloured_obj():
    values = np.hstack([POINTS, COLOURS / 255])
    lines = [f"v {' '.join(map(str, each))}" for each in values.tolist()]
    return "\n".join([*lines, *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in TRIANGLES), ""]).encode()


def textured_obj(more=""):
    """An OBJ file with a texture beside it: each corner has a place in its red or in its blue half."""
    places = {0: 1, 4: -1}  # the first and the last of two
    faces = [" ".join(f"{k + 1}/{places[CORNERS[k][1]]}/1" for k in each) for each in TRIANGLES]
    lines = [
        "mtllib house.mtl",
        *(f"v {x} {y} {z}" for x, y, z in CORNERS),
        "vt 0.25 0.9",
        "vt 1.75 0.1",
        more,
    ]
    return "\n".join([*lines, "usemtl skin", *(f"f {each}" for each in faces), ""]).encode()


def coloured_gltf(kind="f4", width=3):
    """A glTF file with colours at its vertices."""
    full = {"f4": 1.0, "u1": 255, "u2": 65535}[kind]
    values = np.ones((10, width)) * full
    values[:, :3] = COLOURS / 255 * full
    code = {"f4": 5126, "u1": 5121, "u2": 5123}[kind]
    accessor = {"componentType": code, "count": 10, "type": f"VEC{width}", "normalized": kind != "f4"}
    return _more_gltf(values.astype(f"<{kind}").tobytes(), accessor, "COLOR_0")


def textured_gltf(image=None, uri=None):
    """A glTF file with a texture, ``image`` in it or ``uri`` beside it."""
    places = np.array([(0.25, 0.5) if y == 0 else (0.75, 0.5) for _, y, _ in CORNERS], dtype="<f4")
    accessor = {"componentType": 5126, "count": 10, "type": "VEC2"}
    document = json.loads(_more_gltf(places.tobytes(), accessor, "TEXCOORD_0"))
    document["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    document["textures"], document["images"] = [{"source": 0}], [{"uri": uri}]
    if uri is None:
        document["images"] = [{"uri": _uri(picture() if image is None else image)}]
    for mesh in document["meshes"]:
        mesh["primitives"][0]["material"] = 0
    return json.dumps(document).encode()


def _uri(data):
    return "data:application/octet-stream;base64," + base64.b64encode(data).decode()


def _more_gltf(values, accessor, name):
    document = json.loads(gltf(binary=False))
    document["buffers"].append({"byteLength": len(values), "uri": _uri(values)})
    document["bufferViews"].append({"buffer": 1, "byteLength": len(values)})
    document["accessors"].append({"bufferView": 3, **accessor})
    for mesh in document["meshes"]:
        mesh["primitives"][0]["attributes"][name] = 3
    return json.dumps(document).encode()


COLOURED = {
    "uchar.ply": coloured_ply(),
    "float.ply": coloured_ply(real=True),
    "binary.ply": coloured_ply(order="binary_little_endian", prefix="diffuse_"),
    "behind.obj": coloured_obj(),
    "shares.gltf": coloured_gltf(),
    "bytes.gltf": coloured_gltf("u1", 4),
    "words.gltf": coloured_gltf("u2", 4),
    "texture.gltf": textured_gltf(),
}
"""Files that need no other beside them."""
