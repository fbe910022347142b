"""Pattern pieces of the shown body: their block, seams and cloths are edited, and the pieces follow."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.gui.features.pattern.exporting import PatternExport
from app.gui.features.pattern.garment_layer import GarmentLayer, GarmentSeams, vertex_colours
from app.gui.features.pattern.panel import PatternPanel
from app.gui.features.pattern.piece_fixes import PieceFixes
from app.gui.features.pattern.pieces_view import PiecesView, strain_ramp
from app.gui.features.pattern.seam_drawing import SeamDrawTool
from app.gui.features.pattern.seam_editing import SeamEditing
from app.gui.features.pattern.worker import PatternRequest, PatternResult, PatternWorker
from app.gui.theme.stylesheet import tokens_of
from app.i18n.catalog import number, tr
from app.i18n.lengths import length
from app.presenters.messages import render
from app.presenters.pattern import block_about, block_title, seam_title
from app.presenters.status import display_state, is_result, state_title
from core.document.block import Block, without_side
from core.document.design import Design
from core.document.garment_pattern import GarmentPattern
from core.document.lower_trunk import LowerTrunk
from core.errors import UserError
from core.pattern.block_library import built_in_blocks, find_block
from core.pattern.cloth_library import built_in
from core.pipeline.frame import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext

STEP = "pattern"

MARGIN = 15.0
"""What is seen round a garment when its block is chosen [mm]."""


class PatternController(QObject):
    """Show the pieces of the session's frame while the step is open; ``changed`` when there are others,
    ``selected`` when another piece or seam is.

    ``result`` is what is shown, of the present frame or a former one.
    """

    changed = Signal()
    selected = Signal()

    def __init__(self, context: AppContext, panel: PatternPanel, view: PiecesView) -> None:
        super().__init__(context.session)
        self._context, self._session = context, context.session
        self.panel, self.view = panel, view
        self.layer = GarmentLayer(context)
        self.worker = PatternWorker(context.jobs, self)
        self.result: PatternResult | None = None
        self._failure = ""
        self.piece = self.seam = ""
        self.is_open = False
        self._framed = ""  # the block that the camera was moved to
        self.editing = SeamEditing(context, self)
        self.drawing = SeamDrawTool(context, self)
        self.files, self.fixes = PatternExport(context, self), PieceFixes(context, self)
        panel.set_blocks([(each.name, block_title(each), block_about(each)) for each in built_in_blocks()])
        self._connect()
        self._add_actions()

    def _connect(self) -> None:
        panel, view, layer, session = self.panel, self.view, self.layer, self._session
        self.worker.computed.connect(self._take)
        self.worker.failed.connect(self._fail)
        self.worker.stopped.connect(self._stop)
        session.design_changed.connect(self._follow_design)
        session.opened.connect(lambda _: self._forget())
        self._context.navigation.step_shown.connect(self._show_step)
        self._context.view.compared.connect(self._draw_garment)
        panel.block_chosen.connect(lambda name: self.choose_block(find_block(name)))
        panel.removed.connect(self.remove)
        panel.compute.clicked.connect(self._compute)
        panel.piece_chosen.connect(self.select_piece)
        panel.allowance_changed.connect(self.set_allowance)
        panel.bridged_changed.connect(self.set_bridged)
        panel.lines_requested.connect(lambda: self._context.navigation.show_panel("lines"))
        for each in (view, layer):
            each.piece_chosen.connect(self.select_piece)
            each.seam_chosen.connect(self.select_seam)
        view.seam_hovered.connect(layer.hover)
        view.theme_changed.connect(self._show_theme)
        layer.seam_hovered.connect(view.hover)
        panel.seam_card.walked.connect(self._walk)
        panel.seam_card.joined_changed.connect(view.join)

    def _add_actions(self) -> None:
        """List the blocks in the menu of lines, so that each can be asked for by its name."""
        do = self._context.actions
        do.submenu("lines", "blocks", tr("Pattern pieces"))
        for block in built_in_blocks():
            action = do.add("blocks", block_title(block), of_document=True)
            action.triggered.connect(lambda _=False, block=block: self._choose_and_show(block))
        do.rule("blocks")
        do.add("blocks", tr("Draw seam or dart"), do=self._draw, of_document=True)
        do.add("blocks", tr("Export pieces…"), do=self._export, of_document=True)

    def _choose_and_show(self, block: Block) -> None:
        self._context.navigation.show_step(STEP)
        self.choose_block(block)

    def _draw(self) -> None:
        self._context.navigation.show_step(STEP)
        self.drawing.begin()

    def _export(self) -> None:
        self._context.navigation.show_step(STEP)
        if self.plan is not None:
            self.files.show()

    # -- what is decided

    @property
    def plan(self) -> GarmentPattern | None:
        """Return the plan of the session's design, or the one that a hand tries."""
        design = self._session.design
        return self.editing.trial or (None if design is None else design.pattern)

    def choose_block(self, block: Block) -> None:
        """Make the pieces by another block."""

        def chosen(design: Design) -> Design:
            lower = design.lower or (LowerTrunk() if block.needs_lower_trunk else None)
            former = design.pattern
            plan = GarmentPattern(block) if former is None else replace(former, block=block)
            return replace(design, lower=lower, pattern=plan)

        self._session.edit(chosen, tr("Pattern: {block}").format(block=block_title(block)))

    def remove(self) -> None:
        """Remove the pattern from the design."""
        self._session.edit(lambda design: replace(design, pattern=None), tr("Pattern removed"))

    def change(self, text: str, what: str = "", **changes: object) -> None:
        """Change fields of the plan as one undo step."""

        def changed(design: Design) -> Design:
            if design.pattern is None:
                return design
            return replace(design, pattern=replace(design.pattern, **changes))  # type: ignore[arg-type]

        self._session.edit(changed, text, what)

    def set_plan(self, plan: GarmentPattern, text: str) -> None:
        """Take another plan as one undo step."""
        self._session.edit(lambda design: replace(design, pattern=plan), text)

    def set_allowance(self, mm: float) -> None:
        """Set the allowance of seams without their own [mm]."""
        self.change(tr("Seam allowance {length}").format(length=length(mm, 1)), "allowance", allowance=mm)

    def set_bridged(self, on: bool) -> None:
        """Let the cloth span hollows or lie in them."""
        self.change(tr("Bridge hollows") if on else tr("Do not bridge hollows"), bridged=on)

    # -- what is shown

    def follow(self, frame: Frame) -> None:
        """Compute the pieces of a frame, if the step is open."""
        plan = self.plan
        if not self.is_open or plan is None:
            return
        if plan.block.needs_lower_trunk and frame.stages.lower is None and not self._session.is_converged:
            self._show_state()  # that region is being built
            return
        final = self._session.is_converged and self.editing.trial is None
        if self.result is not None and final and self._is_of(frame, plan):
            self._show()
            return
        self.panel.compute.hide()
        self.worker.submit(PatternRequest(frame, plan, final))
        self._show_state()

    def is_current(self) -> bool:
        """Return whether the pieces are those of the present design, solved to the end."""
        frame, plan = self._session.frame, self.plan
        if frame is None or plan is None or self.result is None:
            return False
        return self._session.is_converged and self._is_of(frame, plan)

    def _is_of(self, frame: Frame, plan: GarmentPattern) -> bool:
        """Return whether the result is a final one of a body like that of a frame."""
        if self.result is None or not self.result.request.final or self.result.request.plan != plan:
            return False
        made = self.result.request.frame
        same = made.stages.body is frame.stages.body and made.stages.landmarks is frame.stages.landmarks
        return same and np.array_equal(made.points, frame.points)

    def _show_step(self, step: str) -> None:
        self.is_open = step == STEP
        self.view.setVisible(self.is_open)
        self._framed = ""
        if not self.is_open:
            self.editing.let_go()
            self.layer.end()
            return
        self.layer.begin()
        if self._session.design is not None:
            self._follow_design(self._session.design)

    def _follow_design(self, design: Design) -> None:
        plan = design.pattern
        self.editing.check(plan)
        self.panel.show_plan(plan, "" if plan is None else block_title(plan.block))
        self._failure = ""
        if plan is None:
            self.worker.cancel()
            self.result = None
            self.select_piece("")
            self._show()
        elif self._session.frame is not None:
            self.follow(self._session.frame)

    def _forget(self) -> None:
        self.editing.let_go()
        self.worker.cancel()
        self.result, self.piece, self.seam = None, "", ""
        self._show()

    def _take(self, result: PatternResult) -> None:
        """Show new pieces; those of a former shape are shown too while a newer one is being made."""
        if self.plan is None or not self.is_open:
            return
        self.result, self._failure = result, ""
        self._show()
        self.changed.emit()
        frame = self._session.frame
        if frame is not None and not self.worker.at_work and not self.is_current():
            self._request_again(frame, result)

    def _request_again(self, frame: Frame, result: PatternResult) -> None:
        """Make the pieces that are to be cut, once nothing moves any more."""
        plan, final = self.plan, self._session.is_converged and self.editing.trial is None
        if plan is not None and (final or plan != result.request.plan):
            self.worker.submit(PatternRequest(frame, plan, final))

    def _fail(self, request: PatternRequest, error: Exception) -> None:
        if request.plan != self.plan:
            return
        if not isinstance(error, UserError):
            self._context.notifications.error(error)
            self._failure = tr("The pieces could not be computed.")
        else:
            self._failure = render(error.text)
        if not self.editing.carries:
            self.result = None
        self._show()

    def _stop(self) -> None:
        """Show that the user has cancelled the computation."""
        self._failure = tr("The computation of the pieces was cancelled.")
        self.panel.compute.show()
        self._show_state()

    def _compute(self) -> None:
        self._failure = ""
        if self._session.frame is not None:
            self.follow(self._session.frame)

    def _show(self) -> None:
        """Show the present result."""
        result = self.result
        if result is None:
            self.view.show_pieces((), {}, {})
            self.panel.show_pieces((), faint=False, selected="")
            self.layer.clear()
        else:
            rows = {row.name: row for row in result.pieces}
            if self.piece and self.piece not in rows:
                self.select_piece("")
            titles = {name: row.title for name, row in rows.items()}
            values = {name: f"{number(row.strain_percent, 1)} %" for name, row in rows.items()}
            self.view.show_pieces(result.shapes, titles, values)
            self.panel.show_pieces(tuple(rows.values()), faint=not self.is_current(), selected=self.piece)
            self._draw_garment()
        self._show_state()
        self._show_selection()

    def _show_state(self) -> None:
        """Show whether the pieces are those of the present shape, and what they are worth."""
        result, plan = self.result, self.plan
        current = self.is_current()
        self.view.set_faint(result is not None and not current and not self.editing.carries)
        for each in (
            self.panel.export,
            self.panel.draw,
            self.panel.seam_card.edit,
            self.panel.seam_card.notches,
        ):
            each.setEnabled(current)
        if plan is None:
            self.view.show_words(tr("Choose a garment block to see its pieces here."))
        elif self._failure:
            self.view.show_words("" if result is not None else self._failure)
            self.panel.show_verdict(self._failure, "warn")
        elif result is None:
            self.view.show_words(tr("Computing pattern pieces…"))
            self.panel.show_verdict("", "")
        else:
            self.view.show_words("")
            self._show_verdict(result, current)

    def _show_verdict(self, result: PatternResult, current: bool) -> None:
        if not current:
            self.panel.show_verdict(tr("Solver not converged: pieces may change"), "faint")
            return
        if doubt := self.doubt():
            self.panel.show_verdict(doubt, "bad")
            return
        tight = sum(not row.fits for row in result.pieces)
        note = tr("{count} pieces. Seam lengths match within {length}.").format(
            count=len(result.pieces), length=length(max(result.pattern.matched.off, 0.01), 2)
        )
        if tight:
            words = (
                tr("{count} pieces do not fit their cloth.")
                if tight > 1
                else tr("A piece does not fit its cloth.")
            )
            self.panel.show_verdict(words.format(count=tight), "warn", note)
        else:
            self.panel.show_verdict(tr("All pieces fit their cloths."), "ok", note)

    def _draw_garment(self) -> None:
        if self.result is None or not self.is_open or not self._context.view.after:
            self.layer.clear()
            return
        pattern, dark = self.result.pattern, tokens_of(self.view).dark
        ramps = [
            strain_ramp(pattern.cloths[flat.panel.cloth].limit, dark)(flat.largest) for flat in pattern.flats
        ]
        seams, framed = GarmentSeams.of(pattern), self._framed
        self.layer.show(seams, vertex_colours(pattern, ramps))
        self._framed = pattern.garment.block.name
        if self._framed != framed:
            self._context.view.viewport.frame_points(seams.points, MARGIN)

    def _show_theme(self) -> None:
        self.layer.set_dark(tokens_of(self.view).dark)
        self._draw_garment()

    # -- what is selected

    def select_piece(self, name: str) -> None:
        """Select a piece and no seam, or nothing."""
        self.piece, self.seam = name, ""
        self._show_selection()
        self.selected.emit()

    def select_seam(self, name: str) -> None:
        """Select a seam by the name of its curve, or nothing."""
        self.seam = name
        self.piece = "" if name else self.piece
        self.panel.seam_card.knob.setValue(0)
        self._show_selection()
        self.selected.emit()

    def _show_selection(self) -> None:
        result, plan = self.result, self.plan
        if result is None or plan is None:
            self.panel.piece_card.hide()
            self.panel.seam_card.hide()
            return
        self.view.select(self.piece, self.seam)
        self.panel.select_piece(self.piece)
        self._show_piece(result, plan)
        self._show_seam(result, plan)
        self.layer.select(self.seam, self.editing.handles())

    def _show_piece(self, result: PatternResult, plan: GarmentPattern) -> None:
        row = next((row for row in result.pieces if row.name == self.piece), None)
        panel = next((each for each in plan.block.panels if each.name == without_side(self.piece)[0]), None)
        if row is None or panel is None:
            self.panel.piece_card.hide()
            return
        cloths = (*built_in(), *plan.cloths)
        self.panel.piece_card.show_piece(row, cloths, panel.cloth, panel.turn)

    def _show_seam(self, result: PatternResult, plan: GarmentPattern) -> None:
        seam = self.editing.seam(plan.block, self.seam)
        if seam is None:
            self.panel.seam_card.hide()
            self.view.walk(None)
            self.layer.walk(np.empty((0, 3)))
            return
        seams = result.seams
        rows = None if seams is None else [row for row in seams if row.name == self.seam]
        moved = self.editing.is_moved(plan.block, seam)
        title = seam_title(self.seam)
        self.panel.seam_card.show_seam(title, rows, seam, plan.allowance, can_reset=moved)
        self._walk(self.panel.seam_card.knob.value() / max(self.panel.seam_card.knob.maximum(), 1))

    def _walk(self, share: float) -> None:
        """Show the same place of the selected seam on the body and on its pieces."""
        result = self.result
        if result is None or not self.seam:
            return
        walked = self.editing.walked(result.pattern, self.seam, share)
        self.view.walk(share)
        self.layer.walk(walked.places)
        self.panel.seam_card.show_walked(walked.words)

    # -- files

    def doubt(self) -> str:
        """Return why the reshaped body is no shape to cut by, empty where it is one."""
        frame = self._session.frame
        if frame is None or is_result(frame):
            return ""
        words = tr("{state}: do not use this shape for production.")
        return words.format(state=state_title(display_state(frame)))

    def stem(self) -> str:
        """Return the name that files of the pieces begin with."""
        plan = self.plan
        return f"{self._session.name}-{plan.block.name}" if plan is not None else self._session.name
