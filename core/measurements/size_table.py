"""Size charts: bands by under-bust girth, cups by the difference of the girths."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

UNIT_MM = {"cm": 10.0, "in": 25.4}
"""The units that a table may speak in [mm]."""

UNDERBUST, BAND = "underbust", "band"
"""What a cup is counted from: the under-bust girth itself, or the middle of its band."""


@dataclass(frozen=True)
class LocalizedText:
    """A text of a table in English, and in Japanese where somebody wrote it."""

    en: str
    ja: str = ""

    def told(self, language: str) -> str:
        """Return the text in a language, in English where it is not known in that."""
        return (self.ja if language == "ja" else "") or self.en


@dataclass(frozen=True)
class Source:
    """Where numbers of a table come from: a ``name``, and what it says in words of our own.

    ``name_ja`` is the name as it is written in Japanese, if it is another one.
    """

    name: str
    words: LocalizedText
    name_ja: str = ""

    def named(self, language: str) -> str:
        """Return the name in a language."""
        return LocalizedText(self.name, self.name_ja).told(language)


@dataclass(frozen=True)
class Example:
    """Two girths in the unit of the table and the size that a source makes of them."""

    underbust: float
    bust: float
    size: str
    source: str


@dataclass(frozen=True)
class Step:
    """A band or a cup by its ``name``; the source says that it is for ``least`` to ``most`` [unit]."""

    name: str
    least: float
    most: float

    @property
    def middle(self) -> float:
        """Return the nominal value of the step [unit]."""
        return (self.least + self.most) / 2

    def is_listed(self, value: float) -> bool:
        """Return whether the source lists this value, so that it is in no gap of the table."""
        return self.least <= value <= self.most


@dataclass(frozen=True)
class Scale:
    """Steps that rise; a gap between two belongs by halves to both, a value between them to the nearest.

    ``upward`` says where a value right on a border belongs: to the step above it, or to the one below.
    """

    steps: tuple[Step, ...]
    upward: bool

    @cached_property
    def borders(self) -> tuple[float, ...]:
        """Return the limits between steps [unit], one more than there are steps.

        The outer ends reach out as far as the step there does into its inner gap.
        """
        inner = [(low.most + high.least) / 2 for low, high in pairwise(self.steps)]
        first, last = self.steps[0], self.steps[-1]
        ends = (first.least + first.most - inner[0], last.least + last.most - inner[-1])
        return tuple(round(border, 6) for border in (ends[0], *inner, ends[1]))

    def place(self, value: float) -> int:
        """Return the place of the step that a value belongs to: -1 below all, their number above all."""
        return (bisect_right if self.upward else bisect_left)(self.borders, value) - 1

    def step(self, place: int) -> Step | None:
        """Return the step of a place, None outside."""
        return self.steps[place] if 0 <= place < len(self.steps) else None

    def ends(self, place: int) -> tuple[float, float]:
        """Return where the step of a place begins and ends [unit]."""
        return self.borders[place], self.borders[place + 1]


@dataclass(frozen=True)
class SizeTable:
    """A system of sizes as its sources tell it.

    ``label`` is how a size is written, with {band} and {cup}; ``cup_from`` is UNDERBUST or BAND.
    ``doubts`` say what in it is uncertain, the gravest first, ``sources`` where it comes from, ``examples``
    what these work out. ``caution`` is that doubt in a few words, to stand beside each size, where others
    may find quite another one.
    """

    key: str
    system: str
    title: LocalizedText
    unit: str
    label: str
    cup_from: str
    bands: Scale
    cups: Scale
    sources: tuple[Source, ...]
    doubts: tuple[LocalizedText, ...]
    examples: tuple[Example, ...] = ()
    caution: LocalizedText | None = None

    @property
    def unit_mm(self) -> float:
        """Return the unit of the table [mm]."""
        return UNIT_MM[self.unit]

    def in_unit(self, mm: float) -> float:
        """Return a length in the unit of the table, without the dust of the conversion: borders hold."""
        return round(mm / self.unit_mm, 6)

    def over(self, underbust: float, bust: float) -> float | None:
        """Return what the cup is chosen by [unit], None if it is counted from a band that is not there."""
        band = self.bands.step(self.bands.place(underbust))
        if self.cup_from == BAND:
            return round(bust - band.middle, 6) if band else None
        return round(bust - underbust, 6)

    def steps(self, underbust: float, bust: float) -> tuple[Step | None, Step | None]:
        """Return the band and the cup of two girths [unit], None for one that lies outside the table."""
        over = self.over(underbust, bust)
        cup = None if over is None else self.cups.step(self.cups.place(over))
        return self.bands.step(self.bands.place(underbust)), cup

    def labelled(self, band: Step | None, cup: Step | None) -> str:
        """Return how a size is written, nothing if a part of it is not known."""
        return self.label.format(band=band.name, cup=cup.name) if band and cup else ""
