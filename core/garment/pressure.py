"""Contact pressure under bands by Laplace's law, and its limits.

p = T / (w R): tension T over width w and the radius R of the band's path in the plane of the skin's normal.
The full law has a second term for the pull across the band; bands have none, it is left out.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property
from importlib import resources
from types import MappingProxyType
from typing import Any

import numpy as np

from core.garment.band_contact import STANDS_OFF, Bridge, bridge_between, bridges, pull_taut
from core.garment.band_path import BandPath, band_paths
from core.garment.curve_smoothing import USUAL_WIDTH
from core.garment.cut_list import is_strap
from core.garment.tension import LineTension, line_tensions
from core.geometry.mesh import Flags, Floats, Points
from core.measurements.size_table import LocalizedText, Source
from core.messages import Length, Message
from core.pipeline.stages import RegionStages

GREEN, AMBER, RED = "green", "amber", "red"


MMHG = 0.133322
"""One mmHg [kPa]."""

LEAST_OVER = 20.0
"""The radius is never taken over less than this length [mm]: a scan does not show more."""

LEFT_OUT = (
    Message("Estimate, probably too high: tissue yields under a band, and sensors measured up to 42 % less."),
    Message("Friction, such as the friction that keeps a band from slipping, is not included."),
    Message(
        "Only the tension along the band is included: fabric stretched in both directions has a "
        "higher contact pressure."
    ),
    Message(
        "The radius of curvature is averaged over about one band width: the pressure at bone edges is higher."
    ),
    Message("Valid for standing and quiet breathing: sitting or breathing in can double the pressure."),
)
"""What the figures leave out."""

SLACK_NOTE = Message("Slack: no contact pressure.")
"""What is said of a line without tension."""

NOT_FOR_STRAPS = Message(
    "The pressure limits apply to soft tissue around the trunk, not to bands over the shoulders."
)
"""What is said of a line that goes on beyond the control mesh, as straps do."""


@dataclass(frozen=True)
class PressureLimits:
    """From which pressure [kPa] the light is amber and red, what each light says, and how sure that is.

    ``beyond`` are pressures [kPa] above which more has to be said than the red light does, the lowest first.
    The limits are an estimate of ours between the figures of the ``sources``: guidance, nothing medical.
    """

    amber_kpa: float
    red_kpa: float
    lights: Mapping[str, LocalizedText]
    beyond: tuple[tuple[float, LocalizedText], ...]
    sources: tuple[Source, ...]
    doubts: tuple[LocalizedText, ...]

    def rating(self, kpa: float) -> str:
        """Return "green", "amber" or "red" for a pressure [kPa]."""
        return RED if kpa >= self.red_kpa else AMBER if kpa >= self.amber_kpa else GREEN

    def description(self, kpa: float) -> LocalizedText:
        """Return what is said of a pressure [kPa]."""
        above = [words for limit, words in self.beyond if kpa >= limit]
        return above[-1] if above else self.lights[self.rating(kpa)]


@cache
def pressure_limits() -> PressureLimits:
    """Return the limits that come with Busk."""
    values = json.loads((resources.files("resources") / "pressure.json").read_text(encoding="utf-8"))
    lights = {name: _words(values["lights"][name]) for name in (GREEN, AMBER, RED)}
    beyond = tuple((each["from_kpa"], _words(each)) for each in values["beyond"])
    sources = tuple(Source(each["name"], _words(each), each.get("name_ja", "")) for each in values["sources"])
    doubts = tuple(_words(each) for each in values["doubts"])
    amber, red = values["amber_kpa"], values["red_kpa"]
    return PressureLimits(amber, red, MappingProxyType(lights), beyond, sources, doubts)


def _words(values: Mapping[str, Any]) -> LocalizedText:
    return LocalizedText(values["en"], values["ja"])


@dataclass(frozen=True, eq=False)
class LinePressure:
    """What a band presses with at places along it, every ``step`` [mm], shape (k,).

    ``places`` (k, 3) [mm] of the taut band, the ``skin`` below it and its ``normals``; ``tension`` [N] (a
    slack band has none), ``bends`` [rad] towards the skin, how far the band is ``gap`` it [mm], ``front``
    where it is the front part; ``width`` [mm]. A ``closed`` one ends beside its beginning. ``input_notes``
    is what was put in.
    """

    places: Points
    skin: Points
    normals: Points
    tension: Floats
    bends: Floats
    gap: Floats
    front: Flags
    width: float
    step: float
    closed: bool
    input_notes: tuple[Message, ...] = ()

    @cached_property
    def along(self) -> Floats:
        """Return the distance of each place from the first [mm]."""
        return np.asarray(self.step * np.arange(len(self.places)))

    @cached_property
    def radius(self) -> Floats:
        """The radius that the band bends with towards the skin [mm]; infinite where it does not press."""
        with np.errstate(divide="ignore"):
            return np.asarray(self.step / self.bends)

    @cached_property
    def kpa(self) -> Floats:
        """Return the pressure at each place [kPa], 0 where the band bridges."""
        return np.asarray(1000.0 * self.tension / (self.width * self.radius))

    @cached_property
    def contact_share(self) -> Floats:
        """Return how much of the band lies on the skin at each place, 0 to 1.

        It fades while the band comes off, so that a hollow that hardly shows does not decide about the mean.
        """
        return np.asarray(np.clip(2.0 - self.gap / STANDS_OFF, 0.0, 1.0))

    @cached_property
    def bridges(self) -> tuple[Bridge, ...]:
        """Return where the band visibly bridges a hollow; a slack band does not."""
        return bridges(self.gap, self.step, self.closed) if self.tension.any() else ()

    @cached_property
    def bridged(self) -> Flags:
        """Return whether each place belongs to a hollow that the band goes straight over, shape (k,)."""
        flags = np.zeros(len(self.places), dtype=np.bool_)
        for bridge in self.bridges:
            inside = np.arange(np.ceil(bridge.begin / self.step), bridge.end / self.step).astype(np.int64)
            flags[inside % len(flags)] = True
        return flags

    @property
    def bridged_length(self) -> float:
        """Return how much of the band does not lie on the skin [mm]."""
        return sum(bridge.length for bridge in self.bridges)

    @property
    def mean(self) -> float:
        """Return the mean pressure where the band lies on the skin [kPa]."""
        return float(self.kpa.sum() / max(self.contact_share.sum(), 1.0))

    @property
    def peak(self) -> int:
        """Return the place that is pressed most."""
        return int(self.kpa.argmax())

    @property
    def largest(self) -> float:
        """Return the largest pressure [kPa]."""
        return float(self.kpa[self.peak])

    @property
    def force(self) -> float:
        """Return the sum of the magnitudes of all contact forces of the band [N]."""
        return float((self.tension * self.bends).sum())

    @property
    def resultant(self) -> Floats:
        """The sum of all forces on the skin along its normals, shape (3,) [N]; nothing for a level band."""
        inward = -self.tension * self.bends
        return np.asarray(inward @ self.normals, dtype=np.float64)

    @property
    def rating(self) -> str:
        """ "green", "amber" or "red" for the largest pressure; see ``core.garment.pressure``."""
        return pressure_limits().rating(self.largest)

    @property
    def notes(self) -> tuple[Message, ...]:
        """Return notes on assumptions, and on parts without contact."""
        texts = list(self.input_notes)
        if not self.tension.any():
            texts.append(SLACK_NOTE)
        elif not self.tension.all():
            texts.append(Message("Partly slack: no contact pressure there."))
        if self.bridges:
            most = max(bridge.height for bridge in self.bridges)
            texts.append(
                Message(
                    "Bridges hollows over {length}, up to {height} off the skin: no contact pressure there.",
                    length=Length(self.bridged_length),
                    height=Length(most),
                )
            )
        return tuple(texts)


def mmhg(kpa: float) -> float:
    """Return a pressure of so many kPa in mmHg."""
    return kpa / MMHG


def band_pressure(course: BandPath, width: float) -> LinePressure:
    """Return what a band ``width`` [mm] wide on a course presses with.

    The radius is taken over about its width. A hollow is bridged: there it does not press.
    """
    smooth = course.smoothed(max(width, LEAST_OVER))
    turns, touched = pull_taut(smooth.points, smooth.normals, course.closed)
    places, off = bridge_between(course.points, smooth.normals, touched, course.closed)
    tension = np.maximum(course.tension, 0.0)  # a band cannot push
    front, step, closed = course.front, course.step, course.closed
    return LinePressure(
        places, course.points, smooth.normals, tension, turns, off, front, width, step, closed
    )


def pressures(stages: RegionStages, control_points: Points) -> Mapping[str, LinePressure]:
    """Return what worn lines press with on the body as ``control_points``, (n, 3) [mm], shape it, by line.

    A line whose tension is not known is left out; see ``core.garment.tension``.
    """
    tensions = line_tensions(stages, control_points)
    return MappingProxyType(
        {
            name: replace(band_pressure(course, width), input_notes=_told(stages, name, tensions[name]))
            for name, course, width in band_paths(stages, control_points, tensions)
        }
    )


def _told(stages: RegionStages, name: str, tension: LineTension) -> tuple[Message, ...]:
    """Return in sentences what was taken for granted."""
    texts = []
    if tension.estimate:
        texts.append(Message("The tension is computed from the tissue stiffness alone (estimate)."))
    if not stages.design.line_settings(name).width:
        texts.append(Message("Width not specified: {width} assumed.", width=Length(USUAL_WIDTH)))
    if any(line.name == name and is_strap(stages, line) for line in stages.model.lines):
        texts.append(NOT_FOR_STRAPS)
    return tuple(texts)
