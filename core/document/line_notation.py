"""Own lines as text: control points by number, or places by row and column of the template."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby
from types import MappingProxyType

import numpy as np

from core.control_mesh.embedding import Cell, EmbeddedCurve, embed
from core.control_mesh.fit import ControlMesh
from core.control_mesh.lower_template import LowerTemplate, read_lower_template
from core.control_mesh.template import Template, read_template
from core.document.lines import BUST, LOWER, CustomLine
from core.errors import LineError
from core.geometry.mesh import Flags
from core.messages import LineName, Message

HELP = (
    "NAME=POINT,POINT,...[,closed][,shoulder][,lower][,continues OTHER]: a line of your own. A POINT is the "
    "number of a control point, or its place like r2c-3: row 2 from below, column 3 on the subject's right "
    "(c0 is the middle); r2c-3:r2c3 goes along a row or a column. control.csv lists them all. With "
    "fractions, like r2.35c-3.2, the line is free: it runs between control points, straight over each "
    "triangle. With shoulder it runs on over the shoulder to the under-bust band. With lower its rows, from "
    "above, and columns are those of the lower trunk (c0 front, c11 back); one that continues a line of the "
    "bust is one band with it. Set its length with --line NAME=LENGTH, else it is measured only"
)
"""What a user has to know to write an own line."""

DECIMALS = 4
"""Of a row or column: a few thousandths of a millimetre."""

_NUMBER = r"\d+(?:\.\d+)?"
_PLACE = re.compile(rf"r({_NUMBER})c([+-]?{_NUMBER})")
_ASK = Message('Enter NAME=r2c-3,r3c0,r2c3 or NAME=28,45,34. Append ",closed" for a closed line.')
_ENDINGS = ("closed", "shoulder", LOWER)
_CONTINUES = "continues "

AnyTemplate = Template | LowerTemplate
"""A template that own lines may be on."""


def template_of(region: str, template: str) -> AnyTemplate:
    """Return the template of a region; ``template`` is the name of that of the bust."""
    return read_lower_template() if region == LOWER else read_template(template)


def parse_line(text: str, template: Template) -> CustomLine:
    """Read ``NAME=POINT,POINT,...`` and what follows on the ``template`` of the bust or the lower one (ours).

    Raises LineError, see ``HELP``.
    """
    name, equals, path = text.replace("\N{MINUS SIGN}", "-").partition("=")
    name, words = name.strip().lower(), [word.strip().lower() for word in path.split(",")]
    endings, continued = set(), ""
    while words and (words[-1] in _ENDINGS or words[-1].startswith(_CONTINUES)):
        word = words.pop()
        if word in _ENDINGS:
            endings.add(word)
        else:
            continued = word.removeprefix(_CONTINUES).strip()
    words = [word.replace(" ", "") for word in words]
    if not equals or not name or not words or not all(words):
        raise LineError(Message("'{text}' is not a line.", text=text), _ASK)
    closed, shoulder, lower = (ending in endings for ending in _ENDINGS)
    on = read_lower_template() if lower else template
    region = LOWER if lower else BUST
    points: tuple[int, ...] = ()
    places: tuple[Cell, ...] = ()
    if any(_between(word) for word in words):
        places = tuple(place for word in words for place in _places(word, on))
    else:
        points = tuple(point for word in words for point in _walk(word, on))
    return CustomLine(name, points, closed, places, shoulder, region, continued)


def format_point(point: int, template: AnyTemplate) -> str:
    """Return how a control point is written: r2c-3."""
    return f"r{template.row[point]}c{template.column[point]}"


def format_path(line: CustomLine, template: AnyTemplate) -> str:
    """Return how the course of a line is written, without its name: r2c-3,r2.35c-1.8,closed."""
    words = [format_point(point, template) for point in line.points]
    words += [f"r{_plain(row)}c{_plain(column)}" for row, column in line.places]
    said = line.closed, line.over_shoulder, line.region == LOWER
    words += [ending for ending, is_so in zip(_ENDINGS, said, strict=True) if is_so]
    return ",".join([*words, *([_CONTINUES + line.continues] if line.continues else [])])


def _plain(number: float) -> str:
    return f"{number:.{DECIMALS}f}".rstrip("0").rstrip(".")


def mirrored(points: Sequence[int], template: AnyTemplate) -> tuple[int, ...]:
    """Return the control points of the other side, in the same order."""
    return tuple(template.mirror[list(points)].tolist())


def mirror_image(line: CustomLine, template: AnyTemplate, name: str) -> CustomLine:
    """Return a line with its mirror image on the other side, as ``name``; it continues none."""
    points, places = mirrored(line.points, template), tuple((row, -column) for row, column in line.places)
    return replace(line, name=name, points=points, places=places, continues="")


def path_cells(line: CustomLine, template: AnyTemplate) -> tuple[Cell, ...]:
    """Return the course of a line by row and column; a closed line ends with where it begins."""
    path = tuple((float(template.row[point]), float(template.column[point])) for point in line.path)
    return line.grid_path or path


def with_custom_lines(control: ControlMesh, own: tuple[CustomLine, ...]) -> ControlMesh:
    """Return the control mesh with ``own`` lines beside those of the template.

    Raises LineError if a line cannot be laid.
    """
    paths, embedded, count = dict(control.paths), {}, len(control.mesh.vertices)
    for line in own:
        if line.name in paths or line.name in embedded:
            raise LineError(
                Message("Two lines are named '{name}'.", name=LineName(line.name)),
                Message("Give each line a unique name."),
            )
        if not all(0 <= point < count for point in line.points):
            raise LineError(
                Message(
                    "The line {name} contains a control point that does not exist.", name=LineName(line.name)
                ),
                Message("The control mesh has points 0 to {last}.", last=count - 1),
            )
        if not all(control.grid.has(place) for place in line.places):
            raise LineError(
                Message("The line {line} leaves the control mesh.", line=LineName(line.name)),
                Message(
                    "The control mesh has rows 0 to {rows} and columns {low} to {high}.",
                    rows=control.grid.top,
                    low=control.grid.first,
                    high=control.grid.half,
                ),
            )
        if line.free:
            embedded[line.name] = _led_over(control, embed(control.grid, line.grid_path), line)
        else:
            paths[line.name] = _strap(control, line.path) if line.over_shoulder else line.path
    return replace(control, paths=MappingProxyType(paths), embedded=MappingProxyType(embedded))


def _strap(control: ControlMesh, path: tuple[int, ...]) -> tuple[int, ...]:
    """Return the path of a strap up to where the body is fixed."""
    upward = path if control.row[path[0]] <= control.row[path[-1]] else path[::-1]
    return upward[: _held_from(control.fixed[list(upward)])]


def _led_over(control: ControlMesh, curve: EmbeddedCurve, line: CustomLine) -> EmbeddedCurve:
    """Return the vertices of a free line; those of a strap go up to where the body is fixed."""
    if not line.over_shoulder:
        return curve
    upward = line.grid_path if curve.places[0, 0] <= curve.places[-1, 0] else line.grid_path[::-1]
    curve = embed(control.grid, upward)
    end = _held_from(curve.weights @ control.fixed > 1.0 - 1e-9)
    return embed(control.grid, [(float(row), float(column)) for row, column in curve.places[:end]])


def _held_from(fixed: Flags) -> int:
    """Return how many vertices there are up to the first fixed one above all that move; two at least."""
    moving = np.flatnonzero(~fixed)
    return max(int(moving[-1]) + 2 if len(moving) else len(fixed), 2)


def _between(word: str) -> bool:
    """Return whether a word names a place between control points."""
    match = _PLACE.fullmatch(word)
    return match is not None and any(not float(number).is_integer() for number in match.groups())


def _places(word: str, template: AnyTemplate) -> list[Cell]:
    """Return the places of one word of a free line."""
    if not _between(word):
        return [(float(template.row[at]), float(template.column[at])) for at in _walk(word, template)]
    match = _PLACE.fullmatch(word)
    assert match is not None, "it was matched before"
    place = float(match[1]), float(match[2])
    if not template.grid.has(place):
        raise _nowhere(word, template)
    return [place]


def _walk(word: str, template: AnyTemplate) -> list[int]:
    """Return the points of one word: one, or all from one to the other along a row or a column."""
    ends = [_point(each, template) for each in word.split(":")]
    if len(ends) == 1:
        return ends
    (row, column), (to_row, to_column) = (
        (int(template.row[end]), int(template.column[end])) for end in (ends[0], ends[-1])
    )
    if len(ends) != 2 or (row == to_row) == (column == to_column):
        raise LineError(
            Message("'{word}' does not follow a row or a column of the control mesh.", word=word),
            Message("List the points of the line one by one."),
        )
    rows, columns = _steps(row, to_row), _steps(column, to_column)
    return [template.point(r, c) for r in rows for c in columns]


def _steps(start: int, end: int) -> range:
    step = 1 if end >= start else -1
    return range(start, end + step, step)


def _point(word: str, template: AnyTemplate) -> int:
    """Return the number of the control point that a word names."""
    match = _PLACE.fullmatch(word)
    if match is None:
        count = len(template.row)
        if not word.isdecimal() or not int(word) < count:
            raise LineError(
                Message(
                    "'{word}' is not a control point of the template {template}.",
                    word=word,
                    template=template.name,
                ),
                Message(
                    "Points are 0 to {last}, or positions such as r2c-3. {hint}", last=count - 1, hint=_ASK
                ),
            )
        return int(word)
    if _between(word) or not template.grid.has((float(match[1]), float(match[2]))):
        raise _nowhere(word, template)
    return template.point(int(float(match[1])), int(float(match[2])))


def _nowhere(word: str, template: AnyTemplate) -> LineError:
    return LineError(
        Message("The template {template} has no position '{word}'.", template=template.name, word=word),
        Message(
            "The control mesh has rows 0 to {rows} and columns {low} to {high}.",
            rows=template.grid.top,
            low=template.grid.first,
            high=template.grid.half,
        ),
    )


def ready_made_lines(template: Template) -> dict[str, tuple[CustomLine, ...]]:
    """Return lines that garments have, a pair of each, by kind (ours): they go where the template has rows.

    "straps" rise through the bust points and go over the shoulder, "slings" hang round each breast from the
    upper edge, "obliques" go from the side under the bust point and up inside it, "rings" are closed round
    the bust point.
    """
    low, bust = template.lines["mid-bust"], template.row_of("bust point")
    top, side, tip = template.row_of("edge"), template.half - 1, template.bust_column
    up = range(low, top + 1)
    around = [(bust - 1, column) for column in range(tip - 1, tip + 2)] + [(bust, tip + 1)]
    around += [(bust + 1, column) for column in range(tip + 1, tip - 2, -1)] + [(bust, tip - 1)]
    inner = max(tip - 2, 1)
    rising = [(bust, tip - 1), *((row, inner) for row in range(bust + 1, top + 1))]
    kinds = {
        "strap": [(row, tip) for row in up],
        "sling": [*((row, tip + 1) for row in reversed(up)), (low, tip), *((row, tip - 1) for row in up)],
        "oblique": [(low, column) for column in range(side, tip - 1, -1)] + rising,
        "ring": around,
    }
    sides = (("left", 1), ("right", -1))
    return {
        f"{kind}s": tuple(
            CustomLine(
                f"{kind} {word}",
                _numbers(cells, sign, template),
                kind == "ring",
                over_shoulder=kind == "strap",
            )
            for word, sign in sides
        )
        for kind, cells in kinds.items()
    }


def _numbers(cells: list[tuple[int, int]], sign: int, template: Template) -> tuple[int, ...]:
    points = [template.point(row, sign * column) for row, column in cells]
    return tuple(point for point, _ in groupby(points))
