"""The body in the 3D view: plates told from skin, clay that is darker in folds, movement in place."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import pyvista as pv
from scipy import sparse

from app.rendering.actors import RayPicker, smooth_actor
from app.rendering.appearance import Appearance
from app.rendering.camera import View
from app.rendering.render_mesh import CELL, NONE, MeshPart, Singles, mesh_parts, render_mesh
from app.rendering.vertex_colors import Colours, clay_colours, map_colours, scan_colours
from core.geometry.mesh import Flags, Floats, Indices, Mesh, Points, area_vectors, incidence, unit

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
        """Return whether one of some vertices of the skin, shape (k,), belongs to it."""
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
        """Set the reflection of ambient light and of lamps."""
        self.actor.prop.ambient, self.actor.prop.diffuse = ambient, diffuse

    def remove(self) -> None:
        """Take it off the plotter."""
        self._plotter.remove_actor(self.actor, reset_camera=False, render=False)


_EVENLY = 0.18
"""How much of what the skin throws back comes from all sides in a map."""


class BodyActor:
    """The body on one plotter: shown once, then moved in place.

    ``points`` are the moved positions of the body's n vertices, (n, 3) [mm], shown or not. What moves is
    drawn apart from what stands still, so that little is handed to the graphics when it does: ``moving`` are
    the vertices of which that is known already, shape (k,). Of much that stands still a rough copy is drawn
    where nobody sees the difference, see ``set_detail``, and met by sights. ``scanned`` are the colours of
    the scan, shape (n, 4), if it has any; they are shown when ``set_scanned`` asks for it.
    """

    def __init__(
        self,
        plotter: pv.BasePlotter,
        mesh: Mesh,
        look: Appearance,
        moving: Indices = NONE,
        scanned: Colours | None = None,
    ) -> None:
        self.rest = mesh
        self.points = np.array(mesh.vertices)
        self._shift, self._nowhere = np.zeros(mesh.vertices.shape), np.zeros(mesh.vertices.shape)
        self._plotter = plotter
        self._skin = render_mesh(mesh)
        self._look = look
        self._occlusion = np.ones(len(mesh.vertices))
        self._map: Floats | None = None
        self._scanned, self._is_scanned = scanned, False
        self._before = False
        self._visible = True
        rest = self._skin.mesh
        self._normals: Singles = self._skin.normals.copy()
        self._colours: Colours = np.zeros(rest.vertices.shape, dtype=np.uint8)
        self._moves: Flags = np.zeros(len(mesh.vertices), dtype=bool)
        self._moves[moving] = True
        self._carried = NONE
        self._roughly = False
        self._still: BodyPartActor | None = None
        self._moving: BodyPartActor | None = None
        self._rough: BodyPartActor | None = None
        self._mix(slice(None))
        self._part(moving)

    def set_appearance(self, look: Appearance) -> None:
        """Repaint for one theme."""
        self._look = look
        self._light()
        self._paint(slice(None))

    def set_occlusion(self, occlusion: Floats) -> None:
        """Darken folds: openness to the sky of each body vertex, shape (n,) [1]."""
        self._occlusion = np.asarray(occlusion)
        self.set_appearance(self._look)

    def set_scanned(self, shown: bool) -> None:
        """Show the colours of the scan, where it has any, or the material."""
        if self._scanned is not None and shown != self._is_scanned:
            self._is_scanned = shown
            self.set_appearance(self._look)

    def set_visible(self, visible: bool) -> None:
        """Show or hide it."""
        self._visible = visible
        roughly = self._roughly and self._rough is not None
        for part in self._parts:
            hidden = part is (self._still if roughly else self._rough)
            part.actor.SetVisibility(visible and not hidden)

    def set_detail(self, finest: float) -> None:
        """Draw nothing that is finer than so much [mm], if there is a way to draw less."""
        self._roughly = finest >= CELL
        self.set_visible(self._visible)

    @property
    def box(self) -> Floats:
        """Return least and largest coordinates of the original, shape (3, 2) [mm]."""
        return self._skin.box

    @property
    def still(self) -> tuple[pv.Actor, ...]:
        """Return the parts that are static while the body moves."""
        return tuple(part.actor for part in (self._still, self._rough) if part is not None)

    @property
    def colours(self) -> Colours:
        """Return the colour of each vertex as drawn, shape (n, 3)."""
        return self._colours[: len(self.rest.vertices)]

    def show_map(self, colours: Floats | None) -> None:
        """Show a map over the clay: the colour of each body vertex, shape (n, 3) 0..255; None removes it."""
        self._map = None if colours is None else np.array(colours)
        self._light()
        self._paint(slice(None))

    def recolour(self, indices: Indices, colours: Floats) -> None:
        """Change the map at some body vertices, shapes (k,) and (k, 3) 0..255."""
        if self._map is not None:
            self._map[indices] = colours
            self._paint(indices)  # their doubles lie on plates, which no map colours

    def move(self, indices: Indices, points: Points, normals: Points | None = None) -> None:
        """Move body vertices: indices (k,), positions (k, 3) [mm], unit normals (k, 3), else worked out."""
        if indices is not self._carried:
            self._put_back(np.setdiff1d(self._carried, indices))
            self._carried = indices
        self.points[indices] = points
        self._shift[indices] = points - self.rest.vertices[indices]
        if not self._moves[indices].all():
            self._moves[indices] = True
            self._part(np.flatnonzero(self._moves))
        if normals is None:
            self._normals = self._work_out_normals()
            if not self._moves.all():  # so do the normals round it
                self._moves[:] = True
                self._part(np.flatnonzero(self._moves))
        else:
            self._normals[indices] = normals
        if not self._before:
            self._write()

    def before(self, shown: bool) -> None:
        """Show the rest positions, or the moved ones again."""
        if shown != self._before:
            self._before = shown
            self._write()

    @property
    def displacement(self) -> Points:
        """Return how far each vertex is on the screen from where it rests, shape (n, 3) [mm]."""
        return self._nowhere if self._before else self._shift

    @property
    def shown_points(self) -> Points:
        """Return the positions on the screen, shape (n, 3) [mm]."""
        return self.rest.vertices if self._before else self.points

    def hit(self, start: Floats, end: Floats) -> Floats | None:
        """Return where the segment between two points, each (3,) [mm], first meets the body, or None."""
        parts = (self._rough or self._still, self._moving)
        met = [place for part in parts if part and (place := part.sight.hit(start, end)) is not None]
        return min(met, key=lambda place: float(np.linalg.norm(place - start)), default=None)

    @property
    def _parts(self) -> tuple[BodyPartActor, ...]:
        return tuple(part for part in (self._still, self._moving, self._rough) if part is not None)

    def _put_back(self, indices: Indices) -> None:
        """Let vertices stand where they rest, shape (k,): another control mesh carries them no more."""
        self.points[indices] = self.rest.vertices[indices]
        self._shift[indices] = 0.0
        self._normals[indices] = self._skin.normals[indices]

    def _part(self, moving: Indices) -> None:
        """Part the skin anew into faces that stand still and faces that move, all of them at rest."""
        for part in self._parts:
            part.remove()
        pieces = mesh_parts(self._skin, moving)
        self._still = self._drawn(pieces.static, "body")
        self._moving = self._drawn(pieces.moving, "body that moves")
        self._rough = self._drawn(pieces.rough, "rough body")
        for part in self._parts:
            part.paint(self._colours)
        self.set_visible(self._visible)
        self._light()

    def _drawn(self, piece: MeshPart | None, name: str) -> BodyPartActor | None:
        inside_seen = bool(self.rest.boundary_loops)
        return None if piece is None else BodyPartActor(self._plotter, piece, name, inside_seen)

    def _light(self) -> None:
        """Light a map and a scan more evenly than clay, so that colours can be told in the shade too."""
        evenly = _EVENLY if self._map is not None or self._is_scanned else 0.0
        for part in self._parts:
            part.light(self._look.ambient + evenly, DIFFUSE - evenly)

    def _paint(self, rows: Indices | slice) -> None:
        """Colour some of the drawn vertices anew."""
        self._mix(rows)
        for part in self._parts:
            if part.has(rows):
                part.paint(self._colours)

    def _mix(self, rows: Indices | slice) -> None:
        source, plate = self._skin.source[rows], self._skin.plate[rows]
        sky = self._occlusion[source]
        if self._map is None:
            clay = clay_colours(sky, plate, self._look)
            if self._scanned is not None and self._is_scanned:
                clay = scan_colours(clay, self._scanned[source], sky)
            self._colours[rows] = clay
        else:
            self._colours[rows] = map_colours(self._map[source], sky, plate, self._look)

    def _work_out_normals(self) -> Singles:
        vertices = self.points[self._skin.source]
        return unit(self._sum_at_vertices @ area_vectors(vertices, self._skin.mesh.faces)).astype(np.float32)

    @cached_property
    def _sum_at_vertices(self) -> sparse.csr_array:
        return incidence(self._skin.mesh.faces, len(self._skin.source))

    def _write(self) -> None:
        """Draw what moves where it is now."""
        if self._moving is None:
            return
        rows, shown = self._moving.rows, self.shown_points
        source = self._skin.source[rows]
        normals = self._skin.normals if self._before else self._normals
        self._moving.move(shown[source], normals[rows])


class GhostActor:
    """The body at rest, seen only where it reaches out beyond the moved one.

    It is drawn opaque and enlarged about the eye, so that its picture is the same but lies behind the body.
    """

    _LARGER = 1.12

    def __init__(self, plotter: pv.BasePlotter, mesh: Mesh) -> None:
        data = pv.PolyData.from_regular_faces(mesh.vertices.astype(np.float32), mesh.faces)
        self.actor = plotter.add_mesh(
            data, name="ghost", lighting=False, copy_mesh=False, reset_camera=False, render=False
        )

    def look_from(self, view: View) -> None:
        """Keep behind the body for this eye."""
        matrix = np.eye(4)
        if view.parallel:
            matrix[:3, 3] = -(self._LARGER - 1.0) * view.distance * view.axes[2]
        else:
            matrix[:3, :3] *= self._LARGER
            matrix[:3, 3] = (1.0 - self._LARGER) * view.eye
        self.actor.user_matrix = matrix
