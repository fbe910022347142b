"""Design: all that the designer decided, one small immutable value. Everything else follows from it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

from core.errors import LineError, ProjectError, UserError
from core.lines import RATIO_LIMITS
from core.solver import DEFAULT_LINE_STIFFNESS
from core.volume import CONTROLS

FORMAT = 1
CONTACTS = ("glued",)
WEIGHTS = ("smooth", "paper")
TEMPLATES = ("168", "120")


@dataclass(frozen=True)
class ScanSource:
    """Where the scan lies: the file ``path``, or ``member`` of the project ``path``.

    ``unit``, ``up`` and ``front`` are None unless they were set by hand.
    """

    path: str
    member: str = ""
    unit: str | None = None
    up: str | None = None
    front: str | None = None

    @property
    def name(self) -> str:
        """The scan's file name."""
        return Path(self.member or self.path).name


@dataclass(frozen=True)
class WornLine:
    """A line that is worn, and its natural length as ratio of its length at rest [1] (paper section 3)."""

    name: str
    ratio: float


@dataclass(frozen=True)
class Design:
    """The document: what is saved, undone and solved.

    A line that is not in ``lines`` is not worn: it is measured only. ``line_height`` [1] is where the
    mid-bust line runs between fold (0) and bust point (1). ``gain`` [probe units] is that of the conventional
    force; None stands for 0.97 of the limit at which it starts to vibrate at rest. ``line_stiffness`` [1] see
    ``core.solver``. ``unknown`` keeps what a later version wrote.
    """

    scan: ScanSource
    template: str = "168"
    line_height: float = 0.5
    lines: tuple[WornLine, ...] = ()
    volume: str = "adaptive"
    gain: float | None = None
    line_stiffness: float = DEFAULT_LINE_STIFFNESS
    line_contact: str = "glued"
    weights: str = "smooth"
    unknown: Mapping[str, Any] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        for value, choices, what in (
            (self.template, TEMPLATES, "template"),
            (self.volume, CONTROLS, "volume control"),
            (self.line_contact, CONTACTS, "line contact"),
            (self.weights, WEIGHTS, "t-FFD weights"),
        ):
            if value not in choices:
                raise UserError(f"There is no {what} '{value}'.", f"Choose one of: {', '.join(choices)}.")
        for number, low, high, what in (
            (self.line_height, 0.25, 0.75, "line height"),
            (self.line_stiffness, 0.1, 500.0, "line stiffness"),
            (1.0 if self.gain is None else self.gain, 0.0, 10.0, "gain"),
        ):
            if not low <= number <= high:
                raise UserError(
                    f"The {what} {number:g} is out of range.", f"It goes from {low:g} to {high:g}."
                )
        for line in self.lines:
            if not RATIO_LIMITS[0] <= line.ratio <= RATIO_LIMITS[1]:
                raise LineError(
                    f"{line.name} cannot be set to {100 * line.ratio:.1f} % of its rest length.",
                    f"Stay between {100 * RATIO_LIMITS[0]:.0f} and {100 * RATIO_LIMITS[1]:.0f} %.",
                )

    def ratio(self, name: str) -> float:
        """Return the ratio of a line, 1 if it is not worn."""
        return next((line.ratio for line in self.lines if line.name == name), 1.0)

    def worn(self) -> frozenset[str]:
        """Return the names of the lines that are worn."""
        return frozenset(line.name for line in self.lines)

    def with_line(self, name: str, ratio: float | None) -> Design:
        """Return the design with a line at ``ratio``, or taken off (None)."""
        others = [line for line in self.lines if line.name != name]
        worn = [*others, WornLine(name, ratio)] if ratio is not None else others
        return replace(self, lines=tuple(sorted(worn, key=lambda line: line.name)))


def to_json(design: Design) -> str:
    """Return the design as text, format number first."""
    values = asdict(design)
    unknown = values.pop("unknown")
    return json.dumps({"format": FORMAT, "length_unit": "mm", **unknown, **values}, indent=1)


def from_json(text: str) -> Design:
    """Read a design; keys of later versions are kept. Raises ProjectError if it is no design."""
    try:
        values = dict(json.loads(text))
        written = values.pop("format")
        values.pop("length_unit", None)
        if written > FORMAT:
            raise ProjectError(
                f"This project has format {written}; this Busk reads up to {FORMAT}.", "Update Busk."
            )
        scan = ScanSource(**values.pop("scan"))
        lines = tuple(WornLine(str(line["name"]), float(line["ratio"])) for line in values.pop("lines"))
        known = {f.name for f in fields(Design)} - {"unknown"}
        unknown = {key: values.pop(key) for key in list(values) if key not in known}
        return Design(scan=scan, lines=lines, unknown=unknown, **values)
    except UserError:
        raise
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as broken:
        raise ProjectError(
            "The project's design cannot be read.", "Open a backup or start from the scan."
        ) from broken
