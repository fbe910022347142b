"""What can be asked for: figures as they are measured, slopes as differences tell them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from slopes import doubled, slope

from app.presenters.samples import sample_design
from core.analysis.inverse_design.profile_quantities import profile_name, section_at
from core.analysis.inverse_design.quantities import LOWER_TARGETS, NAMES, reading
from core.deformation.tffd import deform
from core.errors import UserError
from core.geometry.planar_curves import Plane, Slicer
from core.measurements.table import before_after
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve


@pytest.fixture(scope="module")
def stages() -> Stages:
    return build(replace(sample_design(), volume="exact").with_line("mid-bust", 0.9))


BUST_NAMES = tuple(name for name in NAMES if name not in LOWER_TARGETS)
PROFILES = ("profile left 340", "profile right 320.125", "profile 60.5 375")


@pytest.mark.parametrize("name", [*BUST_NAMES, *PROFILES])
def test_slopes_are_those_of_differences(stages: Stages, name: str) -> None:
    here = solve(stages).control_points
    way = np.random.default_rng(4).normal(size=here.shape) * ~stages.control.fixed[:, None]
    read = reading(doubled(stages), name)
    expected = float(slope(lambda t: read(here + t * way).value, 1e-4))
    assert np.sum(read(here).slopes * way) == pytest.approx(expected, rel=1e-6)


def test_figures_are_those_of_the_marks_and_measures(stages: Stages) -> None:
    points = solve(stages).control_points
    marks, rest = stages.watch(points), stages.rest_marks
    figures = {name: reading(stages, name)(points).value for name in BUST_NAMES}
    assert figures["lift left"] == pytest.approx(marks.bust_point_left_z - rest.bust_point_left_z)
    assert figures["lift right"] == pytest.approx(marks.bust_point_right_z - rest.bust_point_right_z)
    assert figures["out left"] == pytest.approx(marks.bust_point_left_out - rest.bust_point_left_out)
    assert figures["out right"] == pytest.approx(marks.bust_point_right_out - rest.bust_point_right_out)
    for what in ("lift", "out"):
        assert figures[what] == pytest.approx(0.5 * (figures[f"{what} left"] + figures[f"{what} right"]))
    _, after = before_after(stages, points)
    assert figures["girth"] == pytest.approx(after["bust_girth"].value, abs=0.2)


def test_apexes_are_those_of_the_marks(stages: Stages) -> None:
    points = solve(stages).control_points
    marks, rest = stages.watch(points), stages.rest_marks
    assert reading(stages, "apex lift")(points).value == pytest.approx(marks.apex_z - rest.apex_z)
    out = marks.apex_protrusion - rest.apex_protrusion
    assert reading(stages, "apex out")(points).value == pytest.approx(out)
    for what in ("apex lift", "apex out"):
        both = [reading(stages, f"{what} {side}")(points).value for side in ("left", "right")]
        assert reading(stages, what)(points).value == pytest.approx(sum(both) / 2.0)


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_profile_is_the_foremost_skin_of_the_section(stages: Stages, side: str) -> None:
    points, at = solve(stages).control_points, section_at(stages, side)
    mesh = stages.body.mesh.moved(deform(stages.binding, points))
    curves = Slicer(mesh, Plane("x", at)).curves(mesh.vertices)
    middle = stages.landmarks.position(f"bust_point_{side}")[2]
    for height in middle + np.arange(-90.0, 91.0, 15.0):
        crossed = [
            a[0] + (height - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            for curve in curves
            for a, b in zip(curve.places[:-1], curve.places[1:], strict=True)
            if (a[1] - height) * (b[1] - height) < 0.0
        ]
        out = reading(stages, profile_name(side, height))(points).value
        assert out == pytest.approx(max(crossed), abs=1e-3)


def test_what_cannot_be_asked_for_is_refused(stages: Stages) -> None:
    for name in ("lift upwards", "left", "", "girth left"):
        with pytest.raises(UserError, match="is not a target"):
            reading(stages, name)
    with pytest.raises(UserError, match="is not a position on a profile"):
        reading(stages, "profile left high")
    with pytest.raises(UserError, match="has no skin at a height of 9000 mm"):
        reading(stages, "profile left 9000")
