"""A studio: pictures of a body drawn off-screen, piece by piece, so that a window answers between them.

Without a graphics card a piece takes a tenth of a second on a body of usual size; on scans of half a million
points a quarter, and the first look at such a body longer.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType

import numpy as np
import numpy.typing as npt
import pyvista as pv
from PIL import Image
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

from app.rendering.appearance import APPEARANCES, CLAY, rgb
from app.rendering.band import Band
from app.rendering.camera import LENS
from app.rendering.display import off_screen
from app.rendering.scene import Scene
from core.errors import UserError
from core.files.atomic_write import atomic_path
from core.geometry.mesh import Floats, Points
from core.messages import Message
from core.pipeline.build import Stages
from core.progress import Pieces, Progress, quiet

Picture = npt.NDArray[np.uint8]
"""Red, green, blue and how solid, shape (h, w, 4)."""

FINER = 2
"""Pixels drawn for each one of a picture, in both directions: no stairs at the outlines."""

LONGEST = 960
"""Width and height that is drawn at once [px]: a tenth of a second without a graphics card."""


class OffscreenRenderer:
    """A body with its bands before an off-screen camera; close it in the thread that made it.

    ``scene`` is free to be looked at from anywhere; its background is not drawn, see ``with_background``.
    """

    def __init__(
        self,
        stages: Stages,
        region_points: Sequence[Points],
        bands: Sequence[Band],
        occlusion: Floats,
        *,
        dark: bool = False,
        material: str = CLAY,
    ) -> None:
        off_screen()
        plotter = self._plotter = pv.Plotter(off_screen=True, window_size=[64, 64], lighting="none")
        try:
            plotter.ren_win.SetAlphaBitPlanes(1)
            plotter.ren_win.SetMultiSamples(0)
            self.scene = Scene(plotter, dark)
            self.scene.set_material(material)
            plotter.set_background(APPEARANCES[dark].centre)
            plotter.renderer.SetGradientBackground(False)  # it would begin anew in each piece
            plotter.renderer.SetBackgroundAlpha(0.0)
        except BaseException:
            plotter.close()
            raise
        self._shows = stages, region_points, bands, occlusion

    def set_up(self) -> Pieces[None]:
        """Add body and bands to the scene, part by part, before the first image."""
        scene, (stages, region_points, bands, occlusion) = self.scene, self._shows
        yield 0.0  # the window was opened
        scene.show_body(stages.body.mesh)
        yield 0.2
        scene.set_occlusion(occlusion)
        yield 0.4
        scene.show_control_mesh(stages.control.mesh, stages.control.fixed)  # framed by it, and not seen
        yield 0.5
        scene.show_bands(bands)
        yield 0.7
        shape = stages.skin.shape(region_points)
        scene.move_body(stages.skin.vertices, *shape)
        scene.show_cups(stages, *stages.skin.of_bust(*shape))
        yield 1.0

    def __enter__(self) -> OffscreenRenderer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, fault: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._plotter.close()

    def frame_worn(self, size: tuple[int, int], side: str) -> None:
        """Frame shoulders to waist, with the lower trunk all of the body, from ``side`` in ``VIEWS``."""
        self.scene.set_view(side)
        whole = self._shows[0].lower is not None
        framing = self.scene.framing_all if whole else self.scene.framing_bust
        self.scene.set_camera(framing(size[0] / size[1]))

    def render(self, size: tuple[int, int]) -> Pieces[Picture]:
        """Return a picture of ``size`` [px] on one pale or dark colour.

        ``with_background`` and ``with_transparency`` take that colour away where the picture is not solid.
        """
        columns, rows = (-(-FINER * side // LONGEST) for side in size)
        # Whole pixels of the picture in each piece: it may grow by a few pixels, which are cut off.
        wide, high = (-(-side // count) for side, count in zip(size, (columns, rows), strict=True))
        picture = np.empty((high * rows, wide * columns, 4), dtype=np.uint8)
        for row in range(rows):
            for column in range(columns):
                piece = self._piece(column, row, columns, rows, (FINER * wide, FINER * high))
                picture[row * high : (row + 1) * high, column * wide : (column + 1) * wide] = piece
                yield (row * columns + column + 1) / (rows * columns)
        return picture[: size[1], : size[0]]

    def _piece(self, column: int, row: int, columns: int, rows: int, size: tuple[int, int]) -> Picture:
        plotter, camera = self._plotter, self._plotter.camera
        plotter.window_size = list(size)
        self.scene.set_camera(self.scene.view)
        half = np.tan(np.radians(LENS / 2.0)) / rows
        camera.SetViewAngle(float(np.degrees(2.0 * np.arctan(half))))
        camera.SetParallelScale(camera.GetParallelScale() / rows)
        camera.SetWindowCenter(2 * column + 1 - columns, rows - 1 - 2 * row)
        plotter.ren_win.Render()
        drawn = _pixels(plotter)
        # Four plain bands: as RGBA the colour of what is seen through would be lost.
        return np.asarray(Image.frombytes("RGBX", drawn.shape[1::-1], drawn.tobytes()).reduce(FINER))


def write_picture(
    path: str | os.PathLike[str], picture: Picture, dark: bool, clear: bool, progress: Progress = quiet
) -> None:
    """Write what ``OffscreenRenderer.render`` has drawn as PNG, on its ground or on ``clear`` nothing.

    Raises UserError for another ending or a place that cannot be written to; Cancelled leaves no file.
    """
    target = Path(path)
    picture_kind(target)
    progress("writing", 0.1)
    image = Image.fromarray(with_transparency(picture, dark) if clear else with_background(picture, dark))
    with atomic_path(target) as partial:
        progress("writing", 0.3)
        image.save(partial, "PNG", optimize=False)
        progress("writing", 1.0)


def picture_kind(path: str | os.PathLike[str]) -> str:
    """Return the kind of picture that a name ends in. Raises UserError if Busk does not make it."""
    kind = Path(path).suffix.lower().lstrip(".")
    if kind != "png":
        raise UserError(
            Message("Images cannot be exported as .{kind}.", kind=kind),
            Message("Choose a name ending in .png."),
        )
    return kind


def with_background(picture: Picture, dark: bool) -> Picture:
    """Return a picture on the background of the views, shape (h, w, 3): bright in the middle."""
    (height, width), look = picture.shape[:2], APPEARANCES[dark]
    y, x = np.ogrid[-1.0 : 1.0 : height * 1j, -1.0 : 1.0 : width * 1j]
    away = (np.hypot(width * x, height * y) / np.hypot(width, height)).astype(np.float32)
    clear = away * (1.0 - picture[..., 3] / np.float32(255.0))
    darker = (rgb(look.edge) - rgb(look.centre)).astype(np.float32)
    shown = picture[..., :3] + clear[..., None] * darker
    return np.asarray(np.clip(shown + 0.5, 0.0, 255.0), dtype=np.uint8)


def with_transparency(picture: Picture, dark: bool) -> Picture:
    """Return a picture as files hold it, shape (h, w, 4): its own colours, whatever is seen through."""
    solid = picture[..., 3:] / np.float32(255.0)
    own = picture[..., :3] - (1.0 - solid) * rgb(APPEARANCES[dark].centre).astype(np.float32)
    colours = np.clip(own / np.maximum(solid, 1.0 / 255.0) + 0.5, 0.0, 255.0)
    return np.concatenate([colours.astype(np.uint8), picture[..., 3:]], axis=2)


def _pixels(plotter: pv.Plotter) -> Picture:
    """Return what has been drawn, shape (h, w, 4)."""
    camera = vtkWindowToImageFilter()
    camera.SetInput(plotter.ren_win)
    camera.SetInputBufferTypeToRGBA()
    camera.ShouldRerenderOff()
    camera.ReadFrontBufferOff()
    camera.Update()
    output = camera.GetOutput()
    width, height, _ = output.GetDimensions()
    pixels = vtk_to_numpy(output.GetPointData().GetScalars()).reshape(height, width, 4)
    return np.ascontiguousarray(pixels[::-1])
