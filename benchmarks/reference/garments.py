"""Names of cases: states of gravity and lines of the template, and the definitions that they stand for."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from core.control_mesh.fit import ControlMesh
from core.document.design import Design, ScanSource
from core.geometry.mesh import Floats, Points
from core.pipeline.build import build
from reference.cases import Case

Places = tuple[tuple[int, int], ...]
"""Row and column in the template of each control point of a line."""

LINES: dict[str, tuple[Places, ...]] = {
    "mid-bust": (tuple((2, column) for column in range(-5, 6)),),
    "sling": tuple(tuple((row, column) for row in range(7, 0, -1)) for column in (3, -3)),
    "strap": tuple(tuple((row, column) for row in range(7, 2, -1)) for column in (2, -2)),
}
"""Lines by name; rows count from the fold upward, column 0 is the centre, positive the subject's left."""


def bare_case(path: Path, shear_kpa: float) -> tuple[Case, ControlMesh]:
    """Return the case of the standing body in file ``path`` [mm] and the control mesh that is laid on it."""
    stages = build(Design(ScanSource(str(path))))
    control = stages.control
    busts = np.stack([stages.landmarks.position(f"bust_point_{side}") for side in ("left", "right")])
    return Case(path.name, control.mesh, control.fixed, busts, shear_kpa), control


def named_case(name: str, bare: Case, control: ControlMesh) -> Case:
    """Return ``bare`` in the state ``name``: parts joined by "+", as "supine", "lean=30" or "sling=95%".

    Raises ValueError for an unknown part or lines of different ratios.
    """
    case, ratios = bare, set()
    lines: list[Places] = []
    for part in name.split("+"):
        label, _, value = part.partition("=")
        if label in LINES and re.fullmatch(r"\d+(\.\d+)?%", value):
            ratios.add(float(value[:-1]) / 100.0)
            lines += LINES[label]
        else:
            case = replace(case, gravity=gravity_of(part))
    if len(ratios) > 1:
        raise ValueError(f"{name}: all lines of a case have the same ratio")
    return _with_lines(case, control, lines, ratios.pop()) if lines else case


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
    return name.replace("%", "").replace("=", "-").replace("+", "_").replace(",", "_")
