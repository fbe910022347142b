"""The turntable camera: a small value with the geometry of looking, and no window."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from core.geometry.mesh import Floats, Points, frozen
from core.geometry.planar_curves import Plane

if TYPE_CHECKING:
    import pyvista as pv


LENS = 20.0
"""Vertical opening angle [degrees]; a portrait lens, because a wider one makes the chest bulge."""

STEEPEST = 89.0
"""Largest elevation [degrees]: the up direction stays defined, so that the picture never rolls."""

SLANTED = 35.0
"""The steepest view of a place that is turned to by itself [degrees]."""

NEAREST, FARTHEST = 120.0, 9000.0
"""Limits of the distance between the eye and the focus [mm]."""

VIEWS: dict[str, tuple[float, float]] = {
    "front": (0.0, 0.0),
    "left": (90.0, 0.0),
    "right": (-90.0, 0.0),
    "back": (180.0, 0.0),
    "three-quarter": (34.0, 8.0),
    "top": (0.0, STEEPEST),
}
"""Named views: azimuth from the front towards the subject's left, and elevation [degrees]."""


@dataclass(frozen=True)
class View:
    """Where the eye is: on a sphere round ``focus`` [mm], at ``azimuth`` and ``elevation`` [degrees].

    Azimuth 0 looks at the front, 90 at the subject's left side. ``parallel`` shows the same size at the focus
    without perspective.
    """

    focus: tuple[float, float, float] = (0.0, 0.0, 0.0)
    distance: float = 2000.0
    azimuth: float = 0.0
    elevation: float = 0.0
    parallel: bool = False

    @property
    def name(self) -> str | None:
        """Return which of ``VIEWS`` this is, or None for any other one."""
        for name, (azimuth, elevation) in VIEWS.items():
            turned = (self.azimuth - azimuth + 180.0) % 360.0 - 180.0
            if abs(turned) < 0.5 and abs(self.elevation - elevation) < 0.5:
                return name
        return None

    @cached_property
    def axes(self) -> Points:
        """Return the unit vectors right, up and towards the eye, shape (3, 3)."""
        a, e = np.radians([self.azimuth, self.elevation])
        back = np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)])
        right = np.array([np.cos(a), np.sin(a), 0.0])
        return frozen([right, np.cross(back, right), back])

    @cached_property
    def eye(self) -> Floats:
        """Return the position of the eye, shape (3,) [mm]."""
        return frozen(np.asarray(self.focus) + self.distance * self.axes[2])

    @property
    def half_height(self) -> float:
        """Return half of the height that is seen at the focus [mm]."""
        return float(self.distance * np.tan(np.radians(LENS / 2.0)))

    def orbit(self, azimuth: float, elevation: float) -> View:
        """Return the view turned by two angles [degrees]; the elevation stops at straight up and down."""
        turned = (self.azimuth + azimuth + 180.0) % 360.0 - 180.0
        return replace(
            self, azimuth=turned, elevation=float(np.clip(self.elevation + elevation, -STEEPEST, STEEPEST))
        )

    def named(self, name: str) -> View:
        """Return the view from the side called ``name`` in ``VIEWS``; raises KeyError for another name."""
        azimuth, elevation = VIEWS[name]
        return replace(self, azimuth=azimuth, elevation=elevation)

    def facing(self, way: npt.ArrayLike) -> View:
        """Return the view from where ``way``, shape (3,), points, but neither steeply down nor up."""
        x, y, z = np.asarray(way, dtype=np.float64)
        elevation = np.degrees(np.arctan2(z, np.hypot(x, y)))
        azimuth = float(np.degrees(np.arctan2(x, -y)))
        return replace(self, azimuth=azimuth, elevation=float(np.clip(elevation, -SLANTED, SLANTED)))

    def pan(self, dx: float, dy: float, height: int) -> View:
        """Return the view dragged by (dx, dy) pixels, y downwards, in a picture ``height`` pixels high."""
        step = 2.0 * self.half_height / max(height, 1)
        right, up, _ = self.axes
        return self.centred(np.asarray(self.focus) + step * (dy * up - dx * right))

    def zoom(self, factor: float, x: float = 0.0, y: float = 0.0) -> View:
        """Return the view ``factor`` times larger, keeping the place (x, y) of the focus plane where it is.

        ``x`` and ``y`` count from the centre of the picture, y upwards, in half heights.
        """
        distance = float(np.clip(self.distance / factor, NEAREST, FARTHEST))
        shift = self.half_height * (1.0 - distance / self.distance)
        right, up, _ = self.axes
        return replace(self.centred(np.asarray(self.focus) + shift * (x * right + y * up)), distance=distance)

    def centred(self, focus: npt.ArrayLike) -> View:
        """Return the view of another focus, shape (3,) [mm], from the same side."""
        x, y, z = np.asarray(focus, dtype=np.float64)
        return replace(self, focus=(float(x), float(y), float(z)))

    def framing(self, bounds: npt.ArrayLike, aspect: float, margin: float = 1.16) -> View:
        """Return the view from the same side that shows the box ``bounds``, (x0, x1, y0, y1, z0, z1) [mm]."""
        box = np.asarray(bounds, dtype=np.float64).reshape(3, 2)
        right, up, _ = np.abs(self.axes)
        size = box[:, 1] - box[:, 0]
        needed = max(float(up @ size), float(right @ size) / aspect) * margin
        distance = needed / (2.0 * np.tan(np.radians(LENS / 2.0)))
        return replace(self.centred(box.mean(axis=1)), distance=float(np.clip(distance, NEAREST, FARTHEST)))

    def towards(self, other: View, part: float) -> View:
        """Return the view ``part`` of the way (0..1) to ``other``, round the shorter side."""
        turn = (other.azimuth - self.azimuth + 180.0) % 360.0 - 180.0
        focus = (1.0 - part) * np.asarray(self.focus) + part * np.asarray(other.focus)
        return replace(
            other.centred(focus),
            distance=self.distance ** (1.0 - part) * other.distance**part,
            azimuth=self.azimuth + part * turn,
            elevation=(1.0 - part) * self.elevation + part * other.elevation,
        )

    def to_picture(self, points: npt.ArrayLike, width: float, height: float) -> Points:
        """Return where ``points``, (n, 3) [mm], appear: x and y from the top left [px], and depth [mm]."""
        right, up, back = self.axes
        relative = np.atleast_2d(np.asarray(points, dtype=np.float64)) - np.asarray(self.focus)
        depth = self.distance - relative @ back
        shrink = 1.0 if self.parallel else np.maximum(depth, 1e-3) / self.distance
        scale = height / (2.0 * self.half_height) / shrink
        x = width / 2.0 + relative @ right * scale
        return np.stack([x, height / 2.0 - relative @ up * scale, depth], axis=1)

    def ray(self, x: float, y: float, width: float, height: float) -> tuple[Floats, Floats]:
        """Return the start, shape (3,) [mm], and the unit direction of the sight through a pixel."""
        right, up, back = self.axes
        step = 2.0 * self.half_height / height
        across = (x - width / 2.0) * step * right + (height / 2.0 - y) * step * up
        target = np.asarray(self.focus) + across
        start = target + self.distance * back if self.parallel else self.eye
        sight = target - start
        return start, sight / np.linalg.norm(sight)


def aim(camera: pv.Camera, view: View) -> None:
    """Set a camera to ``view``; the clipping range is unchanged.

    Pyvista's own way looks through all places on the stage for that, at each of position, focus and up.
    """
    camera.SetPosition(*view.eye)
    camera.SetFocalPoint(*view.focus)
    camera.SetViewUp(0.0, 0.0, 1.0)
    camera.SetViewAngle(LENS)
    camera.SetParallelProjection(view.parallel)
    camera.SetParallelScale(view.half_height)
    camera.is_set = True


NOBODY = np.array([[-200.0, 200.0], [-130.0, 130.0], [0.0, 560.0]])
"""The box of a torso, where there is none."""

_ABOVE_BUST, _BELOW_BUST = 270.0, 350.0  # what a framed bust shows: from the neck to below the waist [mm]

_BUST_HEIGHT = 0.56  # of a torso cut at the hips, used until the landmarks are known

_EDGE = 0.1  # what lies nearer to the edge of a picture than this part of it is hardly seen
_SHEET = 24.0  # how far the sheet of a section reaches out of the body [mm]
_CLOSEST = 90.0  # what is shown round a place, whatever its size [mm]


def box_of(points: Points) -> Floats:
    """Return the least and largest coordinates of points (n, 3), shape (3, 2) [mm]."""
    return np.stack([points.min(axis=0), points.max(axis=0)], axis=1)


def framing_bust(view: View, box: Floats, level: float | None, aspect: float) -> View:
    """Return ``view`` of shoulders to waist; ``level`` is the height of the bust [mm], if it is known."""
    low, high = box[2]
    if level is None:
        level = low + _BUST_HEIGHT * (high - low)
    height = max(level - _BELOW_BUST, low), min(level + _ABOVE_BUST, high)
    return view.framing(np.stack([*box[:2], height]), aspect, margin=1.08)


def framing_points(view: View, points: Points, aspect: float, margin: float = _CLOSEST) -> View:
    """Return ``view`` of ``points``, shape (k, 3) [mm], with a ``margin`` [mm] of what lies round them."""
    around = np.array([-margin, margin])
    return view.framing(box_of(points) + around, aspect)


def framing_place(view: View, place: Floats, normal: Floats, aspect: float) -> View:
    """Return ``view`` turned to where a place, (3,) [mm], faces the eye, and brought there if it is not seen.

    ``normal`` is that of the skin there, shape (3,).
    """
    turned = view.facing(normal)
    x, y, _ = turned.to_picture(place[None], aspect, 1.0)[0]
    seen = _EDGE * aspect < x < (1.0 - _EDGE) * aspect and _EDGE < y < 1.0 - _EDGE
    return turned if seen else turned.centred(place)


def depth_range(view: View, box: Floats) -> tuple[float, float]:
    """Return between which distances from the eye a body in ``box`` and its floor lie [mm]."""
    radius = float(np.hypot(np.linalg.norm(box[:, 1] - box[:, 0]) / 2.0, 700.0))
    depth = float((view.eye - box.mean(axis=1)) @ view.axes[2])
    return max(depth - radius, 20.0), max(depth + radius, 40.0)


def sheet_ends(plane: Plane, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return the least and the largest flat coordinates, (2,) each, of a sheet through a box, (3,) [mm]."""
    corners = plane.flat(np.stack([low - _SHEET, high + _SHEET]))
    return corners.min(axis=0), corners.max(axis=0)
