"""Landmarks: where they were found, where pins are put, how the model follows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QSettings, Qt, QTimer, Signal
from PySide6.QtGui import QCursor, QKeyEvent

from app.gui.features.landmarks.panel import LandmarksPanel
from app.gui.widgets.tooltip import show_tip
from app.i18n.catalog import joined, tr
from app.i18n.lengths import arrow_step
from app.presenters.landmarks import kind_of, landmark_title, landmark_views, other_side, spot_of
from app.presenters.messages import render, render_all
from core.document.design import Design
from core.geometry.mesh import Points
from core.landmarks.manual import in_file, mirrored, nearest_skin
from core.landmarks.warnings import landmark_warnings
from core.pipeline.build import IncompleteBuildError, Stages
from core.pipeline.live_solver import Frame
from core.scan.body import Body

if TYPE_CHECKING:
    from app.gui.context import AppContext

LINKED = "landmarks/linked"
"""The setting of the window that both sides are placed together."""

ARROWS = {
    Qt.Key.Key_Left: (-1, 0),
    Qt.Key.Key_Right: (1, 0),
    Qt.Key.Key_Up: (0, 1),
    Qt.Key.Key_Down: (0, -1),
}
"""Which way each arrow key moves a pin over the picture, right and up."""

_DOUBT = "landmarks"  # what a notice of uncertain landmarks is about

PAUSE = 800
"""Milliseconds without a key after which a pin that was moved by keys is put down."""


class LandmarksController(QObject):
    """Show landmarks in the panel and as pins, and make what is done to these edits of the design.

    A pin that is carried, by the pointer or by keys, is previewed: the model is fitted again with its newest
    place. Putting it down is one undo step, with its mirror image if both sides are linked.
    ``upright_requested`` carries the direction of the file that is up; ``carrying_changed`` is emitted when
    a pin is taken, put down or let go.
    """

    carrying_changed = Signal()
    upright_requested = Signal(str)

    def __init__(self, context: AppContext, panel: LandmarksPanel) -> None:
        super().__init__(context.session)
        self._context, self._panel = context, panel
        self._viewport = context.view.viewport
        self._session = context.session
        self._carried: dict[str, Points] = {}
        self._refused = False
        self._middle = 0.0
        self._pause = QTimer(self, interval=PAUSE, singleShot=True)
        self._pause.timeout.connect(self.put_down)
        panel.link.setChecked(bool(QSettings().value(LINKED, False, bool)))
        context.view.viewport.watch_keys(self)
        self._connect()

    def _connect(self) -> None:
        panel, viewport = self._panel, self._viewport
        panel.landmark_selected.connect(self.take)
        panel.reset_requested.connect(self.reset)
        panel.confirmed.connect(self.confirm)
        panel.place_requested.connect(self.put_pin)
        panel.keys_requested.connect(self.move_by_keys)
        panel.hovered.connect(self.hover)
        panel.linked.connect(self.link)
        viewport.pin_pressed.connect(self.take)
        viewport.pin_moved.connect(self.carry)
        viewport.pin_released.connect(self.put_down)
        viewport.pin_hovered.connect(self.hover_pin)
        selection = self._context.selection
        selection.landmark_selected.connect(panel.select)
        selection.landmark_selected.connect(self._context.view.pins.select)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Move the selected pin by the arrow keys, while the view has them; Enter puts it down."""
        if event.type() != QEvent.Type.KeyPress or not isinstance(event, QKeyEvent):
            return False
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self._carried:
            self.put_down()
            return True
        right, up = ARROWS.get(Qt.Key(event.key()), (0, 0))
        far = arrow_step(bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
        return bool(right or up) and self.nudge(far * right, far * up)

    # -- the session speaks

    def show_found(self, stages: Stages) -> None:
        """Show what was found on a body."""
        context, warnings = self._context, landmark_warnings(stages.landmarks)
        views = landmark_views(stages.all_landmarks, context.view.pins.accepted)
        self._panel.set_landmarks(views, render_all([each.message for each in warnings]))
        weak = sum(view.weak for view in views)
        context.navigation.mark_step("landmarks", "look" if weak or warnings else "done", weak)
        if not (weak or warnings):
            context.notifications.withdraw(_DOUBT)

    def show_unclear(self, stages: Stages) -> None:
        """Show which landmarks of the control mesh have low confidence."""
        self._carried = {}
        self._context.view.pins.drop_back()
        warnings = landmark_warnings(stages.landmarks)
        if any(each.prominent for each in warnings):
            first, *more = warnings
            actions = [(tr("Review"), lambda: self._look_at(first.landmark))]
            if stages.landmarks.size_doubted:
                actions.insert(0, (tr("Check unit"), lambda: self._context.navigation.show_step("scan")))
            if up := stages.landmarks.upright:
                actions.insert(0, (tr("Set upright"), lambda: self._stand_upright(up)))
            self._context.notifications.show(
                "warn",
                first.message,
                joined(render_all([each.message for each in more])),
                actions,
                lasting=True,
                topic=_DOUBT,
            )

    def show_stuck(self, stuck: IncompleteBuildError) -> None:
        """Show what was found on a scan that cannot go on."""
        refused = stuck.kind == "refused"
        self._carried = {}
        views = landmark_views(stuck.landmarks)
        self._panel.set_landmarks(views, [render(stuck.message)], placing=not refused)
        self._context.navigation.mark_step("landmarks", "missing" if refused else "look")

    def follow(self, frame: Frame) -> None:
        """Let pins that were put down stand where the landmarks are, once these are found."""
        if not self._carried and frame.stages.design is self._session.design:
            self._context.view.pins.drop_back()

    def _stand_upright(self, up: str) -> None:
        self._context.notifications.withdraw(_DOUBT)
        self.upright_requested.emit(up)

    def _look_at(self, landmark: str) -> None:
        self._context.navigation.show_step("landmarks")
        self._context.selection.select_landmark(landmark)

    # -- a pin is carried

    @property
    def carries(self) -> bool:
        """Return whether a pin is off its place and not put down yet."""
        return bool(self._carried)

    def take(self, name: str) -> None:
        """Take hold of a pin."""
        self.put_down()
        self._refused = False
        self._context.selection.select_landmark(name)

    def carry(self, name: str, place: Points) -> None:
        """Move a pin to a position of the original body, shape (3,) [mm], and update the model."""
        if self._refused:
            return
        frame = self._session.frame
        if not self._carried and frame is not None:
            self._middle = frame.stages.moving.middle
        self._carried = {name: place}
        partner = other_side(name) if self._panel.link.isChecked() else ""
        if partner and frame is not None and not self._session.stuck:
            self._carried[partner] = mirrored(frame.stages.body.smoothed, place, self._middle)
        self._context.view.pins.carry(self._carried)
        self._context.actions.cancel.setEnabled(True)
        if self._session.design is not None and not self._session.stuck:
            self._session.preview(self._placed(self._session.design))

    def nudge(self, right: float, up: float) -> bool:
        """Move the selected pin over the skin by a shift in the image [mm]; returns whether there is one."""
        pins, view = self._context.view.pins, self._viewport.view
        name, place = pins.chosen()
        body = self._body()
        if place is None or body is None:
            return False
        self._refused = False
        self.carry(name, nearest_skin(body.smoothed, place + right * view.axes[0] + up * view.axes[1]))
        self._pause.start()
        return True

    def put_down(self, name: str = "") -> None:
        """Keep where pins were carried, as one undo step; a stuck scan is tried again with them."""
        self._pause.stop()
        if not self._carried:
            return
        design, stuck = self._session.design, self._session.stuck
        first, *others = self._carried
        text = tr("{name} placed on both sides") if others else tr("{name} placed")
        text = text.format(name=landmark_title(kind_of(first) if others else first))
        if stuck:
            again, self._carried = self._placed(stuck.design), {}
            self._session.open_design(again)
        elif design is not None:
            after, self._carried = self._placed(design), {}
            self._session.edit(lambda _: after, text)
        self.carrying_changed.emit()

    def let_go(self) -> bool:
        """Restore moved pins; returns whether there were any."""
        if not self._carried:
            return False
        self._pause.stop()
        self._carried, self._refused = {}, True
        self._context.view.pins.drop_back()
        self._session.cancel_preview()
        self.carrying_changed.emit()
        return True

    # -- the user asks

    def put_pin(self, name: str) -> None:
        """Add a pin for a landmark that was not detected."""
        self._context.view.pins.put(name)
        self.move_by_keys()

    def move_by_keys(self) -> None:
        """Let the arrow keys move the selected pin."""
        self._viewport.setFocus()

    def confirm(self, names: Sequence[str]) -> None:
        """Keep landmarks where they are: the designer has looked at them.

        What a hand placed is kept already; that it contradicts its rule is not said again in this context.
        """
        frame = self._session.frame
        if frame is None or self._session.design is None:
            return
        marks = frame.stages.all_landmarks
        self._context.view.pins.accepted.update(spot_of(marks[name]) for name in names if marks[name].by_hand)
        names = [name for name in names if not marks[name].by_hand]
        if not names:
            self.show_found(frame.stages)
            self._context.view.pins.set_landmarks(dict(marks))
            return
        self._carried = {name: marks[name].position for name in names}
        after, self._carried = self._placed(self._session.design), {}
        text = tr("{name} confirmed").format(name=landmark_title(names[0]))
        self._session.edit(lambda _: after, text if len(names) == 1 else tr("Landmarks confirmed"))

    def reset(self, names: Sequence[str]) -> None:
        """Let landmarks be found again."""
        stuck = self._session.stuck
        if stuck:
            again = reduce(lambda design, name: design.with_placed(name, None), names, stuck.design)
            self._session.open_design(again)
            return
        text = tr("{name} reset to detected position").format(name=landmark_title(names[0]))
        self._session.reset_landmarks(
            names, text if len(names) == 1 else tr("Landmarks reset to detected positions")
        )

    def link(self, linked: bool) -> None:
        """Place both sides together from now on, or each alone."""
        QSettings().setValue(LINKED, linked)

    def hover(self, name: str) -> None:
        """Draw what a landmark was read from; an empty name ends it."""
        self._context.view.pins.hover(name)

    def hover_pin(self, name: str) -> None:
        """Show the definition of the landmark under the pointer, and draw its source curve."""
        self.hover(name)
        row = self._panel.rows.get(name)
        words = "" if row is None or self._carried else f"{row.view.title}\n{row.view.words()}"
        show_tip(QCursor.pos(), words, self._viewport)

    # -- inside

    def _body(self) -> Body | None:
        stuck, frame = self._session.stuck, self._session.frame
        return stuck.body if stuck else frame.stages.body if frame is not None else None

    def _placed(self, design: Design) -> Design:
        """Return a design with the carried pins where they are."""
        body = self._body()
        assert body is not None
        places: Mapping[str, tuple[float, float, float]] = {
            name: in_file(place, body.pose.file_to_mm) for name, place in self._carried.items()
        }
        return reduce(lambda each, name: each.with_placed(name, places[name]), places, design)
