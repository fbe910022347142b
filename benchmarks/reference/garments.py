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
from core.geometry.mesh import Floats, Points
from core.pipeline.build import Stages, build
from reference.cases import Case
from reference.contact import Cup

Places = tuple[tuple[int, int], ...]
"""Row and column in the template of each control point of a line."""

LINES: dict[str, tuple[Places, ...]] = {
    "mid-bust": (tuple((2, column) for column in range(-5, 6)),),
    "sling": tuple(tuple((row, column) for row in range(7, 0, -1)) for column in (3, -3)),
    "strap": tuple(tuple((row, column) for row in range(7, 2, -1)) for column in (2, -2)),
}
"""Lines by name; rows count from the fold upward, column 0 is the centre, positive the subject's left."""


WAYS = ("lift", "forward", "gather")
"""Ways of a cup's apex [mm]."""


def bare_case(path: Path, shear_kpa: float) -> tuple[Case, Stages]:
    """Return the case of the standing body in file ``path`` [mm] and the stages that lay its control mesh."""
    stages = build(Design(ScanSource(str(path)), tissue="solid"))
    control = stages.fitted
    busts = np.stack([stages.landmarks.position(f"bust_point_{side}") for side in ("left", "right")])
    return Case(path.name, control.mesh, control.fixed, busts, shear_kpa), stages


def named_case(name: str, bare: Case, stages: Stages) -> Case:
    """Return ``bare`` in the state ``name``: parts joined by "+", as "supine", "lean=30", "sling=95%" or
    "cup=half,lift:25,forward:5".

    Raises ValueError for an unknown part or lines of different ratios.
    """
    case, ratios = bare, set()
    lines: list[Places] = []
    for part in name.split("+"):
        label, _, value = part.partition("=")
        if label in LINES and re.fullmatch(r"\d+(\.\d+)?%", value):
            ratios.add(float(value[:-1]) / 100.0)
            lines += LINES[label]
        elif label == "cup":
            case = replace(case, cup=cup_of(value, stages))
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


def cup_of(value: str, stages: Stages) -> Cup:
    """Return the cup of "half,lift:25,forward:5": its coverage, and the way of the apex [mm]."""
    coverage, *ways = value.split(",")
    way = dict.fromkeys(WAYS, 0.0) | {
        label: float(number) for label, _, number in (part.partition(":") for part in ways)
    }
    if coverage not in COVERAGES or len(way) > len(WAYS):
        raise ValueError(f"cup={value}: give {', '.join(COVERAGES)}, then lift, forward or gather")
    control = stages.control
    lift, forward, gather = (way[each] for each in WAYS)
    settings = CupSettings(coverage=coverage, lift=lift, forward=forward, gather=gather)
    layout = stages.cup_layout(settings)
    side = np.zeros(len(control.fixed), dtype=np.int64)
    for each in (1, -1):
        side[layout.points(each)] = each
    return Cup(lift, forward, gather, coverage, control.mesh, layout.target, side)


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
