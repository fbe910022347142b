"""A design that a search for lengths of lines came to, and what keeps it there (ours)."""

from __future__ import annotations

from dataclasses import dataclass

from core.analysis.inverse_design.sensitivities import LinearizedSolution
from core.document.design import Design
from core.geometry.mesh import Floats


@dataclass(frozen=True, eq=False)
class Candidate:
    """A design with the ``lengths`` that were found [%], the exact answer there, and what keeps it there.

    ``reached`` tells whether the answer is what was asked for. ``at_limit`` names the lines as short or as
    long
    as they may be, ``most_tensioned`` those with the most tension they may have, ``slack`` those that would
    push if they were longer; ``strained`` tells that the shape would strain beyond what looks natural.
    """

    design: Design
    lengths: Floats
    solution: LinearizedSolution
    reached: bool
    at_limit: tuple[str, ...]
    most_tensioned: tuple[str, ...]
    slack: tuple[str, ...]
    strained: bool
