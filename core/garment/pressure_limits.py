"""Contact pressure limits with sources and uncertainties, as data."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from types import MappingProxyType
from typing import Any

from core.measurements.size_table import LocalizedText, Source

GREEN, AMBER, RED = "green", "amber", "red"


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
