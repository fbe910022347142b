"""Sizes in letters, S to 3L, each by one girth: tables as data, whose steps overlap."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from core.measurements.size_table import LocalizedText, Source, Step


@dataclass(frozen=True)
class LetterTable:
    """What a letter stands for: ``steps`` [cm] of the measure ``girth``; where two overlap, both fit."""

    key: str
    title: LocalizedText
    girth: str
    steps: tuple[Step, ...]

    def sizes(self, girth_mm: float) -> tuple[str, ...]:
        """Return the letters that a girth [mm] may have, that with the nearest middle first."""
        girth = round(girth_mm / 10.0, 6)
        fitting = [step for step in self.steps if step.is_listed(girth)]
        return tuple(step.name for step in sorted(fitting, key=lambda step: abs(step.middle - girth)))


@dataclass(frozen=True)
class LetterSizes:
    """All such tables, where they come from and what in them is uncertain."""

    tables: tuple[LetterTable, ...]
    sources: tuple[Source, ...]
    doubts: tuple[LocalizedText, ...]


@cache
def letter_sizes() -> LetterSizes:
    """Return the tables that come with Busk, those of Japan."""
    text = (resources.files("resources") / "letter_sizes.json").read_text(encoding="utf-8")
    values = json.loads(text)
    return LetterSizes(
        tuple(_table(each) for each in values["tables"]),
        tuple(Source(each["name"], _words(each)) for each in values["sources"]),
        tuple(_words(each) for each in values["doubts"]),
    )


def _table(values: Mapping[str, Any]) -> LetterTable:
    steps = tuple(Step(*each) for each in values["steps"])
    return LetterTable(values["key"], _words(values["names"]), values["girth"], steps)


def _words(values: Mapping[str, Any]) -> LocalizedText:
    return LocalizedText(values["en"], values["ja"])
