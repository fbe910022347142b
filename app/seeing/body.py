"""The body in the 3D view: plates told from skin, clay that is darker in folds, movement in place."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt
import pyvista as pv
from scipy import sparse

from app.seeing.camera import View
from app.seeing.paint import clay_colours, map_colours
from app.seeing.sight import Sight
from app.seeing.skin import skin_of
from app.seeing.stage import Look
from core.mesh import Floats, Indices, Mesh, Points, area_vectors, incidence, unit
from core.progress import Progress, quiet

Singles = npt.NDArray[np.float32]

_DIM_INSIDE = """//VTK::Color::Impl
  if (!gl_FrontFacing) { ambientColor *= 1.5; diffuseColor *= 0.3; }
"""
"""What is seen from inside, through an open neck or arm, lies in its own shadow."""

DIFFUSE, _EVENLY = 0.86, 0.18
"""How much of the lamps' light the skin throws back, and how much of that comes from all sides in a map."""


def bake_occlusion(mesh: Mesh, directions: int = 32, cell: float = 7.0, progress: Progress = quiet) -> Floats:
    """Return how open the sky above each vertex is, shape (n,) [1]: 1 free, small in folds.

    Each direction keeps the surface nearest to the sky on a grid of ``cell`` [mm]; a vertex loses its sky
    between 5 and 17 mm under it. Runs in any thread; raises Cancelled.
    """
    sky = _sphere(directions)
    samples = _samples(mesh, cell).astype(np.float32)
    normals = mesh.vertex_normals
    count = len(mesh.vertices)
    seen, possible = np.zeros(count), np.full(count, 1e-6)
    for number, towards in enumerate(sky):
        progress("soft shadows", number / directions)
        facing = normals @ towards
        depth = samples @ towards.astype(np.float32)
        under = _shaded(samples, depth, towards, cell)[:count] - depth[:count]
        weight = np.maximum(facing, 0.0)
        possible += weight
        seen += weight * np.clip((17.0 - under) / 12.0, 0.0, 1.0)
    return _smoothed(seen / possible, mesh, passes=14)


def _sphere(count: int) -> Points:
    """Return ``count`` even directions."""
    turn = np.arange(count) * np.pi * (3.0 - np.sqrt(5.0))
    z = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    radius = np.sqrt(1.0 - z**2)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1)


def _samples(mesh: Mesh, cell: float) -> Points:
    """Return the vertices, then the face centres and, on faces too large for the grid, more points."""
    corners = mesh.vertices[mesh.faces]
    points = [mesh.vertices, corners.mean(axis=1)]
    large = corners[mesh.face_areas > cell**2]
    if len(large):
        steps = np.arange(1, 8) / 8.0
        u, v = (grid.ravel() for grid in np.meshgrid(steps, steps))
        u, v = u[u + v < 1.0], v[u + v < 1.0]
        mix = np.stack([1.0 - u - v, u, v], axis=1)
        points.append(np.einsum("sk,mkj->msj", mix, large).reshape(-1, 3))
    return np.concatenate(points)


def _shaded(samples: Singles, depth: Singles, towards: Floats, cell: float) -> Singles:
    """Return for each sample the depth of the surface nearest to the sky in its grid cell."""
    helper = np.eye(3)[np.argmin(np.abs(towards))]
    across = unit(np.cross(towards, helper)[None])[0]
    plane = np.stack([across, np.cross(towards, across)], axis=1).astype(np.float32)
    grid = ((samples @ plane) / np.float32(cell)).astype(np.int32)
    grid -= grid.min(axis=0)
    place = grid[:, 0] * (grid[:, 1].max() + 1) + grid[:, 1]
    nearest = np.full(int(place.max()) + 1, -np.inf, dtype=np.float32)
    np.maximum.at(nearest, place, depth)
    return np.asarray(nearest[place])


def _smoothed(values: Floats, mesh: Mesh, passes: int) -> Floats:
    a, b = mesh.edges.T
    count = len(mesh.vertices)
    links = sparse.csr_array((np.ones(2 * len(a)), (np.r_[a, b], np.r_[b, a])), shape=(count, count))
    degree = np.maximum(links.sum(axis=1), 1.0)
    for _ in range(passes):
        values = 0.5 * values + 0.5 * (links @ values) / degree
    return np.asarray(values)


class BodyActor:
    """The body on one plotter: shown once, then moved in place.

    ``points`` are the moved positions of the body's n vertices, (n, 3) [mm], shown or not.
    """

    def __init__(self, plotter: pv.BasePlotter, mesh: Mesh, look: Look) -> None:
        self.rest = mesh
        self.points = np.array(mesh.vertices)
        self._skin = skin_of(mesh)
        self._look = look
        self._occlusion = np.ones(len(mesh.vertices))
        self._map: Floats | None = None
        self._before = False
        rest = self._skin.mesh
        self._data = pv.PolyData.from_regular_faces(rest.vertices.astype(np.float32), rest.faces)
        self._rest_normals = rest.vertex_normals.astype(np.float32)
        self._normals: Singles = self._rest_normals.copy()
        self._data.point_data["Normals"] = self._rest_normals.copy()
        self._data.point_data["Colour"] = np.zeros(rest.vertices.shape, dtype=np.uint8)
        self.actor = plotter.add_mesh(
            self._data,
            scalars="Colour",
            rgb=True,
            copy_mesh=False,
            name="body",
            reset_camera=False,
            render=False,
            diffuse=DIFFUSE,
            specular=0.10,
            specular_power=14,
        )
        self.actor.prop.interpolation = "Gouraud"
        # Of a closed body no inside is seen; not to fill it halves the time of a frame on software GL.
        self.actor.prop.culling = "none" if mesh.boundary_loops else "back"
        # Coloured points overrule VTK's own property for back faces, hence these lines of shader.
        self.actor.GetShaderProperty().AddFragmentShaderReplacement(
            "//VTK::Color::Impl", True, _DIM_INSIDE, False
        )
        self._data.point_data.active_normals_name = "Normals"
        self.sight = Sight(self._data)
        self.set_look(look)

    def set_look(self, look: Look) -> None:
        """Repaint for one theme."""
        self._look = look
        self._light()
        self._paint(np.arange(len(self._skin.source)))

    def set_occlusion(self, occlusion: Floats) -> None:
        """Darken folds: openness to the sky of each body vertex, shape (n,) [1]."""
        self._occlusion = np.asarray(occlusion)
        self.set_look(self._look)

    def show_map(self, colours: Floats | None) -> None:
        """Lay a map over the clay: the colour of each body vertex, shape (n, 3) 0..255; None takes it off."""
        self._map = None if colours is None else np.array(colours)
        self._light()
        self._paint(np.arange(len(self._skin.source)))

    def recolour(self, indices: Indices, colours: Floats) -> None:
        """Change the map at some body vertices, shapes (k,) and (k, 3) 0..255."""
        if self._map is not None:
            self._map[indices] = colours
            self._paint(indices)  # their doubles lie on plates, which no map colours

    def move(self, indices: Indices, points: Points, normals: Points | None = None) -> None:
        """Move body vertices: indices (k,), positions (k, 3) [mm], unit normals (k, 3), else worked out."""
        self.points[indices] = points
        if normals is None:
            self._normals = self._work_out_normals()
        else:
            self._normals[indices] = normals
        if not self._before:
            self._write(indices if normals is not None else None)

    def before(self, shown: bool) -> None:
        """Show the rest positions, or the moved ones again."""
        if shown != self._before:
            self._before = shown
            self._write()

    @property
    def shown_points(self) -> Points:
        """The positions on the screen, shape (n, 3) [mm]."""
        return self.rest.vertices if self._before else self.points

    def _light(self) -> None:
        """Light a map more evenly than clay, so that its colours can be told in the shade too."""
        evenly = 0.0 if self._map is None else _EVENLY
        self.actor.prop.ambient, self.actor.prop.diffuse = self._look.ambient + evenly, DIFFUSE - evenly

    def _paint(self, rows: Indices) -> None:
        """Colour some of the drawn vertices anew."""
        source, plate = self._skin.source[rows], self._skin.plate[rows]
        sky = self._occlusion[source]
        if self._map is None:
            colours = clay_colours(sky, plate, self._look)
        else:
            colours = map_colours(self._map[source], sky, plate, self._look)
        self._data.point_data["Colour"][rows] = colours
        self._data.GetPointData().GetArray("Colour").Modified()

    def _work_out_normals(self) -> Singles:
        vertices = self.points[self._skin.source]
        return unit(self._sum_at_vertices @ area_vectors(vertices, self._skin.mesh.faces)).astype(np.float32)

    @cached_property
    def _sum_at_vertices(self) -> sparse.csr_array:
        return incidence(self._skin.mesh.faces, len(self._skin.source))

    def _write(self, indices: Indices | None = None) -> None:
        """Copy positions and normals, or those of some vertices, into the arrays that are drawn all along."""
        places, normals = self._data.points, self._data.point_data["Normals"]
        shown, count = self.shown_points, len(self.rest.vertices)
        if indices is None:
            places[:] = shown[self._skin.source]
            normals[:] = self._rest_normals if self._before else self._normals
        else:
            places[indices] = shown[indices]
            places[count:] = shown[self._skin.source[count:]]
            normals[indices] = self._normals[indices]
        self._data.GetPoints().Modified()
        self._data.GetPointData().GetNormals().Modified()
        self.sight.forget()


class Ghost:
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
