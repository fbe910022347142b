"""Uncertain parameters of a design."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

import numpy as np

from core.analysis.uncertainty.input_uncertainty import InputUncertainty
from core.document.cup import CUP_RANGES, Cup
from core.document.design import Design
from core.document.elastic import TISSUE_LIMITS, Elastic
from core.geometry.mesh import Points, unit
from core.landmarks.manual import in_file
from core.landmarks.types import SIDES
from core.measurements.table import OWN
from core.measurements.uncertain_value import ELASTIC, LANDMARKS, LINE, SCAN, TAPE, TISSUE
from core.mechanics.constraint_lines import RATIO_LIMITS, Line
from core.mechanics.options import RANGES
from core.pipeline.build import Stages
from core.pipeline.stages import RegionStages

UPRIGHT = np.array([0.0, 0.0, 1.0])

OF_THE_FIT = ("bust_point", "fold")
"""The landmarks of each side that the control mesh hangs on."""

OF_MEASURES = ("root_inner", "root_outer")
"""Further landmarks of each side that measures alone hang on."""

NAMES = tuple(f"{kind}_{side}" for kind in (*OF_THE_FIT, *OF_MEASURES) for side in SIDES)
"""All landmarks that have knobs."""


@dataclass(frozen=True, eq=False)
class UncertainParameter:
    """One thing that may be off by ``sd``: in mm, or in the logarithm of a stiffness or force.

    ``source`` is one of ``SOURCES``; ``name`` that of a landmark, line or elastic; ``direction`` (3,) is
    where a landmark goes, None for ``PLACING``; ``shift`` (n, 3) [mm] is how far one ``sd`` of the model
    error moves the control points; ``cup`` names a setting of the cups.
    """

    source: str
    sd: float
    name: str = ""
    direction: Points | None = None
    shift: Points | None = None
    cup: str = ""


PLACING = UncertainParameter(LANDMARKS, 1.0)
"""What placing all landmarks where they were found does by itself: so far are those unsure, too."""


def uncertain_parameters(stages: Stages, assumed: InputUncertainty) -> tuple[UncertainParameter, ...]:
    """Return all knobs of a design that turn anything, the quick ones first."""
    found = [
        *line_parameters(stages, assumed),
        *_of_cups(stages, assumed),
        UncertainParameter(SCAN, assumed.skin_mm),
        *_of_landmarks(stages, assumed),
    ]
    return tuple(knob for knob in found if knob.sd > 0.0)


def line_parameters(stages: RegionStages, assumed: InputUncertainty) -> Iterator[UncertainParameter]:
    """Yield the knobs of the lines and the tissue of a region."""
    design = stages.design
    elastics, worn = (
        design.active_elastics(),
        [line for line in stages.model.lines if line.name in design.active_lines()],
    )
    moving = [line for line in worn if line.constrains]
    if not design.is_bare:
        yield UncertainParameter(TISSUE, assumed.sag_ln if design.tissue == "solid" else assumed.tissue_ln)
    if any(line.name not in elastics for line in moving) and design.line_hold == "spring":
        yield UncertainParameter(LINE, assumed.line_ln)
    for line in worn:
        if line.constrains or line.name in elastics:
            yield UncertainParameter(TAPE, assumed.tape_mm, line.name)
    for elastic in dict.fromkeys(elastics.values()):
        sd = assumed.elastic_ln if elastic.estimate else assumed.measured_elastic_ln
        yield UncertainParameter(ELASTIC, sd, elastic.name)


def _of_cups(stages: Stages, assumed: InputUncertainty) -> Iterator[UncertainParameter]:
    """Yield each length of a cup off by what a band is, and its cloth as an elastic that is estimated."""
    cup = stages.design.cup
    if cup is None:
        return
    layout = stages.cup_layout(cup)
    if cup.kind == "moulded":
        lengths = dict.fromkeys(("lift", "forward", "gather"), 1.0)
    else:
        lengths = dict(zip(("across", "upright"), layout.cloth_lengths(1), strict=True))
        yield UncertainParameter(ELASTIC, assumed.elastic_ln, cup="cloth")
    if cup.wire:
        lengths["wire_width"] = layout.root_width(1)
    for setting, length in lengths.items():
        yield UncertainParameter(TAPE, assumed.tape_mm / length, cup=setting)


def _of_landmarks(stages: Stages, assumed: InputUncertainty) -> Iterator[UncertainParameter]:
    marks, skin = stages.landmarks.points, stages.body.smoothed
    for name in NAMES:
        if name not in marks:
            continue
        mark, sd = marks[name], assumed.of_landmark(marks[name])
        nearest = int(np.linalg.norm(skin.vertices - mark.position, axis=1).argmin())
        across = unit(np.cross(UPRIGHT, skin.vertex_normals[nearest]))
        if not name.startswith("root"):
            up = UPRIGHT if name.startswith("fold") else np.cross(skin.vertex_normals[nearest], across)
            yield UncertainParameter(LANDMARKS, sd, name, up)
        if not name.startswith("fold"):
            yield UncertainParameter(LANDMARKS, sd, name, across)


def unmodelled_measurements(design: Design) -> tuple[str, ...]:
    """Return the keys of measures at rest and as worn whose landmarks have no knobs: how sure, nobody knows.

    Waist and hip are not among them: where they lie a girth hardly changes with the height.
    """
    own = [f"{OWN}{own.name}" for own in design.own_measures if not set(own.marks) <= set(NAMES)]
    return "high_bust_girth", "high_bust_girth_skin", *own


@dataclass(frozen=True, eq=False)
class Perturbed:
    """A ``design`` with knobs turned, how much further out all skin lies [mm], and the ``shift`` (n, 3) of
    the control points by the model error [mm].
    """

    design: Design
    skin: float = 0.0
    shift: Points | float = 0.0


def perturb(stages: Stages, turns: Mapping[UncertainParameter, float]) -> Perturbed:
    """Return the design of ``stages`` with each knob turned by so many standard deviations.

    Where a landmark is turned all others that have knobs are placed where they are: they do not follow it.
    """
    design, skin = stages.design, 0.0
    shift: Points | float = 0.0
    marks: dict[str, Points] = {}
    if any(knob.source == LANDMARKS for knob in turns):
        marks = {name: stages.landmarks.position(name) for name in NAMES if name in stages.landmarks.points}
    for knob, turn in turns.items():
        off = turn * knob.sd
        if knob.source == SCAN:
            skin += off
        elif knob.shift is not None:
            shift = shift + off * knob.shift
        elif knob.source == LANDMARKS:
            if knob.direction is not None:
                marks[knob.name] = marks[knob.name] + off * knob.direction
        else:
            design = turned_design(design, stages, knob, turn)
    for name, place in marks.items():
        design = design.with_placed(name, in_file(place, stages.body.pose.file_to_mm))
    return Perturbed(design, skin, shift)


def turned_design(design: Design, stages: RegionStages, knob: UncertainParameter, turn: float) -> Design:
    """Return the ``design`` of a region with a knob of lines, tissue or cups turned by so many deviations."""
    if knob.cup:
        return replace(design, cup=turned_cup(design.cup, knob, turn))
    lines = {line.name: line for line in stages.model.lines}
    return _TURNS[knob.source](design, knob, turn * knob.sd, lines)


def turned_cup(cup: Cup | None, knob: UncertainParameter, turn: float) -> Cup:
    """Return a cup with one of its settings turned by so many standard deviations, within its range."""
    assert cup is not None, "a knob of cups is one of a design with cups"
    value, off = getattr(cup, knob.cup), turn * knob.sd
    turned = value * math.exp(off) if knob.source == ELASTIC else value + off
    changed: dict[str, Any] = {knob.cup: _within(turned, CUP_RANGES[knob.cup])}
    return replace(cup, **changed)


def _tissue(design: Design, knob: UncertainParameter, off: float, lines: Mapping[str, Line]) -> Design:
    if design.tissue == "solid":
        return replace(design, sag=_within(design.sag * math.exp(off), RANGES["sag"]))
    return replace(design, tissue_stiffness=_within(design.tissue_stiffness * math.exp(off), TISSUE_LIMITS))


def _line(design: Design, knob: UncertainParameter, off: float, lines: Mapping[str, Line]) -> Design:
    """Return it with lines that are made of no elastic stiffer."""
    limits, factor = RANGES["line_stiffness"], math.exp(off)
    own = design.line_stiffnesses()
    traits = [
        replace(design.line_settings(name), stiffness=_within(stiffness * factor, limits))
        for name, stiffness in own.items()
        if name not in design.active_elastics()
    ]
    usual = _within(design.line_stiffness * factor, limits)
    return reduce(Design.with_line_settings, traits, replace(design, line_stiffness=usual))


def _tape(design: Design, knob: UncertainParameter, off: float, lines: Mapping[str, Line]) -> Design:
    ratio = design.ratio(knob.name) + off / lines[knob.name].whole_length
    worn = [
        replace(line, ratio=_within(ratio, RATIO_LIMITS)) if line.name == knob.name else line
        for line in design.lines
    ]
    return replace(design, lines=tuple(worn))


def _elastic(design: Design, knob: UncertainParameter, off: float, lines: Mapping[str, Line]) -> Design:
    made = [_stronger(each, math.exp(off)) if each.name == knob.name else each for each in design.elastics]
    return replace(design, elastics=tuple(made))


def _stronger(elastic: Elastic, factor: float) -> Elastic:
    return replace(elastic, curve=tuple((elongation, factor * force) for elongation, force in elastic.curve))


def _within(number: float, limits: tuple[float, float]) -> float:
    return min(max(number, limits[0]), limits[1])


_TURNS: Mapping[str, Callable[[Design, UncertainParameter, float, Mapping[str, Line]], Design]] = {
    TISSUE: _tissue,
    LINE: _line,
    TAPE: _tape,
    ELASTIC: _elastic,
}
