"""Seams moved by hand: a point is another word in the block, tried while dragged, one step when dropped."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.i18n.catalog import number, tr
from app.i18n.lengths import length, length_number, length_unit
from app.presenters.messages import own_title
from app.presenters.pattern import piece_title, seam_title
from core.document.block import Block, Seam, without_side
from core.document.cloth import Cloth
from core.document.garment_pattern import GarmentPattern
from core.errors import UserError
from core.geometry.mesh import Points
from core.geometry.plane_sections import arc_length, interpolate
from core.messages import ClothName
from core.pattern.block_library import built_in_blocks
from core.pattern.cloth_library import built_in, with_cloth

if TYPE_CHECKING:
    from app.gui.context import AppContext
    from app.gui.features.pattern.controller import PatternController
    from core.pattern.garment import CutGarment, Pattern
    from core.pattern.seam_curves import SeamDrawing


@dataclass(frozen=True, eq=False)
class Walked:
    """A place of a seam on the body, ``places`` (k, 3) [mm], and the lengths up to it in ``words``."""

    places: Points
    words: str


class SeamEditing(QObject):
    """Edits of seams and pieces of the plan; ``trial`` is the plan while a point is dragged.

    ``carrying_changed`` is emitted when a drag begins and ends.
    """

    carrying_changed = Signal()

    def __init__(self, context: AppContext, controller: PatternController) -> None:
        super().__init__(controller)
        self._session, self._controller = context.session, controller
        self._notifications = context.notifications
        self.trial: GarmentPattern | None = None
        self._plan: GarmentPattern | None = None  # that the drag began with
        layer, panel = controller.layer, controller.panel
        layer.moved.connect(self._move)
        layer.dropped.connect(self._drop)
        layer.cancelled.connect(self._cancel)
        layer.handle_chosen.connect(self._show_handle)
        layer.point_requested.connect(self.add_point)
        layer.point_removed.connect(self.remove_point)
        card = panel.seam_card
        card.point_requested.connect(self.add_point)
        card.point_removed.connect(self.remove_point)
        card.seam_removed.connect(self.remove_seam)
        card.notch_requested.connect(self.add_notch)
        card.notches_changed.connect(self.set_notches)
        card.allowance_changed.connect(self.set_allowance)
        card.reset_requested.connect(self.reset)
        card.apart_changed.connect(self.set_apart)
        panel.piece_card.cloth_chosen.connect(self.choose_cloth)
        panel.piece_card.turn_changed.connect(self.turn)

    @property
    def carries(self) -> bool:
        """Return whether a hand has hold of a point of a seam."""
        return self._controller.layer.carries

    def let_go(self) -> bool:
        """Cancel a drag and move the seam back; returns whether there was one."""
        had = self.trial is not None
        self._controller.layer.release()
        self._cancel()
        return had

    def check(self, plan: GarmentPattern | None) -> None:
        """Cancel a drag that began with another plan than that of the design."""
        if self.trial is not None and plan is not self._plan:
            self.let_go()

    # -- a point of the selected seam

    def handles(self) -> Points:
        """Return the points of the selected seam on the body at rest, (h, 3) [mm]."""
        result, plan, name = self._controller.result, self._controller.plan, self._controller.seam
        if result is None or plan is None or self.seam(plan.block, name) is None:
            return np.empty((0, 3))
        from core.pattern.seam_moves import handles_of  # noqa: PLC0415 (takes 0.1 s to load)

        try:
            garment = result.pattern.garment
            found = handles_of(result.drawing, garment.block, name, garment.curves)
        except (UserError, KeyError):  # of a seam that the shown pieces do not have yet
            return np.empty((0, 3))
        return np.array([place for _, place in found]).reshape(-1, 3)

    def _move(self, number_: int, place: Points) -> None:
        """Try the plan with a point of the seam at a place of the body at rest, (3,) [mm]."""
        controller, plan = self._controller, self._controller.plan
        if controller.result is None or plan is None:
            return
        from core.pattern.seam_moves import moved_block  # noqa: PLC0415 (takes 0.1 s to load)

        if self.trial is None:
            self._plan = plan
            self.carrying_changed.emit()
        try:
            block = moved_block(controller.result.drawing, plan.block, controller.seam, number_, place)
            self.trial = replace(plan, block=block)
        except UserError as error:
            self._notifications.error(error, "pattern")
            return
        if self._session.frame is not None:
            controller.follow(self._session.frame)

    def _drop(self) -> None:
        trial, self.trial = self.trial, None
        self.carrying_changed.emit()
        if trial is not None:
            seam = trial.block.seam(self._controller.seam)
            title = seam_title(self._controller.seam if seam.right else seam.name)
            self._controller.change(tr("{seam} moved").format(seam=title), block=trial.block)

    def _cancel(self) -> None:
        if self.trial is None:
            return
        self.trial = None
        self.carrying_changed.emit()
        if self._session.frame is not None:
            self._controller.follow(self._session.frame)

    def seam(self, block: Block, name: str) -> Seam | None:
        """Return the seam of a curve, None for an unknown name."""
        try:
            return block.seam(name)
        except KeyError:
            return None

    def is_moved(self, block: Block, seam: Seam) -> bool:
        """Return whether a seam lies elsewhere than in the block that comes with Busk."""
        original = _original(block)
        return original is not None and self.seam(original, seam.name) not in (None, seam)

    def reset(self) -> None:
        """Move the points of the selected seam back."""
        plan, name = self._controller.plan, self._controller.seam
        original = None if plan is None else _original(plan.block)
        seam = None if original is None else self.seam(original, name)
        if seam is not None:
            self._edit_seam(seam, tr("{seam} reset").format(seam=seam_title(name)))

    def set_apart(self, apart: bool) -> None:
        """Give each side of the selected seam places of its own, or those of the left side to both."""
        plan, name = self._controller.plan, self._controller.seam
        if plan is None or self.seam(plan.block, name) is None:
            return
        text = tr("{seam}: sides separate") if apart else tr("{seam}: sides symmetric")
        block = plan.block.with_own_sides(name, apart)
        self._controller.change(text.format(seam=seam_title(plan.block.seam(name).name)), block=block)

    def set_allowance(self, mm: float | None) -> None:
        """Set the allowance of the selected seam [mm], None for that of the pattern."""
        plan, name = self._controller.plan, self._controller.seam
        seam = None if plan is None else self.seam(plan.block, name)
        if seam is not None:
            amount = tr("default") if mm is None else length(mm, 1)
            text = tr("Allowance of {seam}: {amount}").format(seam=seam_title(name), amount=amount)
            self._edit_seam(replace(seam, allowance=mm), text)

    def _edit_seam(self, seam: Seam, text: str) -> None:
        plan = self._controller.plan
        assert plan is not None
        self._controller.change(text, block=plan.block.with_seam(seam))

    # -- points, notches, and the whole seam

    def _show_handle(self) -> None:
        """Let the selected point be removed, if it is not an end."""
        layer = self._controller.layer
        inner = layer.handle is not None and 0 < layer.handle < len(self.handles()) - 1
        self._controller.panel.seam_card.remove_point.setEnabled(inner)

    def add_point(self, place: Points | None = None) -> None:
        """Add a point to the selected seam, at a place (3,) [mm] or in the middle of its longest stretch."""
        from core.pattern.seam_edits import with_point  # noqa: PLC0415 (takes 0.1 s to load)

        self._change_block(
            tr("Point added: {seam}"),
            lambda garment, drawing, name: with_point(drawing, garment.block, name, garment.curves, place),
        )

    def remove_point(self) -> None:
        """Remove the selected point of the seam."""
        from core.pattern.seam_edits import without_point  # noqa: PLC0415 (takes 0.1 s to load)

        number_ = self._controller.layer.handle
        if number_ is not None:
            self._change_block(
                tr("Point removed: {seam}"),
                lambda garment, _, name: without_point(garment.block, name, number_),
            )

    def remove_seam(self) -> None:
        """Remove the selected seam; the pieces on both sides of it become one."""
        from core.pattern.seam_edits import without_seam  # noqa: PLC0415 (takes 0.1 s to load)

        self._change_block(tr("{seam} removed"), lambda garment, _, name: without_seam(garment, name))

    def add_notch(self, share: float) -> None:
        """Add a notch to the selected seam at a share of its length [1]."""

        def changed(garment: CutGarment, _: SeamDrawing, name: str) -> Block:
            seam, result = garment.block.seam(name), self._controller.result
            assert result is not None
            sewn = next(each for each in result.pattern.matched.seams if each.name == name)
            pattern = result.pattern
            side = pattern.flats[sewn.panels[0]].panel.name, sewn.sides[0]
            shares = (min(max(share, 0.01), 0.99), *pattern.notches[side])
            notches = {round(pattern.notch_share(sewn, each), 3) for each in shares}
            return garment.block.with_seam(replace(seam, notches=tuple(sorted(notches))))

        self._change_block(tr("Notch added: {seam}"), changed)

    def set_notches(self, notches: tuple[float, ...] | None) -> None:
        """Set the notches of the selected seam: none, or the usual ones for None."""

        def changed(garment: CutGarment, _: SeamDrawing, name: str) -> Block:
            return garment.block.with_seam(replace(garment.block.seam(name), notches=notches))

        self._change_block(tr("Notches changed: {seam}"), changed)

    def _change_block(self, text: str, change: Callable[[CutGarment, SeamDrawing, str], Block]) -> None:
        """Change the block by the selected seam as one undo step; a refusal is shown and changes nothing."""
        controller = self._controller
        result, name = controller.result, controller.seam
        if result is None or not name or not controller.is_current():
            return
        try:
            block = change(result.pattern.garment, result.drawing, name)
        except (UserError, KeyError) as error:
            self._notifications.error(error, "pattern")
            return
        controller.change(text.format(seam=seam_title(without_side(name)[0])), block=block)

    # -- the selected piece

    def choose_cloth(self, name: str) -> None:
        """Cut the selected piece, and that of the other side, from a cloth that is known by its name."""
        plan = self._controller.plan
        if plan is not None:
            self.use_cloth({each.name: each for each in (*built_in(), *plan.cloths)}[name])

    def use_cloth(self, cloth: Cloth) -> None:
        """Cut the selected piece, and that of the other side, from a cloth."""
        plan, piece = self._controller.plan, self._controller.piece
        if plan is not None and piece:
            title = own_title(ClothName(cloth.title))
            text = tr("Cloth of {piece}: {cloth}").format(piece=_both(piece), cloth=title)
            self._controller.set_plan(with_cloth(plan, without_side(piece)[0], cloth), text)

    def turn(self, degrees: float) -> None:
        """Turn the grain line of the selected piece [degrees]."""
        text = tr("Grain line of {piece}: {turn}°")
        self._edit_panel(
            text.format(piece=_both(self._controller.piece), turn=number(degrees, 0)), turn=degrees
        )

    def _edit_panel(self, text: str, **changes: object) -> None:
        plan, piece = self._controller.plan, self._controller.piece
        if plan is None:
            return
        base = without_side(piece)[0]
        panels = tuple(
            replace(each, **changes) if each.name in (piece, base) else each  # type: ignore[arg-type]
            for each in plan.block.panels
        )
        self._controller.change(text, block=replace(plan.block, panels=panels))

    # -- walking

    def walked(self, pattern: Pattern, name: str, share: float) -> Walked:
        """Return the place at a share of the length of a seam, on the body and on its pieces."""
        places, lengths = [], []
        for seam in pattern.matched.seams:
            if seam.name != name:
                continue
            curve = pattern.places[seam.panels[0]][seam.points[0]]
            along = arc_length(curve)
            places.append(interpolate(np.array([share * along[-1]]), along, curve)[0])
            sides = zip(seam.panels, seam.sides, strict=True)
            lengths.append([share * pattern.flats[panel].side_length(side) for panel, side in sides])
        words = " / ".join(f"{length_number(one, 1)} | {length_number(two, 1)}" for one, two in lengths)
        return Walked(np.array(places).reshape(-1, 3), f"{words} {length_unit()}" if words else "")


def _original(block: Block) -> Block | None:
    return next((each for each in built_in_blocks() if each.name == block.name), None)


def _both(piece: str) -> str:
    return piece_title(without_side(piece)[0])
