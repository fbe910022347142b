"""Contact pressures: computed once a run has converged, for what is seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.gui.features.garment.panel import GarmentPanel
from app.gui.features.garment.pressure_card import PressureCard
from app.gui.session.frame_cache import FrameCache
from app.i18n.catalog import tr
from app.presenters.pressure import pressure_summary, pressure_views, rating_limits, unknown_pressure
from app.presenters.status import invalid_reason, not_computed
from core.garment.pressure_list import PressureList, pressure_list_of
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext


class PressureController(QObject):
    """Keep the contact pressures of frames, and show them beside the cut list.

    ``changed`` is emitted when more of them are known, or will not be; ``place_requested`` when the place of
    the highest pressure is to be shown.
    """

    changed = Signal()
    place_requested = Signal()

    def __init__(self, context: AppContext, panel: GarmentPanel) -> None:
        super().__init__(context.session)
        self._session, self._panel = context.session, panel
        self.card = PressureCard(rating_limits())
        self.card.hide()
        panel.cards.addWidget(self.card)
        self._shown: PressureList | None = None
        self._stale: bool | None = None
        self._doubt = ""  # why the present values are no result
        self._body: object = None
        title = tr("Computing contact pressure…")
        self._cache = FrameCache(
            context.session,
            context.jobs,
            title,
            lambda frame, _: pressure_list_of(frame),
            failed=context.notifications.error,
            stopped=lambda: context.notifications.stopped(title),
        )
        self._cache.changed.connect(self.changed)
        self.changed.connect(self.follow)
        context.session.failed.connect(lambda _: self.changed.emit())
        self.card.place_requested.connect(self.place_requested)
        panel.opened.connect(self._open)

    def of(self, frame: Frame) -> PressureList | None:
        """Return the pressures of a frame; if they are not known yet they are computed."""
        return self._cache.request(frame)

    def of_active(self, frame: Frame) -> PressureList | None:
        """Return the pressures of a frame that is a result and not of a bare body."""
        return self.of(frame) if not frame.stages.design.is_bare and not invalid_reason(frame) else None

    def has_failed(self, frame: Frame) -> bool:
        """Return whether the pressures of a frame were not computed, and will not be."""
        return self._cache.is_given_up(frame)

    def missing(self, frame: Frame) -> str:
        """Return why there are no pressures of a frame, nothing where they are known or will be."""
        if self.has_failed(frame):
            return unknown_pressure()
        failed = self._session.failure is not None and frame is self._session.frame
        return not_computed() if failed and self._cache.get(frame) is None else ""

    @property
    def shown(self) -> PressureList | None:
        """Return the pressures beside the cut list, if they are of the present body and a result."""
        return None if self._stale or self._doubt else self._shown

    def follow(self) -> None:
        """Update the values beside the cut list, if visible."""
        frame = self._session.frame
        if frame is None or not self._panel.isVisible():
            return
        known = self.of(frame)
        if frame.stages.body is not self._body:
            self._body, self._shown, self._stale = frame.stages.body, None, None
        stale = known is None
        doubt = invalid_reason(frame) or self.missing(frame)
        if (known or self._shown) is self._shown and (stale, doubt) == (self._stale, self._doubt):
            return
        self._shown, self._stale = known or self._shown, stale
        design, self._doubt = frame.stages.design, doubt
        listed = None if self._doubt else self._shown
        self._panel.set_pressures(pressure_views(listed, design, stale) if listed else {})
        self.card.show_summary(pressure_summary(listed, design, self._doubt), stale and listed is not None)
        self.card.setVisible(not design.is_bare)

    def _open(self) -> None:
        """Compute again what the user stopped: it is looked at again."""
        self._cache.retry()
        self.follow()
