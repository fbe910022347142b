"""Design and document as text for projects and recovery folders; keys of later versions are kept."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, fields
from typing import Any

from core.document.design import Design
from core.document.document import Document
from core.document.document_limits import LARGEST_UNKNOWN, check_nesting, check_values
from core.document.elastic import TISSUE_STIFFNESS
from core.document.json_values import field_of, parsed, whole_number
from core.document.lines import BUST, LOWER
from core.errors import ProjectError, UserError
from core.messages import Message
from core.scan.source import UNEDITED

FORMAT = 7
"""The newest format that is read: 2 has variants beside the design, 3 elastics, 4 free lines and straps, 5
edits of the scan, 6 the lower trunk, 7 pattern pieces.
"""

WITH_VARIANTS, WITH_ELASTICS, WITH_FREE_LINES, WITH_EDITS, WITH_LOWER_TRUNK, WITH_PATTERN = 2, 3, 4, 5, 6, 7
"""All else is written as 1."""

_KNOWN = frozenset(field.name for field in fields(Design)) - {"unknown"}


DESIGN, VARIANTS = "design.json", "variants.json"
"""The name of the text of the design that is shown, and of that of its variants, if there are any."""


def to_json(design: Design, written: int = 1) -> str:
    """Return the design as text, the number of the format first."""
    return json.dumps(to_values(design, written), indent=1)


def to_values(design: Design, written: int = 1) -> dict[str, Any]:
    """Return the design as values of JSON, the number of the format first."""
    values = asdict(design)
    unknown = values.pop("unknown")
    # What is not used is not written: the project stays one that every Busk reads, to the byte.
    for traits in values["traits"]:
        if not traits["elastic"]:
            del traits["elastic"]
    for line in values["own_lines"]:
        for key in ("places", "over_shoulder", "continues"):
            if not line[key]:
                del line[key]
        if line["region"] == BUST:
            del line["region"]
    if not design.elastics:
        del values["elastics"]
    if design.scan.edits == UNEDITED:
        del values["scan"]["edits"]
    if design.tissue_stiffness == TISSUE_STIFFNESS:
        del values["tissue_stiffness"]
    for key in ("own_measures", "customer", "worn_tight_mm", "calibration", "cup", "lower", "pattern"):
        if not values[key]:
            del values[key]
    return {"format": max(written, _format_of(design)), "length_unit": "mm", **unknown, **values}


def _format_of(design: Design) -> int:
    """Return the oldest format that holds a design: an older program would drop what it does not know."""
    needed = (
        (WITH_PATTERN, design.pattern is not None),
        (WITH_LOWER_TRUNK, design.lower is not None or bool(design.lines_of(LOWER))),
        (WITH_EDITS, design.scan.edits != UNEDITED),
        (WITH_FREE_LINES, any(line.free or line.over_shoulder for line in design.own_lines)),
        (WITH_ELASTICS, bool(design.elastics)),
    )
    return max((written for written, used in needed if used), default=1)


def from_json(text: str) -> Design:
    """Read a design; keys of later versions are kept. Raises ProjectError if it is no design."""
    try:
        check_values(text)
        return from_values(parsed(text))
    except ValueError as broken:
        raise ProjectError(
            Message("The project's design cannot be read."), Message("Open a backup or start from the scan.")
        ) from broken


def from_values(values: Any) -> Design:
    """Read a design of JSON values; keys of later versions are kept. Raises ProjectError, ValueError."""
    if not isinstance(values, Mapping) or not {"format", "scan", "lines"} <= values.keys():
        raise ValueError("not a design")
    written = whole_number(values["format"], "format")
    if written > FORMAT:
        raise ProjectError(
            Message(
                "The project has file format {written}. This version of Busk reads formats up to {format}.",
                written=written,
                format=FORMAT,
            ),
            Message("Update Busk."),
        )
    known = {key: field_of(Design, key, values[key]) for key in values if key in _KNOWN}
    others = {key: values[key] for key in values if key not in (*_KNOWN, "format", "length_unit")}
    check_nesting(others)
    if not _fits(others):
        raise ProjectError(
            Message("The project contains too much data that this version of Busk does not support."),
            Message("Update Busk."),
        )
    return Design(**known, unknown=others)


def _fits(others: Mapping[str, Any]) -> bool:
    """Return whether what is unknown can be written within its limit; no more of it is than that."""
    left = LARGEST_UNKNOWN
    for part in json.JSONEncoder(indent=1).iterencode(others):
        left -= len(part)
        if left < 0:
            return False
    return True


def to_texts(document: Document) -> dict[str, str]:
    """Return what is written of a document, by name."""
    others = {name: to_values(each) for name, each in document.designs if name != document.shown}
    if document == Document.single(document.design):
        return {DESIGN: to_json(document.design)}
    # An older program would drop the variants at its next save: it must not read this.
    variants = {"shown": document.shown, "others": others}
    # Nor one that could read the design that is shown, but not a variant of it: it says by itself why.
    written = max([WITH_VARIANTS, *(each["format"] for each in others.values())])
    return {DESIGN: to_json(document.design, written), VARIANTS: json.dumps(variants, indent=1)}


def from_texts(texts: Mapping[str, str]) -> Document:
    """Read a document; there must be at least its design. Raises ProjectError if it is none."""
    design = from_json(texts[DESIGN])
    if VARIANTS not in texts:
        return Document.single(design)
    try:
        check_values(texts[VARIANTS])
        told = parsed(texts[VARIANTS])
        shown, others = told["shown"], {name: from_values(each) for name, each in told["others"].items()}
        if shown in others:
            raise ValueError("more than one design is shown")
        return Document(tuple(sorted({**others, shown: design}.items())), shown).with_design(design)
    except ProjectError:
        raise
    except (UserError, ValueError, KeyError, TypeError, AttributeError) as broken:
        raise ProjectError(
            Message("The project's variants cannot be read."), Message("Open a backup.")
        ) from broken
