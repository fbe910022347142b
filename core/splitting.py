"""A line that goes across both sides, split at the front centre into a left and a right one (ours)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.design import Design
from core.design_lines import OwnLine
from core.errors import LineError
from core.template import Template

_HALVES = ("{name} left", "{name} right")


def halves(name: str, path: Sequence[int], template: Template) -> tuple[OwnLine, OwnLine]:
    """Return the left and the right half of the line ``name`` whose control points are ``path``, in order.

    Both begin at the front centre. Raises LineError if it does not cross the front centre just once, at a
    control point: then there are no two halves that are as long together.
    """
    sides = [int(template.column[point]) for point in path]
    at = sides.index(0) if 0 in sides else -1
    before, after = sides[:at], sides[at + 1 :]
    if path[0] == path[-1]:
        raise LineError(f"The line {name} goes round and has no two halves.", "Draw two lines instead.")
    if at <= 0 or not (
        (_beside(before, -1) and _beside(after, 1)) or (_beside(before, 1) and _beside(after, -1))
    ):
        raise LineError(
            f"The line {name} does not go across the front centre from one side to the other.",
            "Split one that does, such as the mid-bust line.",
        )
    inward, outward = tuple(path[at::-1]), tuple(path[at:])
    left, right = (outward, inward) if after[0] > 0 else (inward, outward)
    return OwnLine(_HALVES[0].format(name=name), left), OwnLine(_HALVES[1].format(name=name), right)


def _beside(columns: list[int], side: int) -> bool:
    return bool(columns) and all(side * column > 0 for column in columns)


def can_split(design: Design, template: Template, name: str) -> bool:
    """Tell whether a line can be split as it stands."""
    try:
        split(design, template, name)
    except LineError:
        return False
    return True


def is_split(design: Design, name: str) -> bool:
    """Tell whether a line is off while its halves, of which one at least is worn, lie in its place."""
    pair, worn = {half.format(name=name) for half in _HALVES}, design.worn()
    return name not in worn and pair <= {line.name for line in design.own_lines} and bool(pair & worn)


def split(design: Design, template: Template, name: str, *, linked: bool = False) -> Design:
    """Return the design with a line split at the front centre into "NAME left" and "NAME right".

    Both lie where it lay, are as long in percent, worn if it was, and treated alike, ``linked`` or each by
    itself. It is taken off; one of the designer's own is no more. Raises LineError if it cannot be split,
    moves nothing, is locked, or other lines have these names.
    """
    path = _path(design, template, name)
    if not template.free[list(path)].any():
        raise LineError(f"The line {name} lies where nothing moves.", "Split one that moves the body.")
    pair = halves(name, path, template)
    there = {line.name: line for line in design.own_lines}
    for half in pair:
        if half.name in there and there[half.name] != half:
            raise LineError(f"There is another line {half.name}.", "Rename or remove that one first.")
    worn, ratio, traits = name in design.worn(), design.ratio(name), design.traits_of(name)
    after = design
    for half in pair:
        after = after.with_own_line(half) if half.name not in there else after
        treated = replace(traits, name=half.name, linked=linked, locked=False)
        after = after.with_traits(treated)
        if worn:
            after = after.with_line(half.name, ratio)
    if name in there:
        return after.without_own_line(name)
    return after.with_line(name, None)


def _path(design: Design, template: Template, name: str) -> tuple[int, ...]:
    own = {line.name: line.path for line in design.own_lines}
    if name in own:
        return own[name]
    if name in template.paths:
        return template.paths[name]
    raise LineError(f"There is no line '{name}'.", "Name one of the design's.")
