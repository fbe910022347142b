"""Everything that is drawn in 3D, on any pyvista plotter: a widget, a picture or a test."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import pyvista as pv

from app.rendering.appearance import CLAY, Appearance, appearance_of
from app.rendering.band import Band
from app.rendering.band_actors import Bands
from app.rendering.body_actor import BodyActor, GhostActor
from app.rendering.camera import NOBODY, View, aim, depth_range, framing_bust
from app.rendering.control_mesh_actor import ControlActor
from app.rendering.cup_actors import Cups
from app.rendering.curve_actors import MeasureTrace, Trace
from app.rendering.lights_and_floor import LightsAndFloor
from app.rendering.render_mesh import NONE
from app.rendering.ribbon_mesh import RibbonSurface
from app.rendering.section_actor import SectionSheet
from app.rendering.vertex_colors import Colours
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points
from core.pipeline.build import Stages

PARTS = ("body", "bands", "control", "floor", "ghost", "colours")
"""What ``Scene.set_visible`` knows; the ghost is the body at rest as a fringe, the colours are the scan's."""


class Scene:
    """The body, its lines and its control mesh, seen through one camera.

    All methods belong to the thread of the window. Nothing draws by itself: the holder draws when it likes.
    ``pixel_ratio`` is the number of device pixels of a logical one, for thin lines.
    """

    def __init__(self, plotter: pv.BasePlotter, dark: bool = False, pixel_ratio: float = 1.0) -> None:
        self.plotter = plotter
        self.body: BodyActor | None = None
        self._pixel_ratio = pixel_ratio
        self._stage = LightsAndFloor(plotter)
        self.bands = Bands(plotter)
        self.cups = Cups(plotter, pixel_ratio)
        self._trace, self.measure = Trace(plotter), MeasureTrace(plotter)
        self.section = SectionSheet(plotter, pixel_ratio)
        self._surface: RibbonSurface | None = None
        self._ghost: GhostActor | None = None
        self._control: ControlActor | None = None
        self._control_points: tuple[Points, Points] | None = None
        self._visible = dict.fromkeys(PARTS, True) | {"control": False, "ghost": False, "colours": False}
        self._before = False
        self._material = CLAY
        self._view = View()
        self.set_dark(dark)
        self.set_camera(self._view)

    # -- what is shown

    def show_body(self, mesh: Mesh, moving: Indices = NONE, scanned: Colours | None = None) -> None:
        """Show a body at rest alone; vertices ``moving`` (k,) may move, ``scanned`` (n, 4) its colours."""
        self.bands.clear()
        self.cups.clear()
        self._trace.show()
        self._drop_control()
        self.body = BodyActor(self.plotter, mesh, self._look, moving, scanned)
        self._surface = RibbonSurface(mesh)
        low, high = self._box().T
        self._stage.place_floor(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), low[2])
        self._before, self._ghost = False, None
        self.plotter.remove_actor("ghost", reset_camera=False, render=False)
        self._apply_visible()
        self.set_camera(self._view)

    def set_occlusion(self, occlusion: Floats) -> None:
        """Darken the folds of the body by ``bake_occlusion``'s result, shape (n,) [1]."""
        self._shown_body().set_occlusion(occlusion)

    def show_control_mesh(self, control: Mesh, fixed: Flags) -> None:
        """Show the control mesh on the body; ``fixed`` control points, shape (n,), are small and dark."""
        self._drop_control()
        self._control = ControlActor(self.plotter, control, fixed, self._laying_ground(), self._pixel_ratio)
        self._control.set_appearance(self._look)
        self._control_points = (control.vertices, control.vertices)
        self._apply_visible()

    def show_bands(self, bands: Iterable[Band]) -> None:
        """Show these lines on the body in place of the former ones."""
        self.bands.show(bands, self._laying_ground())
        self._follow()

    def show_cups(self, stages: Stages, points: Points, normals: Points) -> None:
        """Show the cups of a design, if any, on its worn body: (r, 3) places and normals of what moves."""
        self.cups.show(stages, points, normals)

    def show_trace(self, points: Points) -> None:
        """Draw a curve of the body at rest, shape (k, 3) [mm], where it is on the shown one; or no curve."""
        self._trace.show(self.carried_points(points) if len(points) else points)

    def mark_bands(self, selected: str = "", hovered: str = "") -> None:
        """Draw a white casing round the selected line and a faint one round the one under the pointer.

        An empty or unknown name marks none.
        """
        self.bands.mark(selected, hovered)

    # -- what moves

    def move_body(self, indices: Indices, points: Points, normals: Points | None = None) -> None:
        """Move body vertices in place, and the lines with them.

        ``indices`` (k,) of the body's vertices, ``points`` (k, 3) [mm], ``normals`` (k, 3), else worked out.
        """
        self._shown_body().move(indices, points, normals)
        if not self._before:
            self._follow()

    def move_control_mesh(self, points: Points) -> None:
        """Move the control points, shape (n, 3) [mm]."""
        if self._control is not None and self._control_points is not None:
            self._control_points = (self._control_points[0], points)
            if not self._before:
                self._control.move(points)

    def before(self, shown: bool) -> None:
        """Show everything at rest, or as it was moved."""
        self._before = shown
        self._shown_body().before(shown)
        self._apply_visible()
        self._follow()
        if self._control is not None and self._control_points is not None:
            self._control.move(self._control_points[0 if shown else 1])

    def set_visible(self, what: str, visible: bool) -> None:
        """Show or hide one of ``PARTS``; raises KeyError for another word."""
        if what not in self._visible:
            raise KeyError(what)
        self._visible[what] = visible
        self._apply_visible()

    def static_actors(self) -> list[pv.Actor]:
        """Return what stays where it is while the body moves."""
        ghost = () if self._ghost is None else (self._ghost.actor,)
        return [self._stage.floor, *ghost, *(() if self.body is None else self.body.still)]

    def is_visible(self, what: str) -> bool:
        """Return whether one of ``PARTS`` is shown."""
        return self._visible[what]

    # -- how it is seen

    @property
    def dark(self) -> bool:
        """Return whether the dark theme is on."""
        return self._dark

    def set_dark(self, dark: bool) -> None:
        """Repaint everything for the light or the dark theme."""
        self._dark = dark
        look = self._look
        self._stage.set_appearance(look)
        for each in (self._trace, self.measure, self.section, self.cups):
            each.set_dark(dark)
        if self.body is not None:
            self.body.set_appearance(look)
        if self._control is not None:
            self._control.set_appearance(look)
        if self._ghost is not None:
            self._ghost.actor.prop.color = look.ghost

    @property
    def material(self) -> str:
        """Return the material of the body."""
        return self._material

    def set_material(self, material: str) -> None:
        """Paint the body as one of ``appearance.MATERIALS``; raises KeyError for another word."""
        self._material = material
        self.set_dark(self._dark)

    @property
    def _look(self) -> Appearance:
        return appearance_of(self._dark, self._material)

    @property
    def view(self) -> View:
        """Return the view of the scene."""
        return self._view

    def set_camera(self, view: View) -> None:
        """Set the camera to ``view``."""
        self._view = view
        aim(self.plotter.camera, view)
        self.plotter.camera.SetClippingRange(depth_range(view, self._box()))
        if self._ghost is not None:
            self._ghost.look_from(view)

    def set_view(self, name: str) -> None:
        """Set the view called ``name`` in ``app.rendering.camera.VIEWS``."""
        self.set_camera(self._view.named(name))

    def set_parallel(self, parallel: bool) -> None:
        """Switch between parallel and perspective projection."""
        self.set_camera(replace(self._view, parallel=parallel))

    def frame_all(self) -> None:
        """Step back until the whole body is in the picture."""
        self.set_camera(self.framing_all(self._aspect()))

    def frame_bust(self) -> None:
        """Step closer, so that shoulders to waist fill the picture."""
        self.set_camera(self.framing_bust(self._aspect()))

    def framing_all(self, aspect: float) -> View:
        """Return the view from the same side that shows the whole body; ``aspect`` is width by height."""
        return self._view.framing(self._box(), aspect)

    def framing_bust(self, aspect: float) -> View:
        """Return the view from the same side that shows bust and trunk, from the shoulders to the waist."""
        laid = self._control_points
        level = None if laid is None else float(laid[0][:, 2].mean())
        return framing_bust(self._view, self._box(), level, aspect)

    # -- what is under the pointer

    def hit_body(self, start: Floats, end: Floats) -> Floats | None:
        """Return where the segment between two points, each (3,) [mm], first meets the body, or None."""
        return None if self.body is None else self.body.hit(start, end)

    def hidden(self, point: Floats, clearance: float = 4.0) -> bool:
        """Return whether the body hides ``point``, shape (3,) [mm]."""
        sight = np.asarray(point) - self._view.eye
        nearer = point - clearance * sight / np.linalg.norm(sight)
        return self.hit_body(self._view.eye, nearer) is not None

    def carried_points(self, points: Points) -> Points:
        """Return where places on the body at rest, shape (k, 3) [mm], are on the shown one."""
        return np.asarray(points + self._laying_ground().displacement_weights(points) @ self._displacement())

    def at_rest(self, points: Points) -> Points:
        """Return where places on the shown body, shape (k, 3) [mm], are on the body at rest."""
        rest = points
        for _ in range(4):  # each round leaves a small part of the last one's error
            rest = rest + points - self.carried_points(rest)
        return rest

    def band_at(self, x: float, y: float, width: float, height: float) -> str:
        """Return the line seen at the pixel (x, y), counted from the top left, or an empty string."""
        start, sight = self._view.ray(x, y, width, height)
        met = self.bands.hit(start, start + 2.0 * self._view.distance * sight)
        if met is None or self.hit_body(start, met[1] - sight) is not None:
            return ""
        return met[0]

    def band_anchor(self, name: str) -> Floats:
        """Return a place on the line that faces the eye, for its label, shape (3,) [mm]."""
        points, normals = self.bands.spine(name)
        facing = np.einsum("ij,ij->i", normals, self._view.eye - points) > 0.0
        seen = points[facing] if facing.any() else points
        along = np.argsort(seen @ self._view.axes[0])
        return np.asarray(seen[along[int(0.66 * (len(seen) - 1))]])

    # -- inside

    def _shown_body(self) -> BodyActor:
        if self.body is None:
            raise RuntimeError("show_body comes first")
        return self.body

    def _laying_ground(self) -> RibbonSurface:
        if self._surface is None:
            raise RuntimeError("show_body comes first")
        return self._surface

    def _follow(self) -> None:
        self.bands.move(self._displacement())

    def _displacement(self) -> Points:
        return self._shown_body().displacement

    def _drop_control(self) -> None:
        if self._control is not None:
            self._control.remove()
        self._control, self._control_points = None, None

    def _apply_visible(self) -> None:
        if self.body is not None:
            self.body.set_visible(self._visible["body"])
            self.body.set_scanned(self._visible["colours"])
            self._stage.show_floor(self._visible["floor"])
            if self._visible["ghost"] and self._ghost is None:
                self._ghost = GhostActor(self.plotter, self.body.rest)
                self._ghost.actor.prop.color = self._look.ghost
                self._ghost.look_from(self._view)
        if self._ghost is not None:
            self._ghost.actor.SetVisibility(self._visible["ghost"] and not self._before)
        if self._control is not None:
            self._control.set_visible(self._visible["control"])
        self.bands.set_visible(self._visible["bands"])
        self.cups.set_visible(self._visible["bands"] and not self._before)

    def _box(self) -> Floats:
        return NOBODY if self.body is None else self.body.box

    def _aspect(self) -> float:
        width, height = self.plotter.window_size
        return float(width) / max(float(height), 1.0)
