"""Size charts: bands by under-bust girth, cups by the difference of the girths."""

from __future__ import annotations

import json
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

from core.document.printable_name import is_printable
from core.errors import SizeError, reason_of
from core.files.regular_file import read_text
from core.messages import Message

UNIT_MM = {"cm": 10.0, "in": 25.4}
"""The units that a table may speak in [mm]."""

UNDERBUST, BAND = "underbust", "band"
"""What a cup is counted from: the under-bust girth itself, or the middle of its band."""


FORMAT = 1
"""The newest format of a table of sizes that is read."""

_LARGEST = 1_000_000  # bytes

_LONGEST = 10_000  # letters of a text in it

_KEYS: tuple[str, ...] = ("format", "system", "names", "unit", "label", "cup_from", "borders")

_MAY = ("caution",)

_MOST = 10_000.0
"""No number of a table is larger [unit]."""

_SIDES = {"up": True, "down": False}

T = TypeVar("T")


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


_KEYS += ("bands", "cups", "sources", "doubts", "examples")


def read_table(path: Path) -> SizeTable:
    """Read a table's file, whose name without the ending is the key. Raises SizeError, which says why not."""
    try:
        return table_of(path.stem, read_text(path, _LARGEST))
    except (OSError, ValueError) as problem:
        raise SizeError(
            Message("The size chart {name} cannot be read: {why}.", name=path.name, why=reason_of(problem)),
            Message("Correct the file or remove it."),
        ) from problem


def table_of(key: str, text: str) -> SizeTable:
    """Return the table that a file's text describes. Raises ValueError, which says what is wrong in it."""
    try:
        values = json.loads(text, parse_constant=_no_number)
    except RecursionError as problem:
        raise ValueError("it is nested too deeply") from problem
    _same_keys("it", values, _KEYS, _MAY)
    if values["format"] != FORMAT or isinstance(values["format"], bool):
        raise ValueError(f"it is not of format {FORMAT}")
    borders = values["borders"]
    _same_keys("borders", borders, ("band", "cup"))
    table = SizeTable(
        key=key,
        system=_text("system", values["system"]),
        title=_words("names", values["names"]),
        unit=_one_of("unit", values["unit"], UNIT_MM),
        label=_label(values["label"]),
        cup_from=_one_of("cup_from", values["cup_from"], (UNDERBUST, BAND)),
        bands=_scale("bands", values["bands"], _one_of("borders", borders["band"], _SIDES)),
        cups=_scale("cups", values["cups"], _one_of("borders", borders["cup"], _SIDES)),
        sources=_list("sources", values["sources"], _source, least=1),
        doubts=_list("doubts", values["doubts"], _words),
        examples=_list("examples", values["examples"], _example),
        caution=_words("caution", values["caution"]) if "caution" in values else None,
    )
    for each in table.examples:
        _come_out(table, each)
    return table


def _come_out(table: SizeTable, example: Example) -> None:
    """Raise ValueError if the table does not make of an example what its source does."""
    made = table.labelled(*table.steps(example.underbust, example.bust))
    if made != example.size:
        girths = f"{example.underbust:g} and {example.bust:g} {table.unit}"
        raise ValueError(f"it makes {made or 'no size'} of {girths}, but the example lists {example.size}")


def _no_number(text: str) -> float:
    raise ValueError(f"{text} is not a number")


def _same_keys(what: str, values: Any, keys: tuple[str, ...], may: tuple[str, ...] = ()) -> None:
    if not isinstance(values, dict):
        raise ValueError(f"{what} must be a JSON object")
    missing = [key for key in keys if key not in values]
    unknown = [key for key in values if key not in (*keys, *may)]
    if missing:
        raise ValueError(f"{what} lacks '{missing[0]}'")
    if unknown:
        raise ValueError(f"{what} has '{unknown[0]}', which is unknown")


def _text(what: str, value: Any) -> str:
    if not isinstance(value, str) or not value.strip():
        raise ValueError(f"{what} must be a text")
    if not is_printable(value, _LONGEST):
        raise ValueError(f"{what} is too long or cannot be printed")
    return value


def _one_of(what: str, value: Any, known: Mapping[str, object] | tuple[str, ...]) -> str:
    if not isinstance(value, str) or value not in known:
        raise ValueError(f"{what} must be one of {', '.join(known)}, not {value!r}")
    return value


def _number(what: str, value: Any) -> float:
    if type(value) not in (int, float) or not abs(value) <= _MOST:
        raise ValueError(f"{what} must be a number, not {value!r}")
    return float(value)


def _list(what: str, values: Any, read: Callable[[str, Any], T], least: int = 0) -> tuple[T, ...]:
    if not isinstance(values, list) or len(values) < least:
        raise ValueError(f"{what} must be a list" + f" of {least} at least" * bool(least))
    return tuple(read(what, each) for each in values)


def _words(what: str, values: Any) -> LocalizedText:
    if not isinstance(values, dict) or "en" not in values or values.keys() - {"en", "ja"}:
        raise ValueError(f"{what} must have 'en', may have 'ja', and nothing else")
    return LocalizedText(**{language: _text(what, text) for language, text in values.items()})


def _source(what: str, values: Any) -> Source:
    if not isinstance(values, dict):
        raise ValueError(f"{what} must hold objects")
    words = {language: text for language, text in values.items() if language != "name"}
    return Source(_text("the name of a source", values.get("name")), _words(what, words))


def _label(value: Any) -> str:
    text = _text("label", value)
    rest = text.replace("{band}", "", 1).replace("{cup}", "", 1)
    if len(text) - len(rest) != len("{band}{cup}") or set(rest) & set("{}"):
        raise ValueError("label must have {band} and {cup}, each once")
    return text


def _scale(what: str, values: Any, side: str) -> Scale:
    steps = _list(what, values, _step, least=2)
    for low, high in pairwise(steps):
        if high.least < low.most:
            raise ValueError(f"in {what} {high.name} begins before {low.name} ends")
    if len({step.name for step in steps}) < len(steps):
        raise ValueError(f"a name in {what} is repeated")
    scale = Scale(steps, _SIDES[side])
    for step, (begin, end) in zip(steps, pairwise(scale.borders), strict=True):
        if end <= begin:
            raise ValueError(f"{step.name} in {what} is empty")
    return scale


def _step(what: str, value: Any) -> Step:
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError(f"{what} must hold steps as [name, from, to]")
    name = _text(f"the name of one of the {what}", value[0])
    least, most = _number(f"{name} in {what}", value[1]), _number(f"{name} in {what}", value[2])
    if most < least:
        raise ValueError(f"in {what} {name} ends before it begins")
    return Step(name, least, most)


def _example(what: str, values: Any) -> Example:
    keys = ("underbust", "bust", "size", "source")
    _same_keys("an example", values, keys)
    underbust, bust = (_number(f"'{key}' of an example", values[key]) for key in keys[:2])
    return Example(underbust, bust, _text("'size'", values["size"]), _text("'source'", values["source"]))
