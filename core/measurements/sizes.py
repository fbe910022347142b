"""Sizes: band and cup from two girths in every size system, with the calculation."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from itertools import product
from math import isfinite
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import platformdirs

from core.document.custom_measures import WORN_TIGHT
from core.errors import SizeError
from core.measurements.size_table import (
    BAND,
    UNDERBUST,
    LocalizedText,
    Scale,
    SizeTable,
    Source,
    Step,
    read_table,
    table_of,
)
from core.messages import Message, length_of

ALLOWANCE = WORN_TIGHT
"""What may be taken off the under-bust girth for a tape that is worn tight [mm]: an estimate, not a norm."""

GIRTHS_OF_SIZES = ("underbust_girth", "bust_girth")
"""The measures that a size is made of."""

_ORDER = ("jp", "eu", "uk", "us", "fr", "it", "au")

_LONGEST = 5000.0  # mm; no girth of a body is longer

_SHARES, _ROUND = (0.25, 0.5, 0.75, 1.0), 32  # of an ellipse that is looked at, and places round it


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


class _Words(NamedTuple):
    inside: Message
    below: Message
    above: Message


_BAND_WORDS = _Words(
    Message("Under-bust {value}: band {name} ({low} to {high})."),
    Message("Under-bust {value} is below the smallest band, {name} (from {low})."),
    Message("Under-bust {value} is above the largest band, {name} (up to {high})."),
)
_CUP_WORDS = {
    UNDERBUST: _Words(
        Message("Bust minus under-bust {value}: cup {name} ({low} to {high})."),
        Message("Bust minus under-bust {value} is below the smallest cup, {name} (from {low})."),
        Message("Bust minus under-bust {value} is above the largest cup, {name} (up to {high})."),
    ),
    BAND: _Words(
        Message("Bust minus band {value}: cup {name} ({low} to {high})."),
        Message("Bust minus band {value} is below the smallest cup, {name} (from {low})."),
        Message("Bust minus band {value} is above the largest cup, {name} (up to {high})."),
    ),
}


def short(value: float) -> str:
    """Return a number as short as it can be written, to a hundredth."""
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def allowance_sentence(table: SizeTable, underbust: float, allowance: float) -> Message:
    """Return the sentence on the tape tension allowance of the under-bust girth; both [unit of the table]."""
    value, taken, left = (
        f"{short(each)} {table.unit}" for each in (underbust, allowance, underbust - allowance)
    )
    return Message(
        "Under-bust {value} minus tape tension allowance {allowance}: {left}.",
        value=value,
        allowance=taken,
        left=left,
    )


def band_sentences(table: SizeTable, value: float) -> tuple[Message, ...]:
    """Return which band an under-bust girth [unit of the table] gives, and why."""
    return _sentences(_BAND_WORDS, table.bands, value, table.unit)


def cup_sentences(table: SizeTable, value: float) -> tuple[Message, ...]:
    """Return which cup a difference of girths [unit of the table] gives, and why."""
    return _sentences(_CUP_WORDS[table.cup_from], table.cups, value, table.unit)


def _sentences(words: _Words, scale: Scale, value: float, unit: str) -> tuple[Message, ...]:
    place, told = scale.place(value), f"{short(value)} {unit}"
    step = scale.step(place)
    if step is None:
        if place < 0:
            first = scale.steps[0].name
            return (words.below.fill(value=told, name=first, low=short(scale.borders[0])),)
        return (words.above.fill(value=told, name=scale.steps[-1].name, high=short(scale.borders[-1])),)
    # The borders that decide, in gaps of the source too: how far the next step is counts from them.
    low, high = map(short, scale.ends(place))
    rule = words.inside.fill(value=told, name=step.name, low=low, high=high)
    return (rule,) if step.is_listed(value) else (rule, _gap(step.name, short(step.least), short(step.most)))


def _gap(name: str, least: str, most: str) -> Message:
    """Say that a value lies in no range of the source, but next to this one, which may be a single number."""
    if least == most:
        return Message(
            "The size chart lists {value} for {name}; intermediate values use the nearest step.",
            value=least,
            name=name,
        )
    return Message(
        "The size chart lists {low} to {high} for {name}; intermediate values use the nearest step.",
        low=least,
        high=most,
        name=name,
    )


@dataclass(frozen=True)
class Neighbour:
    """The next band or cup: its ``name``, and the ``label`` of the size beyond that border.

    ``part`` is "band" or "cup", ``up`` whether it is the larger one. ``missing_mm`` is how far the border is:
    what the under-bust girth would have to change for a band, the bust girth for a cup, the other one kept.
    So a larger band often comes with a smaller cup. The label is empty where no cup is that small or large.
    """

    part: str
    up: bool
    name: str
    label: str
    missing_mm: float


@dataclass(frozen=True)
class Sister:
    """A sister size: a band smaller and a cup larger, or the other way round.

    ``bust_mm`` is how much longer the bust is that it is made for, nominally.
    """

    label: str
    bust_mm: float


@dataclass(frozen=True)
class SizeAnswer:
    """What a table says of a body: the size by its ``label``, empty if the body is not ``inside`` the table.

    ``rule`` says how it was found, sentence by sentence; ``doubts`` what is uncertain in the table.
    """

    table: SizeTable
    underbust_mm: float
    bust_mm: float
    allowance_mm: float
    label: str
    band: str
    cup: str
    neighbours: tuple[Neighbour, ...]
    sisters: tuple[Sister, ...]
    rule: tuple[Message, ...]

    @property
    def inside(self) -> bool:
        """Return whether the table has a size for this body."""
        return bool(self.label)

    @property
    def doubts(self) -> tuple[LocalizedText, ...]:
        """Return what is uncertain in the table."""
        return self.table.doubts


def size(table: SizeTable, underbust_mm: float, bust_mm: float, allowance_mm: float = 0.0) -> SizeAnswer:
    """Return the size that a table makes of two girths, as a tape measures them [mm].

    ``allowance_mm`` is taken off the under-bust first, and told. Raises SizeError for what no body measures.
    """
    _check(underbust_mm, bust_mm, allowance_mm)
    underbust, bust = table.in_unit(underbust_mm - allowance_mm), table.in_unit(bust_mm)
    band, cup = table.steps(underbust, bust)
    over = table.over(underbust, bust)
    rule = band_sentences(table, underbust)
    if allowance_mm:
        rule = (allowance_sentence(table, *map(table.in_unit, (underbust_mm, allowance_mm))), *rule)
    if over is not None:
        rule = (*rule, *cup_sentences(table, over))
    return SizeAnswer(
        table=table,
        underbust_mm=underbust_mm,
        bust_mm=bust_mm,
        allowance_mm=allowance_mm,
        label=table.labelled(band, cup),
        band=band.name if band else "",
        cup=cup.name if cup else "",
        neighbours=tuple(_neighbours(table, underbust, bust)),
        sisters=tuple(_sisters(table, underbust, over)),
        rule=rule,
    )


def sizes(underbust_mm: float, bust_mm: float, allowance_mm: float = 0.0) -> Mapping[str, SizeAnswer]:
    """Return the sizes in every system, by the key of its table: built-in tables, then custom ones.

    Custom tables that cannot be read are left out. Raises SizeError for girths that are not plausible.
    """
    tables = (*built_in(), *user_tables()[0])
    return MappingProxyType({each.key: size(each, underbust_mm, bust_mm, allowance_mm) for each in tables})


def neighbours_of(answer: SizeAnswer, underbust_off: float, bust_off: float) -> tuple[str, ...]:
    """Return the other sizes of bodies whose girths are no further off than that [mm], the nearest first.

    Both girths may be off at once, together no further than the ellipse with these half axes.
    """
    table, found = answer.table, dict[str, None]()
    for share, angle in product(_SHARES, np.linspace(0.0, 2.0 * np.pi, _ROUND, endpoint=False)):
        underbust = answer.underbust_mm + share * underbust_off * np.cos(angle) - answer.allowance_mm
        bust = answer.bust_mm + share * bust_off * np.sin(angle)
        found[table.labelled(*table.steps(table.in_unit(underbust), table.in_unit(bust)))] = None
    return tuple(label for label in found if label not in ("", answer.label))


def sizes_text(answer: SizeAnswer, language: str = "en") -> dict[str, Any]:
    """Return an answer as data, lengths in mm; the texts of the table in ``language``.

    The ``rule`` holds messages: for JSON see ``core.messages.plain``.
    """
    table = answer.table
    return {
        "key": table.key,
        "system": table.system,
        "title": table.title.told(language),
        "size": answer.label or None,
        "band": answer.band or None,
        "cup": answer.cup or None,
        "inside": answer.inside,
        "underbust_mm": answer.underbust_mm,
        "bust_mm": answer.bust_mm,
        "allowance_mm": answer.allowance_mm,
        "unit": table.unit,
        "rule": list(answer.rule),
        "neighbours": [
            {
                "part": each.part,
                "direction": "up" if each.up else "down",
                "name": each.name,
                "size": each.label or None,
                "missing_mm": round(each.missing_mm, 2),
            }
            for each in answer.neighbours
        ],
        "sisters": [{"size": each.label, "bust_mm": round(each.bust_mm, 2)} for each in answer.sisters],
        "caution": table.caution.told(language) if table.caution else None,
        "doubts": [each.told(language) for each in answer.doubts],
        "sources": [{"name": each.name, "says": each.words.told(language)} for each in table.sources],
    }


def with_neighbours(
    told: Sequence[dict[str, Any]], underbust_off: float | None, bust_off: float | None
) -> tuple[dict[str, Any], ...]:
    """Return sizes of ``sizes_text``, each with the others ``within_off`` (``neighbours_of``) if both are
    known.
    """
    if underbust_off is None or bust_off is None or not told:
        return tuple(told)
    girths = ("underbust_mm", "bust_mm", "allowance_mm")
    answers = sizes(*(told[0][name] for name in girths))
    return tuple(
        {**each, "within_off": list(neighbours_of(answers[each["key"]], underbust_off, bust_off))}
        for each in told
    )


@cache
def built_in() -> tuple[SizeTable, ...]:
    """Return the tables that come with Busk."""
    folder = resources.files("resources") / "sizes"
    return tuple(table_of(key, (folder / f"{key}.json").read_text(encoding="utf-8")) for key in _ORDER)


def user_folder() -> Path:
    """Return where a designer's own tables lie, each as one JSON file."""
    return Path(platformdirs.user_data_path("Busk", appauthor=False)) / "sizes"


def user_tables() -> tuple[list[SizeTable], list[SizeError]]:
    """Return the designer's own tables, and why some of them cannot be read."""
    tables, problems = [], []
    for path in sorted(user_folder().glob("*.json")):
        try:
            if path.stem in _ORDER:
                raise SizeError(
                    Message("{name} is the name of a built-in size chart.", name=path.stem),
                    Message("Rename {name}.", name=path.name),
                )
            tables.append(read_table(path))
        except SizeError as problem:
            problems.append(problem)
    return tables, problems


def _check(underbust_mm: float, bust_mm: float, allowance_mm: float) -> None:
    for girth in (underbust_mm, bust_mm):
        if not (isfinite(girth) and 0.0 < girth <= _LONGEST):
            raise SizeError(
                Message("A girth of {girth} is implausible for a body.", girth=length_of(girth)),
                Message("Check the landmarks and the unit."),
            )
    low, high = ALLOWANCE
    if not low <= allowance_mm <= high:
        raise SizeError(
            Message("The tape tension allowance of {value} is out of range.", value=length_of(allowance_mm)),
            Message("Enter a value from {low} to {high}.", low=f"{low:g}", high=f"{high:g}"),
        )


def _neighbours(table: SizeTable, underbust: float, bust: float) -> Iterator[Neighbour]:
    """Yield the bands and cups next to a body: below and above, or the nearest if it lies outside."""
    band, over = table.bands.step(table.bands.place(underbust)), table.over(underbust, bust)
    for up, place, missing in _next(table.bands, underbust):
        step = table.bands.steps[place]
        under = step.middle if table.cup_from == BAND else underbust + (missing if up else -missing)
        cup = table.cups.step(table.cups.place(round(bust - under, 6)))
        yield Neighbour("band", up, step.name, table.labelled(step, cup), missing * table.unit_mm)
    if over is None:
        return
    for up, place, missing in _next(table.cups, over):
        step = table.cups.steps[place]
        yield Neighbour("cup", up, step.name, table.labelled(band, step), missing * table.unit_mm)


def _next(scale: Scale, value: float) -> Iterator[tuple[bool, int, float]]:
    """Yield the steps next to a value: whether it is above, its place and how far its border is [unit]."""
    place = scale.place(value)
    if place > 0:
        yield False, place - 1, value - scale.borders[place]
    if place < len(scale.steps) - 1:
        yield True, place + 1, scale.borders[place + 1] - value


def _sisters(table: SizeTable, underbust: float, over: float | None) -> Iterator[Sister]:
    if over is None:
        return
    place = (table.bands.place(underbust), table.cups.place(over))
    here = (table.bands.step(place[0]), table.cups.step(place[1]))
    for turn in (-1, 1):
        band, cup = table.bands.step(place[0] + turn), table.cups.step(place[1] - turn)
        if here[0] and here[1] and band and cup:
            longer = band.middle + cup.middle - here[0].middle - here[1].middle
            yield Sister(table.labelled(band, cup), longer * table.unit_mm)
