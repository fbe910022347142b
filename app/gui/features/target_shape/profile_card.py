"""Profiles that are drawn on the body while the result is asked for."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from app.gui.viewport.target_handle import TargetCurve, TargetHandle
from app.i18n.catalog import tr
from core.analysis.inverse_design.profile_curve import ProfileCurve, profile_points, section_to_space
from core.pipeline.frame import Frame

if TYPE_CHECKING:
    from app.gui.viewport.viewport import Viewport


class ProfileHandles(QObject):
    """One curve a section with its handles in a view.

    ``taken`` and ``dropped`` when a hand closes and opens, ``taken`` with the section; ``dragged`` carries
    the section, the number of the handle, and each step up and out [mm].
    """

    taken = Signal(str)
    dragged = Signal(str, int, float, float)
    dropped = Signal()

    def __init__(self, viewport: Viewport, parent: QObject) -> None:
        super().__init__(parent)
        self._viewport = viewport
        self._curves: dict[str, TargetCurve] = {}
        self.handles: dict[str, list[TargetHandle]] = {}

    def put_away(self) -> None:
        """Show none any longer."""
        for curve in self._curves.values():
            curve.put_away()
        for handle in self.all():
            handle.put_away()

    def all(self) -> list[TargetHandle]:
        """Return all handles, from below."""
        return [handle for each in self.handles.values() for handle in each]

    def follow(self, frame: Frame, drawn: dict[str, ProfileCurve]) -> None:
        """Show these profiles, by section, on the body of a frame."""
        for gone in [each for each in self.handles if each not in drawn]:
            self._remove(gone)
        for section, profile in drawn.items():
            if len(self.handles.get(section, ())) != len(profile.handles) or section not in self._curves:
                self._remove(section)
                self._make(section, profile)
            stages = frame.stages
            wished = section_to_space(stages, profile.section, profile.curve)
            self._curves[section].show_curves(wished, profile_points(stages, profile, frame.all_points))
            spots = section_to_space(stages, profile.section, profile.handle_positions)
            for handle, spot in zip(self.handles[section], spots, strict=True):
                handle.show_at(spot, spot)

    def _remove(self, section: str) -> None:
        if section in self._curves:
            self._curves.pop(section).deleteLater()
        for handle in self.handles.pop(section, ()):
            handle.put_away()
            handle.deleteLater()

    def _make(self, section: str, profile: ProfileCurve) -> None:
        side = profile.section
        self._curves[section] = TargetCurve(self._viewport, side)
        self.handles[section] = []
        for number in range(len(profile.handles)):
            name = tr("Profile handle {number} from the bottom").format(number=number + 1)
            handle = TargetHandle(self._viewport, side, name, small=True)
            handle.taken.connect(partial(self.taken.emit, section))
            handle.dragged.connect(partial(self.dragged.emit, section, number))
            handle.dropped.connect(self.dropped)
            self.handles[section].append(handle)
