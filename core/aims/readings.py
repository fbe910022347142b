"""Everything that can be asked for, family by family: one row of the table each (ours)."""

from __future__ import annotations

from core.aims.apex import APEX
from core.aims.bust import BUST
from core.aims.even import EVEN
from core.aims.figure import Family, Read
from core.aims.girth import GIRTHS
from core.aims.outline import OUTLINE
from core.errors import UserError
from core.pipeline import Stages

FAMILIES: tuple[Family, ...] = (BUST, APEX, GIRTHS, EVEN, OUTLINE)
"""A family of figures more is one row more; each has a file of its own beside this one."""

NAMES = tuple(name for family in FAMILIES for name in family.names)
"""What can be asked for by name, in millimetres."""


def reading(stages: Stages, name: str) -> Read:
    """Return what reads the figure ``name``. Raises UserError if there is none of that name."""
    for family in FAMILIES:
        if family.has(name):
            return family.read(stages, name)
    raise UserError(f"'{name}' cannot be asked for.", f"Ask for one of: {', '.join(NAMES)}.")
