"""Draws a small picture of each measure on the sample body, for docs/measures.md."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image
from scipy.interpolate import PchipInterpolator

from app.seeing.camera import View
from app.seeing.occlusion import bake_occlusion
from app.seeing.scene import Scene
from app.seeing.trace import Trace
from app.wording.samples import sample_design
from core.body import Body
from core.landmark import SIDES
from core.landmarks import find_landmarks
from core.measures import Measures, before_after, measures
from core.measuring.definitions import DEFINITIONS
from core.mesh import Mesh, Points
from core.pipeline import Stages, build
from core.solution import run

SIDE = 150
"""Width and height of a picture [px]."""

FINER = 4
"""So many times as large a picture is drawn before it is made small."""

RADIUS, THROUGH = 3.4, 0.75
"""Half the thickness of a curve [mm], and how opaque it is where the body hides it [1]."""

VIEWS = dict.fromkeys(("bust_height", "bust_protrusion", "apex_lift", "bust_point_to_fold"), (82.0, 6.0))
VIEWS |= {"cup_depth": (30.0, 50.0), "asymmetry_forward": (0.0, 60.0)}
VIEWS |= dict.fromkeys(("bust_point_distance", "asymmetry_height", "asymmetry_volume"), (0.0, 5.0))
"""From where a measure is seen, azimuth and elevation [degrees]; all others from between front and left."""

USUAL = (35.0, 14.0)

WAIST = 210.0
"""Height of the sample's waist [mm]."""

VIEWS |= {"hip_girth_skin": (150.0, 14.0)}

TRUNK = (-150.0, 150.0, -230.0, 90.0, 120.0, 470.0)
"""What is seen of the sample: x, y and z from and to [mm]."""

LOWER_TRUNK = (-190.0, 190.0, -250.0, 110.0, -150.0, 260.0)
"""What is seen where the hip is measured."""


def draw(folder: Path) -> list[Path]:
    """Write a picture of each measure that the sample shows into a folder, and return their files."""
    stages, points = _solved()
    before, after = before_after(stages, points)
    folder.mkdir(parents=True, exist_ok=True)
    plotter = pv.Plotter(off_screen=True, window_size=[SIDE * FINER] * 2, lighting="none")
    plotter.enable_anti_aliasing("ssaa")
    scene, trace = _scene(plotter, stages.body.mesh), Trace(plotter, "measure", THROUGH, RADIUS)
    written = []
    hips = [key for key in DEFINITIONS if key.startswith("hip")]
    for key in [key for key in DEFINITIONS if key not in hips] + hips:
        if key == hips[0]:  # last of all: from now on another body is seen
            body = drawn_on(stages.body)
            scene.show_body(body.mesh)
            scene.set_occlusion(bake_occlusion(body.mesh))
            before = measures(body.calm, find_landmarks(body))
        trace.show(*_curves(after if key == "apex_lift" else before, key))
        azimuth, elevation = VIEWS.get(key, USUAL)
        view = View(azimuth=azimuth, elevation=elevation, parallel=True)
        scene.look_from(view.framing(LOWER_TRUNK if key in hips else TRUNK, 1.0, margin=1.04))
        path = folder / f"{key}.png"
        _save(plotter, path)
        written.append(path)
    plotter.close()
    return written


def drawn_on(body: Body) -> Body:
    """Return the sample with a hip, which it ends above: what lies below its waist is drawn out and widened.

    It is a drawing, to show where the hip is measured; the measuring is Busk's own.
    """
    x, y, z = body.mesh.vertices.T
    down = np.clip((WAIST - z) / (WAIST - z.min()), 0.0, 1.0)
    wide = PchipInterpolator((0.0, 0.15, 0.4, 0.65, 1.0), (1.0, 1.02, 1.14, 1.2, 1.02))(down)
    behind = 38.0 * np.exp(-(((down - 0.65) / 0.22) ** 2)) * np.exp(-(((np.abs(x) - 62.0) / 42.0) ** 2))
    middle = float(y[np.abs(z - WAIST) < 20.0].mean())
    deep = (
        middle + (y - middle) * (1.0 + 0.4 * (wide - 1.0)) + np.where(y > middle, behind, 0.0) * (down > 0.0)
    )
    skin = np.stack((x * wide, deep, z - 100.0 * down**2 * (3.0 - 2.0 * down)), axis=1)
    return replace(body, mesh=Mesh(skin, body.mesh.faces))


def _solved() -> tuple[Stages, Points]:
    solution = run(build(sample_design().with_line("mid-bust", 0.85)))
    return solution.stages, solution.control_points


def _scene(plotter: pv.Plotter, mesh: Mesh) -> Scene:
    scene = Scene(plotter, dark=False)
    scene.show_body(mesh)
    scene.set_occlusion(bake_occlusion(mesh))
    scene.set_visible("floor", False)
    plotter.set_background("white")
    return scene


def _curves(found: Measures, key: str) -> tuple[Points, ...]:
    """Return the curves of a measure, of the left side where there are two."""
    return (found.get(key) or found[f"{key}_{SIDES[0]}"]).curves


def _save(plotter: pv.Plotter, path: Path) -> None:
    plotter.render()
    image = Image.fromarray(plotter.screenshot(return_img=True))
    small = image.resize((SIDE, SIDE), Image.Resampling.LANCZOS)
    small.quantize(256, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(path, optimize=True)
