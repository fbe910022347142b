"""What window tests share: the sample bodies on a fifth of their vertices, as nothing is measured there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def mannequin(coarse_samples: Callable[[str], Path]) -> Path:
    """The mannequin on which the windows of tests open too."""
    return coarse_samples("mannequin")


@pytest.fixture(scope="session")
def person(coarse_samples: Callable[[str], Path]) -> Path:
    """The body with the shape of a person."""
    return coarse_samples("person")
