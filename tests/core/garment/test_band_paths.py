"""Bands are laid on the body at rest once, and follow it as if they were laid anew."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.presenters.samples import sample_design
from core.deformation.tffd import deform
from core.garment.band_path import band_path, band_paths
from core.garment.curve_smoothing import USUAL_WIDTH, LocalPlanes
from core.garment.tension import line_tensions
from core.pipeline.build import build
from core.pipeline.solve import solve


def test_a_course_that_was_laid_before_is_that_of_the_shape_that_is_asked_for() -> None:
    design = replace(sample_design(), volume="exact").with_line("mid-bust", 0.9).with_line("full-bust", 0.97)
    stages = build(design)
    other = build(design.with_line("mid-bust", 1.0), stages)
    for each in (other, stages):
        points = solve(each).control_points
        tensions = line_tensions(each, points)
        lines = {line.name: line for line in each.model.lines}
        surface, moved = LocalPlanes(each.body.mesh), deform(each.binding, points)
        for name, course, width in band_paths(each, points, tensions):
            route = each.routes[name]
            assert np.array_equal(route.path, lines[name].places(each.control.mesh.vertices))
            anew = band_path(route.path, tensions[name], surface, moved, USUAL_WIDTH, route.back)
            assert width == USUAL_WIDTH
            assert np.allclose(course.points, anew.points, atol=1e-9)
            assert np.allclose(course.normals, anew.normals, atol=1e-9)
            assert np.array_equal(course.tension, anew.tension)
        assert len(tensions) == 2
