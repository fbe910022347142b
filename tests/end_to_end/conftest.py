"""What window tests share: the sample bodies on a fifth of their vertices, as nothing is measured there."""

from __future__ import annotations

from pathlib import Path

import pytest
from coarse_bodies import coarse_body

from core.document.design import Design


@pytest.fixture(scope="session")
def mannequin(coarse_sample: Design) -> Path:
    """The mannequin on which the windows of tests open too."""
    return Path(coarse_sample.scan.path)


@pytest.fixture(scope="session")
def person(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The body with the shape of a person."""
    return coarse_body("person", tmp_path_factory.mktemp("coarse"))
