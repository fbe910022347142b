"""Cache of static layers of an image while other parts move."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager

import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkProp
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLFramebufferObject

_COLOUR_AND_DEPTH = 0x4000 | 0x100
_NEAREST = 0x2600
_BYTES = 3  # VTK_UNSIGNED_CHAR
_DEPTH_BITS = 32


class StaticLayerCache:
    """Draws one plotter's scene; what stands still is kept, with its depth, until something of it changes.

    Without a graphics card the picture of a body costs several times that of the part which moves. The result
    is the same to the pixel, unless something moves behind a still thing that is seen through. Only for
    pictures without passes that smooth outlines; belongs to one thread.
    """

    def __init__(self, plotter: pv.BasePlotter) -> None:
        self._plotter = plotter
        self._kept: vtkOpenGLFramebufferObject | None = None
        self._able = True
        self._size = (0, 0)
        self._state: object = None
        self._eye: object = None

    def render(self, still: Iterable[vtkProp]) -> None:
        """Draw the scene, as little of it as is needed; ``still`` is what of it need not be drawn again."""
        window, still = self._plotter.ren_win, [prop for prop in still if prop.GetVisibility()]
        known = self._state is not None and self._state == self._state_of(still)
        if known or (self._able and self._eye == self._eye_now() and self._keep(still)):
            self._draw_over(still)
            # Only now: hiding things and showing them again has changed their times.
            self._state = self._state_of(still)
        else:  # the eye moves: what would be kept would be of no use, or nothing can be kept
            window.Render()
            self._state = None
        self._eye = self._eye_now()

    def clear(self) -> None:
        """Release cached images."""
        self._kept = self._state = self._eye = None

    def _eye_now(self) -> object:
        return tuple(self._plotter.ren_win.GetSize()), self._plotter.renderer.GetActiveCamera().GetMTime()

    def _state_of(self, still: list[vtkProp]) -> object:
        """Return what changes whenever the picture of ``still`` would."""
        renderer = self._plotter.renderer
        lamps = tuple(lamp.GetMTime() for lamp in renderer.GetLights())
        times = tuple(
            (id(prop), prop.GetRedrawMTime(), prop.GetShaderProperty().GetMTime()) for prop in still
        )
        return self._eye_now(), renderer.GetMTime(), lamps, times

    def _keep(self, still: list[vtkProp]) -> bool:
        """Draw what stands still, and keep it; returns False where the graphics cannot."""
        window, others = self._plotter.ren_win, [prop for prop in self._shown() if prop not in still]
        with _hidden(others):
            window.Render()
        if self._kept is None or self._size != tuple(window.GetSize()):
            self._size, self._kept = tuple(window.GetSize()), vtkOpenGLFramebufferObject()
            self._kept.SetContext(window)
            made = self._kept.PopulateFramebuffer(
                *self._size, True, 1, _BYTES, True, _DEPTH_BITS, window.GetMultiSamples()
            )
            # OpenGL copies depth only between formats that are the same.
            if not made or _depth_of(self._kept) != _depth_of(window.GetRenderFramebuffer()):
                self.clear()
                self._able = False  # to try it at every picture would draw each one twice
                return False
        self._copy(window.GetRenderFramebuffer(), self._kept)
        return True

    def _draw_over(self, still: list[vtkProp]) -> None:
        """Draw the rest of the scene over what is kept."""
        renderer, window, kept = self._plotter.renderer, self._plotter.ren_win, self._kept
        assert kept is not None
        restore = renderer.AddObserver(
            "StartEvent", lambda *_: self._copy(kept, window.GetRenderFramebuffer())
        )
        renderer.SetPreserveColorBuffer(True)
        renderer.SetPreserveDepthBuffer(True)
        try:
            with _hidden(still):
                window.Render()
        finally:
            renderer.SetPreserveColorBuffer(False)
            renderer.SetPreserveDepthBuffer(False)
            renderer.RemoveObserver(restore)

    def _shown(self) -> list[vtkProp]:
        return [prop for prop in self._plotter.renderer.GetViewProps() if prop.GetVisibility()]

    def _copy(self, source: vtkOpenGLFramebufferObject, target: vtkOpenGLFramebufferObject) -> None:
        state, (width, height) = self._plotter.ren_win.GetState(), self._size
        everywhere = (0, width, 0, height)  # up to, and without
        state.PushFramebufferBindings()
        source.Bind(source.GetReadMode())
        source.ActivateReadBuffer(0)
        target.Bind(target.GetDrawMode())
        target.ActivateDrawBuffer(0)
        vtkOpenGLFramebufferObject.Blit(everywhere, everywhere, _COLOUR_AND_DEPTH, _NEAREST)
        state.PopFramebufferBindings()


def _depth_of(buffer: vtkOpenGLFramebufferObject) -> int:
    """Return the format in which a buffer holds depth, or 0."""
    depth = buffer.GetDepthAttachmentAsTextureObject()
    return 0 if depth is None else int(depth.GetInternalFormat(0, 0, False))


@contextmanager
def _hidden(props: list[vtkProp]) -> Iterator[None]:
    for prop in props:
        prop.SetVisibility(False)
    try:
        yield
    finally:
        for prop in props:
            prop.SetVisibility(True)
