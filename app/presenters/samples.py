"""List the sample bodies, and the design that each of them opens with."""

from __future__ import annotations

from dataclasses import replace
from importlib import resources
from pathlib import Path

from core.control_mesh.template import read_template
from core.document.design import Design, ScanSource
from core.document.line_notation import ready_made_lines
from core.document.lines import ActiveLine
from core.garment.elastic_library import find_elastic

SAMPLES = {"mannequin": "Mannequin", "person": "Person"}
"""The sample bodies by file name, each with what it is called in the window."""

FIRST_RATIO = 0.95
"""Length of the mid-bust line in the first picture: natural on every body tried, and plainly to be seen."""


FIRST_SAMPLE = "person"
"""The sample body of the first start and of the tour."""

LIFTING_LINE, LIFTING_ELASTIC, LIFTING_RATIO = "strap left", "strap 15", 0.94
"""Straps of a soft bra on tissue with weight: they lift the bust by about a centimetre, and press gently."""


def sample_path(name: str) -> Path:
    """Return the file of a sample body."""
    return Path(str(resources.files("resources") / "samples" / f"{name}.ply"))


def sample_design(name: str = "mannequin") -> Design:
    """Return a design on a sample body that is already worth looking at."""
    # How the samples stand is known: not to search for it shows the first body sooner.
    scan = ScanSource(str(sample_path(name)), unit="mm", up="+z", front="-y")
    return Design(scan, lines=(ActiveLine("mid-bust", FIRST_RATIO),))


def lifted_sample(name: str = FIRST_SAMPLE) -> Design:
    """Return the design that a sample body opens with: elastic straps lift the bust."""
    straps = ready_made_lines(read_template("168"))["straps"]
    design = replace(sample_design(name), lines=(), own_lines=straps, tissue="solid")
    for strap in straps:
        design = design.with_elastic(strap.name, find_elastic(LIFTING_ELASTIC))
    return design.with_linked(LIFTING_LINE, LIFTING_RATIO)
