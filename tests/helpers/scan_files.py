"""Small scan files of every format, made by hand: a house of two pentagons, four quads and two triangles."""

import base64
import gzip
import json
import struct
import zlib

import numpy as np

CORNERS = [(x, y, z) for y in (0, 4) for x, z in ((0, 0), (2, 0), (2, 2), (1, 3), (0, 2))]
WALLS = [
    (0, 1, 2, 3, 4),
    (9, 8, 7, 6, 5),
    (0, 5, 6, 1),
    (1, 6, 7, 2),
    (2, 7, 8, 3),
    (3, 8, 9, 4),
    (4, 9, 0),
    (9, 5, 0),
]
TRIANGLES = [(wall[0], wall[k], wall[k + 1]) for wall in WALLS for k in range(1, len(wall) - 1)]
VOLUME = 20.0
"""Of the house: a square of 2 and a roof of 1 above it, 4 deep."""

POINTS = np.array(CORNERS, dtype="<f4")
FACES = np.array(TRIANGLES, dtype="<u4")


def rows(values, form="{:g}"):
    return "".join(" ".join(form.format(v) for v in row) + "\n" for row in values)


def ply(order="ascii", *, real="float", extras=False, newline="\n"):
    """A PLY file; with ``extras`` colours, normals, lists of other things and elements without use."""
    head = ["ply", f"format {order} 1.0", "comment by hand", "element vertex 10"]
    head += ["property uchar red", "property list uchar short near"] if extras else []
    head += [f"property {real} {axis}" for axis in ("x", "y", "z", *(("nx", "ny", "nz") if extras else ()))]
    head += ["element odd 2", "property list int double what", "property char sign"] if extras else []
    head += ["element face 8", *(["property uchar red"] if extras else [])]
    head += ["property list uchar int vertex_indices", "end_header", ""]
    sign = ">" if order.endswith("big_endian") else "<"
    body, text = b"", ""
    for k, place in enumerate(CORNERS):
        near = [k, -k][: k % 3]
        values = [k, len(near), *near] if extras else []
        kinds = f"BB{len(near)}h" if extras else ""
        values += [*place, 0, 0, 1] if extras else place
        kinds += ("f" if real == "float" else "d") * (6 if extras else 3)
        body += struct.pack(sign + kinds, *values)
        text += " ".join(map(str, values)) + "\n"
    if extras:
        body += struct.pack(sign + "i2dbib", 2, 0.5, 1.5, -1, 0, 1)
        text += "2 0.5 1.5 -1\n0 1\n"
    for wall in WALLS:
        values = [*([7] if extras else []), len(wall), *wall]
        body += struct.pack(f"{sign}{'B' * extras}B{len(wall)}i", *values)
        text += " ".join(map(str, values)) + "\n"
    return newline.join(head).encode() + (text.encode() if order == "ascii" else body)


def obj():
    """An OBJ file with groups, corners with texture and normals, negative numbers and a broken line."""
    lines = ["# by hand", "mtllib none.mtl", "o front"]
    lines += [f"v {x} {y} {z} 0.5 0.5 0.5" for x, y, z in CORNERS[:5]]
    lines += ["vn 0 -1 0", "vt 0 0", "f -5//1 -4//1 -3//1 -2//1 -1//1  # pentagon", "g rest"]
    lines += [f"  v\t{x} {y:e} {z}" for x, y, z in CORNERS[5:]]
    lines += ["usemtl paint", "s off", "f 10/1/1 9/1/1 \\", "8/1/1 7/1/1 6/1/1"]
    lines += ["f " + " ".join(f"{k + 1}/1" for k in wall) for wall in WALLS[2:4]]
    lines += ["l 1 2", "p 1", *("f " + " ".join(str(k + 1) for k in wall) for wall in WALLS[4:])]
    return "\r\n".join(lines).encode()


def stl(*, text):
    if text:
        body = "".join(
            "facet normal 0 0 0\n outer loop\n"
            + "".join("  vertex {:e} {:e} {:e}\n".format(*POINTS[k]) for k in t)
            + " endloop\nendfacet\n"
            for t in TRIANGLES
        )
        return f"solid house\n{body}endsolid house\n".encode()
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *POINTS[list(t)].ravel(), 0) for t in TRIANGLES)
    return b"solid house in fact binary, facet".ljust(80) + struct.pack("<I", len(TRIANGLES)) + body


def off(kind="OFF"):
    more = {"OFF": (), "COFF": (9, 8, 7, 255), "NOFF": (0, 0, 1)}[kind]
    walls = "".join(f"{len(wall)} {' '.join(map(str, wall))} 0.1 0.2 0.3\n" for wall in WALLS)
    return f"{kind} # by hand\n\n10 8 0\n{rows([(*p, *more) for p in CORNERS])}# walls\n{walls}".encode()


def gltf(*, binary, buffer=None, **more):
    """The house half as large, lying, and a floor lower, put up by its nodes; the gables are a mesh apart."""
    points = ((POINTS - [0, 0, 1]) / 2).astype("<f4")[:, [0, 2, 1]] * [1, 1, -1]
    parts = [points.astype("<f4").tobytes(), FACES[:6].astype("<u2").tobytes(), FACES[6:].tobytes()]
    starts = [0, len(parts[0]), len(parts[0]) + len(parts[1])]
    content = b"".join(parts)
    views = [{"buffer": 0, "byteOffset": s, "byteLength": len(p)} for s, p in zip(starts, parts, strict=True)]
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": 10, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5123, "count": 18, "type": "SCALAR"},
        {"bufferView": 2, "componentType": 5125, "count": 30, "type": "SCALAR"},
    ]
    meshes = [{"primitives": [{"attributes": {"POSITION": 0}, "indices": k}]} for k in (1, 2)]
    half = 0.5**0.5
    nodes = [
        {"children": [1, 2], "translation": [0, 0, 1], "scale": [2, 2, 2]},
        {"mesh": 0, "rotation": [half, 0, 0, half]},
        {"mesh": 1, "matrix": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1]},
    ]
    uri = (
        {}
        if binary
        else {"uri": "data:application/octet-stream;base64," + base64.b64encode(content).decode()}
    )
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": meshes,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [buffer or {"byteLength": len(content), **uri}],
        **more,
    }
    text = json.dumps(document).encode()
    if not binary:
        return text
    text += b" " * (-len(text) % 4)
    content += b"\0" * (-len(content) % 4)
    chunks = (
        struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(content), b"BIN\0") + content
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def vtp(form="ascii", *, packed=False, encoding="raw", strip=True):
    """A VTP file; the last two walls come as one strip of triangles."""
    size = "<u8" if packed else "<u4"
    walls = WALLS[:6] if strip else WALLS
    arrays = {
        "points": ("Float32", POINTS),
        "corners": ("Int64", np.concatenate(walls).astype("<i8")),
        "ends": ("Int32", np.cumsum([len(wall) for wall in walls]).astype("<i4")),
        "strip": ("UInt8", np.array([4, 9, 0, 5], dtype="u1")),
        "strip end": ("Int32", np.array([4], dtype="<i4")),
    }
    appended, found = b"", {}
    for key, (_, values) in arrays.items():
        found[key] = len(appended)
        appended += _stored(values.tobytes(), size, packed, form != "appended" or encoding != "raw")

    def array(key, name, more=""):
        kind, values = arrays[key]
        content = {
            "ascii": " ".join(map(str, values.ravel().tolist())),
            "binary": _stored(values.tobytes(), size, packed, True).decode(),
            "appended": "",
        }[form]
        place = f' offset="{found[key]}"' if form == "appended" else ""
        return (
            f'<DataArray type="{kind}" Name="{name}" format="{form}"{place}{more}>\n{content}\n</DataArray>\n'
        )

    settings = ' compressor="vtkZLibDataCompressor"' if packed else ""
    settings += f' header_type="UInt{64 if packed else 32}"'
    text = (
        f'<?xml version="1.0"?>\n<VTKFile type="PolyData" byte_order="LittleEndian"{settings}>\n<PolyData>\n'
    )
    text += (
        f'<Piece NumberOfPoints="10" NumberOfPolys="{len(walls)}" NumberOfStrips="{int(strip)}">\n<Points>'
    )
    text += array("points", "any", ' NumberOfComponents="3"') + "</Points><Polys>"
    text += array("corners", "connectivity") + array("ends", "offsets") + "</Polys><Strips>"
    text += array("strip", "connectivity") + array("strip end", "offsets") + "</Strips></Piece></PolyData>"
    tail = b""
    if form == "appended":
        tail = f'\n<AppendedData encoding="{encoding}">\n_'.encode() + appended + b"\n</AppendedData>"
    return text.encode() + tail + b"\n</VTKFile>\n"


def _stored(content, size, packed, letters):
    code = base64.b64encode if letters else bytes
    if not packed:
        return code(np.array([len(content)], size).tobytes() + content)
    blocks = [content[k : k + 64] for k in range(0, len(content), 64)]
    squeezed = [zlib.compress(block) for block in blocks]
    rest = len(blocks[-1]) % 64
    head = np.array([len(blocks), 64, rest, *(len(block) for block in squeezed)], size)
    return code(head.tobytes()) + code(b"".join(squeezed))


HOUSES = {
    "text.ply": ply(),
    "text_extras.ply": ply(extras=True),
    "little.ply": ply("binary_little_endian"),
    "big.ply": ply("binary_big_endian", real="double"),
    "extras.ply": ply("binary_little_endian", extras=True, real="double", newline="\r\n"),
    "big_extras.ply": ply("binary_big_endian", extras=True),
    "groups.obj": obj(),
    "text.stl": stl(text=True),
    "binary.stl": stl(text=False),
    "plain.off": off(),
    "colours.off": off("COFF"),
    "normals.off": off("NOFF"),
    "binary.glb": gltf(binary=True),
    "text.gltf": gltf(binary=False),
    "text.vtp": vtp(),
    "base64.vtp": vtp("binary"),
    "base64_packed.vtp": vtp("binary", packed=True),
    "raw.vtp": vtp("appended"),
    "raw_packed.vtp": vtp("appended", packed=True),
    "letters.vtp": vtp("appended", encoding="base64"),
    "letters_packed.vtp": vtp("appended", encoding="base64", packed=True, strip=False),
    "packed.ply.gz": gzip.compress(ply("binary_little_endian"), mtime=0),
    "packed.obj.gz": gzip.compress(obj(), mtime=0),
    "in_fact_a_ply.stl": ply(),
    "in_fact_a_glb": gltf(binary=True),
    "in_fact_binary.dat": stl(text=False),
}
"""The same house in every format, by file name."""

CLOUDS = {
    "plain.xyz": rows(CORNERS).encode(),
    "counted.pts": b"10\n" + rows([(*p, 0.5, 1, 2, 3) for p in CORNERS]).encode(),
    "named.csv": b"x,y,z,nx,ny,nz\n" + rows([(*p, 0, 0.6, 0.8) for p in CORNERS]).replace(" ", ",").encode(),
    "semicolons.txt": b"# by hand\n\n" + rows([(*p, 1, 2, 3) for p in CORNERS]).replace(" ", ";").encode(),
    "cloud.ply": ply().replace(b"element face 8", b"element face 0")[: ply().index(b"\n5 0 1") + 1],
    "cloud.obj": "".join(f"v {x} {y} {z}\nvn 0 0.6 0.8\n" for x, y, z in CORNERS).encode(),
    "cloud.off": b"NOFF\n10 0 0\n" + rows([(*p, 0, 0.6, 0.8) for p in CORNERS]).encode(),
}
"""The corners of the house alone."""
