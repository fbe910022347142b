"""A design that a search for lengths of lines came to, and what keeps it there (ours)."""

from __future__ import annotations

from dataclasses import dataclass

from core.analysis.inverse_design.sensitivities import Look
from core.document.design import Design
from core.geometry.mesh import Floats


@dataclass(frozen=True, eq=False)
class Candidate:
    """A design with the ``lengths`` that were found [%], the exact answer there, and what keeps it there.

    ``reached`` tells whether the answer is what was asked for. ``at_end`` names the lines as short or as long
    as they may be, ``pulled`` those with the most tension they may have, ``slack`` those that would push if
    they were longer; ``strained`` tells that the shape would strain beyond what looks natural.
    """

    design: Design
    lengths: Floats
    look: Look
    reached: bool
    at_end: tuple[str, ...]
    pulled: tuple[str, ...]
    slack: tuple[str, ...]
    strained: bool
