"""A person on solid tissue, which takes a second to condense."""

from __future__ import annotations

import pytest
from coarse_bodies import coarse_body
from solid_bodies import SLINGS

from core.document.design import Design, ScanSource
from core.pipeline.build import Stages, build


@pytest.fixture(scope="session")
def person(tmp_path_factory: pytest.TempPathFactory) -> Stages:
    """The person on solid tissue, with a sling over each breast, not worn."""
    file = coarse_body("person", tmp_path_factory.mktemp("solid"))
    return build(Design(ScanSource(str(file)), tissue="solid", own_lines=SLINGS))
