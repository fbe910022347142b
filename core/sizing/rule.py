"""The rule of a size in words, with the numbers of a body put in."""

from __future__ import annotations

from core.sizing.table import BAND, Scale, SizeTable, Step


def plain(value: float) -> str:
    """Return a number as short as it can be written, to a hundredth."""
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def allowance_sentence(table: SizeTable, underbust: float, allowance: float) -> str:
    """Say what is taken off the under-bust girth for a tape that is worn tight; both [unit of the table]."""
    girth, taken, left = plain(underbust), plain(allowance), plain(underbust - allowance)
    unit = table.unit
    return f"Under-bust {girth} {unit} less {taken} {unit} for a tape that is worn tight: {left} {unit}."


def band_sentences(table: SizeTable, value: float) -> tuple[str, ...]:
    """Say which band an under-bust girth [unit of the table] gives, and why."""
    scale, told = table.bands, f"{plain(value)} {table.unit}"
    place = scale.place(value)
    step = scale.step(place)
    if step is not None:
        low, high = _range(scale, place, value)
        named = f"Under-bust {told} gives band {step.name} ({low} to {high})."
        return (named, *_gap(step, value))
    if place < 0:
        name, low = scale.steps[0].name, plain(scale.borders[0])
        return (f"Under-bust {told} lies below the smallest band, {name}, which begins at {low}.",)
    name, high = scale.steps[-1].name, plain(scale.borders[-1])
    return (f"Under-bust {told} lies above the largest band, {name}, which ends at {high}.",)


def cup_sentences(table: SizeTable, value: float) -> tuple[str, ...]:
    """Say which cup a difference of girths [unit of the table] gives, and why."""
    scale, told = table.cups, f"{plain(value)} {table.unit}"
    what = "Bust less band" if table.cup_from == BAND else "Bust less under-bust"
    place = scale.place(value)
    step = scale.step(place)
    if step is not None:
        low, high = _range(scale, place, value)
        return (f"{what} {told} gives cup {step.name} ({low} to {high}).", *_gap(step, value))
    if place < 0:
        name, low = scale.steps[0].name, plain(scale.borders[0])
        return (f"{what} {told} lies below the smallest cup, {name}, which begins at {low}.",)
    name, high = scale.steps[-1].name, plain(scale.borders[-1])
    return (f"{what} {told} lies above the largest cup, {name}, which ends at {high}.",)


def _range(scale: Scale, place: int, value: float) -> tuple[str, str]:
    """Return the range to show: that of the source, or where the value lies in a gap, that with the gaps."""
    step = scale.steps[place]
    low, high = (step.least, step.most) if step.says(value) else scale.ends(place)
    return plain(low), plain(high)


def _gap(step: Step, value: float) -> tuple[str, ...]:
    if step.says(value):
        return ()
    rest = "what lies between two steps goes to the nearest."
    if step.least == step.most:
        return (f"The table itself names {plain(step.middle)} for {step.name}; {rest}",)
    return (f"The table itself names {plain(step.least)} to {plain(step.most)} for {step.name}; {rest}",)
