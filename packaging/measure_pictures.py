"""Draws a small picture of each measure on the sample body, for docs/reference/measurements.md."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pyvista as pv
from measure_marks import Marks, marks_of
from PIL import Image, ImageDraw

from app.presenters.samples import WHOLE_TRUNK, dressed_sample, sample_design
from app.rendering.ambient_occlusion import bake_occlusion
from app.rendering.camera import View
from app.rendering.curve_actors import COLOURS, Trace
from app.rendering.scene import Scene
from core.geometry.mesh import Indices, Mesh, Points
from core.landmarks.detect import find_landmarks
from core.landmarks.types import SIDES, Landmarks
from core.measurements.definitions import DEFINITIONS, Definition
from core.measurements.lower_trunk import seat_faces
from core.measurements.subject import Subject, subject_of
from core.measurements.table import Measures, before_after, measures
from core.pipeline.build import build
from core.pipeline.solve import solve
from core.scan.body import Body

SIDE = 180
"""Width and height of a picture [px]."""

FINER = 3
"""So many times as large a picture is drawn before it is made small."""

RADIUS, THROUGH = 3.2, 0.22
"""Half the thickness of a curve [mm], and how opaque it is where the body hides it [1]."""

BLUE, GREY = COLOURS[False], "#7A828E"
"""What is measured, and what it is measured from: both are seen on a light page and on a dark one."""

PALE = "#E9E1D8"
"""A cut through the body."""

FILL = (0.55, 0.25)
"""How opaque the left breast is filled, and the right one, which it is compared with [1]."""

FROM_ABOVE = (30.0, 38.0)
USUAL = (35.0, 14.0)
SIDEWAYS = (90.0, 2.0)
BEHIND = (150.0, 14.0)
VIEWS = dict.fromkeys(("bust_height", "bust_protrusion", "apex_lift"), SIDEWAYS)
VIEWS |= {"cup_depth": (25.0, 50.0), "asymmetry_forward": (0.0, 56.0), "bust_point_to_fold": (62.0, 0.0)}
VIEWS |= dict.fromkeys(("bust_point_distance", "asymmetry_height", "asymmetry_volume"), (0.0, 5.0))
VIEWS |= {
    "hip_girth": BEHIND,
    "hip_girth_skin": (150.0, 38.0),
    "buttock_girth": BEHIND,
    "seat_volume": BEHIND,
}
VIEWS |= {"crotch_length": (115.0, -8.0), "waist_hip_ratio": BEHIND}
VIEWS |= dict.fromkeys(("waist_to_hip", "seat_protrusion", "gluteal_fold_height"), SIDEWAYS)
"""From where a measure is seen, azimuth and elevation [degrees]; all others from between front and left."""

TRUNK = (-150.0, 150.0, -230.0, 90.0, 120.0, 470.0)
"""What is seen of the sample: x, y and z from and to [mm]."""

LOWER_TRUNK = (-200.0, 200.0, -260.0, 90.0, -190.0, 260.0)
"""What is seen of the whole trunk where waist, hips and seat are measured."""

BEFORE = (-150.0, 150.0, -290.0, 30.0, 150.0, 470.0)
"""What is seen from the side, with room before the body."""

BREAST = (60.0, 140.0, -290.0, -120.0, 270.0, 430.0)
"""What is seen where little is measured, from the side."""

SEEN = {"bust_height": BEFORE, "bust_protrusion": BEFORE, "apex_lift": BREAST}


@dataclass(frozen=True, eq=False)
class Shown:
    """A body that measures are shown on, and what it measures; ``seat`` are the faces of its left seat."""

    body: Body
    landmarks: Landmarks
    found: Measures
    seat: Indices | None = None

    @property
    def subject(self) -> Subject:
        """What the measures were taken from."""
        return subject_of(self.body.mesh, self.landmarks)


def draw(folder: Path) -> list[Path]:
    """Write a picture of each measure into a folder, and return their files."""
    solution = solve(build(sample_design().with_line("mid-bust", 0.85)))
    stages = solution.stages
    usual = measured(stages.body)
    worn = replace(stages.body, mesh=solution.body)
    lifted = Shown(worn, usual.landmarks, before_after(stages, solution.control_points)[1])
    whole, uneven = whole_trunk(), measured(drawn_uneven(stages.body))
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for key, definition in DEFINITIONS.items():
        on = {"asymmetry": uneven, "apex": lifted}.get(key.partition("_")[0], usual)
        on = whole if on_whole_trunk(definition) else on
        written.append(folder / f"{key}.png")
        draw_one(key, on, marks_of(key, on.found, on.landmarks), written[-1])
    return written


def measured(body: Body) -> Shown:
    """Return a body with what it measures."""
    landmarks = find_landmarks(body)
    return Shown(body, landmarks, measures(body.smoothed, landmarks))


def whole_trunk() -> Shown:
    """Return the sample of a whole trunk with what it measures."""
    stages = build(replace(dressed_sample(WHOLE_TRUNK), tissue="net", cup=None))
    assert stages.lower is not None
    found, _ = before_after(stages, stages.control.mesh.vertices)
    seat = seat_faces(stages.body.smoothed, stages.lower.fitted)[0]
    return Shown(stages.body, stages.landmarks, found, seat)


def on_whole_trunk(definition: Definition) -> bool:
    """Return whether a measure is shown on the whole trunk: the other sample ends above the hip."""
    return definition.lower or definition.key.startswith("hip")


def draw_one(key: str, on: Shown, marks: Marks, path: Path) -> None:
    """Write the picture of one measure: the body, what is filled and the curves on it, then arrows."""
    plotter = pv.Plotter(off_screen=True, window_size=[SIDE * FINER] * 2, lighting="none")
    plotter.enable_anti_aliasing("ssaa")
    level = key.endswith("_skin") or key.startswith("section_area")
    mesh = below(on.body.mesh, marks.curves[0][:, 2].mean()) if level else on.body.mesh
    scene = Scene(plotter, dark=False)
    scene.show_body(mesh)
    scene.set_occlusion(bake_occlusion(mesh))
    scene.set_visible("floor", False)
    plotter.set_background("white")  # no gradient: nothing but the body is seen on the page
    for area, colour, opacity in areas(key, on, marks):
        actor = plotter.add_mesh(area, color=colour, opacity=opacity, lighting=False)
        actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
        actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -3000.0)
    Trace(plotter, "measure", THROUGH, RADIUS).show(*marks.curves)
    azimuth, elevation = VIEWS.get(key, FROM_ABOVE if level else USUAL)
    seen = LOWER_TRUNK if on_whole_trunk(DEFINITIONS[key]) else SEEN.get(key, TRUNK)
    view = View(azimuth=azimuth, elevation=elevation, parallel=True)
    scene.set_camera(view.framing(seen, 1.0, margin=1.04))
    _save(plotter, marks, path)
    plotter.close()


def below(mesh: Mesh, height: float) -> Mesh:
    """Return what of a body lies below a level [mm]: the level can then be looked at from above."""
    cut = pv.make_tri_mesh(mesh.vertices, mesh.faces).clip((0, 0, 1), (0, 0, height)).triangulate()
    return Mesh(np.array(cut.points, dtype=float), np.array(cut.regular_faces))


def areas(key: str, on: Shown, marks: Marks) -> Iterator[tuple[pv.PolyData, str, float]]:
    """Yield what is filled, its colour and how opaque it is: a section, or skin of breasts or of a seat."""
    if key.endswith("_skin") or key.startswith("section_area"):
        ring = marks.curves[0]
        section = pv.PolyData(ring, faces=[len(ring), *range(len(ring))]).triangulate()
        yield section, PALE if key.endswith("_skin") else BLUE, 1.0
    sides = {"breast_volume": SIDES[:1], "asymmetry_volume": SIDES}.get(key, ())
    for side, opacity in zip(sides, FILL, strict=False):
        skin = pv.make_tri_mesh(on.subject.mesh.vertices, on.subject.breasts[side].faces)
        yield skin, BLUE, opacity
    if key == "seat_volume" and on.seat is not None:
        yield pv.make_tri_mesh(on.body.mesh.vertices, on.body.mesh.faces[on.seat]), BLUE, FILL[0]


def drawn_uneven(body: Body) -> Body:
    """Return the sample with its left breast drawn larger, higher and further out than the right one."""
    x, y, z = body.mesh.vertices.T
    tip = find_landmarks(body).position("bust_point_left")
    near = np.exp(-(((x - tip[0]) / 55.0) ** 2) - ((z - tip[2]) / 60.0) ** 2) * (y < tip[1] + 120.0)
    return replace(body, mesh=Mesh(np.stack((x, y - 20.0 * near, z + 18.0 * near), axis=1), body.mesh.faces))


def _save(plotter: pv.Plotter, marks: Marks, path: Path) -> None:
    plotter.render()
    image = Image.fromarray(plotter.screenshot(transparent_background=True, return_img=True))
    _draw_marks(ImageDraw.Draw(image), plotter.renderer, marks)
    small = image.resize((SIDE, SIDE), Image.Resampling.LANCZOS)
    small.save(path, optimize=True)


def _draw_marks(pen: ImageDraw.ImageDraw, renderer: pv.Renderer, marks: Marks) -> None:
    """Draw dashed guides, arrows with two heads and dots over the picture."""
    for guide in marks.guides:
        _dashed(pen, *_on_screen(renderer, guide))
    for arrow in marks.arrows:
        _arrow(pen, *_on_screen(renderer, arrow))
    for dot in (place for dots in marks.dots for place in _on_screen(renderer, dots)):
        pen.circle(tuple(dot), 4.0 * FINER, fill=BLUE, outline="white", width=FINER)


def _on_screen(renderer: pv.Renderer, places: Points) -> Points:
    """Return where places (k, 3) [mm] are in the picture, shape (k, 2) [px]."""
    seen = []
    for place in places:
        renderer.SetWorldPoint(*place, 1.0)
        renderer.WorldToDisplay()
        seen.append(renderer.GetDisplayPoint()[:2])
    return np.array(seen) * (1.0, -1.0) + (0.0, SIDE * FINER)


def _dashed(pen: ImageDraw.ImageDraw, start: Points, end: Points) -> None:
    count = max(int(np.linalg.norm(end - start) / (4.0 * FINER)) // 2 * 2 + 1, 1)
    ends = start + np.linspace(0.0, 1.0, count + 1)[:, None] * (end - start)
    for number in range(0, count, 2):
        pen.line([tuple(ends[number]), tuple(ends[number + 1])], fill=GREY, width=2 * FINER)


def _arrow(pen: ImageDraw.ImageDraw, start: Points, end: Points) -> None:
    """Draw a line with a head at both ends; where it is too short, they point at it from outside."""
    length = float(np.linalg.norm(end - start))
    way = (end - start) / max(length, 1e-9)
    head = 7.0 * FINER
    inside = length > 2.5 * head
    pen.line([tuple(start), tuple(end)], fill=BLUE, width=2 * FINER)
    for tip, back in ((start, way), (end, -way)) if inside else ((start, -way), (end, way)):
        foot, aside = tip + head * back, 0.45 * head * np.array((-way[1], way[0]))
        pen.polygon([tuple(tip), tuple(foot + aside), tuple(foot - aside)], fill=BLUE)
        if not inside:
            pen.line([tuple(foot), tuple(foot + head * back)], fill=BLUE, width=2 * FINER)
