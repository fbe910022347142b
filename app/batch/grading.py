"""The grading of a variant: spread, increments and rules of each measure, who is served, and new sizes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

import numpy as np

from app.batch.graded_bodies import GradedBodies
from core.analysis.grading.coverage import Coverage, coverage
from core.analysis.grading.grade_rule import GradeRule, grade_rules
from core.analysis.grading.increments import Increment, increments
from core.analysis.grading.service import GARMENTS, Service, service_of
from core.analysis.grading.size_groups import Measure, SizeSpread, size_spreads
from core.analysis.grading.tolerance import ComparedBodies
from core.errors import UserError
from core.geometry.mesh import Floats
from core.messages import Message

FIT = ("cut_length_*_mm", "seam_*_mm")
"""Names of the columns that decide whom a size serves if no others are requested: what is sewn together."""

ADJUSTABLE = ("cut_length_strap*",)
"""Those among them that do not decide: straps have slides."""


@dataclass(frozen=True)
class FitMeasure:
    """Columns that decide whom a size serves, by a ``pattern`` of names, with a ``tolerance`` [1] or None."""

    pattern: str
    tolerance: float | None = None


@dataclass(frozen=True)
class ServiceOptions:
    """How it is decided whom a size serves: by the ``fit`` measures, the usual ones if there are none.

    ``tolerance`` is that of measures without their own; ``garments`` are RULE or MEAN; ``share`` of the
    bodies is to be served by new sizes [1].
    """

    tolerance: float
    garments: str
    share: float
    fit: tuple[FitMeasure, ...] = ()

    def shares(self, measures: Sequence[Measure]) -> Floats:
        """Return the tolerances of measures (m,), NaN for those that do not decide. Raises UserError."""
        found = np.array([self._share(each.name) for each in measures])
        if not np.isfinite(found).any():
            raise UserError(
                Message("No graded measure decides whom a size serves."),
                Message("Choose one with --fit, among the measures that are graded."),
            )
        return found

    def _share(self, name: str) -> float:
        for each in self.fit:
            if fnmatchcase(name, each.pattern):
                return self.tolerance if each.tolerance is None else each.tolerance
        usual = any(fnmatchcase(name, each) for each in FIT)
        adjustable = any(fnmatchcase(name, each) for each in ADJUSTABLE)
        return self.tolerance if usual and not adjustable and not self.fit else np.nan


@dataclass(frozen=True)
class ServiceCount:
    """How many bodies were ``compared`` with a garment, and how many of them it serves."""

    compared: int
    served: int

    @property
    def share(self) -> float:
        """Return the share that is served, 0 if none was compared."""
        return self.served / self.compared if self.compared else 0.0


@dataclass(frozen=True)
class Grading:
    """The grading of a variant; ``by_own`` and ``by_best`` count bodies by the kind of garments.

    ``shares`` (m,) are the tolerances of the measures, NaN for those that do not decide.
    """

    graded: GradedBodies
    options: ServiceOptions
    shares: Floats
    spreads: tuple[SizeSpread, ...]
    increments: tuple[Increment, ...]
    rules: tuple[GradeRule, ...]
    service: Service
    by_own: dict[str, ServiceCount]
    by_best: dict[str, ServiceCount]
    coverage: Coverage | None

    @property
    def sizes(self) -> int:
        """Return the number of sizes that have a body."""
        return len(self.graded.bodies.codes)


def grading_of(graded: GradedBodies, options: ServiceOptions) -> Grading:
    """Return the grading of bodies. Raises UserError."""
    bodies = graded.bodies
    compared = ComparedBodies(bodies, options.shares(bodies.measures))
    found = {garments: service_of(compared, garments) for garments in GARMENTS}
    return Grading(
        graded,
        options,
        compared.shares,
        tuple(size_spreads(bodies)),
        tuple(increments(bodies)),
        grade_rules(bodies),
        found[options.garments],
        {garments: _count([each.by_own for each in of.bodies]) for garments, of in found.items()},
        {garments: _count([each.by_best for each in of.bodies]) for garments, of in found.items()},
        coverage(compared, options.share),
    )


def _count(answers: list[bool | None]) -> ServiceCount:
    known = [each for each in answers if each is not None]
    return ServiceCount(len(known), sum(known))
