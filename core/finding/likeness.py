"""What else a body may be than an upper body of true size that stands upright, told by its proportions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.finding.bust_check import refusal
from core.landmark import SIDES, Hint, Landmark, Landmarks
from core.mesh import Floats, Mesh, Points
from core.sections import hull_corners
from core.slicing.trunk_guide import guide_of
from core.standing.body_size import MILLIMETRES
from core.standing.upright import Pose
from core.trunk import Level, stable_level, trunk_levels

ANGULAR = 0.91
"""A section fills this share of the rectangle around it [1] if it is angular: those of bodies fill 0.89."""

TYPICAL = {"neck": 96.0, "length": 316.0, "waist": 696.0}
"""Width of the neck, height from waist to foot of the neck, girth of the waist of women [mm], medians."""

SPREAD = np.array([[0.0176, 0.0005, 0.0037], [0.0005, 0.0081, 0.0020], [0.0037, 0.0020, 0.0124]])
"""How these vary together from one woman to another: covariance of their natural logarithms."""

UNLIKELY, HALVED = 0.20, 0.10
"""So far is the size off [logarithm of the scale] if it is doubted; less if the file may hold a form at half
scale, which only lengths in inches can be mistaken for."""

HALF_SCALE = (280.0, 520.0)
"""Waists of dress forms at half scale [mm]."""

NECK = 180.0
"""What is narrower than this above the arm-pits is a neck [mm]."""

BACK, UPRIGHT, LEANS = 190.0, 9.0, 11.5
"""So far below the arm-pits [mm] a back slopes backward on its way up by so much [degrees]; one that does so
much more or less leans."""

FLAT_GIRTH, FLAT_DEPTH = 0.11, 34.0
"""A bust that is wider than the trunk under it by less than this part and stands out by less [mm] is flat."""

FLAT_SLOPE, FLAT_RUN, FLAT_AROUND, FAINT = 0.45, 42.0, 0.17, 0.3
"""So is one that stands out by less than this part of its drop to a fold that is hardly seen, and less than
so far, and is wider than the trunk by less than this part [1, mm, 1, 1]."""

SHALLOW = 24.0
"""So is one that stands out by less than this [mm], and by less than that part of its drop."""

WRINKLED, CREASED = 3.5, 2.4
"""Upright waves of the skin under the bust [mm, root of the mean square]: bodies have 3.3 at most. The lesser
is enough where cloth hides the folds as well."""

BRIDGED, LONG = 16.0, 45.0
"""Cloth that hides folds leaves the middle so little behind the bust points, and drops so far [mm]."""

DOUBTED = 0.45
"""The most that a landmark of the bust claims (0..1) where no breasts or clothes show."""

UNCLEAR = ("flat", "clothes")
"""The kinds of hints that make landmarks of the bust doubtful."""


@dataclass(frozen=True, eq=False)
class Build:
    """A trunk from below the waist to the arm-pits [mm]: its ``levels``, ascending, and those heights."""

    mesh: Mesh
    levels: list[Level]
    armpit: float


def build_of(mesh: Mesh, landmarks: Landmarks) -> Build:
    """Measure the trunk around the landmarks of the bust."""
    pits = [mark.position[2] for name, mark in landmarks.points.items() if name.startswith("armpit")]
    armpit = float(np.mean(pits)) if pits else landmarks.bust_level + 60.0
    low = max(float(mesh.vertices[:, 2].min()) + 5.0, armpit - 260.0)
    heights = np.linspace(low, armpit - 15.0, 24) if armpit - low > 80.0 else np.empty(0)
    levels = [level for level in trunk_levels(mesh, heights) if len(level.points) > 20]
    return Build(mesh, levels, armpit)


def refuse_angular(build: Build, landmarks: Landmarks) -> None:
    """Raise LandmarkError where the trunk is a block rather than a body."""
    under = [level for level in build.levels if level.z < landmarks.underbust_level - 5.0]
    if len(under) > 2 and np.median([_filling(level) for level in under[-4:]]) > ANGULAR:
        raise refusal("the trunk is angular like a block of stone or wood")


def hints(build: Build, pose: Pose, landmarks: Landmarks) -> tuple[Hint, ...]:
    """Return what the body seems to be that it should not be, most important first. Source: ours."""
    clothes = clothes_hint(build, landmarks)
    flat = () if clothes else flat_hint(build.mesh, landmarks)
    size = () if flat else size_hint(build, pose)
    return (*size, *clothes, *flat, *lean_hint(build, pose))


def flat_hint(mesh: Mesh, landmarks: Landmarks) -> tuple[Hint, ...]:
    """Return a hint where hardly a breast stands out of the chest."""
    under, bust = stable_level(mesh, landmarks.underbust_level), trunk_levels(mesh, landmarks.bust_level)[0]
    more = bust.tape - under.tape
    depth, drop = _breast(landmarks)
    seen = max(landmarks.points[f"fold_{side}"].confidence for side in SIDES)
    low = more < FLAT_GIRTH * under.tape and depth < FLAT_DEPTH
    low |= depth < min(FLAT_SLOPE * drop, SHALLOW)
    hung = depth < min(FLAT_SLOPE * drop, FLAT_RUN) and seen < FAINT and more < FLAT_AROUND * under.tape
    if not (low or hung):
        return ()
    sentence = (
        f"The bust girth is only {more:.0f} mm larger than the under-bust girth. The breasts may be small, "
        "compressed, removed or hidden by loose clothes, or this is a man: check bust points and folds."
    )
    return (Hint("flat", sentence),)


def clothes_hint(build: Build, landmarks: Landmarks) -> tuple[Hint, ...]:
    """Return a hint where the skin under the bust is wrinkled like loose clothes, or cloth hides folds."""
    waves = _waves([level for level in build.levels if level.z < landmarks.underbust_level - 10.0])
    seen = [landmarks.points[f"fold_{side}"].confidence for side in SIDES]
    centre = landmarks.points.get("front_centre")
    busts = np.mean([landmarks.position(f"bust_point_{side}") for side in SIDES], axis=0)
    bridged = centre is not None and centre.position[1] - busts[1] < BRIDGED
    hidden = max(seen) < 0.5 and min(seen) < FAINT and bridged and _breast(landmarks)[1] > LONG
    if not (waves > WRINKLED or (waves > CREASED and hidden)):
        return ()
    sentence = (
        "The surface under the bust has wrinkles like loose clothes. Bust points and folds under cloth are "
        "uncertain: scan the body in close-fitting underwear, or check them."
    )
    return (Hint("clothes", sentence),)


def _breast(landmarks: Landmarks) -> tuple[float, float]:
    """Return how far bust points lie before and above the folds, means of both sides [mm]."""
    busts, folds = (
        np.mean([landmarks.position(f"{kind}_{side}") for side in SIDES], axis=0)
        for kind in ("bust_point", "fold")
    )
    return float(folds[1] - busts[1]), float(busts[2] - folds[2])


def _waves(levels: Sequence[Level]) -> float:
    """Return the size of upright waves that go through most levels [mm]: of radius over direction."""
    turn = np.radians(np.arange(-180.0, 180.0, 2.0))
    waves = []
    for level in levels:
        p = level.segments.reshape(-1, 3)[:, :2]
        if len(p) < 60:
            continue
        p = p - 0.5 * (p.min(axis=0) + p.max(axis=0))
        way, radius = np.arctan2(p[:, 0], -p[:, 1]), np.hypot(p[:, 0], p[:, 1])
        order = np.argsort(way)
        even = np.interp(turn, way[order], radius[order], period=2.0 * np.pi)
        waves.append(gaussian_filter1d(even, 0.8, mode="wrap") - gaussian_filter1d(even, 7.0, mode="wrap"))
    if len(waves) < 3:
        return 0.0
    beside_spine = np.abs(turn) < 2.4
    return float(np.sqrt((np.median(waves, axis=0)[beside_spine] ** 2).mean()))


def doubted(points: Mapping[str, Landmark], found: tuple[Hint, ...]) -> float:
    """Return the most that landmarks of the bust may claim (0..1) with these hints."""
    by_hand = all(points[f"bust_point_{side}"].by_hand for side in SIDES)
    return DOUBTED if not by_hand and any(hint.kind in UNCLEAR for hint in found) else 1.0


def size_hint(build: Build, pose: Pose) -> tuple[Hint, ...]:
    """Return a hint where neck, length and waist are those of a body of another size."""
    lengths = _lengths(build)
    known = [k for k, name in enumerate(TYPICAL) if name in lengths]
    if "length" not in lengths:
        return ()
    over = np.array([np.log(lengths[name] / TYPICAL[name]) for name in TYPICAL if name in lengths])
    weight = np.linalg.inv(SPREAD[np.ix_(known, known)]).sum(axis=0)
    scale = float(weight @ np.clip(over, -0.6, 0.6) / weight.sum())
    in_cm = lengths["waist"] * MILLIMETRES["cm"] / MILLIMETRES[pose.unit]
    form = pose.unit == "inch" and HALF_SCALE[0] < in_cm < HALF_SCALE[1]
    if not (abs(scale) > UNLIKELY or (form and scale > HALVED)):
        return ()
    unit, length, percent = pose.unit, lengths["length"], 100.0 * abs(np.expm1(scale))
    if form:
        sentence = (
            f"In inches, the body is unusually large: {length:.0f} mm from waist to neck. In cm, it would be "
            f"a dress form at half scale, with a waist girth of {in_cm:.0f} mm. Check the unit."
        )
    elif scale > 0.0:
        sentence = (
            f"In {unit}, the body is unusually large: {length:.0f} mm from waist to neck, about "
            f"{percent:.0f} % more than usual. Check the unit."
        )
    else:
        sentence = (
            f"In {unit}, the body is unusually small: {length:.0f} mm from waist to neck, about "
            f"{percent:.0f} % less than usual. Check the unit."
        )
    return (Hint("size", sentence),)


def _lengths(build: Build) -> dict[str, float]:
    """Return those of the lengths in ``TYPICAL`` that the scan shows [mm]."""
    lengths: dict[str, float] = {}
    guide = guide_of(build.mesh)
    shown = guide.tape > 0.0
    if not shown.any():
        return lengths
    tape = gaussian_filter1d(np.interp(guide.z, guide.z[shown], guide.tape[shown]), 3.0)
    low = np.flatnonzero((guide.z < build.armpit - 60.0) & (guide.z > build.armpit - 400.0))
    slimmest = int(np.argmin(tape[low])) if len(low) else 0
    if slimmest <= 3:  # below a waist the trunk widens again
        return lengths
    waist = float(guide.z[low[slimmest]])
    lengths["waist"] = float(tape[low[slimmest]])
    heights, widths = _widths(build)
    narrow = np.flatnonzero((widths > 0.0) & (widths < NECK))[:10]
    if len(narrow):
        neck = narrow[np.argmin(widths[narrow])]
        lengths["neck"] = float(widths[neck])
        shoulders = np.flatnonzero(widths[:neck] > 1.9 * widths[neck])
        if len(shoulders):
            lengths["length"] = float(heights[shoulders[-1]] - waist)
    return lengths


def _widths(build: Build) -> tuple[Floats, Floats]:
    """Return heights every 6 mm above the arm-pits, and how wide the skin is there, arms included [mm]."""
    v, step = build.mesh.vertices, 6.0
    edges = np.arange(build.armpit + 20.0, float(v[:, 2].max()) + step, step)
    row = np.searchsorted(edges, v[:, 2])
    order = np.argsort(row, kind="stable")
    bounds = np.searchsorted(row[order], np.arange(1, len(edges) + 1))
    x = v[order, 0]
    spans = [float(np.ptp(x[a:b])) if b - a > 8 else 0.0 for a, b in pairwise(bounds)]
    return edges[: len(spans)] + 0.5 * step, np.array(spans)


def lean_hint(build: Build, pose: Pose) -> tuple[Hint, ...]:
    """Return a hint where the trunk leans in a file that is level, and the up that would correct it."""
    levels = [level for level in build.levels if level.z > build.armpit - BACK]
    if len(levels) < 8 or pose.tilt > 0.0:
        return ()
    slope = np.polyfit([level.z for level in levels], [_back(level) for level in levels], 1)[0]
    lean = UPRIGHT - float(np.degrees(np.arctan(slope)))
    if abs(lean) < LEANS:
        return ()
    angle = np.radians(lean)
    up = pose.file_to_mm[:3, :3].T @ np.array([0.0, -np.sin(angle), np.cos(angle)])
    direction = ",".join(f"{number:.3f}" for number in up / np.linalg.norm(up))
    forward, lean = lean > 0.0, abs(lean)
    if forward:
        sentence = (
            f"The trunk leans forward by about {lean:.0f} degrees, and girths are measured level. "
            f"To set it upright, turn the scan, or give --up {direction} to the command."
        )
    else:
        sentence = (
            f"The trunk leans backward by about {lean:.0f} degrees, and girths are measured level. "
            f"To set it upright, turn the scan, or give --up {direction} to the command."
        )
    return (Hint("lean", sentence),)


def _back(level: Level) -> float:
    """Return how far back a level reaches near its middle [mm]."""
    x, y = level.points[:, 0], level.points[:, 1]
    low, high = x.min(), x.max()
    return float(y[np.abs(x - 0.5 * (low + high)) < 0.25 * (high - low)].max(initial=y.min()))


def _filling(level: Level) -> float:
    """Return how much of the rectangle around a level its hull fills [1]."""
    flat: Points = level.points[:, :2]
    ring = flat[hull_corners(flat)]
    following = np.roll(ring, -1, axis=0)
    area = 0.5 * abs(float((ring[:, 0] * following[:, 1] - ring[:, 1] * following[:, 0]).sum()))
    return area / max(float(np.prod(np.ptp(ring, axis=0))), 1e-9)
