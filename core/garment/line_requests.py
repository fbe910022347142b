"""Lengths and elastics of lines as text requests: NAME=LENGTH and LINE=ELASTIC."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from pathlib import Path

from core.document.design import Design
from core.document.elastic import Elastic
from core.document.lines import LOWER
from core.document.lower_trunk import LowerTrunk, lower_lines_of
from core.errors import LineError
from core.garment.elastic_library import find_elastic, read_elastic
from core.landmarks.types import SIDES
from core.mechanics.constraint_lines import Line, length_ratio
from core.messages import Message
from core.pipeline.build import Stages, build


def with_lower_trunk(design: Design, requests: Sequence[str]) -> Design:
    """Return a design that has the lower trunk if a request, NAME=LENGTH, is for one of its lines."""
    own = [line.name for line in design.own_lines]
    asked = [name for request in requests if not named(name := _name(request), own)]
    if design.lower is None and any(map(lower_lines_of, asked)):
        return replace(design, lower=LowerTrunk())
    return design


def with_lines_and_elastics(stages: Stages, lines: Sequence[str], elastics: Sequence[str]) -> Stages:
    """Return the stages of a design with ``lines``, NAME=LENGTH, and ``elastics``, LINE=ELASTIC."""
    below = {line.name.lower() for line in stages.design.lines_of(LOWER)}
    asked = {_name(request) for request in lines}
    if stages.lower_problem is not None and (asked & below or any(map(lower_lines_of, asked))):
        raise stages.lower_problem
    design = apply_lines(stages.design, stages.lines, lines)
    return build(apply_elastics(design, elastics), stages)


def apply_lines(design: Design, lines: Sequence[Line], requests: Sequence[str]) -> Design:
    """Return a design with lengths of ``lines`` set by requests, NAME=LENGTH each. Raises LineError.

    A name that both sides have stands for both.
    """
    known = {line.name: line for line in lines}
    for request in requests:
        _, equals, text = request.partition("=")
        names = named(_name(request), known)
        if not names or not equals:
            raise LineError(
                Message("'{request}' is not a line.", request=request),
                Message("Enter NAME=LENGTH. Lines: {names}.", names=", ".join(known)),
            )
        for name in names:
            band = [known[each] for each in design.band_of(name)]
            rest, whole = (sum(line.rest_length for line in band), sum(line.whole_length for line in band))
            design = design.with_line(name, length_ratio(text, name, rest, whole))
    return design


def apply_elastics(design: Design, requests: Sequence[str]) -> Design:
    """Return a design with elastics of active lines set by requests, LINE=ELASTIC each. Raises LineError."""
    active = sorted(design.all_active_lines())
    for request in requests:
        _, equals, elastic = (part.strip() for part in request.partition("="))
        if not equals or not named(_name(request), active):
            raise LineError(
                Message("'{request}' is not an active line.", request=request),
                Message("Enter LINE=ELASTIC. Active lines: {active}.", active=", ".join(active) or "none"),
            )
        design = with_line_elastic(design, _name(request), elastic_of(elastic))
    return design


def elastic_of(text: str) -> Elastic:
    """Return the elastic that a text names: one of the library, or that of a table FILE.csv.

    Raises LineError.
    """
    return read_elastic(Path(text)) if text.lower().endswith(".csv") else find_elastic(text)


def with_line_elastic(design: Design, name: str, elastic: Elastic) -> Design:
    """Return a design with an elastic on the active line ``name``, or on those of both sides."""
    names = named(name, sorted(design.all_active_lines()))
    for part in dict.fromkeys(part for each in names for part in design.band_of(each)):
        design = design.with_elastic(part, elastic)
    return design


def _name(request: str) -> str:
    return request.partition("=")[0].strip().lower()


def named(name: str, known: Collection[str]) -> list[str]:
    """Return which of the ``known`` lines a name stands for: one of them, or both sides."""
    name = name.strip().lower()
    same = [each for each in known if each.lower() == name]
    sides = [f"{name}{gap}{side}" for gap in (" ", "-") for side in SIDES]
    return same or [each for each in known if each.lower() in sides]
