"""Render bodies and control meshes off-screen for the figures: on white, in parallel projection."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np
import numpy.typing as npt
import pyvista as pv

from app.rendering.appearance import APPEARANCES
from app.rendering.band import Band
from app.rendering.camera import View
from app.rendering.display import off_screen
from app.rendering.lights_and_floor import LightsAndFloor
from app.rendering.palette import LINE_COLORS
from app.rendering.scene import Scene
from core.geometry.mesh import Flags, Floats, Mesh, Points

Image = npt.NDArray[np.uint8]
Bounds = npt.ArrayLike

LINE_COLOUR = LINE_COLORS[1]
SIZE = (900, 900)
"""Pixels of a picture, width and height."""


def view_of(mesh: Mesh, azimuth: float = 0.0, elevation: float = 0.0, margin: float = 1.06) -> View:
    """Return the parallel view that frames ``mesh`` from ``azimuth`` and ``elevation`` [degrees]."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    view = View(azimuth=azimuth, elevation=elevation, parallel=True)
    return view.framing(np.stack([low, high], axis=1), SIZE[0] / SIZE[1], margin)


def body_picture(
    rest: Mesh,
    occlusion: Floats,
    view: View,
    *,
    moved: Points | None = None,
    paths: Mapping[str, Points] | None = None,
    control: tuple[Mesh, Flags] | None = None,
) -> Image:
    """Return a picture of a body, moved to ``moved`` (n, 3) [mm], with lines and the control mesh on it.

    ``occlusion`` (n,) darkens folds, see ``bake_occlusion``; ``paths`` are lines at rest, (k, 3) [mm].
    """

    def draw(plotter: pv.Plotter) -> None:
        scene = Scene(plotter)
        scene.show_body(rest)
        scene.set_occlusion(occlusion)
        scene.set_visible("floor", False)
        if control is not None:
            scene.show_control_mesh(*control)
            scene.set_visible("control", True)
        scene.show_bands(Band(name, path, LINE_COLOUR, 7.0) for name, path in (paths or {}).items())
        if moved is not None:
            scene.move_body(np.arange(len(moved)), moved)
        scene.set_camera(view)

    return _shot(draw)


def control_picture(mesh: Mesh, view: View, *, fixed: Flags, paths: Iterable[Points] = ()) -> Image:
    """Return a picture of a control mesh: flat triangles, its points (fixed ones dark), lines (k, 3) [mm]."""

    def draw(plotter: pv.Plotter) -> None:
        stage = LightsAndFloor(plotter)
        stage.set_appearance(APPEARANCES[False])
        data = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
        plotter.add_mesh(
            data, color="#D9D4CC", show_edges=True, edge_color="#57534E", line_width=1.6, ambient=0.12
        )
        for path in paths:
            plotter.add_mesh(_tube(path, 2.6), color=LINE_COLOUR, ambient=0.5)
        for kind, colour, radius in ((True, "#3F4650", 2.0), (False, "#FFFFFF", 3.4)):
            if (fixed == kind).any():
                dots = pv.PolyData(mesh.vertices[fixed == kind])
                balls = dots.glyph(geom=pv.Sphere(radius=radius), scale=False, orient=False)
                plotter.add_mesh(balls, color=colour)
        _look(plotter, view)

    return _shot(draw)


def line_picture(mesh: Mesh, view: View, paths: Iterable[Points]) -> Image:
    """Return a picture of lines alone, each (k, 3) [mm], within the faint shape of a control mesh."""

    def draw(plotter: pv.Plotter) -> None:
        LightsAndFloor(plotter).set_appearance(APPEARANCES[False])
        data = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
        plotter.add_mesh(data, color="#C9C5BF", style="wireframe", line_width=1.2, lighting=False)
        for path in paths:
            plotter.add_mesh(_tube(path, 2.6), color=LINE_COLOUR, ambient=0.5)
        _look(plotter, view)

    return _shot(draw)


def _tube(path: Points, radius: float) -> pv.PolyData:
    return pv.lines_from_points(path).tube(radius=radius)


def _look(plotter: pv.Plotter, view: View) -> None:
    camera = plotter.camera
    camera.position, camera.focal_point, camera.up = tuple(view.eye), view.focus, (0.0, 0.0, 1.0)
    camera.parallel_projection = True
    camera.parallel_scale = view.half_height
    camera.clipping_range = (20.0, 2.0 * view.distance)


def _shot(draw: Callable[[pv.Plotter], None]) -> Image:
    off_screen()
    plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), lighting="none")
    try:
        draw(plotter)
        plotter.set_background("white")
        plotter.enable_anti_aliasing("ssaa")
        return np.asarray(plotter.screenshot(return_img=True))
    finally:
        plotter.close()
