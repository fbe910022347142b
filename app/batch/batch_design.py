"""The design of a run over many bodies: all that a design holds, and nothing of one person."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from core import __version__
from core.analysis.inverse_design.target_requests import goals_of
from core.control_mesh.template import read_template
from core.document.design import Design
from core.document.elastic import Elastic
from core.document.json_values import value_of
from core.document.lower_trunk import LowerTrunk, lower_line_names
from core.document.serialization import from_values, to_values
from core.document.storage.project_file import is_project, open_project
from core.errors import LineError
from core.garment.line_requests import elastic_of, named, with_line_elastic
from core.garment.presets import Preset, with_preset
from core.messages import Message
from core.scan.source import ScanSource

SCHEMA_VERSION = 1
"""The version of the columns of ``app.batch.schema``: results of another version are not continued."""


@dataclass(frozen=True)
class LineElastic:
    """An ``elastic``, with its curve, on the active ``line`` of that name, or on those of both sides."""

    line: str
    elastic: Elastic


@dataclass(frozen=True)
class BatchDesign:
    """One variant of a run, by its ``name``.

    ``design`` holds what is the same on every body; ``lines`` are texts NAME=LENGTH and ``targets`` texts
    NAME=VALUE, whose lengths [mm] are those of each body.
    """

    name: str
    design: Design
    lines: tuple[str, ...] = ()
    elastics: tuple[LineElastic, ...] = ()
    targets: tuple[str, ...] = ()

    @property
    def active_lines(self) -> tuple[str, ...]:
        """Return the names of all lines that are active on every body, in the order of the control meshes."""
        known = line_names(self.design)
        asked = (text.partition("=")[0] for text in self.lines)
        active = self.design.all_active_lines() | {
            part for text in asked for name in named(text, known) for part in self.design.band_of(name)
        }
        return tuple(name for name in known if name in active)

    def on_scan(self, path: Path) -> Design:
        """Return the design on a scan, with the unit and axes of the run, or on the body of a project.

        Of a project scan, edits, landmarks, customer and calibration are used. Raises UserError.
        """
        if not is_project(path):
            return replace(self.design, scan=replace(self.design.scan, path=str(path)))
        body = open_project(path).design
        return replace(
            self.design,
            scan=body.scan,
            placed=body.placed,
            customer=body.customer,
            calibration=body.calibration,
        )

    def as_data(self) -> dict[str, Any]:
        """Return the design as values of JSON."""
        return {
            "name": self.name,
            "design": to_values(self.design),
            "lines": list(self.lines),
            "elastics": [asdict(each) for each in self.elastics],
            "targets": list(self.targets),
        }


def batch_design(
    name: str, design: Design, lines: Sequence[str], elastics: Sequence[str], targets: Sequence[str]
) -> BatchDesign:
    """Return a design for many bodies, with LINE=ELASTIC texts read; what is of one person is left out.

    Left out are scan, its edits, placed landmarks, customer and calibration. Raises UserError for texts that
    are valid on no body.
    """
    scan = ScanSource("", unit=design.scan.unit, up=design.scan.up, front=design.scan.front)
    neutral = replace(design, scan=scan, placed=(), customer="", calibration=None)
    if design.pattern is not None and design.pattern.block.needs_lower_trunk and design.lower is None:
        neutral = replace(neutral, lower=LowerTrunk())
    found = BatchDesign(name, neutral, tuple(lines), (), tuple(targets))
    _check_lines(found)
    goals_of(targets)
    chosen = []
    for text in elastics:
        line, equals, elastic = (part.strip() for part in text.partition("="))
        if not equals or not named(line, found.active_lines):
            raise LineError(
                Message("'{request}' is not an active line.", request=text),
                Message(
                    "Enter LINE=ELASTIC. Active lines: {active}.",
                    active=", ".join(found.active_lines) or "none",
                ),
            )
        chosen.append(LineElastic(line, elastic_of(elastic)))
    # As a worker reads it: the same design has the same key wherever it comes from.
    return design_of_data(json.loads(json.dumps(replace(found, elastics=tuple(chosen)).as_data())))


def preset_design(preset: Preset) -> tuple[str, Design]:
    """Return the name and the design of a preset on no body yet."""
    return preset.title, with_preset(Design(ScanSource("")), preset)


def _check_lines(design: BatchDesign) -> None:
    known = line_names(design.design)
    for text in design.lines:
        name, equals, _ = text.partition("=")
        if not equals or not named(name, known):
            raise LineError(
                Message("'{request}' is not a line.", request=text),
                Message("Enter NAME=LENGTH. Lines: {names}.", names=", ".join(known)),
            )


def line_names(design: Design) -> tuple[str, ...]:
    """Return the names of the lines that a design has on any body, those of the bust first."""
    own = [line.name for line in design.own_lines]
    below = sorted(lower_line_names()) if design.lower is not None else []
    return tuple(dict.fromkeys((*read_template(design.template).lines, *own, *below)))


def design_of_data(values: Mapping[str, Any]) -> BatchDesign:
    """Return the design that ``as_data`` returned as values. Raises UserError, ValueError if it is none."""
    return BatchDesign(
        str(values["name"]),
        from_values(values["design"]),
        tuple(map(str, values["lines"])),
        tuple(value_of(LineElastic, each, "elastics") for each in values["elastics"]),
        tuple(map(str, values["targets"])),
    )


def with_elastics(design: Design, elastics: Sequence[LineElastic]) -> Design:
    """Return a design whose active lines have these elastics."""
    for each in elastics:
        design = with_line_elastic(design, each.line, each.elastic)
    return design


def content_key(designs: Sequence[BatchDesign]) -> str:
    """Return a key of all that decides the results of a run apart from its scans: designs and versions."""
    whole = {"designs": [each.as_data() for each in designs], "busk": __version__, "schema": SCHEMA_VERSION}
    return hashlib.sha256(json.dumps(whole, sort_keys=True).encode()).hexdigest()
