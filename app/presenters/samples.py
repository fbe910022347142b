"""List the sample bodies, and the design that each of them opens with."""

from __future__ import annotations

from functools import reduce
from importlib import resources
from pathlib import Path

from core.document.design import Design, ScanSource
from core.document.lines import ActiveLine
from core.garment.presets import built_in, with_preset

SAMPLES = {"mannequin": "Mannequin", "person": "Person", "trunk": "Whole trunk"}
"""The sample bodies by file name, each with what it is called in the window."""

FIRST_RATIO = 0.95
"""Length of the mid-bust line in the first picture: natural on every body tried, and plainly to be seen."""


FIRST_SAMPLE = "person"
"""The sample body of the first start and of the tour."""

FIRST_PRESET = "Underwired bra"
"""The preset in which sample bodies open: it lifts the bust by about a centimetre, and presses gently."""

WHOLE_TRUNK, LOWER_PRESET = "trunk", "Girdle"
"""The sample that shows a body to the thighs, and the preset that it wears below its bra."""

STRAP = "strap left"
"""The line of it that is selected at first."""


def sample_path(name: str) -> Path:
    """Return the file of a sample body."""
    return Path(str(resources.files("resources") / "samples" / f"{name}.ply"))


def opened_sample(design: Design | None) -> str:
    """Return the name of the sample body that a design is on, empty for another one."""
    paths = {str(sample_path(name)): name for name in SAMPLES}
    return "" if design is None else paths.get(design.scan.path, "")


def sample_design(name: str = "mannequin") -> Design:
    """Return a design on a sample body that is already worth looking at."""
    # How the samples stand is known: not to search for it shows the first body sooner.
    scan = ScanSource(str(sample_path(name)), unit="mm", up="+z", front="-y")
    return Design(scan, lines=(ActiveLine("mid-bust", FIRST_RATIO),))


def dressed_sample(name: str = FIRST_SAMPLE) -> Design:
    """Return the design that a sample body opens with: in a bra that lifts the bust, and in a girdle."""
    titles = [FIRST_PRESET, *([LOWER_PRESET] if name == WHOLE_TRUNK else [])]
    presets = [each for each in built_in() if each.title in titles]
    return reduce(with_preset, presets, sample_design(name))
