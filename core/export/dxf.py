"""A new DXF drawing, and the library that writes it, kept quiet."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

UNIT_NUMBERS = {"mm": 4, "cm": 5, "m": 6, "in": 1}
"""The units of a drawing as DXF numbers them."""


def new_dxf(unit: str) -> Any:
    """Return an empty drawing of DXF R2010 in a unit, "mm", "cm", "m" or "in"."""
    with nullcontext() if "ezdxf" in sys.modules else _without_fonts():
        import ezdxf  # noqa: PLC0415 (it takes long to load, and is needed here alone)

    drawing = ezdxf.new("R2010")
    drawing.header["$INSUNITS"] = UNIT_NUMBERS[unit]
    drawing.header["$MEASUREMENT"] = 0 if unit == "in" else 1
    return drawing


@contextmanager
def _without_fonts() -> Iterator[None]:
    """Let the library find a list of fonts without any.

    Else it reads every font of the system while it loads, which may take seconds, and leaves their list in
    the user's folder; what is drawn here needs none.
    """
    variable = "XDG_CACHE_HOME"
    before = os.environ.get(variable)
    with TemporaryDirectory() as folder:
        known = Path(folder) / "ezdxf" / "font_manager_cache.json"
        known.parent.mkdir()
        known.write_text('{"version": 0, "font-faces": []}', encoding="utf-8")
        os.environ[variable] = folder
        try:
            yield
        finally:
            del os.environ[variable]
            if before is not None:
                os.environ[variable] = before
