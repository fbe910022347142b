"""OBJ files: the polygons of all objects and groups together."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from core.errors import ScanError
from core.geometry.mesh import Faces, Floats, Indices
from core.progress import Progress
from core.scan.readers.colors import UNREADABLE, sampled, texture, with_colors, without_colors
from core.scan.readers.raw_scan import FREE, TIMES, Colours, RawScan, check_size, companion_file, fans
from core.scan.readers.text_table import Growing, Lines, Table, blocks, lines_of, table, whole

_LIBRARY = re.compile(rb"(?:^|[\n\r])[ \t]*mtllib[ \t]+([^\n\r]+)", re.IGNORECASE)
_CORNER = re.compile(rb"(?<!\S)[^\s/]+(?:/([^\s/]*)\S*)?")
_HEAD = _LARGEST_LIBRARY = 1 << 20  # where a library is named, and how much of it is read [bytes]
_MOST_TEXTURES = 100
_A_LINE = 64  # colours in a line, as ZBrush writes them


def with_texture(path: Path, data: bytes, most: int, progress: Progress) -> bytes:
    """Return an OBJ file with the colours of its textures as comments, if they still fit into ``most`` bytes.

    One without textures comes back as it is; textures that are missing or damaged leave an empty comment, of
    which the reader tells. Names that lead out of the folder are not followed. Raises Cancelled.
    """
    found = _LIBRARY.search(data[:_HEAD])
    library = companion_file(path, _text(found[1])) if found else None
    if library is None or MRGB in data:
        return data
    try:
        images = _images(library)
        if not images:
            return data
        comment = _comment(_painted(path.name, data, _pixels(path, images, most), progress))
    except (OSError, ValueError, ScanError):
        comment = b"\n" + MRGB + b"\n"
    return data + comment if len(data) + len(comment) <= most else data


def _images(library: Path) -> dict[bytes, bytes]:
    """Return the name of the image of each material that has one."""
    with library.open("rb") as file:
        text = file.read(_LARGEST_LIBRARY)
    images, material = dict[bytes, bytes](), b""
    for line in text.splitlines():
        word, _, rest = line.strip().partition(b" ")
        if word.lower() == b"newmtl":
            material = rest.strip()
        elif word.lower() == b"map_kd" and rest.strip() and len(images) < _MOST_TEXTURES:
            images[material] = rest.strip()
    return images


def _text(name: bytes) -> str:
    return name.decode("utf-8", errors="replace").strip()


def _pixels(path: Path, images: dict[bytes, bytes], most: int) -> dict[bytes, Colours]:
    """Return the pixels of each material's image. Raises OSError, ValueError."""
    known, room = dict[bytes, Colours](), FREE
    for name in dict.fromkeys(images.values()):
        # Options may precede the name, which may hold blanks.
        file = companion_file(path, _text(name)) or companion_file(path, _text(name.split()[-1]))
        if file is None or file.stat().st_size > most:
            raise ValueError("a texture that is missing or too large")
        content = file.read_bytes()
        room += TIMES * len(content)
        known[name] = texture(content, room)
        room -= known[name].nbytes
    return {material: known[name] for material, name in images.items()}


def _painted(name: str, data: bytes, pixels: dict[bytes, Colours], progress: Progress) -> Colours:
    """Return the colours of the vertices, shape (n, 4): of the texture at one of the corners of each."""
    check_size(name, data.count(b"\nv "), data.count(b"\nf "))  # at once
    if b"\\\n" in data or b"\\\r\n" in data:
        data = re.sub(rb"\\\r?\n", b" ", data)
    points, uvs, corners = 0, Growing("d"), Growing("q")
    number = {name: k for k, name in enumerate(pixels)}
    last = 0 if len(pixels) == 1 else -1  # a file without `usemtl` has the only material there is
    for block in blocks(name, data, progress):
        lines = lines_of(block)
        at, given = lines.marked(b"v"), lines.marked(b"vt")
        known = points + np.cumsum(at), len(uvs) // 2 + np.cumsum(given)
        uvs.add(table(lines.picked(given, 2)).columns(0, 2))
        used = lines.marked(b"usemtl")
        named = [line.split(None, 1)[-1].strip() for line in lines.picked(used).splitlines()]
        materials = np.array([last, *(number.get(name, -1) for name in named)])
        corners.add(_corners(lines, known, materials[np.cumsum(used)]))
        points, last = points + int(at.sum()), int(materials[-1])
    places = uvs.array().reshape(-1, 2)
    return _sampled(points, places, corners.array().reshape(-1, 3), list(pixels.values()))


def _corners(lines: Lines, known: tuple[Indices, Indices], material: Indices) -> Indices:
    """Return vertex, place in the texture and material of a corner at each vertex, shape (k, 3), from 0 on.

    Of all corners of polygons only those with a place and a material count.
    """
    chosen = lines.marked(b"f")
    text = lines.picked(chosen, 1)
    vertex = table(re.sub(rb"/[^\s]*", b"", text))
    place = whole(table(_CORNER.sub(lambda corner: corner[1] or b"0", text)).numbers)
    row = np.repeat(np.flatnonzero(chosen), vertex.counts)
    first = _from_zero(whole(vertex.numbers), known[0][row])
    corners = np.stack([first, _from_zero(place, known[1][row]), material[row]], axis=1)
    corners = corners[(place != 0) & (material[row] >= 0)]
    _, one = np.unique(corners[:, 0], return_index=True)  # a mesh has six times as many corners as vertices
    return np.asarray(corners[one])


def _from_zero(numbers: Indices, known: Indices) -> Indices:
    return np.where(numbers > 0, numbers - 1, numbers + known)


def _sampled(points: int, uvs: Floats, corners: Indices, images: list[Colours]) -> Colours:
    """Return the colours of vertices whose corners are known, as ``_corners`` gives them."""
    colours = without_colors(points)
    vertex, place, _ = corners.T
    corners = corners[(vertex >= 0) & (vertex < points) & (place >= 0) & (place < len(uvs))]
    for number, image in enumerate(images):
        vertex, place, _ = corners[corners[:, 2] == number].T
        colours[vertex] = sampled(image, uvs[place] * (1.0, -1.0) + (0.0, 1.0))
    if not colours[:, 3].any():
        raise ValueError("a texture that no corner refers to")
    return colours


def _comment(colours: Colours) -> bytes:
    """Return colours as lines of comment."""
    digits = np.roll(colours, 1, axis=1).tobytes().hex().encode()
    step = 8 * _A_LINE
    lines = [MRGB + b" " + digits[start : start + step] for start in range(0, len(digits), step)]
    return b"\n" + b"\n".join(lines) + b"\n"


MRGB = b"#MRGB"
"""A comment with the colours of vertices in order, of each eight hexadecimal digits: mask and RGB."""

_PAINT = re.compile(rb"(?<!\S)" + MRGB + rb"\b[ \t]*((?:[\da-fA-F]{2})*)")


def read_obj(name: str, data: bytes, progress: Progress) -> RawScan:
    """Read an OBJ file. Raises ScanError, ValueError if it is damaged.

    Corners may count from the first vertex (1, 2, ...) or back from the latest one (-1, -2, ...). Normals
    count only if there are as many as vertices: of a point cloud. Colours are those behind the coordinates of
    a vertex, or in comments as ZBrush writes them. Source: Wavefront's OBJ format.
    """
    check_size(name, max(data.count(b"\nv "), data.count(b"\nvn ")), data.count(b"\nf "))  # at once
    if b"\\\n" in data or b"\\\r\n" in data:
        data = re.sub(rb"\\\r?\n", b" ", data)
    vertices, normals, faces = Growing("d"), Growing("d"), Growing("q")
    behind, painted, points = Growing("d"), Growing("B"), 0
    for block in blocks(name, data, progress):
        for digits in _PAINT.findall(block) if MRGB in block else ():
            painted.add(np.frombuffer(bytes.fromhex(digits.decode()), dtype=np.uint8))
        lines = lines_of(block)
        at = lines.marked(b"v")
        rows = table(lines.picked(at, 1))
        vertices.add(rows.columns(0, 3))
        _add_colours(behind, points, rows)
        normals.add(table(lines.picked(lines.marked(b"vn"), 2)).columns(0, 3))
        faces.add(_polygons(name, lines, points + np.cumsum(at)))
        points += int(at.sum())
        check_size(name, max(points, len(normals) // 3), len(faces) // 3, len(data))
    directions = normals.array().reshape(-1, 3)
    colours = _colours(points, behind, painted)
    lost = colours is None and MRGB in data and _PAINT.search(data) is not None
    return RawScan(
        vertices.array().reshape(-1, 3),
        faces.array().reshape(-1, 3),
        directions if len(directions) == points else None,
        colours,
        (UNREADABLE,) if lost else (),
    )


def _add_colours(behind: Growing, points: int, rows: Table) -> None:
    """Append the numbers behind the coordinates of vertices after ``points`` others, NaN for none."""
    has = rows.counts >= 6
    if not has.any():
        return
    values = np.full((len(has), 3), np.nan)
    values[has] = rows.numbers[rows.starts[has, None] + np.arange(3, 6)]
    behind.add(np.full(3 * points - len(behind), np.nan))
    behind.add(values)


def _colours(points: int, behind: Growing, painted: Growing) -> Colours | None:
    """Return the colours of all vertices, shape (points, 4), None without any."""
    if points and len(painted) == 4 * points:
        paint = painted.array().reshape(-1, 4)
        colours = np.ascontiguousarray(np.roll(paint, -1, axis=1))
        colours[:, 3] = np.where(colours[:, 3] > 0, 255, 0)
        return colours
    if not len(behind):
        return None
    behind.add(np.full(3 * points - len(behind), np.nan))
    return with_colors(behind.array().reshape(-1, 3))


def _polygons(name: str, lines: Lines, known: Indices) -> Faces:
    """Return the triangles of one block; ``known`` tells how many vertices stand above each of its lines."""
    chosen = lines.marked(b"f")
    text = lines.picked(chosen, 1)
    if b"/" in text:
        text = re.sub(rb"/[^\s]*", b"", text)
    found = table(text)
    corners = whole(found.numbers)
    check_size(name, 0, int(np.maximum(found.counts - 2, 0).sum()))
    if (corners == 0).any():
        raise ValueError("a corner without a number")
    last = np.repeat(known[chosen], found.counts)
    return fans(np.where(corners > 0, corners - 1, corners + last), found.counts)
