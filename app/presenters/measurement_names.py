"""What measures are called, in the window, on the sheet and in files."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from app.i18n.catalog import say, tr
from core.measurements.custom import OWN


def measure_title(row: Mapping[str, Any]) -> str:
    """Return what a row of ``measure_rows`` is called; names of one's own as they are."""
    sides = {"left": tr("{what}, left"), "right": tr("{what}, right")}
    title = row["title"] if row["key"].startswith(OWN) else say(row["title"])
    return sides.get(row["side"], "{what}").format(what=title)
