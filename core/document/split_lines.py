"""A line that goes across both sides, split at the front centre into a left and a right one (ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.control_mesh.embedding import embed
from core.control_mesh.template import Template
from core.document.design import Design
from core.document.line_notation import DECIMALS
from core.document.lines import LOWER, CustomLine
from core.errors import LineError
from core.messages import LineName, Message

_HALVES = ("{name} left", "{name} right")


def halves(name: str, path: Sequence[int], template: Template) -> tuple[CustomLine, CustomLine]:
    """Return the left and the right half of the line ``name`` whose control points are ``path``, in order.

    Both begin at the front centre. Raises LineError if it does not cross the front centre just once, at a
    control point: then there are no two halves that are as long together.
    """
    sides = [int(template.column[point]) for point in path]
    at = sides.index(0) if 0 in sides else -1
    before, after = sides[:at], sides[at + 1 :]
    if path[0] == path[-1]:
        raise LineError(
            Message(
                "The line {name} is closed and cannot be split into left and right.", name=LineName(name)
            ),
            Message("Draw two lines instead."),
        )
    if at <= 0 or not (
        (_beside(before, -1) and _beside(after, 1)) or (_beside(before, 1) and _beside(after, -1))
    ):
        raise _crosses_not(name)
    inward, outward = tuple(path[at::-1]), tuple(path[at:])
    left, right = (outward, inward) if after[0] > 0 else (inward, outward)
    return CustomLine(_HALVES[0].format(name=name), left), CustomLine(_HALVES[1].format(name=name), right)


def free_halves(line: CustomLine) -> tuple[CustomLine, CustomLine]:
    """Return the left and the right half of a free line; see ``halves``."""
    if line.closed:
        raise LineError(
            Message(
                "The line {name} is closed and cannot be split into left and right.", name=LineName(line.name)
            ),
            Message("Draw two lines instead."),
        )
    side = 1.0 if line.places[0][1] < 0.0 else -1.0
    before = [place for place in line.places if side * place[1] < 0.0]
    after = [place for place in line.places if side * place[1] > 0.0]
    crossing = line.places[len(before) : len(line.places) - len(after)]
    apart = (*before, *crossing, *after) == line.places and len(crossing) < 2
    if not before or not after or not apart:
        raise _crosses_not(line.name)
    (row, column), (next_row, next_column) = before[-1], after[0]
    middle = crossing[0] if crossing else (row - column / (next_column - column) * (next_row - row), 0.0)
    middle = round(middle[0], DECIMALS), 0.0
    inward, outward = (middle, *before[::-1]), (middle, *after)
    left, right = (outward, inward) if side > 0.0 else (inward, outward)
    pair = zip(_HALVES, (left, right), strict=True)
    first, second = (CustomLine(half.format(name=line.name), places=places) for half, places in pair)
    return first, second


def _crosses_not(name: str) -> LineError:
    return LineError(
        Message(
            "The line {name} does not cross the front centre.",
            name=LineName(name),
        ),
        Message("Choose a line that crosses the front centre, such as the mid-bust line."),
    )


def _beside(columns: list[int], side: int) -> bool:
    return bool(columns) and all(side * column > 0 for column in columns)


def can_split(design: Design, template: Template, name: str) -> bool:
    """Return whether a line can be split at present."""
    try:
        split(design, template, name)
    except LineError:
        return False
    return True


def is_split(design: Design, name: str) -> bool:
    """Return whether a line is inactive and replaced by its halves, at least one of them active."""
    pair, worn = {half.format(name=name) for half in _HALVES}, design.active_lines()
    return name not in worn and pair <= {line.name for line in design.own_lines} and bool(pair & worn)


def split(design: Design, template: Template, name: str, *, linked: bool = False) -> Design:
    """Return the design with a line split at the front centre into "NAME left" and "NAME right".

    Both lie where it lay, are as long in percent, worn if it was, and treated alike, ``linked`` or each by
    itself. It is taken off; one of the designer's own is no more. Raises LineError if it cannot be split,
    moves nothing, is locked, or other lines have these names.
    """
    there = {line.name: line for line in design.own_lines}
    pair = _halves_of(design, template, name)
    for half in pair:
        if half.name in there and there[half.name] != half:
            raise LineError(
                Message("A line named {name} already exists.", name=LineName(half.name)),
                Message("Rename or remove that line first."),
            )
    worn, ratio, traits = name in design.active_lines(), design.ratio(name), design.line_settings(name)
    after = design
    for half in pair:
        after = after.with_custom_line(half) if half.name not in there else after
        treated = replace(traits, name=half.name, linked=linked, locked=False)
        after = after.with_line_settings(treated)
        if worn:
            after = after.with_line(half.name, ratio)
    if name in there:
        return after.without_custom_line(name)
    return after.with_line(name, None)


def _halves_of(design: Design, template: Template, name: str) -> tuple[CustomLine, CustomLine]:
    """Return both halves of a line of the design. Raises LineError if there are none, or nothing moves."""
    own = {line.name: line for line in design.own_lines}
    if len(design.band_of(name)) > 1 or (name in own and own[name].region == LOWER):
        raise LineError(
            Message("The line {name} runs below the bust and cannot be split.", name=LineName(name)),
            Message("Draw two lines instead."),
        )
    if name in own and own[name].free:
        touched = embed(template.grid, own[name].grid_path).weights.nonzero()[1].tolist()
    elif name in own:
        touched = list(own[name].path)
    elif name in template.paths:
        touched = list(template.paths[name])
    else:
        raise LineError(
            Message("There is no line '{line}'.", line=LineName(name)),
            Message("Specify a line of the design."),
        )
    if not template.free[touched].any():
        raise LineError(
            Message("The line {name} is on the fixed part of the body.", name=LineName(name)),
            Message("Choose a line that moves the body."),
        )
    return free_halves(own[name]) if name in own and own[name].free else halves(name, touched, template)
