"""What the window does about limits: how short each line can be made is worked out beside the window."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.asking.jobs import Job
from app.panels.length_groove import Feasible
from app.wording.words import tr
from core.advice.limits import Limits, limits_of
from core.design import Design
from core.live import Frame

if TYPE_CHECKING:
    from app.main_window import MainWindow

KEPT = 400
"""Limits that are kept, so that undone steps and other variants show theirs at once."""

Key = tuple[Design, str]


class LimitsDesk(QObject):
    """Has the limits of a settled design worked out, the selected line first, and gives them to the lines.

    What a line's limits hang on is the rest of the design: moving the line itself leaves them as they are.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._known: dict[Key, Feasible | None] = {}
        self._last: dict[str, Feasible] = {}
        self._shown: tuple[Design | None, Mapping[str, Feasible]] = None, {}
        self._frame: Frame | None = None
        self._job: Job | None = None

    def feasible(self, frame: Frame) -> Mapping[str, Feasible]:
        """Return the limits of a frame's lines; those of the last design, as stale, until new ones come."""
        design, (shown, limits) = frame.stages.design, self._shown
        if design is shown:
            return limits
        lines = [line.name for line in frame.stages.model.lines if line.constrains]
        found = {name: self._known.get(_key(design, name)) for name in lines}
        self._last |= {name: known for name, known in found.items() if known is not None}
        limits = {
            name: known or replace(self._last[name], stale=True)
            for name, known in found.items()
            if known or name in self._last
        }
        self._shown = design, limits
        return limits

    def follow(self, frame: Frame) -> None:
        """Work on a design once it has settled; whatever is edited meanwhile ends that."""
        before, self._frame = self._frame, frame
        if before is not None and frame.stages.body is not before.stages.body:
            self._last, self._shown = {}, (None, {})
        design = frame.stages.design
        rests = not frame.at_work and design is self._window.session.design
        same = before is not None and before.stages.design is design
        if self._job is not None and not (rests and same):
            self._window.jobs.cancel(self._job)
            self._job = None
        if rests and self._job is None:
            self._next(frame)

    def _next(self, frame: Frame) -> None:
        """Begin with the first line whose limits are not known."""
        self._job, stages = None, frame.stages
        selected = self._window.view.selected_line
        lines = sorted(stages.model.lines, key=lambda line: line.name != selected)
        for line in lines:
            key = _key(stages.design, line.name)
            if line.constrains and key not in self._known:
                self._job = self._window.jobs.run(
                    tr("Finding how short lines can be"),
                    partial(limits_of, stages, line.name),
                    partial(self._keep, frame, key),
                    partial(self._miss, frame, key),
                )
                return

    def _keep(self, frame: Frame, key: Key, found: object) -> None:
        assert isinstance(found, Limits)
        self._known[key] = feasible_of(found)
        while len(self._known) > KEPT:
            del self._known[next(iter(self._known))]
        self._shown = None, {}
        self._window.lines_desk.show_rows()
        self._next(frame)

    def _miss(self, frame: Frame, key: Key, error: Exception) -> None:
        logging.error("the limits of %s were not found", key[1], exc_info=error)
        self._known[key] = None
        self._next(frame)


def feasible_of(found: Limits) -> Feasible | None:
    """Return limits as the slider shows them; None where no length has a balance."""
    if not found.found:
        return None
    ends = {sign: begins.ratio for sign, begins in found.begins.items() if begins is not None}
    strained = ends.pop("strained", None)
    if found.last is not None:
        ends["unreachable"] = found.last.ratio
    if found.stretched is not None:
        ends["stretched"] = found.stretched.ratio
    why = max(ends, key=lambda sign: ends[sign], default="folded")
    return Feasible(strained, ends.get(why), why)


def _key(design: Design, name: str) -> Key:
    """Return what the limits of a line hang on: all that the exact answer does, but its own length."""
    both = design.linked(name)
    others = tuple(line for line in design.lines if line.name not in both)
    return replace(design, lines=others, volume="exact", gain=None), name
