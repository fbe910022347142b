"""Source of a scan: file, orientation and edits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from core.errors import UserError
from core.messages import Message
from core.scan.edits import UNEDITED, ScanEdits

_LONGEST_WORD = 100  # letters of a unit or an axis


@dataclass(frozen=True)
class ScanSource:
    """Where the scan lies: the file ``path``, or ``member`` of the project ``path``.

    ``unit``, ``up`` and ``front`` are None unless they were set by hand; ``up`` and ``front`` are axes of the
    file like "+z", or directions in it like "0.2,0,1". ``edits`` refer to the upright body; the file is never
    changed. Raises UserError for what is far too long.
    """

    path: str
    member: str = ""
    unit: str | None = None
    up: str | None = None
    front: str | None = None
    edits: ScanEdits = UNEDITED

    def __post_init__(self) -> None:
        if any(len(word or "") > _LONGEST_WORD for word in (self.unit, self.up, self.front)):
            raise UserError(
                Message("The unit, up or front of the scan is not valid."),
                Message("Choose the elastic again."),
            )

    def set_up(self, **told: str | None) -> ScanSource:
        """Return the source with another unit, up or front, without edits, which refer to the former."""
        values: dict[str, Any] = dict(told)
        after = replace(self, **values)
        return after if after == self else replace(after, edits=UNEDITED)

    @property
    def name(self) -> str:
        """Return the scan's file name."""
        return Path(self.member or self.path).name
