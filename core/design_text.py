"""The design as text, as a project keeps it; keys of later versions stay."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any

from core.design import Design, ScanSource
from core.design_calibration import calibration_of
from core.design_elastics import TISSUE_STIFFNESS, elastic_of
from core.design_lines import LineTraits, OwnLine, WornLine
from core.design_measures import OwnMeasure
from core.errors import ProjectError, UserError
from core.placing import PlacedMark

FORMAT = 3
"""The newest format that is read: 2 has variants beside the design, 3 elastics; all else is written as 1."""

WITH_VARIANTS, WITH_ELASTICS = 2, 3


def to_json(design: Design, written: int = 1) -> str:
    """Return the design as text, the number of the format first."""
    values = asdict(design)
    unknown = values.pop("unknown")
    # What is not used is not written: the project stays one that every Busk reads, to the byte.
    for traits in values["traits"]:
        if not traits["elastic"]:
            del traits["elastic"]
    if design.elastics:
        # An older program would drop the elastics of lines at its next save: it must not read this.
        written = max(written, WITH_ELASTICS)
    else:
        del values["elastics"]
    if design.tissue_stiffness == TISSUE_STIFFNESS:
        del values["tissue_stiffness"]
    for key in ("own_measures", "customer", "worn_tight_mm", "calibration"):
        if not values[key]:
            del values[key]
    return json.dumps({"format": written, "length_unit": "mm", **unknown, **values}, indent=1)


def from_json(text: str) -> Design:
    """Read a design; keys of later versions are kept. Raises ProjectError if it is no design."""
    try:
        values = dict(json.loads(text))
        written = values.pop("format")
        values.pop("length_unit", None)
        if written > FORMAT:
            raise ProjectError(
                f"This project has format {written}; this Busk reads up to {FORMAT}.", "Update Busk."
            )
        scan = ScanSource(**values.pop("scan"))
        lines = tuple(WornLine(str(line["name"]), float(line["ratio"])) for line in values.pop("lines"))
        own = tuple(_own_line(line) for line in values.pop("own_lines", ()))
        placed = tuple(_placed(mark) for mark in values.pop("placed", ()))
        traits = tuple(_traits(line) for line in values.pop("traits", ()))
        elastics = tuple(elastic_of(each) for each in values.pop("elastics", ()))
        measures = tuple(_own_measure(each) for each in values.pop("own_measures", ()))
        calibrated = values.pop("calibration", None)
        known = {f.name for f in fields(Design)} - {"unknown"}
        unknown = {key: values.pop(key) for key in list(values) if key not in known}
        if not isinstance(values.get("customer", ""), str):
            raise TypeError("the customer is a text")
        return Design(
            scan=scan,
            lines=lines,
            own_lines=own,
            traits=traits,
            placed=placed,
            own_measures=measures,
            elastics=elastics,
            calibration=None if calibrated is None else calibration_of(calibrated),
            unknown=unknown,
            **values,
        )
    except UserError:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as broken:
        raise ProjectError(
            "The project's design cannot be read.", "Open a backup or start from the scan."
        ) from broken


def _own_line(values: Mapping[str, Any]) -> OwnLine:
    points, closed = values["points"], values.get("closed", False)
    if not isinstance(closed, bool) or not all(type(point) is int for point in points):
        raise TypeError("points are numbers, closed is true or false")
    return OwnLine(str(values["name"]), tuple(points), closed)


def _placed(values: Mapping[str, Any]) -> PlacedMark:
    x, y, z = map(float, values["position"])
    return PlacedMark(str(values["name"]), (x, y, z))


def _own_measure(values: Mapping[str, Any]) -> OwnMeasure:
    marks = values.get("marks", ())
    if isinstance(marks, str):
        raise TypeError("marks are a list of names")
    level = float(values.get("level", 0.0))
    return OwnMeasure(str(values["name"]), str(values["kind"]), tuple(map(str, marks)), level)


def _traits(values: Mapping[str, Any]) -> LineTraits:
    locked, linked = values.get("locked", False), values.get("linked", True)
    if not isinstance(locked, bool) or not isinstance(linked, bool):
        raise TypeError("locked and linked are true or false")
    title, colour = str(values.get("title", "")), str(values.get("colour", ""))
    stiffness, width = (
        None if number is None else float(number) for number in (values.get("stiffness"), values.get("width"))
    )
    elastic = str(values.get("elastic", ""))
    return LineTraits(str(values["name"]), title, colour, locked, linked, stiffness, width, elastic)
