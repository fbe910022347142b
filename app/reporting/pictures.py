"""The pictures of a sheet: front and side, before and after, drawn off-screen on white."""

from __future__ import annotations

from PySide6.QtGui import QColor, QImage, QPainter

from app.presenting.frame import bands
from app.printing.studio import Picture, Studio, on_nothing
from app.reporting.handout import SHOTS
from core.mesh import Floats
from core.progress import Pieces
from core.report import Shown

SIZE = (522, 720)
"""Width and height of a picture [px]: 300 dots to an inch, as large as it stands on the page."""

_SIDES = {"front": "front", "side": "left"}


def shots(shown: Shown, occlusion: Floats) -> Pieces[dict[str, QImage]]:
    """Return the pictures by their names in ``SHOTS``, and give the share done after each piece.

    ``occlusion``, (n,) [1], is that of ``bake_occlusion``. Raises whatever VTK does where it cannot draw.
    """
    stages = shown.stages
    with Studio(stages, shown.control_points, bands(stages, ()), occlusion) as studio:
        found = {}
        for place, name in enumerate(SHOTS):
            side, _, when = name.partition(" ")
            scene = studio.scene
            scene.before(when == "before")
            scene.set_visible("bands", when == "after")
            scene.set_visible("floor", False)
            studio.stand_back(SIZE, _SIDES[side])
            drawing = studio.shot(SIZE)
            try:
                while True:
                    yield (place + next(drawing)) / len(SHOTS)
            except StopIteration as ended:
                found[name] = _on_white(on_nothing(ended.value, False))
        return found


def _on_white(pixels: Picture) -> QImage:
    height, width = pixels.shape[:2]
    own = QImage(pixels.tobytes(), width, height, 4 * width, QImage.Format.Format_RGBA8888)
    result = QImage(width, height, QImage.Format.Format_RGB32)
    result.fill(QColor("white"))
    painter = QPainter(result)
    painter.drawImage(0, 0, own)
    painter.end()
    return result
