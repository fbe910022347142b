"""The widget that VTK draws in: with a graphics card, without one, and with no display at all."""

# ruff: noqa: N802 - Qt names its events
from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterable
from functools import cache
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QLineF, QPointF, Qt
from PySide6.QtGui import (
    QColor,
    QGuiApplication,
    QImage,
    QOffscreenSurface,
    QOpenGLContext,
    QPainter,
    QPaintEvent,
    QRadialGradient,
    QResizeEvent,
)
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QWidget

from app.gui.theme.stylesheet import tokens_of
from app.gui.viewport.opengl import is_safe_mode
from app.rendering.appearance import APPEARANCES
from core.errors import UserError
from core.messages import Message

if TYPE_CHECKING:
    import pyvista as pv

    from app.gui.viewport.offscreen_canvas import OffscreenCanvas

_GL_RENDERER = 0x1F01
_loading = threading.Lock()


@cache
def has_graphics_card() -> bool:
    """Return whether OpenGL in Qt's windows is available and fast; Qt composes such a window with it.

    On software OpenGL that took longer than the picture itself. Only on Linux VTK has a software OpenGL of
    its own to draw with where Qt has no other.
    """
    if QGuiApplication.platformName() == "offscreen":
        return False
    if not sys.platform.startswith("linux"):
        return True
    context, ground = QOpenGLContext(), QOffscreenSurface()
    ground.create()
    if not (context.create() and context.makeCurrent(ground)):
        return False
    name = str(context.functions().glGetString(_GL_RENDERER)).lower()
    context.doneCurrent()
    return not any(software in name for software in ("llvmpipe", "softpipe", "swrast", "swiftshader"))


def is_painted() -> bool:
    """Return whether the 3D view shows images, with no OpenGL in the window."""
    return is_safe_mode() or not has_graphics_card()


def load_libraries() -> None:
    """Load all that a scene needs, in whatever thread; who asks for it meanwhile waits until it is there.

    Raises UserError, each time anew, where they cannot be loaded.
    """
    # Of what another thread has half loaded pyvista says that there is no such thing.
    with _loading:
        trouble = _trouble_of_loading(is_painted())
    if trouble is not None:
        raise UserError(
            Message("The 3D view is not available: its libraries could not be loaded."),
            Message(
                "Run 'busk self-test' to list missing libraries, or 'busk --safe-mode' to start "
                "without the graphics driver."
            ),
        ) from trouble


@cache
def _trouble_of_loading(painted: bool) -> Exception | None:
    """Load the libraries once, and return what went wrong: a second try would end as the first."""
    try:
        import pyvista.plotting  # noqa: F401, PLC0415 (with matplotlib, which it needs)

        import app.rendering.scene  # noqa: PLC0415

        if painted:
            import app.gui.viewport.offscreen_canvas  # noqa: F401, PLC0415
        else:
            import pyvistaqt  # noqa: F401, PLC0415
    except Exception as fault:
        return fault
    return None


class Canvas(QWidget):
    """Shows a scene once there is one, until then the ground it will stand on; that takes no 3D library.

    It is ``painted`` where no graphics card draws for Qt: then it shows pictures of a scene that is drawn
    off-screen, and ``quick`` has them drawn in a hurry.
    """

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setMouseTracking(True)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.painted = is_painted()
        self._pictures: OffscreenCanvas | None = None
        self._interactor: Any = None
        self._image: QImage | None = None
        if not self.painted:
            # Qt makes a window for OpenGL only if there is such a widget in it from the first; to make it
            # anew, when the scene comes, would be seen.
            QOpenGLWidget(self).hide()

    def make_plotter(self) -> pv.BasePlotter:
        """Load the 3D libraries, if they are not, and return the plotter whose scene is shown from now on."""
        load_libraries()
        if self.painted:
            from app.gui.viewport.offscreen_canvas import OffscreenCanvas  # noqa: PLC0415 (brings VTK along)

            self._pictures = OffscreenCanvas()
            return self._pictures.plotter
        from pyvistaqt import QtInteractor  # noqa: PLC0415 (brings VTK along)

        self._interactor = QtInteractor(self, auto_update=False, multi_samples=0, lighting="none")
        self._interactor.setAcceptDrops(False)
        self._interactor.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        # The canvas has the pointer, before and after.
        self._interactor.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._interactor.setGeometry(self.rect())
        self._interactor.lower()
        self._interactor.show()
        return self._interactor

    def draw_still(self, still: Callable[[], Iterable[Any]]) -> None:
        """Let what ``still`` returns be drawn again, in a hurry, only if it has changed."""
        if self._pictures is not None:
            self._pictures.still = still

    def hurry(self, quick: bool) -> None:
        """Draw quickly from now on, or at one's best."""
        if self._pictures is not None:
            self._pictures.quick = quick

    def draw(self) -> None:
        """Draw the scene anew when the event loop next turns."""
        self._image = None
        (self._interactor or self).update()

    def let_go(self) -> None:
        """Release graphics resources, before the plotter is closed."""
        if self._pictures is not None:
            self._pictures.let_go()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Draw again at the new size."""
        self._image = None
        if self._interactor is not None:
            self._interactor.setGeometry(self.rect())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Show the picture, made anew only if the scene has changed, or the ground."""
        if self._image is None:
            self._image = self._render()
        painter = QPainter(self)
        if self._image is not None:
            painter.drawImage(self.rect(), self._image)
        elif self._pictures is None:
            self._paint_ground(painter)
        painter.end()

    def _render(self) -> QImage | None:
        if self._pictures is None:
            return None
        ratio = self.devicePixelRatioF()
        width, height = (max(round(side * ratio), 1) for side in (self.width(), self.height()))
        return self._pictures.draw(width, height)

    def _paint_ground(self, painter: QPainter) -> None:
        """Paint the background of the scene to come."""
        look, middle = APPEARANCES[tokens_of(self).dark], self.rect().toRectF().center()
        ground = QRadialGradient(middle, QLineF(middle, QPointF()).length())
        ground.setColorAt(0.0, QColor(look.centre))
        ground.setColorAt(1.0, QColor(look.edge))
        painter.fillRect(self.rect(), ground)
