"""While things move without a graphics card, light is worked out at the vertices: nobody should see it."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from app.rendering.scene import Scene
from app.rendering.vertex_lighting import VertexLighting
from core.geometry.mesh import Mesh


def test_quick_light_looks_like_that_of_every_pixel_and_goes_without_a_trace() -> None:
    plotter = pv.Plotter(off_screen=True, window_size=[320, 240], lighting="none")
    plotter.ren_win.SetMultiSamples(0)
    scene = Scene(plotter, dark=True)
    ball = pv.Icosphere(radius=150.0, nsub=5)
    scene.show_body(Mesh(ball.points, ball.regular_faces))
    plotter.add_mesh(pv.Cube(x_length=100.0, y_length=500.0, z_length=80.0), name="flat", render=False)
    scene.set_view("three-quarter")
    scene.frame_all()
    light = VertexLighting(plotter)
    pictures = []
    for quickly in (False, True, True, False):
        light.use(quickly)
        plotter.ren_win.Render()
        pictures.append(np.asarray(plotter.screenshot(return_img=True), dtype=float))
    at_pixels, quick, quick_again, back = pictures
    assert scene.body is not None
    assert np.abs(quick - at_pixels).max() > 0.0, "it is another sum"
    assert np.abs(quick - at_pixels).mean() < 0.1
    assert np.percentile(np.abs(quick - at_pixels), 99.9) <= 8.0
    assert np.array_equal(quick, quick_again)
    assert np.array_equal(back, at_pixels)
    plotter.close()


def test_what_comes_later_is_lit_quickly_too() -> None:
    plotter = pv.Plotter(off_screen=True, window_size=[64, 64], lighting="none")
    scene, light = Scene(plotter), VertexLighting(plotter)
    light.use(True)
    ball = pv.Icosphere(radius=150.0, nsub=2)
    scene.show_body(Mesh(ball.points, ball.regular_faces))
    assert scene.body is not None
    quick = scene.body.still[0].GetShaderProperty()
    assert quick.GetNumberOfShaderReplacements() == 1, "the inside lies in its own shadow"
    light.use(True)
    assert quick.GetNumberOfShaderReplacements() == 5
    plotter.close()
