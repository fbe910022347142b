"""Cups drawn as translucent cloth with a fine edge, on the body that they are worn on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyvista as pv

from app.rendering.actors import smooth_actor
from app.rendering.appearance import rgb
from core.garment.cup_fit import WornCups
from core.geometry.mesh import Faces, Floats, Indices, Points
from core.pipeline.build import Stages

CLOTH = {False: "#EEEFFB", True: "#C3C8E4"}
"""Colour of cloth in the light and in the dark theme."""

EDGE = {False: "#6B719C", True: "#E4E8FB"}
"""Colour of its edge."""

_OPACITY, _THIN = 0.5, 1.4  # how opaque cloth is [1], and how thick its edge [px]


@dataclass(frozen=True, eq=False)
class Cutout:
    """The part of a mesh on which a value is at least 0.5.

    Its vertices lie ``along`` (v,) [1] the way between pairs of vertices of the mesh, ``ends`` (v, 2);
    ``faces`` (m, 3) and the ``border`` (s, 2) where the mesh is cut are numbers of its vertices.
    """

    ends: Indices
    along: Floats
    faces: Faces
    border: Indices

    def at(self, values: Points) -> Points:
        """Return the values at its vertices, (v, 3), between those at the vertices of the mesh, (n, 3)."""
        first, second = values[self.ends[:, 0]], values[self.ends[:, 1]]
        return np.asarray(first + self.along[:, None] * (second - first))


def cut_out(faces: Faces, value: Floats) -> Cutout:
    """Return the part of ``faces`` (m, 3) on which a ``value`` (n,) at their vertices is at least 0.5.

    Source: marching triangles.
    """
    inside = value[faces] >= 0.5
    count = inside.sum(axis=1)
    whole = faces[count == 3]
    # Of the others the vertex that differs from both others comes first.
    mixed, odd = (count == 1) | (count == 2), np.where(count == 1, True, False)
    differs = inside[mixed] == odd[mixed][:, None]
    turned = (differs.argmax(axis=1)[:, None] + np.arange(3)) % 3
    corner, left, right = np.take_along_axis(faces[mixed], turned, axis=1).T
    pairs = np.sort(np.stack([np.stack([corner, left], 1), np.stack([corner, right], 1)]), axis=2)
    edges, place = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    kept = np.unique(np.concatenate([whole.ravel(), faces[mixed][inside[mixed]]]))
    number = np.full(len(value), -1)
    number[kept] = np.arange(len(kept))
    on_left, on_right = len(kept) + place.reshape(2, -1)
    alone = odd[mixed]
    tips = np.stack([number[corner], on_left, on_right], axis=1)[alone]
    quads = np.stack([number[left], number[right], on_right, on_left], axis=1)[~alone]
    ends = np.concatenate([np.stack([kept, kept], axis=1), edges])
    low, high = value[edges].T
    along = np.concatenate([np.zeros(len(kept)), (0.5 - low) / np.where(high == low, 1.0, high - low)])
    made = np.concatenate([number[whole], tips, quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Cutout(ends, along, made, np.stack([on_left, on_right], axis=1))


class Cups:
    """The cups on one plotter; they are seen while they are ``visible`` and not what a map lies on."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float = 1.0) -> None:
        self._plotter, self._pixel_ratio = plotter, pixel_ratio
        self._worn: WornCups | None = None
        self._cutout: Cutout | None = None
        self._of: tuple[object, ...] = ()
        self._actors: tuple[pv.Actor, pv.Actor] | None = None
        self._dark, self._visible, self._bare = False, True, False

    @property
    def is_shown(self) -> bool:
        """Return whether cloth is seen."""
        return self._actors is not None and bool(self._actors[0].GetVisibility())

    def show(self, stages: Stages, points: Points, normals: Points) -> None:
        """Show the cups of a design, if it has any, on its body as worn: places and normals (r, 3) of the
        moving vertices.
        """
        cup = stages.design.cup
        if cup is None:
            self.clear()
            return
        if self._worn is None or self._worn.stages is not stages:
            self._worn = WornCups(stages)
        places, upright = self._worn.cloth(points, normals)
        of = stages.control, stages.patch, stages.moving, cup.coverage
        if self._cutout is None or any(a is not b for a, b in zip(of, self._of, strict=True)):
            share, moving = self._worn.share, stages.moving
            self._cutout, self._of = cut_out(moving.corners.T, share[moving.vertices]), of
            self._draw(places, upright)
        assert self._actors is not None
        self._sheet.points[:] = self._edge.points[:] = self._cutout.at(places)
        self._sheet.point_data["Normals"][:] = self._cutout.at(upright)
        for data in (self._sheet, self._edge):
            data.GetPoints().Modified()
            data.Modified()

    def clear(self) -> None:
        """Remove the cups."""
        for actor in self._actors or ():
            self._plotter.remove_actor(actor, reset_camera=False, render=False)
        self._actors = self._worn = self._cutout = None

    def set_dark(self, dark: bool) -> None:
        """Repaint for one theme."""
        self._dark = dark
        if self._actors is not None:
            self._sheet.point_data["Colour"][:] = rgb(CLOTH[dark])
            self._sheet.Modified()
            self._actors[1].prop.color = EDGE[dark]

    def set_visible(self, visible: bool) -> None:
        """Show or hide the cups."""
        self._visible = visible
        self._apply()

    def bare(self, bare: bool) -> None:
        """Show only their edges, so that what is painted on the skin is seen, or all of them."""
        if bare != self._bare:
            self._bare = bare
            self._apply()

    def _draw(self, places: Points, normals: Points) -> None:
        cutout = self._cutout
        assert cutout is not None
        places, normals = cutout.at(places), cutout.at(normals)
        self._sheet, sheet = smooth_actor(
            self._plotter,
            "cups",
            places,
            normals,
            cutout.faces,
            ambient=0.35,
            diffuse=0.75,
            specular=0.18,
            specular_power=14,
        )
        sheet.prop.opacity = _OPACITY
        lines = np.insert(cutout.border, 0, 2, axis=1).ravel()
        self._edge = pv.PolyData(places.astype(np.float32), lines=lines)
        edge = self._plotter.add_mesh(
            self._edge,
            name="edges of cups",
            lighting=False,
            line_width=_THIN * self._pixel_ratio,
            copy_mesh=False,
            reset_camera=False,
            render=False,
        )
        self._actors = sheet, edge
        self.set_dark(self._dark)
        self._apply()

    def _apply(self) -> None:
        if self._actors is not None:
            self._actors[0].SetVisibility(self._visible and not self._bare)
            self._actors[1].SetVisibility(self._visible)
