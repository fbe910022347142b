"""A part of the skin on a plotter: what moves is drawn apart from what stands still."""

from __future__ import annotations

import pyvista as pv

from app.rendering.actors import smooth_actor
from app.rendering.picking import RayPicker
from app.rendering.render_mesh_parts import MeshPart, Singles
from app.rendering.vertex_colors import Colours
from core.geometry.mesh import Indices, Points

_DIM_INSIDE = """//VTK::Color::Impl
  if (!gl_FrontFacing) { ambientColor *= 1.5; diffuseColor *= 0.3; }
"""
"""What is seen from inside, through an open neck or arm, lies in its own shadow."""

DIFFUSE = 0.86
"""How much of the lamps' light the skin throws back."""


class BodyPartActor:
    """A piece of a skin: ``rows`` of the skin, shape (r,)."""

    def __init__(self, plotter: pv.BasePlotter, piece: MeshPart, name: str, inside_seen: bool) -> None:
        self._plotter = plotter
        self._held, self.rows = piece.held, piece.rows
        self._data, self.actor = smooth_actor(
            plotter,
            name,
            piece.places,
            piece.normals,
            piece.faces,
            diffuse=DIFFUSE,
            specular=0.10,
            specular_power=14,
        )
        # Of a closed body no inside is seen; not to fill it halves the time of a frame on software GL.
        self.actor.prop.culling = "none" if inside_seen else "back"
        # Coloured points overrule VTK's own property for back faces, hence these lines of shader.
        self.actor.GetShaderProperty().AddFragmentShaderReplacement(
            "//VTK::Color::Impl", True, _DIM_INSIDE, False
        )
        self.sight = RayPicker(self._data)

    def has(self, rows: Indices | slice) -> bool:
        """Tell whether one of some vertices of the skin, shape (k,), belongs to it."""
        return bool(self._held[rows].any())

    def move(self, points: Points, normals: Singles) -> None:
        """Draw its vertices at other positions, (r, 3) [mm], with unit normals (r, 3)."""
        self._data.points[:] = points
        self._data.point_data["Normals"][:] = normals
        self._data.GetPoints().Modified()
        self._data.GetPointData().GetNormals().Modified()
        self.sight.clear()

    def paint(self, colours: Colours) -> None:
        """Take its colours out of those of the whole skin, shape (n, 3)."""
        self._data.point_data["Colour"][:] = colours[self.rows]
        self._data.GetPointData().GetArray("Colour").Modified()

    def light(self, ambient: float, diffuse: float) -> None:
        """Say how much light it throws back: what comes from all sides, and what from the lamps."""
        self.actor.prop.ambient, self.actor.prop.diffuse = ambient, diffuse

    def remove(self) -> None:
        """Take it off the plotter."""
        self._plotter.remove_actor(self.actor, reset_camera=False, render=False)
