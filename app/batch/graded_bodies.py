"""Bodies of a run with their sizes and the measures that are graded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np

from app.batch.results import Results
from app.batch.schema import DONE
from core.analysis.grading.size_groups import Measure, SizeCode, SizedBodies
from core.errors import UserError
from core.measurements.size_table import SizeTable
from core.measurements.sizes import built_in
from core.messages import Message

GRADED = ("cut_length_*_mm", "area_*_cm2", "seam_*_mm")
"""Names of the columns that are graded if no others are requested."""

SIZE, BAND, CUP = GROUPINGS = ("size", "band", "cup")
"""What bodies are grouped by."""

SYSTEMS = tuple(table.key for table in built_in())
"""The size systems of the columns of a run."""


@dataclass(frozen=True)
class Grouping:
    """What bodies are grouped by, in the size system of a ``table``: SIZE, BAND or CUP."""

    by: str
    table: SizeTable

    def label(self, code: SizeCode) -> str:
        """Return a size as it is written."""
        band, cup = self.table.bands.steps[code.band], self.table.cups.steps[code.cup]
        return {SIZE: self.table.labelled(band, cup), BAND: band.name, CUP: cup.name}[self.by]

    def code(self, band: str, cup: str) -> SizeCode | None:
        """Return a size by the names of its band and cup, None if the system has no such size."""
        bands, cups = ([step.name for step in scale.steps] for scale in (self.table.bands, self.table.cups))
        if (band not in bands and self.by != CUP) or (cup not in cups and self.by != BAND):
            return None
        return SizeCode(0 if self.by == CUP else bands.index(band), 0 if self.by == BAND else cups.index(cup))


@dataclass(frozen=True)
class LeftOut:
    """How many rows are not graded: copies of a scan, by their state, by their verdict, or without a size."""

    copies: int
    states: dict[str, int]
    verdicts: dict[str, int]
    no_size: int

    @property
    def sentences(self) -> tuple[str, ...]:
        """Return the reasons in words, none if nothing is left out."""
        found = [f"{count} {state}" for state, count in sorted(self.states.items())]
        found += [f"{count} with the verdict {verdict}" for verdict, count in sorted(self.verdicts.items())]
        found += [f"{self.no_size} without a size in this system"] if self.no_size else []
        return (*found, *([f"{self.copies} copies of another scan"] if self.copies else []))


@dataclass(frozen=True)
class GradedBodies:
    """The ``bodies`` of a variant that are graded, and those that are not."""

    variant: str
    grouping: Grouping
    bodies: SizedBodies
    left_out: LeftOut


def grouping_of(by: str, system: str) -> Grouping:
    """Return what bodies are grouped by, the system by its key."""
    return Grouping(by, next(table for table in built_in() if table.key == system))


def measures_of(results: Results, patterns: Sequence[str], without: Sequence[str]) -> tuple[Measure, ...]:
    """Return the columns of numbers that match one of the ``patterns`` and are not left out.

    Raises UserError without any. A column without any value is not a measure of this variant.
    """
    found = []
    for name, unit in results.units.items():
        wanted = any(fnmatchcase(name, each) for each in patterns or GRADED)
        wanted = wanted and not any(fnmatchcase(name, each) for each in without)
        if wanted and np.isfinite(results.numbers(name)[results.done]).any():
            found.append(Measure(name, unit))
    if not found:
        raise no_measures_error(results.variant)
    return tuple(found)


def graded_bodies(
    results: Results, grouping: Grouping, measures: tuple[Measure, ...], verdicts: Sequence[str] = ()
) -> GradedBodies:
    """Return the bodies that are done and have a size; with ``verdicts`` only those with one of them.

    Measures that none of these bodies has are left out. Raises UserError if there is no body, or no measure.
    """
    bands, cups = (results.texts(f"{part}_{grouping.table.key}") for part in (BAND, CUP))
    found = results.texts("verdict")
    chosen = [int(at) for at in results.done if not verdicts or found[at] in verdicts]
    others = Counter(found[at] for at in results.done if verdicts and found[at] not in verdicts)
    codes = {at: grouping.code(bands[at], cups[at]) for at in chosen}
    sized = {at: code for at, code in codes.items() if code is not None}
    states = results.texts("state")
    undone = {state: states.count(state) for state in set(states) if state != DONE}
    left_out = LeftOut(results.duplicates, undone, dict(others), len(codes) - len(sized))
    if not sized:
        raise UserError(
            Message("No body of {variant} has a size in this system.", variant=results.variant),
            Message("Choose another one with --system, and check the scans in index.html."),
        )
    scans, places = results.texts("scan"), list(sized)
    columns = {each: results.numbers(each.name)[places] for each in measures}
    columns = {each: values for each, values in columns.items() if np.isfinite(values).any()}
    if not columns:
        raise no_measures_error(results.variant)
    bodies = SizedBodies(
        tuple(scans[at] for at in places),
        np.array(list(sized.values()), dtype=np.int64),
        tuple(columns),
        np.column_stack(list(columns.values())),
    )
    return GradedBodies(results.variant, grouping, bodies, left_out)


def no_measures_error(variant: str) -> UserError:
    """Return the error of a variant whose bodies have no values to grade."""
    return UserError(
        Message("{variant} has no values of measures to grade.", variant=variant),
        Message("Use a design with elastics or a pattern, or choose columns with --measure."),
    )
