"""A body with the edits of its scan: cropped, mirrored, its holes filled."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from core.errors import LandmarkError
from core.geometry.mesh import Flags, Mesh, Points
from core.messages import Message
from core.progress import Progress, quiet
from core.scan.body import Body
from core.scan.orientation.symmetry_planes import middle_of, sample_uniformly
from core.scan.readers.colors import transfer_colors, without_colors
from core.scan.repair.clipping import clip_above, mirrored_half
from core.scan.repair.holes import Hole, fill_large_holes, hole_sentences
from core.scan.repair.repair import hole_count
from core.scan.source import LEAST_HEIGHT, UNEDITED, ScanEdits

NEAR = 25.0
"""The centre of a hole is recognised within this distance, or half the hole's length [mm]."""

NO_BUST = Message("No bust detected on the edited scan.")
KEEP_MORE = Message("Crop less: keep the body from the waist to the neck.")


def apply_edits(body: Body, edits: ScanEdits, progress: Progress = quiet) -> Body:
    """Return an upright body with its scan edited, ready to be measured; itself without edits.

    Raises LandmarkError if a crop leaves no body, Cancelled.
    """
    if edits != UNEDITED:
        body = _edited(body, edits)
    body.denoise(progress)
    return body


def _edited(body: Body, edits: ScanEdits) -> Body:
    mesh, levels = _cropped(body, edits)
    sentences: list[Message] = []
    if levels:
        sentences.append(Message("Cropped manually."))
    scanned = mesh.vertices
    if edits.kept:
        sign = 1.0 if edits.kept == "left" else -1.0
        middle = middle_of(sample_uniformly(mesh.vertices, mesh.faces), np.array([1.0, 0.0, 0.0]))
        mesh = mirrored_half(mesh, middle, sign)
        scanned = mesh.vertices.copy()  # where the vertices of the image come from
        scanned[:, 0] = middle + sign * np.abs(mesh.vertices[:, 0] - middle)
    colours = None if body.colours is None else transfer_colors(scanned, body.mesh.vertices, body.colours)
    last = replace(body, mesh=mesh, cut=levels, edits=edits, uncropped_range=body.heights, colours=colours)
    if edits.filled or edits.fill_all:
        chosen = _chosen(last.holes, edits)
        mesh, estimated, unfilled = fill_large_holes(mesh, chosen)
        if done := len(chosen) - unfilled:
            sentences.append(
                Message("Filled {holes} manually: the skin there is an estimate.", holes=hole_count(done))
            )
        if unfilled:
            sentences.append(
                Message("Holes whose border touches itself cannot be filled: {count}.", count=unfilled)
            )
        if colours is not None:
            colours = np.concatenate([colours, without_colors(len(estimated))])
        last = replace(last, mesh=mesh, estimated=estimated, colours=colours)
    former = set(hole_sentences(body.mesh, body.holes))
    kept = [each for each in body.repairs if each not in former]
    return replace(last, repairs=(*kept, *sentences, *hole_sentences(mesh, last.holes)))


def mirror_sentence(kept: str) -> Message:
    """Return the warning that one half of a body is no scan of it."""
    if kept == "left":
        return Message("The right half is a mirror image of the left one: left and right are identical.")
    return Message("The left half is a mirror image of the right one: left and right are identical.")


def _cropped(body: Body, edits: ScanEdits) -> tuple[Mesh, tuple[float, ...]]:
    """Return the skin between the levels that are kept, and the heights at which it was cut [mm]."""
    mesh, floor, levels = body.mesh, body.heights[0], list[float]()
    for level, sign in ((edits.low, 1.0), (edits.high, -1.0)):
        if level is None:
            continue
        mesh, cut = clip_above(mesh, 2, floor + level, sign)
        if len(mesh.faces) == 0 or np.ptp(mesh.vertices[:, 2]) < LEAST_HEIGHT:
            raise LandmarkError(NO_BUST, KEEP_MORE)
        if cut.any():
            levels.append(floor + level)
    return mesh, tuple(levels)


def _chosen(holes: Sequence[Hole], edits: ScanEdits) -> list[Hole]:
    """Return the holes to fill: all of them, or those nearest to the centres that were chosen."""
    if edits.fill_all:
        return list(holes)
    left = list(holes)
    chosen = []
    for place in edits.filled:
        away = [float(np.linalg.norm(hole.centre - place)) for hole in left]
        if away and min(away) < max(NEAR, 0.5 * left[int(np.argmin(away))].length):
            chosen.append(left.pop(int(np.argmin(away))))
    return chosen


def is_estimated(body: Body, places: Points) -> Flags:
    """Return which places, shape (k, 3) [mm], are on skin that fills a hole, shape (k,)."""
    inside = np.zeros(len(body.mesh.vertices), dtype=bool)
    inside[body.estimated] = True
    return np.asarray(inside[cKDTree(body.mesh.vertices).query(places)[1]])
