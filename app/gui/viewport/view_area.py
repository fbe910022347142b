"""The middle of the window: the 3D view and all that lies on it."""

# ruff: noqa: N802 - Qt names its events

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import (
    QAction,
    QColor,
    QImage,
    QPainter,
    QPaintEvent,
    QRadialGradient,
    QRegion,
    QResizeEvent,
)
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.gui.session.jobs import Job, Jobs
from app.gui.theme.stylesheet import tokens_of
from app.gui.viewport.body_view import BodyView
from app.gui.viewport.canvas import load_libraries
from app.gui.viewport.comparison import ViewComparison
from app.gui.viewport.landmark_pins import LandmarkPins
from app.gui.viewport.orientation_card import OrientationCard
from app.gui.viewport.split_view import SplitView
from app.gui.viewport.toolbar import CompareTools, ViewTools
from app.gui.viewport.viewport import Viewport
from app.gui.widgets.basic import ToolButton
from app.gui.widgets.overlay_layout import OverlayLayout
from app.gui.widgets.progress_card import ProgressCard
from app.i18n.catalog import tr
from app.rendering.ambient_occlusion import bake_occlusion
from core.geometry.mesh import Floats
from core.landmarks.types import Landmark
from core.pipeline.live_solver import Frame
from core.scan.body import Body

_STRENGTH = 0.55  # of the picture: not to be taken for the body that can be turned


class OpeningCover(QWidget):
    """Covers the view with a picture, which ends softly at its edges."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._picture = QImage()
        self.hide()

    def show_picture(self, picture: QImage | None) -> None:
        """Show a picture, or uncover the view without one."""
        if picture is None:
            self.hide()
        elif self.isHidden():
            self._picture = _faded_out(picture)
            self.show()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the picture in the middle, as high as the view."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.fillRect(self.rect(), QColor(tokens_of(self).app))
        size = self._picture.size().scaled(self.size(), Qt.AspectRatioMode.KeepAspectRatio)
        place = QRectF((self.width() - size.width()) / 2, 0, size.width(), size.height())
        painter.setOpacity(_STRENGTH)
        painter.drawImage(place, self._picture)


def _faded_out(picture: QImage) -> QImage:
    """Return a picture that becomes transparent towards its edges."""
    result = picture.convertToFormat(QImage.Format.Format_ARGB32_Premultiplied)
    middle, radius = QRectF(result.rect()).center(), max(result.width(), result.height()) / 2
    mask = QRadialGradient(middle, radius)
    mask.setColorAt(0.75, QColor(0, 0, 0, 255))
    mask.setColorAt(1.0, QColor(0, 0, 0, 0))
    painter = QPainter(result)
    painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_DestinationIn)
    painter.fillRect(result.rect(), mask)
    painter.end()
    return result


LOWER_ROWS = {"waist": (2, 6), "seat": (6, 9)}
"""Rows of the control mesh of the lower trunk that are framed with each of its parts."""


class ViewArea(QWidget):
    """Shows frames; ``is_shaded`` says whether the soft shadows of the body have been worked out.

    ``viewport`` is the view that is always there; ``beside`` says what is seen beside it,
    and ``compared`` that this has changed.
    """

    compared = Signal()

    def __init__(self, jobs: Jobs) -> None:
        super().__init__()
        self._jobs = jobs
        self._baking: Job | None = None
        self.viewport = Viewport()
        self.panes = SplitView(self.viewport, self)
        self.tools = ViewTools(self)
        self.compare = CompareTools(self)
        self.busy, self.question = ProgressCard(self), OrientationCard(self)
        self._main = BodyView(self.viewport)
        self.beside = ViewComparison(self._main, self.panes)
        self.pins = LandmarkPins([self.viewport])
        self._shades: tuple[Body, Floats] | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.panes)
        self.cover = OpeningCover(self)
        self.floating = OverlayLayout(self)
        self._explaining: list[QWidget] = []
        for panel, corner in (
            (self.tools, "bottom"),
            (self.busy, "bottom"),
            (self.question, "bottom"),
            (self.compare, "top-left"),
        ):
            panel.hide()
            self.floating.place(panel, corner)
        self.panes.obstacle = self.compare
        self.viewport.set_view("three-quarter")
        self.tools.set_view("three-quarter")
        self.tools.set_shown("bands", True)
        self.tools.set_shown("perspective", True)
        self.viewport.view_changed.connect(self._show_view)

    @property
    def tool_actions(self) -> dict[str, QAction]:
        """Return the actions of all tools, for the menus."""
        return self.compare.actions_by_name | self.tools.actions_by_name

    def prepare(self, done: Callable[[], None], failed: Callable[[Exception], None]) -> None:
        """Load the 3D libraries in a passing thread and make the scene, before there is anything to show.

        ``failed`` hears why they cannot be loaded.
        """

        def make(_: object) -> None:
            self.viewport.make()
            done()

        words = tr("Preparing 3D view")
        self._jobs.run(words, lambda _: load_libraries(), make, failed)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the view covered while something is being opened."""
        super().resizeEvent(event)
        self.cover.resize(self.size())

    # -- what is shown

    def show_frame(self, frame: Frame) -> None:
        """Update all visible parts of the document."""
        first, former = frame.stages.body is not self._main.body, self._main.frame
        if first:
            self.viewport.paint_later()
        for body in self.beside.live:
            body.show_frame(frame)
        if first:
            self._show_new(frame.stages.body)
        whole = frame.lower is not None
        if first or whole != (former is not None and former.lower is not None):
            (self.viewport.frame_all if whole else self.viewport.frame_bust)()
        self.pins.set_landmarks(frame.stages.all_landmarks)

    def show_stuck(self, body: Body, landmarks: Mapping[str, Landmark]) -> None:
        """Show a body on which no control mesh lies, and what landmarks there are."""
        first = self._main.body is None
        self.compare_by("after")
        self._main.show_body(body)
        self._show_new(body)
        if first:
            self.viewport.frame_bust()
        self.pins.set_landmarks(landmarks)

    @property
    def is_shaded(self) -> bool:
        """Return whether the soft shadows of the body have been worked out."""
        return self._shades is not None

    @property
    def hidden_lines(self) -> frozenset[str]:
        """Return the lines whose bands are not shown."""
        return self._main.hidden_lines

    @property
    def selected_line(self) -> str:
        """Return the line with a casing round it."""
        return self._main.selected_line

    def select_line(self, name: str) -> None:
        """Draw a casing round one line."""
        for body in self.beside.bodies:
            body.select_line(name)

    def set_line_visible(self, name: str, visible: bool) -> None:
        """Show or hide one line's band."""
        hidden = self.hidden_lines - {name} if visible else self.hidden_lines | {name}
        for body in self.beside.bodies:
            body.hide_lines(hidden)

    def set_layer(self, layer: str, shown: bool) -> None:
        """Show or hide a layer, as its tool says."""
        (self.compare if layer == "ghost" else self.tools).set_shown(layer, shown)
        if layer == "perspective":
            self.viewport.set_parallel(not shown)
        elif layer == "landmarks":
            self.pins.set_shown(shown)
        else:
            for body in self.beside.bodies:
                body.set_layer(layer, shown)

    def set_material(self, material: str) -> None:
        """Paint the body as one of ``app.rendering.appearance.MATERIALS``."""
        for body in self.beside.bodies:
            body.viewport.set_material(material)

    def frame_selection(self) -> None:
        """Zoom to the selected landmark, if it is shown, else to the selected line."""
        _, place = self.pins.chosen()
        bands = self.viewport.scene.bands
        if place is not None:
            self.viewport.frame_points(place[None])
        elif self.selected_line in bands.names:
            self.viewport.frame_points(bands.spine(self.selected_line)[0])

    def frame_part(self, part: str) -> None:
        """Zoom to the bust, the waist or the seat; to the whole body where the design has no such part."""
        frame = self._main.frame
        if part == "bust" or frame is None or frame.lower is None:
            (self.viewport.frame_bust if part == "bust" else self.viewport.frame_all)()
            return
        control = frame.lower.stages.control
        low, high = LOWER_ROWS[part]
        own = (control.row >= low) & (control.row <= high)
        if part == "seat":
            self.viewport.set_view("back")
        self.viewport.frame_points(control.mesh.vertices[own])

    # -- before and after

    @property
    def after(self) -> bool:
        """Return whether the reshaped body is seen."""
        return self.beside.way != "before"

    def set_after(self, after: bool) -> None:
        """Show the reshaped body alone, or the body at rest."""
        self.compare_by("after" if after else "before")

    def compare_by(self, way: str) -> None:
        """Compare before and after in one of ``app.gui.viewport.comparison.WAYS``."""
        self.beside.show(way)
        self._beside_changed()

    def show_variants(self, variants: Sequence[tuple[str, Frame | None]]) -> None:
        """Show variants of the design side by side; the one without a frame is the one that is worked on."""
        self.beside.show_variants(variants)
        self._beside_changed()

    def close_comparison(self) -> bool:
        """Show the reshaped body alone if it is compared with the original one; returns whether it was."""
        compared = self.beside.way in ("wipe", "side")
        if compared:
            self.compare_by("after")
        return compared

    def _beside_changed(self) -> None:
        self.compare.set_way(self.beside.way)
        self.pins.set_viewports([body.viewport for body in self.beside.live])
        for body in self.beside.bodies[1:]:
            self._shade_or_bake(body)
        self.compared.emit()

    # -- places, pictures, the end

    def place(self, panel: QWidget, corner: str, explains: bool = False) -> None:
        """Let a panel float in one of ``app.gui.widgets.overlay_layout.CORNERS``, over what is there already.

        One that ``explains`` what is seen belongs to a picture of it, and yields to all others.
        """
        self.floating.place(panel, corner, yields=explains)
        if explains:
            self._explaining.append(panel)

    def picture(self, finer: float = 2.0) -> QImage:
        """Return what is seen, with so many times the pixels of the screen in both directions.

        Of what floats over it only that is in the picture which explains it, such as the legend of a map.
        """
        self.viewport.make()
        from app.gui.viewport.screenshot import fine_picture  # noqa: PLC0415 (brings VTK along)

        picture = fine_picture(self.panes, finer)
        painter = QPainter(picture)
        for panel in self._explaining:
            if not panel.isHidden():
                # What closes it is for the hand.
                tools = [tool for tool in panel.findChildren(ToolButton) if not tool.isHidden()]
                for tool in tools:
                    tool.hide()
                panel.render(painter, panel.pos(), QRegion(), QWidget.RenderFlag.DrawChildren)
                for tool in tools:
                    tool.show()
        painter.end()
        return picture

    def close_view(self) -> None:
        """Release all resources, before the window closes."""
        self.panes.close_views()

    # -- inside

    def _show_view(self) -> None:
        """Mark the tools of the view that the camera is in; on its way there it stays marked."""
        self.tools.set_shown("perspective", not self.viewport.view.parallel)
        name = self.viewport.view.name
        if name is not None or self.viewport.heading == self.viewport.view:
            self.tools.set_view(name)

    def _show_new(self, body: Body) -> None:
        self.tools.actions_by_name["colours"].setEnabled(body.colours is not None)
        for panel in (self.tools, self.compare):
            panel.show()
        self._shades = None
        self._jobs.cancel(self._baking)
        self._baking = self._bake(body)

    def _bake(self, body: Body) -> Job:
        return self._jobs.run(
            tr("Computing shading…"),
            lambda progress: bake_occlusion(body.mesh, progress=progress),
            lambda occlusion: self._shade(body, occlusion),
        )

    def _shade(self, body: Body, occlusion: Any) -> None:
        if body is self._main.body:
            self._shades = body, occlusion
        for each in self.beside.bodies:
            each.shade(body, occlusion)

    def _shade_or_bake(self, beside: BodyView) -> None:
        known = self._shades is not None and beside.shade(*self._shades)
        if not known and beside.body is not None and beside.body is not self._main.body:
            self._bake(beside.body)
