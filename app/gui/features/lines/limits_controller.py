"""Length limits: computed for each line in the background, while the solver works."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from app.gui.features.lines.panel import LinesPanel
from app.gui.features.lines.slider import SHORTEST
from app.gui.session.jobs import Job
from app.i18n.catalog import tr
from app.presenters.lines import Shown
from core.analysis.length_limits.zones import LengthLimits, length_limits_of
from core.document.design import Design
from core.mechanics.constraint_lines import Line
from core.pipeline.build import Stages
from core.pipeline.live_solver import Frame
from core.progress import Cancelled, Progress

if TYPE_CHECKING:
    from app.gui.context import AppContext

KEPT = 400
"""Leeways that are kept, so that undone steps and other variants show theirs at once."""

HAND_RESTS = 120
"""Milliseconds without a new frame of a drag after which the other lines' leeways are worth working out."""

Key = tuple[Design, str, bool]


class LimitsController(QObject):
    """Compute the length limits of lines as soon as their design is built; ``changed`` when more are known.

    The line in hand comes first. What a line's leeway hangs on is the rest of the design: moving the line
    itself leaves it as it is. One job does all lines; whatever is edited meanwhile ends it.
    """

    _found = Signal(object, object, object)

    changed = Signal()

    def __init__(self, context: AppContext, panel: LinesPanel) -> None:
        super().__init__(context.session)
        self._context, self._panel = context, panel
        self._known: dict[Key, LengthLimits | None] = {}
        self._last: dict[str, LengthLimits] = {}
        self._shown: tuple[Design | None, Mapping[str, Shown]] = None, {}
        self._frame: Frame | None = None
        self._job: Job | None = None
        self._rests = QTimer(self, interval=HAND_RESTS, singleShot=True)
        self._rests.timeout.connect(self._begin)
        # Told in the job's thread, heard in the window's.
        self._found.connect(self._keep)

    def leeways(self, frame: Frame) -> Mapping[str, Shown]:
        """Return how far a frame's lines can go; those of the last design, as stale, till new ones come."""
        design, (shown, leeways) = frame.stages.design, self._shown
        if design is shown:
            return leeways
        drawn = frame.stages.drawn_lines
        lines = [
            line.name
            for line in frame.stages.lines
            if line.constrains and (line in drawn or line.name in self._last)
        ]
        keys = {name: _key(design, name) for name in lines}
        found = {name: self._known.get(key) for name, key in keys.items()}
        self._last |= {name: known for name, known in found.items() if known is not None}
        told: dict[str, Shown] = {}
        for name, known in found.items():
            if known is not None:
                told[name] = known, False
            elif name in self._last and keys[name] not in self._known:
                told[name] = self._last[name], True
        self._shown = design, told
        return told

    def follow(self, frame: Frame) -> None:
        """Compute the limits of a frame's design at once, or after a drag."""
        before, self._frame = self._frame, frame
        design = frame.stages.design
        if before is not None and frame.stages.body is not before.stages.body:
            self._last, self._shown = {}, (None, {})
        if before is not None and before.stages.design is design:
            return
        self._let_go()
        if design is self._context.session.design:
            self._begin()
        else:
            self._rests.start()

    def _begin(self) -> None:
        """Start with all lines whose leeways are not known."""
        self._let_go()
        frame = self._frame
        if frame is None:
            return
        stages = frame.stages
        design = stages.design
        rows = [
            line.name for line in self._in_order(stages) if line.name == design.linked_lines(line.name)[0]
        ]
        keys = [key for key in (_key(design, name) for name in rows) if key not in self._known]
        if keys:
            self._job = self._context.jobs.run(
                tr("Computing length limits…"), partial(self._work, stages, keys), self._done
            )

    def _in_order(self, stages: Stages) -> Sequence[Line]:
        """Return the lines, those first that are in hand or under the pointer."""
        selected = self._context.view.selected_line
        hovered = {name for row in self._panel.rows.values() if row.underMouse() for name in row.view.names}
        lines = (
            line
            for line in stages.lines
            if line.constrains and (line in stages.drawn_lines or line.name in {selected, *hovered})
        )
        return sorted(lines, key=lambda line: (line.name != selected, line.name not in hovered))

    def _work(self, stages: Stages, keys: Sequence[Key], progress: Progress) -> None:
        """Compute one line after the other, in the job's thread; each is told as soon as it is known."""
        for at, key in enumerate(keys):
            hear = partial(_part, progress, at / len(keys))
            try:
                leeway = length_limits_of(stages, key[1], hear, through=key[2])
            except Cancelled:
                raise
            except Exception:  # the others may have theirs
                logging.exception("the leeway of %s was not found", key[1])
                leeway = None
            hear("", 0.0)
            self._found.emit(stages, key, leeway)

    def _keep(self, stages: Stages, key: Key, leeway: LengthLimits | None) -> None:
        self._known[key] = leeway
        while len(self._known) > KEPT:
            del self._known[next(iter(self._known))]
        if self._frame is not None and stages.body is self._frame.stages.body:
            self._shown = None, {}
            self.changed.emit()

    def _done(self, _: object) -> None:
        self._job = None

    def _let_go(self) -> None:
        """Release work on a design that is no longer shown."""
        self._rests.stop()
        self._context.jobs.cancel(self._job)
        self._job = None


def _part(progress: Progress, begun: float, what: str, share: float) -> None:
    progress(what, begun)


def _key(design: Design, name: str) -> Key:
    """Return what the leeway of a line hangs on: all that its answers do, but its own length.

    Of that only whether it is so short that its slider reaches far into what may be red.
    """
    both, ratio = design.linked_lines(name), design.ratio(name)
    if len(design.band_of(name)) == 1:
        design = replace(design.region_of(name), lower=None)
    others = tuple(line for line in design.lines if line.name not in both)
    lower = design.lower
    if lower is not None:
        lower = replace(lower, lines=tuple(line for line in lower.lines if line.name not in both))
    return replace(design, lines=others, lower=lower, volume="exact"), name, ratio < SHORTEST
