"""What can be asked for: figures as they are measured, slopes as differences tell them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from slopes import doubled, slope

from app.wording.samples import sample_design
from core.aims.readings import NAMES, reading
from core.errors import UserError
from core.measures import before_after
from core.pipeline import Stages, build
from core.solution import run


@pytest.fixture(scope="module")
def stages() -> Stages:
    return build(replace(sample_design(), volume="exact").with_line("mid-bust", 0.9))


@pytest.mark.parametrize("name", NAMES)
def test_slopes_are_those_of_differences(stages: Stages, name: str) -> None:
    here = run(stages).control_points
    way = np.random.default_rng(4).normal(size=here.shape) * ~stages.control.fixed[:, None]
    read = reading(doubled(stages), name)
    expected = float(slope(lambda t: read(here + t * way).value, 1e-4))
    assert np.sum(read(here).slopes * way) == pytest.approx(expected, rel=1e-6)


def test_figures_are_those_of_the_marks_and_measures(stages: Stages) -> None:
    points = run(stages).control_points
    marks, rest = stages.watch(points), stages.rest_marks
    figures = {name: reading(stages, name)(points).value for name in NAMES}
    assert figures["lift left"] == pytest.approx(marks.nipple_left_z - rest.nipple_left_z)
    assert figures["lift right"] == pytest.approx(marks.nipple_right_z - rest.nipple_right_z)
    assert figures["out left"] == pytest.approx(marks.nipple_left_out - rest.nipple_left_out)
    assert figures["out right"] == pytest.approx(marks.nipple_right_out - rest.nipple_right_out)
    for what in ("lift", "out"):
        assert figures[what] == pytest.approx(0.5 * (figures[f"{what} left"] + figures[f"{what} right"]))
    _, after = before_after(stages, points)
    assert figures["girth"] == pytest.approx(after["bust_girth"].value, abs=0.2)


def test_what_cannot_be_asked_for_is_refused(stages: Stages) -> None:
    for name in ("lift upwards", "left", "", "girth left"):
        with pytest.raises(UserError, match="cannot be asked for"):
            reading(stages, name)
