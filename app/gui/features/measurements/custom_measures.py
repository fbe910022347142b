"""Custom measures: made by clicks on landmarks or from lists, changed, and removed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QObject, QPointF, Signal

from app.gui.features.measurements.panel import MeasurementsPanel
from app.gui.session.jobs import Job
from app.gui.viewport.drawing_tool import DrawingTool
from app.i18n.catalog import tr
from app.presenters.landmarks import landmark_title
from app.presenters.measurements import Draft, from_draft, suggested_name, to_draft, value_texts
from app.presenters.messages import render
from core.document.custom_measures import CustomMeasurement
from core.errors import UserError
from core.landmarks.types import NAMES
from core.measurements.definitions import Measure
from core.measurements.table import OWN, custom_before_after
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext


class CustomMeasuresController(QObject):
    """Keep the form and the places chosen in the view alike.

    ``tried`` carries the measure that is being made, before and after, or None.
    """

    tried = Signal(object)

    def __init__(self, context: AppContext, panel: MeasurementsPanel) -> None:
        super().__init__(context.session)
        self._context, self._panel, self._form = context, panel, panel.editor
        self._viewport = context.view.viewport
        viewport = context.view.viewport
        canvas = viewport.overlay.parentWidget()
        assert canvas is not None
        self._hand = DrawingTool(viewport, canvas)
        self._hand.grabs = self._grab
        self._hand.clicked.connect(self._click)
        self._hand.dropped.connect(lambda _: self._form.show_draft(self._form.draft.picked(self._held)))
        self._hand.requested.connect(self._answer)
        self._held: str = ""
        self._former: str = ""
        self._banded = True
        self._titles: Mapping[str, str] = {}
        self._job: Job | None = None
        self._asked: tuple[Frame, CustomMeasurement] | None = None  # whatever the measure is called
        self._form.changed.connect(self._follow)
        self._form.accepted.connect(self.keep)
        self._form.closed.connect(self.leave)
        self._form.removed.connect(lambda: self.remove(OWN + self._former))
        panel.adding.connect(self.begin)
        panel.changing.connect(lambda key: self.begin(key.removeprefix(OWN)))
        panel.removing.connect(self.remove)
        context.session.frame_ready.connect(self._follow)
        context.session.opened.connect(lambda *_: self.leave())
        sentence = tr("Measure a distance between two landmarks, or a girth at a height")
        do = context.actions
        do.rule("edit")
        self.action = do.add("edit", tr("Add measurement…"), tip=sentence, do=self.begin, of_document=True)

    @property
    def at_work(self) -> bool:
        """Return whether a measure is being made or changed."""
        return self._panel.editing

    def begin(self, former: str = "") -> None:
        """Make a measure, or change the ``former`` one of that name."""
        frame, design = self._context.session.frame, self._context.session.design
        if frame is None or design is None:
            return
        self._context.navigation.start_tool()
        self._context.navigation.show_step("result")
        known = next((each for each in design.own_measures if each.name == former), None)
        self._former = former if known else ""
        points = frame.stages.landmarks.points
        self._titles = {name: landmark_title(name) for name in NAMES if name in points}
        self._asked = None
        self._panel.unmark()
        if not self.at_work:
            self._banded = self._viewport.scene.is_visible("bands")
            self._context.view.set_layer("bands", False)  # they would cover what is shown
        self._panel.set_editing(True)
        self._hand.begin()
        self._form.begin(to_draft(known) if known else Draft(), self._titles, self._former)
        self._form.name.setFocus()

    def leave(self) -> None:
        """Make none any more."""
        if not self.at_work:
            return
        self._context.jobs.cancel(self._job)
        self._job = self._asked = None
        self._hand.end()
        self._panel.set_editing(False)
        self._context.view.pins.offer(None)
        self._context.view.set_layer("bands", self._banded)
        self.tried.emit(None)

    def keep(self) -> None:
        """Add the measure, or put it in the place of the one that was changed, as one step."""
        wished, former = self._wished(), self._former
        if wished is None:
            return
        text = tr("Measurement changed: {name}") if former else tr("Measurement added: {name}")
        self.leave()
        self._context.session.edit(
            lambda design: design.with_custom_measurement(wished, former), text.format(name=wished.name)
        )
        self._panel.select(OWN + wished.name)

    def remove(self, key: str) -> None:
        """Remove one's own measure of this key, as one step."""
        name = key.removeprefix(OWN)
        self.leave()
        self._panel.unmark()
        text = tr("Measurement deleted: {name}").format(name=name)
        self._context.session.edit(lambda design: design.without_custom_measurement(name), text)

    # -- the view speaks

    def _grab(self, at: QPointF) -> bool:
        """Hold a pin rather than let the view carry it off; where it is let go it is chosen."""
        self._held = self._viewport.overlay.chosen_at(at)
        return bool(self._held)

    def _click(self, at: QPointF) -> None:
        """Take the height of the skin that is clicked."""
        frame, place = self._context.session.frame, self._viewport.skin_at(at)
        if frame is not None and place is not None and self._form.draft.kind == "girth":
            self._form.set_height(round(float(place[2]) - float(frame.stages.body.mesh.vertices[:, 2].min())))

    def _answer(self, what: str) -> None:
        if what == "leave":
            self.leave()
        elif what == "back":
            self._form.show_draft(self._form.draft.stepped_back())
        elif self._form.keep.isEnabled():
            self.keep()

    # -- what it measures

    def _follow(self, _: object = None) -> None:
        """Show the chosen landmarks, and measure beside the window what is wished for."""
        frame = self._context.session.frame
        if not self.at_work or frame is None:
            return
        self._context.view.pins.offer(self._form.draft.marks)
        try:
            wished = self._wished()
        except UserError as refusal:
            self._show(None, render(refusal.message))
            return
        if wished is None:
            self._show(None)
        elif not self._context.session.is_at_rest:
            self._show(None, tr("Measurements appear when the solver has converged."))
        elif (frame, replace(wished, name="?")) != self._asked:
            self._begin_measuring(frame, replace(wished, name="?"))

    def _begin_measuring(self, frame: Frame, wished: CustomMeasurement) -> None:
        self._context.jobs.cancel(self._job)
        self._asked = frame, wished
        self._form.show_value("", "", "", self._suggested())  # the former one is of another measure
        self._job = self._context.jobs.run(
            tr("Measuring body…"),
            lambda progress: custom_before_after(frame.stages, frame.region_points, wished),
            lambda found: self._show(cast(tuple[Measure, Measure], found)),
            self._fail,
            left=lambda: self._show(None, tr("Computation stopped. Change the measurement to restart it.")),
        )

    def _fail(self, error: Exception) -> None:
        self._context.notifications.error(error)
        self._show(None, tr("The body could not be measured."))

    def _show(self, found: tuple[Measure, Measure] | None, why: str = "") -> None:
        """Show what was measured, or why nothing is."""
        if found is None:
            self._context.jobs.cancel(self._job)
            self._job = self._asked = None
        value, sentence, doubt = value_texts(*found) if found else ("", "", why)
        self._form.show_value(value, sentence, doubt, self._suggested())
        self.tried.emit(found)

    def _suggested(self) -> str:
        return suggested_name(self._form.draft, self._titles)

    def _wished(self) -> CustomMeasurement | None:
        """Return what is wished for, None while places are missing. Raises UserError for what cannot be."""
        frame, design = self._context.session.frame, self._context.session.design
        if frame is None or design is None:
            return None
        taken = {each.name for each in design.own_measures} - {self._former}
        return from_draft(self._form.draft, self._suggested(), taken)
