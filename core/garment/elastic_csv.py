"""Elastics as tables of comma-separated values: measured by a designer, and handed on."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence

from core.document.elastic import Curve, Elastic
from core.errors import LineError
from core.files.table_text import decimal, header_line, header_values, is_yes, numbered_rows, percent
from core.messages import Message, length_of

ALLOWANCE = 20.0
"""For seams, at both ends together, where a table tells none [mm]."""

FEWEST = 2
"""Rows that a table must have beside that of the unstretched elastic."""

_NEWTONS = {"n": 1.0, "cn": 0.01, "gf": 0.00980665, "g": 0.00980665, "kgf": 9.80665, "kg": 9.80665}
_WHOLE = {"%": 100.0, "1": 1.0}  # what elongations are divided by
_ELONGATION = re.compile(r"elongation|extension|stretch|strain|dehnung|伸", re.IGNORECASE)
_FORCE = re.compile(r"force|load|(?<!ex)tension|pull|kraft|荷重|張力|力", re.IGNORECASE)

HELP = Message(
    "The table requires one row of headings with units, such as 'elongation %' and 'force N' "
    "(also N/cm, cN, gf, kgf), and one row for each point. Lines such as '# width_mm: 12', '# "
    "name: ...', '# allowance_mm: 20' precede the headings."
)
"""What a user has to know to write a table."""


SHORTEST_REACH, MOST_PER_CM = 0.02, 100.0
"""Less elongation [1], or more force per width [N/cm], is no elastic's: the unit in the heading is wrong."""

_UNFILLED = "whose it is, when it was measured, at which stretch"

TEMPLATE = f"""\
# name: my elastic 12 mm
# width_mm: 12
# allowance_mm: 20
# source: {_UNFILLED}
elongation %,force N
20,
40,
60,
80,
"""
"""A table to fill in: until each row has its force, it is refused."""


def elastic_from_csv(text: str, name: str, width_mm: float | None = None) -> Elastic:
    """Read a measured table; ``name`` and ``width_mm`` stand where the text tells none.

    See ``HELP``. Force per cm of width is made that of the whole width. Raises LineError with what is wrong.
    """
    told = _told(text)
    name = told.get("name") or name
    width = (
        width_mm if "width" not in told else _number(told["width"].removesuffix("mm"), Message("width"), name)
    )
    if width is None:
        raise LineError(
            Message("The table {name} does not specify the width of the elastic.", name=name),
            Message("Add a line of text such as '# width_mm: 12' before the headings."),
        )
    allowance = ALLOWANCE
    if "allowance" in told:
        allowance = _number(told["allowance"].removesuffix("mm"), Message("seam allowance"), name)
    estimate = is_yes(told.get("estimate", "no"))
    curve = _curve(text, name, width)
    source = told.get("source", "").replace(_UNFILLED, "")
    elastic = Elastic(name, width, curve, allowance, source, estimate)
    _check_units(elastic)
    return elastic


def _check_units(elastic: Elastic) -> None:
    """Raise LineError where figures are no elastic's in the units that the headings tell."""
    if elastic.max_elongation < SHORTEST_REACH:
        raise LineError(
            Message(
                "The table {name} ends at {end} %, which is implausibly low for an elastic.",
                name=elastic.name,
                end=f"{100.0 * elastic.max_elongation:g}",
            ),
            Message("If 1 means twice the length, use the heading 'elongation 1'."),
        )
    if elastic.max_force > MOST_PER_CM * elastic.width_mm / 10.0:
        raise LineError(
            Message(
                "The table {name} ends at {strength} N, which is implausibly high for an elastic "
                "{width} wide.",
                name=elastic.name,
                strength=f"{elastic.max_force:g}",
                width=length_of(elastic.width_mm),
            ),
            Message("Check the unit: 'force cN' or 'force gf' may be intended."),
        )


def has_allowance(text: str) -> bool:
    """Return whether a table tells the allowance, or ``ALLOWANCE`` is taken."""
    return "allowance" in _told(text)


def csv_of(elastic: Elastic) -> str:
    """Return an elastic as a table that ``elastic_from_csv`` reads back as it was, its source on one line."""
    source = " ".join(elastic.source.split())
    told = {
        "name": elastic.name,
        "width_mm": f"{elastic.width_mm:.12g}",
        "allowance_mm": f"{elastic.allowance_mm:.12g}",
        "source": source,
        "estimate": "yes" if elastic.estimate else "no",
    }
    heading = [*(header_line(key, value) for key, value in told.items()), "elongation %,force N"]
    rows = [f"{percent(elongation)},{force!r}" for elongation, force in elastic.curve]
    return "\n".join([*heading, *rows]) + "\n"


def _told(text: str) -> dict[str, str]:
    """Return what stands over a table, in words; of lengths without their unit."""
    return {key.removesuffix("_mm"): words for key, words in header_values(text).items()}


def _number(text: str, what: Message, name: str) -> float:
    try:
        return float(text.strip().replace(",", "."))
    except ValueError:
        raise LineError(
            Message(
                "The {what} '{text}' of {name} is not a number.", what=what, text=text.strip(), name=name
            ),
            Message("Enter the value in mm."),
        ) from None


def _curve(text: str, name: str, width: float) -> Curve:
    """Return the points of a table with the unstretched elastic first."""
    comma, numbered = numbered_rows(text)
    if not numbered:
        raise LineError(Message("The table {name} is empty.", name=name), HELP)
    if not comma:
        raise LineError(
            Message("The table {name} has only one column.", name=name),
            HELP,
        )
    heading, *rows = numbered
    columns = _columns(heading[1], name, width)
    points = list(_points(rows, columns, name, comma))
    if points and points[0] == (0.0, 0.0):
        points = points[1:]
    if len(points) < FEWEST:
        raise LineError(
            Message("The table {name} has too few rows for a curve.", name=name),
            Message("Measure at least {count} points in addition to the unstretched elastic.", count=FEWEST),
        )
    if points[0][0] == 0.0:
        raise LineError(
            Message(
                "The table {name} begins with {force} N at zero elongation.",
                name=name,
                force=f"{points[0][1]:g}",
            ),
            Message("Measure from zero force, or remove that row."),
        )
    return ((0.0, 0.0), *points)


def _columns(heading: Sequence[str], name: str, width: float) -> tuple[tuple[int, float], tuple[int, float]]:
    """Return the places of elongation and force, with what figures are divided and multiplied by."""
    found = []
    for pattern, what, example in ((_ELONGATION, "elongation", "%"), (_FORCE, "force", "N")):
        at = next((i for i, cell in enumerate(heading) if pattern.search(cell)), None)
        if at is None:
            raise LineError(
                Message("The table {name} has no column '{what}'.", name=name, what=what),
                HELP,
            )
        unit = _unit(heading[at], what, width)
        if unit is None:
            raise LineError(
                Message(
                    "The column '{heading}' of {name} has no unit.",
                    heading=heading[at].strip(),
                    name=name,
                ),
                Message("Use a heading such as '{example}'.", example=f"{what} {example}"),
            )
        found.append((at, unit))
    return found[0], found[1]


def _unit(heading: str, what: str, width: float) -> float | None:
    """Return what makes figures under a heading shares or newtons, None if it tells no unit."""
    plain = unicodedata.normalize("NFKC", heading).strip()
    last = re.search(r"[\[(]?\s*([%1]|c?n|k?gf?)\s*(/\s*cm)?\s*[\])]?$", plain, re.IGNORECASE)
    # The unit must stand for itself: the n of "elongation" is none.
    if last is None or (plain[: last.start()][-1:].isalpha() and last[0][:1].isalpha()):
        return None
    if what == "elongation":
        return None if last[2] else _WHOLE.get(last[1])
    newtons = _NEWTONS.get(last[1].lower())
    return newtons if newtons is None or not last[2] else newtons * width / 10.0


def _points(
    rows: Sequence[tuple[int, Sequence[str]]],
    columns: tuple[tuple[int, float], tuple[int, float]],
    name: str,
    comma: str,
) -> Iterator[tuple[float, float]]:
    """Yield the points of a table, rows with their lines in it, whose cells are separated by ``comma``."""
    for count, row in rows:
        try:
            stretched, pulled = (decimal(row[at], comma) for at, _ in columns)
        except (ValueError, IndexError):
            raise LineError(
                Message(
                    "Row {count} of the table {name} does not contain two numbers.", count=count, name=name
                ),
                Message("Remove rows that are not data points."),
            ) from None
        yield stretched / columns[0][1], pulled * columns[1][1]
