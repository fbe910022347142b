"""Handles and profiles on the body for target shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject

from app.gui.features.target_shape.handles import KINDS
from app.i18n.catalog import tr
from app.rendering.camera import box_of
from core.errors import UserError

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.target_shape.controller import TargetShapeController
    from core.analysis.inverse_design.profile_curve import ProfileCurve
    from core.geometry.mesh import Floats
    from core.geometry.planar_curves import Plane
    from core.pipeline.frame import Frame

_BESIDE = 20.0  # what is seen above and below a profile [mm]
_LEVEL = 0.05  # part of the way to the side from which on it is looked at from there [1]
_THROUGH = 0.5  # a plane that is this near goes through the same place [mm]
_SIDEWAYS = 0.8  # of a view from the side: what is seen from less of it is not drawn on [1]


class ProfileTool(QObject):
    """Chooses by ``choose`` what the handles drag; profiles begin with the skin as it is shown."""

    def __init__(self, context: AppContext, controller: TargetShapeController) -> None:
        super().__init__(controller)
        self._context, self._controller = context, controller
        self._viewport = context.view.viewport

    def choose(self, kind: str) -> None:
        """Let the handles be those of the "bust" points, of the foremost places ("apex"), or of a "profile".

        The figures that they drag are shown; those of the others go unless they are asked for.
        """
        controller = self._controller
        if kind == "profile" and not controller.drawn:
            self.begin(self.side)
            return
        design = controller.ground.design
        if kind in KINDS and design is not None and design.lines:
            for name in (name for names in KINDS.values() for name in names):
                if controller.wishes.get(name) is None and name not in KINDS[kind]:
                    controller.wishes.pop(name, None)
            for name in KINDS[kind]:
                if not any(each.startswith(name) for each in controller.wishes):
                    controller.wishes[name] = None
        self.turn_to(kind)
        controller.steps.note()

    def turn_to(self, kind: str) -> None:
        """Let the handles be those of a kind, whatever is on the card."""
        self._controller.handles.kind = kind
        self._controller.card.show_hand(kind)
        self._controller.ask()

    def begin(self, side: str) -> None:
        """Draw the profile through the bust point of a side, as it is now, to be dragged."""
        from core.analysis.inverse_design.profile_curve import profile_at  # noqa: PLC0415 (few ever ask)

        frame, answer = self._context.session.frame, self._controller.answer
        if frame is None:
            return
        reply = answer.reply if answer is not None else None
        try:
            profile = profile_at(frame.stages, side, frame.all_points if reply is None else reply.points)
        except UserError as problem:
            self._context.notifications.error(problem)
        else:
            self._take(profile)

    def take_table(self, side: str, path: str) -> None:
        """Set the profile of a table as target, through the bust point of a side."""
        from core.analysis.inverse_design.profile_curve import profile_from_table, read_profile  # noqa: PLC0415

        frame = self._context.session.frame
        if frame is None:
            return
        try:
            profile = profile_from_table(frame.stages, side, read_profile(path))
            profile.goals(frame.stages)
        except UserError as problem:
            self._context.notifications.error(problem)
        else:
            self._take(profile)

    def draw(self, section: str, profile: ProfileCurve) -> None:
        """Set a drawn profile as target; an invalid one leaves the previous target."""
        frame = self._context.session.frame
        if frame is None:
            return
        try:
            goals = profile.goals(frame.stages)
        except UserError:
            return
        self._controller.all_wishes.set_curve(section, goals, profile)

    def follow(self, frame: Frame) -> None:
        """Let profiles that are free be those of the body of a frame."""
        from core.analysis.inverse_design.profile_curve import profile_at  # noqa: PLC0415 (few ever ask)

        for section, profile in list(self._controller.drawn.items()):
            if profile.is_unchanged:
                fresh = profile_at(frame.stages, profile.section, frame.all_points)
                self._controller.all_wishes.set_curve(section, (), fresh)

    def in_plane(self, plane: Plane) -> dict[str, Sequence[Floats]]:
        """Return the profiles that are wished in a plane, if any are, as flat places (k, 2) [mm]."""
        from core.analysis.inverse_design.profile_curve import section_to_space  # noqa: PLC0415 (few ever ask)

        frame, drawn = self._context.session.frame, self._controller.drawn.values()
        if frame is None or not self._controller.is_open or plane.axis != "x":
            return {}
        wished = [section_to_space(frame.stages, p.section, p.curve) for p in drawn if not p.is_unchanged]
        found = [plane.flat(places) for places in wished if abs(places[0, 0] - plane.at) < _THROUGH]
        return {"wished": found} if found else {}

    def is_from_side(self, section: str) -> bool:
        """Return whether a profile is viewed about from its side, so that up and out can be dragged."""
        across = self._viewport.view.axes[2][0]
        return bool((across if self._controller.drawn[section].section == "left" else -across) > _SIDEWAYS)

    def hint(self) -> str:
        """Return what to do with the handles, as long as nothing was done."""
        kind = self._controller.handles.kind
        untouched = kind == "profile" and any(each.is_unchanged for each in self._controller.drawn.values())
        if self._controller.goals() and not untouched:
            return ""
        if kind != "profile" and (design := self._controller.ground.design) and not design.lines:
            return tr("Enter a value or drag a handle on the body.")
        hints = {
            "bust": tr("Enter a value or drag the handle at the bust point."),
            "apex": tr("Enter a value or drag the handle at the apex."),
            "profile": tr("Drag the handles of the curve to the target profile."),
        }
        return hints[kind]

    def _take(self, profile: ProfileCurve) -> None:
        self.draw(f"profile {profile.section}", profile)
        self.look_at(profile)
        self.turn_to("profile")
        self._controller.steps.note()

    @property
    def side(self) -> str:
        """Return the side from which the body is looked at, about."""
        return "right" if self._viewport.view.axes[2][0] < -_LEVEL else "left"

    def look_at(self, profile: ProfileCurve) -> None:
        """Show a profile from its side, and beside the tools."""
        from core.analysis.inverse_design.profile_curve import section_to_space  # noqa: PLC0415

        view, viewport, frame = self._context.view, self._viewport, self._context.session.frame
        if frame is None:
            return
        room, tools = max(viewport.height(), 1), view.floating.seen(view.tools).top()
        covered = max(view.height() - tools, 0) if view.tools.isVisible() else 0
        box = box_of(section_to_space(frame.stages, profile.section, profile.curve))
        # As large as the part of the picture allows that the tools leave.
        middle, half = box[2].mean(), 0.5 * (np.ptp(box[2]) + 2.0 * _BESIDE) * room / (room - covered)
        box[2] = middle - half, middle + half
        framed = viewport.view.named(profile.section).framing(box, viewport.width() / room)
        # Seen in parallel the body's outline lies where the curve does, however near it is looked at.
        self._controller.back.look(replace(framed.pan(0.0, -0.5 * covered, room), parallel=True))
