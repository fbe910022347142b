"""List the sample bodies, and the design that each of them opens with."""

from __future__ import annotations

from dataclasses import replace
from importlib import resources
from pathlib import Path

from core.document.design import Design, ScanSource
from core.document.lines import ActiveLine
from core.garment.elastic_library import find_elastic

SAMPLES = {"mannequin": "Mannequin", "person": "Person"}
"""The sample bodies by file name, each with what it is called in the window."""

FIRST_RATIO = 0.95
"""Length of the mid-bust line in the first picture: natural on every body tried, and plainly to be seen."""


FIRST_SAMPLE = "person"
"""The sample body of the first start and of the tour."""

LIFTING_LINE, LIFTING_ELASTIC = "mid-bust", "power-net 80"
LIFTING_RATIO, LIFTING_HEIGHT = 0.68, 0.7
"""A wide soft band that slides: it lifts the bust of both samples by about 3 mm, and presses gently."""


def sample_path(name: str) -> Path:
    """Return the file of a sample body."""
    return Path(str(resources.files("resources") / "samples" / f"{name}.ply"))


def sample_design(name: str = "mannequin") -> Design:
    """Return a design on a sample body that is already worth looking at."""
    # How the samples stand is known: not to search for it shows the first body sooner.
    scan = ScanSource(str(sample_path(name)), unit="mm", up="+z", front="-y")
    return Design(scan, lines=(ActiveLine("mid-bust", FIRST_RATIO),))


def lifted_sample(name: str = FIRST_SAMPLE) -> Design:
    """Return the design that a sample body opens with: a wide elastic band lifts the bust."""
    bare = replace(sample_design(name), lines=(), line_contact="sliding", line_height=LIFTING_HEIGHT)
    return bare.with_elastic(LIFTING_LINE, find_elastic(LIFTING_ELASTIC)).with_line(
        LIFTING_LINE, LIFTING_RATIO
    )
