"""Names of cases: states of gravity, lines of the template and cups, and what they stand for."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from core.control_mesh.fit import ControlMesh
from core.document.cup import COVERAGES
from core.document.cup import Cup as CupSettings
from core.document.design import Design, ScanSource
from core.geometry.mesh import Flags, Floats, Points
from core.pipeline.build import Stages, build
from core.pipeline.cup_parts import CupLayout
from reference.cases import Case
from reference.contact import Cup
from reference.sewn import Cloth, strips_of
from reference.underwire import Wire

Places = tuple[tuple[int, int], ...]
"""Row and column in the template of each control point of a line."""

LINES: dict[str, tuple[Places, ...]] = {
    "mid-bust": (tuple((2, column) for column in range(-5, 6)),),
    "sling": tuple(tuple((row, column) for row in range(7, 0, -1)) for column in (3, -3)),
    "strap": tuple(tuple((row, column) for row in range(7, 2, -1)) for column in (2, -2)),
}
"""Lines by name; rows count from the fold upward, column 0 is the centre, positive the subject's left."""


CUP_NUMBERS = {
    "cup": ("lift", "forward", "gather", "wire"),
    "sewn": ("across", "upright", "cloth", "wire"),
}
"""Numbers of moulded and sewn cups: ways of the apex [mm], ratios [1], cloth [N/m], width of a wire [1]."""


def bare_case(path: Path, shear_kpa: float) -> tuple[Case, Stages]:
    """Return the case of the standing body in file ``path`` [mm] and the stages that lay its control mesh."""
    stages = build(Design(ScanSource(str(path)), tissue="solid"))
    control = stages.fitted
    busts = np.stack([stages.landmarks.position(f"bust_point_{side}") for side in ("left", "right")])
    return Case(path.name, control.mesh, control.fixed, busts, shear_kpa), stages


def named_case(name: str, bare: Case, stages: Stages) -> Case:
    """Return ``bare`` in the state ``name``: parts joined by "+", as "supine", "lean=30", "sling=95%" or
    "cup=half,lift:25,forward:5" or "sewn=half,across:0.95,wire:1".

    Raises ValueError for an unknown part or lines of different ratios.
    """
    case, ratios = bare, set()
    lines: list[Places] = []
    for part in name.split("+"):
        label, _, value = part.partition("=")
        if label in LINES and re.fullmatch(r"\d+(\.\d+)?%", value):
            ratios.add(float(value[:-1]) / 100.0)
            lines += LINES[label]
        elif label in CUP_NUMBERS:
            case = replace(case, cup=cup_of(label, value, stages))
        else:
            case = replace(case, gravity=gravity_of(part))
    if len(ratios) > 1:
        raise ValueError(f"{name}: all lines of a case have the same ratio")
    return _with_lines(case, stages.fitted, lines, ratios.pop()) if lines else case


def gravity_of(part: str) -> Floats:
    """Return gravity (3,) [9.81 m/s^2] of "no-weight", "supine", "lean=DEGREES" or "gravity=X,Y,Z"."""
    label, _, value = part.partition("=")
    if part == "no-weight":
        return np.zeros(3)
    if part == "supine":
        return np.array([0.0, 1.0, 0.0])
    if label == "lean" and value:
        angle = np.radians(float(value))
        return np.array([0.0, -np.sin(angle), -np.cos(angle)])
    if label == "gravity" and value:
        return np.array([float(each) for each in value.split(",")])
    raise ValueError(
        f"{part} is not a state; choose no-weight, supine, lean=30, gravity=0,0,-1 or a line "
        f"with its ratio ({', '.join(f'{line}=95%' for line in LINES)})"
    )


def cup_of(kind: str, value: str, stages: Stages) -> Cup:
    """Return the cup of "cup" and "half,lift:25,forward:5", or "sewn" and "half,across:0.95": its numbers."""
    coverage, *parts = value.split(",")
    numbers = {label: float(number) for label, _, number in (part.partition(":") for part in parts)}
    known = CUP_NUMBERS[kind]
    if coverage not in COVERAGES or not set(numbers) <= set(known):
        raise ValueError(f"{kind}={value}: give {', '.join(COVERAGES)}, then any of {', '.join(known)}")
    width = numbers.pop("wire", None)
    settings = CupSettings("sewn" if kind == "sewn" else "moulded", coverage, **numbers)
    if width is not None:
        settings = replace(settings, wire=True, wire_width=width)
    return _laid(settings, stages)


def _laid(settings: CupSettings, stages: Stages) -> Cup:
    """Return a cup where the program lays it: its own shape and wire, but not how they act."""
    control, layout = stages.control, stages.cup_layout(settings)
    side = np.zeros(len(control.fixed), dtype=np.int64)
    for each in (1, -1):
        side[layout.points(each)] = each
    ways = settings.lift, settings.forward, settings.gather
    cup = Cup(*ways, settings.coverage, control.mesh, layout.target, side)
    if settings.kind == "sewn":
        fitted = stages.fitted
        row, column = (
            np.concatenate([at, at[fitted.mesh.edges].mean(axis=1)]) for at in (fitted.row, fitted.column)
        )
        strips = strips_of(control.mesh.edges, row, column, side)
        cup = replace(cup, cloth=Cloth(settings.across, settings.upright, settings.cloth, *strips))
    return replace(cup, wire=_wire(settings.wire_width, layout, control.fixed)) if settings.wire else cup


def _wire(width: float, layout: CupLayout, fixed: Flags) -> Wire:
    """Return the wires of both cups along the points of the roots that can move."""
    points, side, shape = [], [], []
    for each in (1, -1):
        root = layout.root(each)
        points.append(root[~fixed[root]])
        side.append(np.full(len(points[-1]), each))
        shape.append(layout.wire_shape(each)[~fixed[root]])
    return Wire(width, *map(np.concatenate, (points, side, shape)))


def _with_lines(case: Case, control: ControlMesh, lines: list[Places], ratio: float) -> Case:
    """Return ``case`` with ``lines``, the shorter ones filled up with rows of -1."""
    longest = max(map(len, lines))
    rows, columns = np.full((len(lines), longest), -1), np.zeros((len(lines), longest), dtype=np.int64)
    points: Points = np.full((len(lines), longest, 3), np.nan)
    for number, line in enumerate(lines):
        for place, (row, column) in enumerate(line):
            at = np.flatnonzero((control.row == row) & (control.column == column))
            rows[number, place], columns[number, place] = row, column
            points[number, place] = control.mesh.vertices[at[0]]
    return replace(case, ratio=ratio, rows=rows, columns=columns, points=points)


def file_label(name: str) -> str:
    """Return the part of a file's name that stands for the case ``name``."""
    return name.replace("%", "").replace("=", "-").replace("+", "_").replace(",", "_").replace(":", "-")
