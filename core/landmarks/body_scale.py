"""Plausibility of the scale of a body, by the lengths of adults."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.geometry.mesh import Floats, Indices, Mesh
from core.landmarks.torso.cross_sections import Level, trunk_levels
from core.landmarks.torso.torso_axis import torso_axis
from core.landmarks.types import Hint, Landmarks
from core.messages import Length, Message
from core.scan.orientation.pose import Pose
from core.scan.orientation.unit_detection import MILLIMETRES

TYPICAL = {"neck": 96.0, "length": 316.0, "waist": 696.0}
"""Width of the neck, height from waist to foot of the neck, girth of the waist of women [mm], medians."""

SPREAD = np.array([[0.0176, 0.0005, 0.0037], [0.0005, 0.0081, 0.0020], [0.0037, 0.0020, 0.0124]])
"""How these vary together from one woman to another: covariance of their natural logarithms."""

UNLIKELY, HALVED = 0.18, 0.10
"""So far is the size off [logarithm of the scale] if it is doubted; less if the file may hold a form at half
scale, which only lengths in inches can be mistaken for."""

HALF_SCALE = (280.0, 520.0)
"""Waists of dress forms at half scale [mm]."""

NECK = 0.45
"""What is narrower than this part of the shoulders above the arm-pits is a neck [1], whatever the scale."""

STATURES = 1400.0, 1880.0
"""Statures of women, but for one in a thousand [mm]."""

HEAD, LEGS = 1.4, (2.4, 3.8)
"""A head is so much wider than the neck; from foot to arm-pit is so many times from there to the top [1]."""


@dataclass(frozen=True, eq=False)
class Build:
    """A trunk from below the waist to the arm-pits [mm]: its ``levels``, ascending, and those heights."""

    mesh: Mesh
    levels: list[Level]
    armpit: float


def measure_build(mesh: Mesh, landmarks: Landmarks) -> Build:
    """Measure the trunk around the landmarks of the bust."""
    pits = [mark.position[2] for name, mark in landmarks.points.items() if name.startswith("armpit")]
    armpit = float(np.mean(pits)) if pits else landmarks.bust_level + 60.0
    low = max(float(mesh.vertices[:, 2].min()) + 5.0, armpit - 260.0)
    heights = np.linspace(low, armpit - 15.0, 24) if armpit - low > 80.0 else np.empty(0)
    levels = [level for level in trunk_levels(mesh, heights) if len(level.points) > 20]
    return Build(mesh, levels, armpit)


def size_hint(build: Build, pose: Pose) -> tuple[Hint, ...]:
    """Return a hint where stature, or neck, length and waist, are those of a body of another size."""
    heights, widths = _widths(build)
    low, unit = float(build.mesh.vertices[:, 2].min()), pose.unit
    stature = whole_figure(heights, widths, build.armpit, low)
    if stature and not STATURES[0] < stature < STATURES[1]:
        sentence = Message(
            "In {unit}, the body is {stature} tall, which is rare among adults. Check the unit.",
            unit=unit,
            stature=Length(stature),
        )
        return (Hint("size", sentence),)
    lengths = _lengths(build, heights, widths)
    return _torso_hint(lengths, unit) if "length" in lengths else ()


def _torso_hint(lengths: dict[str, float], unit: str) -> tuple[Hint, ...]:
    known = [k for k, name in enumerate(TYPICAL) if name in lengths]
    over = np.array([np.log(lengths[name] / TYPICAL[name]) for name in TYPICAL if name in lengths])
    weight = np.linalg.inv(SPREAD[np.ix_(known, known)]).sum(axis=0)
    scale = float(weight @ np.clip(over, -0.6, 0.6) / weight.sum())
    in_cm = lengths["waist"] * MILLIMETRES["cm"] / MILLIMETRES[unit]
    form = unit == "inch" and HALF_SCALE[0] < in_cm < HALF_SCALE[1] and scale > HALVED
    if not (abs(scale) > UNLIKELY or form):
        return ()
    length, percent = lengths["length"], 100.0 * abs(np.expm1(scale))
    if form:
        sentence = Message(
            "In inches, the body is unusually large: {length} from waist to neck. In cm, it "
            "would be a dress form at half scale, with a waist girth of {in_cm}. Check the unit.",
            length=Length(length),
            in_cm=Length(in_cm),
        )
    elif scale > 0.0:
        sentence = Message(
            "In {unit}, the body is unusually large: {length} from waist to neck, about "
            "{percent} % more than usual. Check the unit.",
            unit=unit,
            length=Length(length),
            percent=f"{percent:.0f}",
        )
    else:
        sentence = Message(
            "In {unit}, the body is unusually small: {length} from waist to neck, about "
            "{percent} % less than usual. Check the unit.",
            unit=unit,
            length=Length(length),
            percent=f"{percent:.0f}",
        )
    return (Hint("size", sentence),)


def whole_figure(heights: Floats, widths: Floats, armpit: float, low: float) -> float:
    """Return the height of a figure from its feet to the top of its head, 0 if the scan lacks either [mm].

    ``widths`` of rows at ``heights`` above the arm-pits, both of shape (k,) [mm]; ``low`` is the lowest
    level of the scan [mm]. Source: ours.
    """
    narrow = _neck_rows(widths)
    if not len(narrow):
        return 0.0
    neck, top = narrow[np.argmin(widths[narrow])], float(heights[-1])
    head = widths[neck:].max() > HEAD * widths[neck] and top - heights[neck] > 0.35 * (top - armpit)
    return top - low if head and LEGS[0] < (armpit - low) / (top - armpit) < LEGS[1] else 0.0


def _lengths(build: Build, heights: Floats, widths: Floats) -> dict[str, float]:
    """Return those of the lengths in ``TYPICAL`` that the scan shows [mm]."""
    lengths: dict[str, float] = {}
    guide = torso_axis(build.mesh)
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
    narrow = _neck_rows(widths)
    if len(narrow):
        neck = narrow[np.argmin(widths[narrow])]
        lengths["neck"] = float(widths[neck])
        shoulders = np.flatnonzero(widths[:neck] > 1.9 * widths[neck])
        if len(shoulders):
            lengths["length"] = float(heights[shoulders[-1]] - waist)
    return lengths


def _neck_rows(widths: Floats) -> Indices:
    """Return the lowest rows that are a neck, shape (k,)."""
    return np.flatnonzero((widths > 0.0) & (widths < NECK * widths.max(initial=0.0)))[:10]


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
