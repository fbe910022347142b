"""One body with its lines and its control mesh on one viewport, kept up with the frames."""

from __future__ import annotations

from app.gui.viewport.viewport import Viewport
from app.presenters.lines import band_label, bands, drawn
from app.rendering.render_mesh import NONE
from core.control_mesh.fit import ControlMesh
from core.geometry.mesh import Floats, Indices
from core.pipeline.build import Stages
from core.pipeline.live_solver import Frame
from core.scan.body import Body

SCENE_PARTS = {"control-mesh": "control", "bands": "bands", "ghost": "ghost", "colours": "colours"}
"""Layers of the tools by what the scene calls them."""


class BodyView:
    """What is new is built, what moved is moved; ``after`` says whether the reshaped body is seen."""

    def __init__(self, viewport: Viewport, after: bool = True) -> None:
        self.viewport = viewport
        self.after = after
        self.body: Body | None = None
        self.frame: Frame | None = None
        self.hidden_lines: frozenset[str] = frozenset()
        self.selected_line = "mid-bust"
        self._control: ControlMesh | None = None
        self._laid: Stages | None = None  # whose lines lie on the body
        self._layers: dict[str, bool] = {}

    def show_frame(self, frame: Frame) -> None:
        """Update the view; of an unchanged body only new items are redrawn."""
        stages, scene = frame.stages, self.viewport.scene
        fresh = stages.body is not self.body
        laid = stages.control is not self._control
        if fresh:
            self.show_body(stages.body, stages.skin.vertices)
        if laid:
            self._control = stages.control
            scene.show_control_mesh(stages.control.mesh, stages.control.fixed)
            self._laid = None
        redrawn = self._laid is None or (stages is not self._laid and drawn(stages) != drawn(self._laid))
        self._laid = stages
        if redrawn:
            self.show_bands()
        scene.move_body(stages.skin.vertices, frame.points, frame.normals)
        scene.move_control_mesh(frame.control_points)
        scene.show_cups(stages, *stages.skin.of_bust(frame.points, frame.normals))
        self.frame = frame
        self._show_label()
        if self.after or fresh or laid or redrawn:
            self.viewport.request_draw()

    def show_body(self, body: Body, moving: Indices = NONE) -> None:
        """Show a body on which nothing lies yet; ``moving`` are the vertices that will move, if known."""
        self.body, self.frame = body, None
        scene = self.viewport.scene
        scene.show_body(body.mesh, moving, body.colours)
        scene.measure.before(not self.after)
        if not self.after:
            scene.before(True)
        for layer, shown in self._layers.items():
            scene.set_visible(SCENE_PARTS[layer], shown)

    def shade(self, body: Body, occlusion: Floats) -> bool:
        """Darken the folds of ``body``, if it is the one shown; see ``bake_occlusion``."""
        if body is not self.body:
            return False
        self.viewport.scene.set_occlusion(occlusion)
        self.viewport.request_draw()
        return True

    def set_after(self, after: bool) -> None:
        """Show the reshaped body, or the body at rest."""
        self.after = after
        if self.body is not None:
            self.viewport.scene.measure.before(not after)
            self.viewport.scene.before(not after)
            self._show_label()
            self.viewport.request_draw()

    def set_layer(self, layer: str, shown: bool) -> None:
        """Show or hide one of ``SCENE_PARTS``."""
        self._layers[layer] = shown
        if self.body is not None:
            self.viewport.scene.set_visible(SCENE_PARTS[layer], shown)
            self._show_label()
            self.viewport.request_draw()

    def hide_lines(self, names: frozenset[str]) -> None:
        """Show the bands of all lines but these."""
        self.hidden_lines = names
        self.show_bands()

    def show_bands(self) -> None:
        """Show all visible lines on the body."""
        if self._laid is not None:
            self.viewport.scene.show_bands(bands(self._laid, self.hidden_lines))
        self.select_line(self.selected_line)

    def select_line(self, name: str) -> None:
        """Draw a casing round one line."""
        self.selected_line = name
        if self.body is None:
            return
        names = {line.name for line in self._laid.lines} if self._laid is not None else set()
        shown = name in names - self.hidden_lines
        self._show_label()
        self.viewport.select_band(name if shown else None)

    def _show_label(self) -> None:
        """Write beside the selected line, if it can be seen."""
        name, frame = self.selected_line, self.frame
        seen = self.after and name not in self.hidden_lines and self.viewport.scene.is_visible("bands")
        if seen and frame is not None and name in frame.line_lengths:
            self.viewport.label_band(name, *band_label(frame.stages.design, frame, name))
        else:
            self.viewport.label_band(None)
