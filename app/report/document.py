"""Content of a report: values, images of the body, and colours of the lines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from PySide6.QtGui import QImage

from core.export.report_data import Report
from core.messages import Message

if TYPE_CHECKING:
    from core.pattern.garment import Pattern

SHOTS = ("front before", "front after", "side before", "side after")
"""The pictures of a sheet, in the order in which they stand."""

SHOT_SIZES = {"front": (54.0, 60.0), "side": (37.0, 60.0)}
"""Width and height of the pictures on the page [mm]."""


@dataclass(frozen=True, eq=False)
class ReportDocument:
    """A sheet, its ``pictures`` by their names in ``SHOTS``, or none, the ``colours`` of its lines, and the
    ``pattern`` of the design, if it has one, or why its pieces cannot be had.
    """

    report: Report
    pictures: Mapping[str, QImage] = field(default_factory=dict)
    colours: Mapping[str, str] = field(default_factory=dict)
    pattern: Pattern | Message | None = None
