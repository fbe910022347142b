"""Colours of a scan at its vertices: numbers as bytes, textures sampled, laid on another mesh."""

from __future__ import annotations

import io
import warnings

import numpy as np
from scipy.spatial import cKDTree

from core.geometry.mesh import MAX_COORDINATE, Floats, Points
from core.messages import Message
from core.scan.readers.raw_scan import Colours

UNREADABLE = Message("The colours of the scan could not be read.")

FINEST = 2048
"""A texture is sampled with about so many pixels a side: a vertex covers several of a finer one."""

NEAR = 10.0
"""A vertex has the colour of the nearest scanned one within this distance [mm]."""

_LARGEST_PROGRESSIVE = 8192**2
"""A progressive JPEG is held whole while it is decoded, 6 or 8 bytes a pixel, however small it is to be."""

_FORMATS = ("JPEG", "PNG", "BMP", "TGA")


def without_colors(count: int) -> Colours:
    """Return the colours of vertices without any, shape (count, 4)."""
    return np.zeros((count, 4), dtype=np.uint8)


def full_of(kind: np.dtype[np.generic]) -> float | None:
    """Return the brightest value of a kind of whole numbers, None of others.

    None also of those of four bytes: who writes them means bytes.
    """
    return float(2 ** (8 * kind.itemsize) - 1) if kind.kind in "iu" and kind.itemsize <= 2 else None


def with_colors(values: Floats, full: float | None = None) -> Colours:
    """Return the colours of rows of three numbers, shape (n, 3), of which ``full`` is the brightest.

    None: fractions of 1 if none is larger, else of 255. Rows of numbers that are not finite have no colour.
    """
    colours = without_colors(len(values))
    known = np.isfinite(values).all(axis=1)
    real = values[known]
    full = full or (1.0 if real.max(initial=0.0) <= 1.0 else 255.0)
    colours[known, :3] = np.round(np.clip(real * (255.0 / full), 0.0, 255.0))
    colours[known, 3] = 255
    return colours


def texture(data: bytes, room: int) -> Colours:
    """Return the pixels of an image, shape (rows, columns, 3), thinned to about ``FINEST`` a side.

    Raises ValueError if it is damaged, of another format, or takes more than ``room`` bytes.
    """
    from PIL import Image

    try:
        warnings.simplefilter("ignore", Image.DecompressionBombWarning)  # what it may take is looked at here
        image = Image.open(io.BytesIO(data), formats=_FORMATS)
        if image.info.get("progressive") and image.width * image.height > _LARGEST_PROGRESSIVE:
            raise ValueError("an image that takes far more memory than its pixels")
        if image.format == "JPEG":
            image.draft("RGB", (FINEST, FINEST))  # decoded at a half, a quarter or an eighth
        if 4 * image.width * image.height > room:
            raise ValueError("an image of far more pixels than bytes")
        return np.asarray(image.convert("RGB").reduce(max(1, max(image.size) // FINEST)))
    except Exception as problem:  # a malformed image makes its reader fail in any way
        raise ValueError("a texture that cannot be read") from problem


def sampled(pixels: Colours, places: Floats) -> Colours:
    """Return the colours of an image at places, shape (n, 2), from its upper left, (0, 0), to (1, 1).

    The image repeats beyond. Rows of numbers that are not finite have no colour.
    """
    colours = without_colors(len(places))
    known = np.isfinite(places).all(axis=1)
    x, y = (np.mod(places[known], 1.0) * (pixels.shape[1], pixels.shape[0])).astype(np.int64).T
    at = np.minimum(y, pixels.shape[0] - 1), np.minimum(x, pixels.shape[1] - 1)
    colours[known, :3], colours[known, 3] = pixels[at], 255
    return colours


def is_plain(colours: Colours | None) -> bool:
    """Return whether there are no colours, or the same everywhere."""
    if colours is None:
        return True
    known = colours[colours[:, 3] > 0]
    return len(known) == 0 or not np.ptp(known, axis=0).any()


def transfer_colors(vertices: Points, scanned: Points, colours: Colours) -> Colours:
    """Return the colours of ``vertices``, (n, 3) [mm], of the nearest ``scanned`` ones, (k, 3) [mm].

    Cleaning moves few vertices and makes few new ones, so nearly all find themselves.
    """
    found = without_colors(len(vertices))
    sound = (np.abs(scanned) < MAX_COORDINATE).all(axis=1)
    scanned, colours = scanned[sound], colours[sound]
    if len(scanned):
        away, nearest = cKDTree(scanned).query(vertices, distance_upper_bound=NEAR)
        near = np.flatnonzero(np.asarray(away) < NEAR)
        found[near] = colours[np.asarray(nearest)[near]]
    return found
