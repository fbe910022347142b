"""The rule of a size in words, with the numbers of a body put in."""

from __future__ import annotations

from typing import NamedTuple

from core.measurements.size_table import BAND, UNDERBUST, Scale, SizeTable
from core.messages import Message


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
