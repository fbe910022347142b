"""Before and after, or variants of a design: in place, wiped or side by side."""

from __future__ import annotations

from collections.abc import Sequence

from app.gui.viewport.body_view import BodyView
from app.gui.viewport.split_view import SplitView
from app.gui.viewport.viewport import Viewport
from app.i18n.catalog import tr
from core.pipeline.live_solver import Frame

WAYS = ("before", "after", "wipe", "side")
"""How the two bodies of a frame can be looked at."""

_LAYERS = ("control", "bands", "ghost", "colours")


class ViewComparison:
    """Owns the views beside the main one, from when they are wanted until they are not.

    ``way`` is one of ``WAYS``, or "variants". ``bodies`` are all that are seen, ``live`` those of them that
    show the frame of the session; the main one is always there and the first of both.
    """

    def __init__(self, main: BodyView, panes: SplitView) -> None:
        self._panes = panes
        self._main = main
        self.way = "after"
        self.bodies: tuple[BodyView, ...] = (main,)
        self.live: tuple[BodyView, ...] = (main,)

    def show(self, way: str) -> None:
        """Compare before and after in one of ``WAYS``; without a frame nothing is shown beside the body."""
        frame = self._main.frame
        if frame is None and way not in ("before", "after"):
            way = "after"
        self.way = way
        self._main.set_after(way != "before")
        if frame is None or way in ("before", "after"):
            self._panes.show_alone()
            self.bodies = self.live = (self._main,)
            return
        rest = next((body for body in self.live if body is not self._main), None)
        rest = rest or self._beside(frame, after=False)
        if way == "wipe":
            self._panes.show_wipe((tr("Before"), rest.viewport), tr("After"))
        else:
            self._panes.show_row([(tr("Before"), rest.viewport), (tr("After"), self._main.viewport)])
        self.bodies = self.live = (self._main, rest)

    def show_variants(self, variants: Sequence[tuple[str, Frame | None]]) -> None:
        """Show reshaped bodies side by side, each with a title; the one without a frame is the session's own.

        Raises ValueError unless there is exactly one of these.
        """
        if [frame for _, frame in variants].count(None) != 1:
            raise ValueError("exactly one of the variants is the one that is worked on")
        self.way = "variants"
        self._main.set_after(True)
        shown = [
            (title, self._main if frame is None else self._beside(frame, after=True))
            for title, frame in variants
        ]
        self._panes.show_row([(title, body.viewport) for title, body in shown])
        self.bodies = (self._main, *(body for _, body in shown if body is not self._main))
        self.live = (self._main,)

    def _beside(self, frame: Frame, after: bool) -> BodyView:
        """Return another view that looks like the main one."""
        main = self._main
        body = BodyView(Viewport(self._panes), after)
        body.viewport.motion = main.viewport.motion
        body.viewport.look_from(main.viewport.scene.view)
        for layer in _LAYERS:
            body.viewport.scene.set_visible(layer, main.viewport.scene.is_visible(layer))
        body.viewport.set_material(main.viewport.scene.material)
        body.hidden_lines, body.selected_line = main.hidden_lines, main.selected_line
        body.show_frame(frame)
        body.viewport.forward_to(main.viewport)
        return body
