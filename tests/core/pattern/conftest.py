"""What several tests of patterns look at."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from core.document.garment_pattern import GarmentPattern
from core.pattern.block_library import find_block
from core.pattern.garment import Pattern, pattern_of
from core.pipeline.build import Stages


@pytest.fixture(scope="session")
def bra(built: Callable[[str], Stages]) -> Pattern:
    """The three-part cup on a mannequin at rest."""
    stages = built("mannequin")
    return pattern_of(stages, stages.body.mesh.vertices, GarmentPattern(find_block("three-part-cup")))
