"""The middle of the window: the 3D view and the tools that float on it, kept up with the frames."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.asking.background import Background
from app.desks.present import band_label, bands
from app.desks.present_scan import PINNED, kind_of, landmark_title
from app.panels.busy import BusyCard
from app.panels.question import QuestionCard
from app.panels.view_tools import CompareTools, ViewTools
from app.seeing.body import bake_occlusion
from app.showing.floating import Floating
from app.showing.overlay import Pin
from app.showing.viewport import Viewport
from core.body import Body
from core.control_mesh import ControlMesh
from core.design import Design
from core.fitting.back_length import Back
from core.landmark import Landmark
from core.lines import Line
from core.live import Frame
from core.mesh import Points

SCENE_PARTS = {"control-mesh": "control", "bands": "bands", "ghost": "ghost"}
"""Layers of the tools by what the scene calls them."""


class ViewArea(QWidget):
    """Shows frames; ``is_shaded`` says whether the soft shadows of the body have been worked out."""

    def __init__(self) -> None:
        super().__init__()
        self.viewport = Viewport(self)
        self.tools = ViewTools(self)
        self.compare = CompareTools(self)
        self.busy, self.question = BusyCard(self), QuestionCard(self)
        self.hidden_lines: set[str] = set()
        self.selected_line = "mid-bust"
        self.after = True
        self.is_shaded = False
        self._body: Body | None = None
        self._control: ControlMesh | None = None
        self._landmarks: Mapping[str, Landmark] = {}
        self._lines: tuple[Line, ...] = ()
        self._backs: Mapping[str, Back] = {}
        self._landmark = ""
        self._dragged: tuple[str, Points] | None = None
        self._labels: dict[str, tuple[str, str]] = {}
        self._background = Background(self)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.viewport)
        self.floating = Floating(self)
        for panel, corner in (
            (self.tools, "bottom"),
            (self.busy, "bottom"),
            (self.question, "bottom"),
            (self.compare, "top-left"),
        ):
            panel.hide()
            self.floating.place(panel, corner)
        self.viewport.set_view("three-quarter")
        self.tools.set_view("three-quarter")
        self.tools.set_shown("bands", True)
        self.tools.set_shown("perspective", True)
        self._background.finished.connect(self._shade)
        self.viewport.view_changed.connect(self._show_view)

    def show_frame(self, frame: Frame, design: Design) -> None:
        """Bring the view up to date: what is new is built, what moved is moved."""
        stages, scene = frame.stages, self.viewport.scene
        fresh = stages.body is not self._body
        if fresh:
            self._show_body(stages.body)
        if stages.landmarks.points is not self._landmarks:
            self._landmarks, self._dragged = stages.landmarks.points, None
            self._show_pins()
        if stages.control is not self._control:
            self._control = stages.control
            scene.show_control_mesh(stages.control.mesh, stages.control.fixed)
            self._lines = ()
            if fresh:
                self.viewport.frame_bust()
        if _paths(stages.model.lines) != _paths(self._lines):
            self._lines, self._backs = stages.model.lines, stages.backs
            self.show_bands()
        scene.move_body(stages.moving.vertices, frame.points, frame.normals)
        scene.move_control_mesh(frame.control_points)
        self._labels = {name: band_label(design, frame, name) for name in frame.lengths}
        self._show_label()
        self.viewport.request_draw()

    def show_stuck(self, body: Body, landmarks: Mapping[str, Landmark]) -> None:
        """Show a body on which no control mesh lies, and what landmarks there are."""
        first = self._body is None
        self._show_body(body)
        self._landmarks, self._dragged = landmarks, None
        if first:
            self.viewport.frame_bust()
        self._show_pins()

    def show_bands(self) -> None:
        """Lay the lines that are not hidden on the body."""
        if self._control is not None:
            rest = self._control.mesh.vertices
            self.viewport.scene.show_bands(bands(self._lines, rest, self.hidden_lines, self._backs))
        self.select_line(self.selected_line)

    def select_line(self, name: str) -> None:
        """Put a casing round one line."""
        self.selected_line = name
        shown = name in {line.name for line in self._lines} - self.hidden_lines
        self.viewport.select_band(name if shown else None)
        self._show_label()

    def select_landmark(self, name: str) -> None:
        """Mark one landmark's pin, and draw the curve that it was read from."""
        self._landmark = name
        self._show_pins()

    def drag_landmark(self, name: str, place: Points) -> None:
        """Let a pin follow the pointer to a place of the body at rest, shape (3,) [mm]."""
        self._dragged = name, place
        self._show_pins()

    def put_pin(self, name: str) -> None:
        """Put the pin of a landmark that was not found in the middle of the view, to be dragged away."""
        place = self.viewport.skin_in_the_middle()
        if place is not None:
            self._landmark, self._dragged = name, (name, place)
            self._show_pins()

    def dropped(self) -> tuple[str, Points] | None:
        """Return which pin was let go and where, if it was moved."""
        return self._dragged

    def drop_back(self) -> None:
        """Put a dragged pin back to where its landmark is."""
        if self._dragged is not None:
            self._dragged = None
            self._show_pins()

    def set_line_visible(self, name: str, visible: bool) -> None:
        """Show or hide one line's band."""
        self.hidden_lines = self.hidden_lines - {name} if visible else self.hidden_lines | {name}
        self.show_bands()

    def set_after(self, after: bool) -> None:
        """Show the reshaped body, or the body at rest."""
        self.after = after
        self.compare.set_after(after)
        if self._body is not None:
            self.viewport.scene.before(not after)
            self._show_pins()
            self._show_label()
            self.viewport.request_draw()

    def set_layer(self, layer: str, shown: bool) -> None:
        """Show or hide a layer, as its tool says."""
        self.tools.set_shown(layer, shown)
        if layer == "perspective":
            self.viewport.set_parallel(not shown)
        elif layer == "landmarks":
            self._show_pins()
        else:
            self.viewport.scene.set_visible(SCENE_PARTS[layer], shown)
        self._show_label()
        self.viewport.request_draw()

    def place(self, panel: QWidget, corner: str) -> None:
        """Let a panel float in one of ``app.showing.floating.CORNERS``, over what is there already."""
        self.floating.place(panel, corner)

    def picture(self) -> QImage:
        """Return what is seen."""
        return self.viewport.picture()

    def close_view(self) -> None:
        """Give everything back, before the window goes."""
        self._background.close()
        self.viewport.close_view()

    def _show_view(self) -> None:
        """Mark the tool of the view that the camera is in; on its way there it stays marked."""
        name = self.viewport.scene.view.name
        if name is not None or not self.viewport.gliding:
            self.tools.set_view(name)

    def _show_body(self, body: Body) -> None:
        self._body = body
        for panel in (self.tools, self.compare):
            panel.show()
        self.viewport.scene.show_body(body.mesh)
        self.after, self.is_shaded = True, False
        self.compare.set_after(True)
        self._background.run(body, lambda: bake_occlusion(body.mesh))

    def _shade(self, body: object, occlusion: object) -> None:
        if body is self._body:
            self.viewport.scene.set_occlusion(occlusion)  # type: ignore[arg-type]
            self.viewport.request_draw()
            self.is_shaded = True

    def _show_label(self) -> None:
        """Write beside the selected line, if it can be seen."""
        name = self.selected_line
        seen = self.after and name not in self.hidden_lines and self.viewport.scene.is_visible("bands")
        if seen and name in self._labels:
            self.viewport.label_band(name, *self._labels[name])
        else:
            self.viewport.label_band(None)

    def _show_pins(self) -> None:
        """Show the pins of the bust and of the selected landmark, with the curve that this was read from."""
        shown = self.tools.actions_by_name["landmarks"].isChecked()
        found = self._landmarks if shown else {}
        pins = {
            mark.name: Pin(mark.name, landmark_title(mark.name), mark.position, mark.confidence)
            for mark in found.values()
            if kind_of(mark.name) in PINNED or mark.by_hand or mark.name == self._landmark
        }
        if shown and self._dragged is not None:
            name, place = self._dragged
            sure = found[name].confidence if name in found else 0.0
            pins[name] = Pin(name, landmark_title(name), place, sure)
        chosen = None if self._dragged else found.get(self._landmark)
        if self._body is not None:
            self.viewport.scene.show_trace(chosen.evidence if chosen else np.empty((0, 3)))
        self.viewport.set_pins(pins.values(), self._landmark)


def _paths(lines: tuple[Line, ...]) -> list[tuple[str, list[int]]]:
    return [(line.name, line.path.tolist()) for line in lines]
