"""The rule of a size in words, with the numbers of a body put in."""

from __future__ import annotations

from typing import NamedTuple

from core.measurements.size_table import BAND, UNDERBUST, Scale, SizeTable


class _Words(NamedTuple):
    inside: str
    below: str
    above: str


_BAND_WORDS = _Words(
    "Under-bust {} gives band {} ({} to {}).",
    "Under-bust {} lies below the smallest band, {}, which begins at {}.",
    "Under-bust {} lies above the largest band, {}, which ends at {}.",
)
_CUP_WORDS = {
    UNDERBUST: _Words(
        "Bust less under-bust {} gives cup {} ({} to {}).",
        "Bust less under-bust {} lies below the smallest cup, {}, which begins at {}.",
        "Bust less under-bust {} lies above the largest cup, {}, which ends at {}.",
    ),
    BAND: _Words(
        "Bust less band {} gives cup {} ({} to {}).",
        "Bust less band {} lies below the smallest cup, {}, which begins at {}.",
        "Bust less band {} lies above the largest cup, {}, which ends at {}.",
    ),
}


def plain(value: float) -> str:
    """Return a number as short as it can be written, to a hundredth."""
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def allowance_sentence(table: SizeTable, underbust: float, allowance: float) -> str:
    """Say what is taken off the under-bust girth for a tape that is worn tight; both [unit of the table]."""
    told = (f"{plain(value)} {table.unit}" for value in (underbust, allowance, underbust - allowance))
    return "Under-bust {} less {} for a tape that is worn tight: {}.".format(*told)


def band_sentences(table: SizeTable, value: float) -> tuple[str, ...]:
    """Say which band an under-bust girth [unit of the table] gives, and why."""
    return _sentences(_BAND_WORDS, table.bands, value, table.unit)


def cup_sentences(table: SizeTable, value: float) -> tuple[str, ...]:
    """Say which cup a difference of girths [unit of the table] gives, and why."""
    return _sentences(_CUP_WORDS[table.cup_from], table.cups, value, table.unit)


def _sentences(words: _Words, scale: Scale, value: float, unit: str) -> tuple[str, ...]:
    place, told = scale.place(value), f"{plain(value)} {unit}"
    step = scale.step(place)
    if step is None:
        if place < 0:
            return (words.below.format(told, scale.steps[0].name, plain(scale.borders[0])),)
        return (words.above.format(told, scale.steps[-1].name, plain(scale.borders[-1])),)
    # The borders that decide, in gaps of the source too: how far the next step is counts from them.
    rule = words.inside.format(told, step.name, *map(plain, scale.ends(place)))
    return (rule,) if step.is_listed(value) else (rule, _gap(step.name, plain(step.least), plain(step.most)))


def _gap(name: str, least: str, most: str) -> str:
    """Say that a value lies in no range of the source, but next to this one, which may be a single number."""
    rest = "what lies between two steps goes to the nearest."
    if least == most:
        return f"The table itself names {least} for {name}; {rest}"
    return f"The table itself names {least} to {most} for {name}; {rest}"
