"""Cases: a body in a state of gravity, lines and cups, and the file that keeps its displacement."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv

from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points
from reference.bands import Bands
from reference.contact import Cup, CupContact
from reference.cup_arrays import cup_arrays, read_cup
from reference.model import BustModel, bust_model
from reference.states import STANDING, Worn
from reference.underwire import Underwire

TAPE_EA_N = 1000.0
"""Stiffness of a line per unit of strain [N]."""

BAND_MM = 15.0
"""Diameter of the disc over which the force of a line is spread [mm]."""

CONTROL_MESH = ("control_points", "control_faces", "control_fixed", "bust_left", "bust_right")


@dataclass(frozen=True, eq=False)
class Case:
    """Definition of a case: a body, its control mesh, gravity [9.81 m/s^2] and lines.

    ``rows`` and ``columns`` (l, k) are the control points of each line in the template, ``points`` (l, k, 3)
    [mm] their places; a line shorter than others ends with rows of -1. ``busts`` (2, 3): left, right. ``cup``
    is that of both breasts, if any.
    """

    body: str
    control: Mesh
    fixed: Flags
    busts: Points
    shear_kpa: float
    gravity: Floats = field(default_factory=STANDING.copy)
    ratio: float = 1.0
    rows: Indices | None = None
    columns: Indices | None = None
    points: Points | None = None
    tape_ea_n: float = TAPE_EA_N
    band_mm: float = BAND_MM
    cup: Cup | None = None

    def lines(self) -> tuple[Points, ...]:
        """Return the places of each line's control points, (k, 3) [mm]."""
        if self.rows is None or self.points is None:
            return ()
        return tuple(points[row >= 0] for row, points in zip(self.rows, self.points, strict=True))

    def held(self, line: Points) -> Flags:
        """Return which points of a line are fixed in the control mesh, (k,)."""
        away = np.linalg.norm(line[:, None] - self.control.vertices, axis=2)
        return np.asarray(self.fixed[away.argmin(axis=1)])


def read_case(path: Path) -> tuple[Case, Points, Points]:
    """Return the definition stored in ``path``, its skin nodes and their displacements, both (n, 3) [mm]."""
    with np.load(path, allow_pickle=False) as stored:
        control = Mesh(stored["control_points"].astype(np.float64), stored["control_faces"].astype(np.int64))
        case = Case(
            str(stored["body"]),
            control,
            stored["control_fixed"],
            np.stack([stored["bust_left"], stored["bust_right"]]).astype(np.float64),
            float(stored["shear_modulus_kpa"]),
            stored["gravity"].astype(np.float64),
            float(stored["ratio"]),
            tape_ea_n=float(stored["tape_ea_n"]),
            band_mm=float(stored["band_mm"]),
        )
        if stored["line_rows"].size:
            rows, columns, points = (stored[f"line_{each}"] for each in ("rows", "columns", "points"))
            case = replace(case, rows=rows, columns=columns, points=points.astype(np.float64))
        if "cup" in stored:
            case = replace(case, cup=read_cup(stored))
        return case, stored["rest"].astype(np.float64), stored["displacement"].astype(np.float64)


def write_case(path: Path, case: Case, model: BustModel, moved: Points, info: dict[str, Any]) -> None:
    """Write ``case`` and how far the skin of ``model`` is displaced at nodes ``moved`` (n, 3) [mm]."""
    picked, triangles = model.skin_nodes()
    small = np.float32
    np.savez_compressed(
        path,
        rest=(picked @ model.nodes).astype(small),
        displacement=(picked @ (moved - model.nodes)).astype(small),
        triangles=triangles.astype(np.int32),
        body=np.array(case.body),
        gravity=case.gravity,
        shear_modulus_kpa=np.array(case.shear_kpa),
        ratio=np.array(case.ratio),
        line_rows=np.zeros(0) if case.rows is None else case.rows,
        line_columns=np.zeros(0) if case.columns is None else case.columns,
        line_points=np.zeros(0) if case.points is None else case.points,
        tape_ea_n=np.array(case.tape_ea_n),
        band_mm=np.array(case.band_mm),
        control_points=case.control.vertices,
        control_faces=case.control.faces.astype(np.int32),
        control_fixed=case.fixed,
        bust_left=case.busts[0],
        bust_right=case.busts[1],
        info=np.array(repr(info)),
        wall=model.wall.astype(small),
        wall_triangles=model.skin.faces.astype(np.int32),
        **({} if case.cup is None else cup_arrays(case.cup)),
    )


def model_of(case: Case, bodies: Path, count: int) -> BustModel:
    """Return the tissue of the body of ``case``, whose file [mm] is in the folder ``bodies``."""
    read = pv.read(bodies / case.body)
    body = Mesh(np.asarray(read.points, dtype=np.float64), read.regular_faces)
    return bust_model(body, case.control, case.fixed, case.shear_kpa, count)


CUP_STEPS = 8
"""Load steps of a case with cups: in each they move so little that skin in touch stays near them."""


def solved(case: Case, model: BustModel) -> tuple[Points, dict[str, Any]]:
    """Return the nodes of ``model`` in ``case``, (n, 3) [mm], and what lines and cups do."""
    start = time.perf_counter()
    lines = case.lines()
    held = tuple(map(case.held, lines))
    bands = [model.bands(lines, held, case.ratio, case.tape_ea_n, case.band_mm)] if lines else []
    cup = CupWorn() if case.cup is None else _worn(case.cup, model, case.band_mm)
    if worn := [*bands, *cup.parts]:
        moved = model.loaded_body.loaded(case.gravity, worn, CUP_STEPS if cup.parts else 4)
    else:
        moved = model.loaded_body.loaded(case.gravity) if case.gravity.any() else model.loaded_body.unloaded
    seconds = round(time.perf_counter() - start, 1)
    return moved, {"ok": True, **_line_info(bands, model, moved), **cup.info(moved), "s": seconds}


@dataclass(frozen=True, eq=False)
class CupWorn:
    """What acts of both cups, worn: the contact or the cloth, and the wires, the left before the right."""

    contacts: tuple[CupContact, ...] = ()
    cloth: tuple[Bands, ...] = ()
    wires: tuple[Underwire, ...] = ()

    @property
    def parts(self) -> tuple[Worn, ...]:
        """Return all parts."""
        return *self.contacts, *self.cloth, *self.wires

    def info(self, moved: Points) -> dict[str, Any]:
        """Return the force of each cup on the breast [N], the largest penetration [mm], the tension of cloth
        [N], and how far wires leave their form [mm], at nodes ``moved`` (n, 3).
        """
        info: dict[str, Any] = {}
        if self.contacts:
            left, right = (each.total(moved).round(3).tolist() for each in self.contacts)
            deepest = max(float(each.outside(moved).max()) for each in self.contacts)
            info |= {"cup_left_n": left, "cup_right_n": right, "penetration": round(deepest, 3)}
        for each in self.cloth:
            tension = each.tension(moved)
            info |= {
                "cloth_mean": round(float(tension.mean()), 3),
                "cloth_max": round(float(tension.max()), 3),
            }
        if self.wires:
            off = max(float(np.linalg.norm(each.off(moved), axis=1).max()) for each in self.wires)
            info["wire_off"] = round(off, 3)
        return info


def _worn(cup: Cup, model: BustModel, disc_mm: float) -> CupWorn:
    """Return ``cup`` as it acts on ``model``; cloth and wires are glued to discs of ``disc_mm``."""
    wires = () if cup.wire is None else model.wires(cup, cup.wire, disc_mm)
    if cup.cloth is not None:
        return CupWorn(cloth=(model.cloth(cup, cup.cloth, disc_mm),), wires=wires)
    return CupWorn(model.contacts(cup), wires=wires)


def _line_info(bands: Sequence[Bands], model: BustModel, moved: Points) -> dict[str, Any]:
    """Return the reached length [1] and the tensions [N] of lines."""
    info = {}
    for each in bands:
        tension = each.tension(moved)
        reached = each.lengths(moved).sum() / each.lengths(model.nodes).sum()
        info = {"reached": round(float(reached), 4)}
        info |= {"T_mean": round(float(tension.mean()), 3), "T_max": round(float(tension.max()), 3)}
    return info
