"""Contact pressures of all active lines and of cups, a row for each, and totals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.deformation.tffd import deform
from core.garment.body_location import body_location
from core.garment.cup_fit import CupSide, WornCups
from core.garment.pressure import LEFT_OUT, LinePressure, mmhg, pressure_limits, pressures
from core.garment.tension import LineTension, line_tensions
from core.geometry.mesh import Mesh, Points
from core.mechanics.constraint_lines import Line
from core.messages import Message, plain
from core.pipeline.build import Stages
from core.pipeline.stages import RegionStages
from core.pipeline.warnings import ShownState


@dataclass(frozen=True)
class PressureRow:
    """What one worn line presses with, or why that is not known: then its figures are None.

    ``where`` is the place that is pressed most, see ``body_location``, ``height_mm`` that above the
    lowest point of the scan, ``place`` the same as x, y, z [mm]. ``light`` is "green", "amber" or "red".
    ``force_n`` is all that the band presses with, whichever way; ``notes`` are sentences. The ``line`` of a
    cup is "cup left" or "cup right", and it has no width and no tension.
    """

    line: str
    title: str
    elastic: str
    width_mm: float | None = None
    tension_n: float | None = None
    mean_kpa: float | None = None
    mean_mmhg: float | None = None
    max_kpa: float | None = None
    max_mmhg: float | None = None
    where: str = ""
    height_mm: float | None = None
    place: tuple[float, ...] = ()
    light: str = ""
    force_n: float | None = None
    bridged_mm: float | None = None
    notes: tuple[Message, ...] = ()

    @property
    def is_cup(self) -> bool:
        """Return whether this is a cup, and no line."""
        return self.max_kpa is not None and self.width_mm is None


@dataclass(frozen=True, eq=False)
class PressureList:
    """All worn lines in the order of the model, then cups; ``worn`` holds places of lines, by name."""

    rows: tuple[PressureRow, ...]
    worn: Mapping[str, LinePressure]

    @property
    def force_n(self) -> float | None:
        """Return the sum of all contact forces that are known [N]; None without any."""
        known = [row.force_n for row in self.rows if row.force_n is not None]
        return sum(known) if known else None

    @property
    def complete(self) -> bool:
        """Return whether the tension of every line is known."""
        return all(row.force_n is not None for row in self.rows)

    @property
    def highest(self) -> PressureRow | None:
        """Return the line or cup with the largest pressure, if any presses."""
        pressing = [row for row in self.rows if row.max_kpa]
        return max(pressing, key=lambda row: row.max_kpa or 0.0, default=None)

    def as_data(self) -> dict[str, Any]:
        """Return the list ready for JSON, with limits, their sources and what is left out."""
        limits = pressure_limits()
        return {
            "rows": plain(self.rows),
            "force_n": self.force_n,
            "limits": {
                "amber_kpa": limits.amber_kpa,
                "red_kpa": limits.red_kpa,
                "lights": {name: words.en for name, words in limits.lights.items()},
                "beyond": [{"from_kpa": kpa, "says": words.en} for kpa, words in limits.beyond],
                "sources": [{"name": each.name, "says": each.words.en} for each in limits.sources],
                "doubts": [each.en for each in limits.doubts],
            },
            "left_out": plain(LEFT_OUT),
        }


def pressure_list_of(shown: ShownState) -> PressureList:
    """Compute the contact pressures in all regions of a body as it is shown.

    Raises LineError for control points that are not a valid shape.
    """
    lists = [pressure_list(*each) for each in zip(shown.stages.regions, shown.region_points, strict=True)]
    worn = {name: line for each in lists for name, line in each.worn.items()}
    return PressureList(tuple(row for each in lists for row in each.rows), worn)


def pressure_list(stages: RegionStages, control_points: Points) -> PressureList:
    """Compute the contact pressures of lines and cups at ``control_points``, shape (n, 3) [mm].

    Raises LineError for control points that are not a valid shape.
    """
    worn, tensions = pressures(stages, control_points), line_tensions(stages, control_points)
    body = stages.body.mesh.moved(deform(stages.binding, control_points))
    rows = [
        _row(stages, body, line, worn.get(line.name), tensions.get(line.name))
        for line in stages.model.lines
        if line.name in stages.design.active_lines()
    ]
    if isinstance(stages, Stages) and stages.design.cup is not None:
        cups = WornCups(stages).fit(control_points)
        rows += [_cup_row(stages, body, side) for side in cups.sides]
    return PressureList(tuple(rows), worn)


def _row(
    stages: RegionStages, body: Mesh, line: Line, worn: LinePressure | None, tension: LineTension | None
) -> PressureRow:
    design = stages.design
    elastic = design.active_elastics().get(line.name)
    named = line.name, design.line_settings(line.name).title or line.name, elastic.name if elastic else ""
    if worn is None or tension is None:
        return PressureRow(*named, notes=(_unknown(design.line_hold == "held"),))
    place = worn.places[worn.peak]
    at = body_location(body, stages.moving.middle, place, worn.normals[worn.peak])
    pressing = worn.largest > 0.0
    return PressureRow(
        *named,
        width_mm=worn.width,
        tension_n=tension.tension,
        mean_kpa=worn.mean,
        mean_mmhg=mmhg(worn.mean),
        max_kpa=worn.largest,
        max_mmhg=mmhg(worn.largest),
        where=at.side if pressing else "",
        height_mm=at.height_mm if pressing else None,
        place=tuple(map(float, place)) if pressing else (),
        light=worn.rating,
        force_n=worn.force,
        bridged_mm=worn.bridged_length,
        notes=worn.notes,
    )


def _cup_row(stages: RegionStages, body: Mesh, side: CupSide) -> PressureRow:
    name, place = f"cup {side.side}", np.array(side.place)
    at = None
    if side.place:
        nearest = int(np.linalg.norm(body.vertices - place, axis=1).argmin())
        at = body_location(body, stages.moving.middle, place, body.vertex_normals[nearest])
    return PressureRow(
        *(name, name, ""),
        mean_kpa=side.mean_kpa,
        mean_mmhg=mmhg(side.mean_kpa),
        max_kpa=side.max_kpa,
        max_mmhg=mmhg(side.max_kpa),
        where="" if at is None else at.side,
        height_mm=None if at is None else at.height_mm,
        place=side.place,
        light=pressure_limits().rating(side.max_kpa),
        force_n=side.force_n,
    )


def _unknown(held: bool) -> Message:
    if held:
        return Message("Tension of a line on fixed points is unknown: make lines elastic to compute it.")
    return Message("Line on fixed points: choose an elastic to compute the tension.")
