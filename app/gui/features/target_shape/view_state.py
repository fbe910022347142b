"""Camera and keyboard focus before the target card opened; both are restored when it closes."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QAbstractButton, QWidget

from app.gui.viewport.target_handle import TargetHandle
from app.rendering.camera import View

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.target_shape.controller import TargetShapeController


class ViewState(QObject):
    """Leads the camera by ``look``, and brings it back by ``go`` unless a hand has turned it since."""

    def __init__(self, context: AppContext, controller: TargetShapeController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        self._viewport = context.view.viewport
        self._keyboard: QWidget | None = None
        self._own: View | None = None  # the view that somebody chose
        self._led: View | None = None  # the one that was led to from there
        self._parallel = False

    def remember(self) -> None:
        """Record the keyboard focus; the camera is recorded when it moves."""
        self._keyboard, self._own, self._led = self._context.window.focusWidget(), None, None

    def look(self, view: View) -> None:
        """Move the camera to a view."""
        heading = self._viewport.heading
        if self._led is None:
            self._parallel = heading.parallel
        if heading != self._led:
            self._own = heading
        self._led = view
        self._viewport.glide_to(view)

    def go(self) -> None:
        """Restore camera and keyboard focus, before the card closes."""
        own, led, viewport = self._own, self._led, self._viewport
        self._own = self._led = None
        if own is not None and led is not None:
            here = viewport.heading
            # Of a view that a hand has turned since only the projection is not its own.
            there = own if here == led else here
            parallel = self._parallel if there.parallel == led.parallel else there.parallel
            if (view := replace(there, parallel=parallel)) != here:
                viewport.glide_to(view)
        has, before = self._context.window.focusWidget(), self._keyboard
        if has is None or self._controller.card.isAncestorOf(has) or isinstance(has, TargetHandle):
            # A button would be pressed by the next Enter, or a space that is meant to flip the body.
            gone = before is None or isinstance(before, QAbstractButton) or not before.isVisible()
            (viewport if gone or before is None else before).setFocus(Qt.FocusReason.OtherFocusReason)
        self._keyboard = None
