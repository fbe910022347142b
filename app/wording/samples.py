"""The two sample bodies that Busk ships, and the design that it opens with at first start."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from core.design import Design, ScanSource
from core.design_lines import WornLine

SAMPLES = {"mannequin": "Mannequin", "person": "Person"}
"""The sample bodies by file name, each with what it is called in the window."""

FIRST_RATIO = 0.95
"""Length of the mid-bust line in the first picture: natural on every body tried, and plainly to be seen."""


def sample_path(name: str) -> Path:
    """Return the file of a sample body."""
    return Path(str(resources.files("resources") / "samples" / f"{name}.ply"))


def sample_design(name: str = "mannequin") -> Design:
    """Return a design on a sample body that is already worth looking at."""
    # How the samples stand is known: not to search for it shows the first body sooner.
    scan = ScanSource(str(sample_path(name)), unit="mm", up="+z", front="-y")
    return Design(scan, lines=(WornLine("mid-bust", FIRST_RATIO),))
