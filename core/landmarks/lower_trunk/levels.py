"""Levels of the lower trunk, each with how sure it is: crotch, largest tape, natural waist and belly."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core.errors import LandmarkError
from core.geometry.mesh import Floats, Points
from core.landmarks.lower_trunk.outline_profiles import (
    FINE,
    crossings,
    front,
    heights,
    midline_point,
    peak,
    smoothed,
    tapes,
)
from core.landmarks.lower_trunk.sections import STEP, LowerSection, LowerSections
from core.landmarks.torso.girths import MUCH
from core.landmarks.types import Landmark
from core.messages import Message

HALF_WIDTH = 130.0
"""Half the width of an average trunk 20 mm under the under-bust [mm]: lengths scale by it. Source: ours."""

UPWARD = 0.62
"""The largest tape is sought up to this part of the way from crotch to under-bust [1]. Source: measured."""

WAIST_ABOVE_HIP = 60.0
"""The natural waist lies at least this far above the largest tape [mm]. Source: measured on bodies."""

WAIST_DEPTH = 6.0
"""A natural waist is smaller than what is above and below it by this [mm]. Source: measured on bodies."""

WAIST_BELOW_BUST = 80.0
"""A body without a waist has it so far under the under-bust [mm, at scale 1]. Source: measured on bodies."""

LEGS_APART = 2.0
"""The middle between the legs is that so far under the crotch, where two outlines just part [mm]. Ours."""

BRIDGE_UP = 30.0
"""The depth of the trunk in its middle is measured so far above the crotch [mm, at scale 1]. Ours."""

BRIDGE = 100.0
"""A trunk less deep there is two thighs that touch [mm, at scale 1]. Source: measured on bodies."""

ALONG_BELLY = 12.0
"""The front midline is smoothed by a Gaussian of this width [mm]. Source: measured with noise."""

PUBIS = 80.0
"""The belly lies at least this far above the crotch [mm, at scale 1]. Ours."""

LOPSIDED = 40.0
"""Left and right half widths of a trunk that differ by more are those of a hand that touches [mm]. Ours."""

HIP_WIDTH = 10.0
"""Tapes are smoothed over this height [mm]. Source: measured with noise."""


@dataclass(frozen=True)
class Found:
    """A height ``z`` [mm] with its confidence (0..1) and the rule that found it."""

    z: float
    confidence: float
    rule: Message


def body_scale(sections: LowerSections) -> float:
    """Return the half width 20 mm under the under-bust, as a part of ``HALF_WIDTH`` [1]; 1 if unknown."""
    trunk = sections.at(sections.top - 20.0).trunk
    return 1.0 if trunk is None else 0.5 * float(np.ptp(trunk[:, 0])) / HALF_WIDTH


def crotch(sections: LowerSections, scale: float) -> Landmark:
    """Return the crotch. Raises LandmarkError if the scan ends above it, or if the thighs touch all along."""
    z = sections.crotch
    if z is None:
        raise no_crotch(sections)
    here, above = sections.at(z), sections.at(z + BRIDGE_UP * scale).trunk
    x = _between(sections.at(z - LEGS_APART), _between(here, sections.middle))
    depth = crossings(above, x) if above is not None else np.empty(0)
    place = _under(sections, x, z)
    rule = Message("Highest level with an outline of each leg.")
    if len(depth) < 2 or np.ptp(depth) < BRIDGE * scale:
        return Landmark("crotch", place, 0.3, Message("The thighs touch below the crotch: estimate."))
    if max(here.bridged, sections.at(z + 2.0).bridged) > 5.0:
        return Landmark("crotch", place, 0.3, Message("The scan has a hole at the crotch: estimate."))
    return Landmark("crotch", place, 0.95, rule)


def _between(section: LowerSection, otherwise: float) -> float:
    """Return the middle between the insides of both legs [mm]; ``otherwise`` where one is not seen."""
    left, right = section.legs
    if left is None or right is None:
        return otherwise
    return 0.5 * (float(left[:, 0].min()) + float(right[:, 0].max()))


def no_crotch(sections: LowerSections) -> LandmarkError:
    """Return the refusal of a scan without a crotch that can be found."""
    if sections.search == "touch":
        return LandmarkError(
            Message("The thighs touch all the way down: the crotch cannot be detected."),
            Message("Place the landmark crotch by hand, or scan with the legs apart."),
        )
    return LandmarkError(
        Message("The scan ends above the crotch, or shows one leg only."),
        Message("Scan down to the middle of both thighs."),
    )


def _under(sections: LowerSections, x: float, z: float) -> Points:
    """Return the middle of the skin between the legs at ``x``, just above height ``z``, (3,) [mm]."""
    for up in (0.25, 1.0, 4.0):
        trunk = sections.at(z + up).trunk
        if trunk is not None and len(ys := crossings(trunk, x)) > 1:
            return np.array([x, 0.5 * (ys[0] + ys[-1]), z])
    legs = [leg for leg in sections.at(z).legs if leg is not None]
    return np.array([x, float(np.mean([leg[:, 1].mean() for leg in legs])), z])


def tape_profile(sections: LowerSections, low: float) -> tuple[Floats, Floats]:
    """Return heights from ``low`` to the under-bust and smoothed tapes there, shape (k,) each [mm]."""
    z = heights(low, sections.top - 1.0, STEP)
    return z, smoothed(tapes(sections.many(z.tolist())), STEP, HIP_WIDTH)


def hip(profile: tuple[Floats, Floats], low: float, top: float) -> Found:
    """Return the level of the largest tape of a profile between the crotch at ``low`` and ``top`` [mm]."""
    z, tape = profile
    own = z <= low + UPWARD * (top - low)
    at, inside = peak(z[own], tape[own])
    rule = Message("Largest tape between crotch and waist.")
    return Found(at, 0.85 if inside else 0.4, rule)


def checked(sections: LowerSections, found: Found) -> Found:
    """Return a level with little confidence where its outline is not skin, or lopsided as by a hand."""
    section = sections.at(found.z)
    if section.trunk is None:
        return found
    x = section.trunk[:, 0] - sections.middle
    if abs(float(x.max() + x.min())) < LOPSIDED and section.bridged < MUCH:
        return found
    rule = Message("A hole or a hand at this level: estimate.")
    return replace(found, confidence=min(found.confidence, 0.4), rule=rule)


def waist(profile: tuple[Floats, Floats], hips: float, top: float, scale: float) -> Found:
    """Return the level of the least tape above the hips; of a body without a waist, one by proportion."""
    z, tape = profile
    own = z > hips + WAIST_ABOVE_HIP
    usual = top - WAIST_BELOW_BUST * scale
    if own.sum() > 2:
        at, inside = peak(z[own], -tape[own])
        least = float(np.nanmin(tape[own]))
        above = tape[z > at]
        deep = inside and float(np.nanmax(above, initial=0.0)) - least > WAIST_DEPTH
        if deep and at <= usual:
            return Found(at, 0.8, Message("Least tape between hip and under-bust."))
        if deep or at <= usual:
            return Found(min(at, usual), 0.4, Message("No clear waist: estimated from the under-bust."))
    return Found(usual, 0.3, Message("No waist below the bust: estimated from the under-bust."))


def belly(sections: LowerSections, low: float, high: float, scale: float) -> Found:
    """Return the level of the belly between the crotch at ``low`` and the waist at ``high`` [mm]."""
    z = heights(low + PUBIS * scale, max(high, low + (PUBIS + 20.0) * scale), FINE)
    out = -smoothed(front(sections.many(z.tolist()), sections.middle), FINE, ALONG_BELLY)
    inner = np.flatnonzero((out[1:-1] > out[:-2]) & (out[1:-1] >= out[2:])) + 1
    if len(inner):
        best = int(inner[np.argmax(out[inner])])
        at, _ = peak(z[best - 1 : best + 2], out[best - 1 : best + 2])
        return Found(at, 0.8, Message("Hump of the belly on the front midline."))
    chord = np.interp(z, z[[0, -1]], out[[0, -1]])
    best = int(np.nanargmax(out - chord)) if np.isfinite(out - chord).any() else len(z) // 2
    return Found(float(z[best]), 0.4, Message("No hump: farthest before the line from pubis to waist."))


def on_midline(name: str, sections: LowerSections, found: Found) -> Landmark:
    """Return a level as the landmark ``name`` on the front midline, with its outline as evidence."""
    found = checked(sections, found)
    trunk = sections.at(found.z).trunk
    curve = np.empty((0, 3)) if trunk is None else np.concatenate([trunk, trunk[:1]])
    return Landmark(name, midline_point(sections, found.z), found.confidence, found.rule, curve)
