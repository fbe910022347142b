"""Outcome: what files are written of, and how a file is wished for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from app.rendering.band import band_width
from app.rendering.camera import View
from core.deformation.tffd import deform
from core.document.design import Design
from core.geometry.mesh import Floats, Mesh, Points
from core.measurements.table import before_after, measure_rows
from core.mechanics.iteration import Record
from core.pipeline.build import Stages


@dataclass(frozen=True)
class Manner:
    """How something is written; each kind of file asks for what concerns it.

    ``unit`` and ``axes`` are None where the usual ones will do; ``before`` takes the body at rest in place of
    the reshaped one; ``frames``, ``seconds`` and ``beside`` are those of a turntable, ``size`` [px], ``dark``
    ground and ``bands`` those of pictures, ``clear`` ground and ``view``, by name or whole, of a single one.
    """

    unit: str | None = None
    axes: str | None = None
    before: bool = False
    frames: int = 36
    seconds: float = 6.0
    size: tuple[int, int] = (640, 720)
    dark: bool = False
    beside: bool = False
    clear: bool = False
    bands: bool = True
    view: str | View = "three-quarter"


@dataclass(frozen=True, eq=False)
class Outcome:
    """A body at rest and as ``control_points``, (n, 3) [mm], reshape it, with the turns that led there.

    What is worked out for one file is kept for the next. ``hidden`` are lines that pictures leave out,
    ``material`` what the body looks made of in them, ``named`` project and customer, None as
    they were opened.
    """

    stages: Stages
    control_points: Points
    records: Sequence[Record] = ()
    hidden: frozenset[str] = frozenset()
    material: str = "clay"
    named: tuple[str, str] | None = None

    @property
    def whose(self) -> str:
        """The names of project and customer, as a drawing is headed."""
        named = self.named or (Path(self.design.scan.path).name, self.design.customer)
        return " · ".join(filter(None, named))

    @property
    def design(self) -> Design:
        """The design that this came out of."""
        return self.stages.design

    def points(self, before: bool) -> Points:
        """Return the control points at rest or reshaped, shape (n, 3) [mm]."""
        return self.stages.control.mesh.vertices if before else self.control_points

    def body(self, before: bool) -> Mesh:
        """Return the whole body at rest or reshaped."""
        mesh = self.stages.body.mesh
        return mesh.moved(deform(self.stages.binding, self.points(before)))

    @cached_property
    def measures(self) -> list[dict[str, Any]]:
        """The measures before and after, a row each."""
        return measure_rows(*before_after(self.stages, self.control_points))

    @cached_property
    def occlusion(self) -> Floats:
        """How open to light the body is at each vertex, (n,) [1]."""
        from app.rendering.ambient_occlusion import bake_occlusion  # noqa: PLC0415 (brings VTK along)

        return bake_occlusion(self.stages.body.mesh)

    @cached_property
    def looks(self) -> tuple[Mapping[str, str], Mapping[str, float]]:
        """Titles and widths [mm] of the lines as the window shows them."""
        from app.presenters.lines import line_title  # noqa: PLC0415 (brings Qt along)

        names = [line.name for line in self.stages.model.lines]
        titles = {name: line_title(name, self.design) for name in names}
        return titles, {name: band_width(name, self.design) for name in names}
