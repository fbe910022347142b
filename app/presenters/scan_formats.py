"""The kinds of scan files that can be opened, as they are written in help and dialogs."""

from __future__ import annotations

from core.scan.readers.registry import FORMATS

PACKED = ".gz"
"""Any scan may be packed."""

KINDS = ", ".join(kind.upper() for kind in FORMATS if f".{kind}" != PACKED)
"""The formats in a row: PLY, OBJ and so on."""

PATTERNS = " ".join(f"*.{kind}" for kind in FORMATS)
"""What their names look like."""
