"""The pictures of a sheet: front and side, before and after, drawn off-screen on white."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from PySide6.QtGui import QColor, QImage, QPainter

from app.presenters.lines import bands
from app.rendering.camera import View
from app.rendering.offscreen import OffscreenRenderer, Picture, with_transparency
from app.report.document import SHOT_SIZES, SHOTS
from core.geometry.mesh import Floats
from core.pipeline.warnings import ShownState
from core.progress import Pieces, part_of

DOTS = 300.0 / 25.4
"""Pixels of a picture to a millimetre of the page."""

_SIDES = {"front": "front", "side": "left"}


def render_images(shown: ShownState, occlusion: Floats) -> Pieces[dict[str, QImage]]:
    """Return the pictures by their names in ``SHOTS``, and give the share done after each piece.

    ``occlusion``, (n,) [1], is that of ``bake_occlusion``. Raises whatever VTK does where it cannot draw.
    """
    stages = shown.stages
    unworn = {line.name for line in stages.model.lines} - stages.design.active_lines()
    with OffscreenRenderer(stages, shown.region_points, bands(stages, unworn), occlusion) as studio:
        yield from part_of(studio.set_up(), 0.0, 0.0)
        scene, sizes = studio.scene, {side: _pixels(SHOT_SIZES[side]) for side in _SIDES}
        scene.set_visible("floor", False)
        views = _views(studio, sizes)
        found = {}
        for place, name in enumerate(SHOTS):
            side, _, when = name.partition(" ")
            scene.before(when == "before")
            scene.set_visible("bands", when == "after")
            scene.set_camera(views[side])
            drawing = studio.render(sizes[side])
            try:
                while True:
                    yield (place + next(drawing)) / len(SHOTS)
            except StopIteration as ended:
                found[name] = _on_white(with_transparency(ended.value, False))
        return found


def _pixels(size: tuple[float, float]) -> tuple[int, int]:
    return round(DOTS * size[0]), round(DOTS * size[1])


def _views(studio: OffscreenRenderer, sizes: Mapping[str, tuple[int, int]]) -> dict[str, View]:
    """Return where each side is seen from: all from as far away, so that heights compare."""
    views = {}
    for side, name in _SIDES.items():
        studio.frame_worn(sizes[side], name)
        views[side] = studio.scene.view
    farthest = max(view.distance for view in views.values())
    return {side: replace(view, distance=farthest) for side, view in views.items()}


def _on_white(pixels: Picture) -> QImage:
    height, width = pixels.shape[:2]
    own = QImage(pixels.tobytes(), width, height, 4 * width, QImage.Format.Format_RGBA8888)
    result = QImage(width, height, QImage.Format.Format_RGB32)
    result.fill(QColor("white"))
    painter = QPainter(result)
    painter.drawImage(0, 0, own)
    painter.end()
    return result
