"""Profiles from tables: as they are written by hand, and as Busk exports a section."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.presenters.samples import sample_design
from core.analysis.inverse_design.profile_curve import profile_goals, read_profile
from core.analysis.inverse_design.profile_quantities import section_at
from core.analysis.inverse_design.quantities import reading
from core.deformation.tffd import deform
from core.errors import UserError
from core.export.mesh import write_profile
from core.geometry.planar_curves import Plane, Slicer
from core.pipeline.build import Stages, build
from core.pipeline.solve import solve


@pytest.fixture(scope="module")
def stages() -> Stages:
    return build(replace(sample_design(), volume="exact").with_line("mid-bust", 0.93))


@pytest.mark.parametrize(
    "text",
    [
        "height_mm,out_mm\n350,140.5\n330,-12\n",
        "\ufeffHeight_mm;note;Out_mm\n350,0;a;140,5\n\n330;b;\N{MINUS SIGN}12\n",
        "out\theight\n140.5\t350\n-12\t330\n",
    ],
)
def test_tables_are_read_as_people_write_them(tmp_path: Path, text: str) -> None:
    path = tmp_path / "wish.csv"
    path.write_text(text, encoding="utf-8")
    assert read_profile(str(path)).tolist() == [[330.0, -12.0], [350.0, 140.5]]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "no columns height_mm and out_mm"),
        ("height_mm,depth\n1,2\n", "no columns height_mm and out_mm"),
        ("height_mm,out_mm\n", "contains no heights"),
        ("height_mm,out_mm\n350\n", "'' in .* is not a length"),
        ("height_mm,out_mm\n350,nan\n", "'nan' in .* is not a length"),
        ("height_mm,out_mm\n350,1e9\n", "is not a length"),
        ("height_mm,out_mm\n350,1\n350,2\n", "contains a duplicate height"),
        ("body,curve,x_mm,y_mm,z_mm\nafter,1,0,0,0\n", "contains no curve"),
    ],
)
def test_what_is_no_profile_is_refused(tmp_path: Path, text: str, sentence: str) -> None:
    path = tmp_path / "wish.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UserError, match=sentence):
        read_profile(str(path))


def test_an_exported_section_is_the_profile_of_the_body_after(stages: Stages, tmp_path: Path) -> None:
    points = solve(stages).control_points
    mesh, moved = stages.body.mesh, deform(stages.binding, points)
    slicer = Slicer(mesh, Plane("x", section_at(stages, "left")))
    path = tmp_path / "section.csv"
    bodies = {"before": slicer.curves(mesh.vertices), "after": slicer.curves(moved)}
    write_profile(path, slicer.plane, bodies)
    goals = profile_goals(stages, "left", read_profile(str(path)))
    assert len(goals) > 15
    off = [reading(stages, goal.name)(points).value - goal.value for goal in goals]
    assert np.abs(off).max() < 0.01


def test_heights_where_nothing_moves_are_left_out(stages: Stages) -> None:
    free = stages.control.mesh.vertices[~stages.control.fixed, 2]
    heights = np.arange(0.0, 600.0, 1.0)
    goals = profile_goals(stages, "right", np.stack([heights, np.full(600, 100.0)], axis=1))
    asked = [float(goal.name.rpartition(" ")[2]) for goal in goals]
    assert 30 < len(goals) <= 60
    assert free.min() <= min(asked) < max(asked) <= free.max()
    with pytest.raises(UserError, match="All heights of the profile are outside the reshaped region"):
        profile_goals(stages, "right", np.array([[5000.0, 100.0]]))
