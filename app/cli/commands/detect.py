"""What was found on a scan, as the command line prints it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def found_text(found: Mapping[str, Any]) -> str:
    """Return what ``core.landmarks.as_dict.detection`` found as lines of text.

    Places are in the canonical frame [mm], and in the file's own where that is another.
    """
    own = not np.allclose(found["file_to_mm"], np.eye(4))
    lines = [f"unit {found['unit']}, up {found['up']}, front {found['front']}"]
    if found["upright"]:
        lines.append(f"set upright with --up={found['upright']}")
    for name, mark in found["landmarks"].items():
        x, y, z = mark["mm"]
        line = f"{name:22} {x:8.1f} {y:8.1f} {z:8.1f} mm  {100 * mark['confidence']:3.0f} %"
        if own:
            line += "  file " + ",".join(f"{value:.6g}" for value in mark["file"])
        lines.append(f"{line}  {mark['rule']}")
    lines += [
        f"{name:22} tape {girth['tape_mm']:.1f} mm at height {girth['level_mm']:.1f} mm"
        for name, girth in found["girths"].items()
    ]
    return "\n".join(lines)
