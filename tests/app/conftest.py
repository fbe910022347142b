"""What tests of the program share: the sample bodies on a fifth of their vertices."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from core.pipeline.build import Stages


@pytest.fixture(scope="session")
def mannequin(coarse_samples: Callable[[str], Path]) -> Path:
    """The smooth body, on which the windows of tests open too."""
    return coarse_samples("mannequin")


@pytest.fixture(scope="session")
def person(coarse_samples: Callable[[str], Path]) -> Path:
    """The body with the shape of a person."""
    return coarse_samples("person")


@pytest.fixture(scope="session")
def built(coarsely_built: Callable[[str], Stages]) -> Callable[[str], Stages]:
    """The stages of a sample body with its mid-bust line at 97 %."""
    return coarsely_built
