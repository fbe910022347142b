"""Small reference cases whose displacements the model itself has made."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from core.control_mesh.template import read_template
from core.deformation.tffd import deform
from core.document.cup import Cup
from core.document.design import Design, ScanSource
from core.document.lines import CustomLine
from core.pipeline.build import build
from core.pipeline.solve import exact_equilibrium

SLINGS = [[(row, column) for row in range(7, 0, -1)] for column in (3, -3)]
MID_BUST = [[(2, column) for column in range(-5, 6)]]
BOTH = [MID_BUST[0], SLINGS[0]]


def case_arrays(
    body: Path, lines: list[list[tuple[int, int]]], ratio: float = 0.95, **settings: Any
) -> dict[str, Any]:
    """Return what a case holds on a body with lines through rows and columns, by a design's own answer.

    Without lines the design has a cup, and solid tissue.
    """
    design = replace(Design(ScanSource(str(body))), **settings)
    template = read_template(design.template)
    for number, cells in enumerate(lines):
        line = CustomLine(f"line {number}", tuple(template.point(*cell) for cell in cells))
        design = design.with_custom_line(line).with_line(line.name, ratio)
    stages = build(design)
    binding, points = stages.binding, stages.model.tensegric.expand(exact_equilibrium(stages).state.moved)
    longest = max(map(len, lines), default=0)
    table = np.array([[*line, *[(-1, 0)] * (longest - len(line))] for line in lines] or np.empty((0, 0, 2)))
    bust = {f"bust_{side}": stages.landmarks.position(f"bust_point_{side}") for side in ("left", "right")}
    return {
        "body": body.name,
        "rest": binding.rest_moving,
        "displacement": (deform(binding, points) - binding.body.vertices)[binding.moving],
        "control_points": stages.fitted.mesh.vertices,
        "control_faces": template.faces,
        "control_fixed": template.fixed,
        "gravity": np.array([0.0, 0.0, -1.0]),
        "line_rows": table[..., 0],
        "line_columns": table[..., 1],
        "ratio": ratio,
        "tape_ea_n": 1000.0,
        "shear_modulus_kpa": 0.5 if stages.tissue is None else stages.tissue.shear_modulus(design.sag),
        **bust,
        **({} if design.cup is None else cup_arrays(design.cup)),
    }


def cup_arrays(cup: Cup) -> dict[str, Any]:
    """Return what tells the cup of a case."""
    arrays: dict[str, Any] = {
        "cup": np.array([cup.lift, cup.forward, cup.gather]),
        "cup_coverage": cup.coverage,
        "cup_kind": None if cup.kind == "moulded" else cup.kind,
        "cup_sewn": np.array([cup.across, cup.upright, cup.cloth]) if cup.kind == "sewn" else None,
        "cup_wire": cup.wire_width if cup.wire else None,
    }
    return {name: array for name, array in arrays.items() if array is not None}


def write_case(folder: Path, arrays: dict[str, Any], body: Path | None = None, /, **changed: Any) -> Path:
    """Write a case, and a copy of its body beside it; arrays ``changed`` to None are left out."""
    folder.mkdir(exist_ok=True)
    if body is not None:
        shutil.copy(body, folder)
    kept = {name: array for name, array in {**arrays, **changed}.items() if array is not None}
    np.savez_compressed(folder / "case.npz", **kept)
    return folder / "case.npz"
