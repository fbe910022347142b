"""The lines: shown in a list, and edited there."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import partial, reduce
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt

from app.gui.features.lines.panel import LinesPanel
from app.i18n.catalog import number, tr
from app.presenters.lines import Shown, line_views, pair_title, row_title
from app.presenters.messages import kind_of, render_all
from app.presenters.pressure import line_pressure_view
from core.control_mesh.template import read_template
from core.document.design import Design
from core.document.lines import partner_of
from core.document.lower_trunk import LowerTrunk, line_group
from core.document.split_lines import is_split, split
from core.garment.pressure_list import PressureList
from core.pipeline.live_solver import Frame

if TYPE_CHECKING:
    from app.gui.context import AppContext


@dataclass(frozen=True)
class LineSources:
    """Return what other features know of the lines of a frame.

    ``limits`` of their lengths, their ``pressures`` if there are any, and whether the lengths of lines in a
    design are those of a proposal (``is_on_trial``).
    """

    limits: Callable[[Frame], Mapping[str, Shown]]
    pressures: Callable[[Frame], PressureList | None]
    is_on_trial: Callable[[tuple[str, ...], Design], bool]


class LinesController(QObject):
    """Show the list of lines, and carry out its commands; a linked pair is treated as one line."""

    def __init__(self, context: AppContext, panel: LinesPanel, sources: LineSources) -> None:
        super().__init__(context.session)
        self._context, self._panel, self.sources = context, panel, sources
        self._session = context.session
        self._frame: Frame | None = None
        self._parted: set[str] = set()
        self._add_actions()
        panel.opened.connect(self.show_rows)
        panel.length_previewed.connect(context.session.preview_line)
        panel.length_committed.connect(self.commit_length)
        panel.drag_cancelled.connect(lambda _: context.session.cancel_preview())
        panel.selected.connect(context.selection.select_line)
        panel.visibility_changed.connect(self.set_visible)
        panel.decided.connect(self.decide)
        panel.reset_all.connect(context.session.reset_lines)
        panel.removed.connect(self.remove)
        panel.lower_trunk_requested.connect(self.add_lower_trunk)
        context.selection.line_selected.connect(panel.select)
        context.actions.reset.triggered.connect(context.session.reset_lines)

    def show_frame(self, frame: Frame) -> None:
        """Show the lines of a frame."""
        self._frame = frame
        self.show_rows()
        self._go_on_in_halves(frame)

    def _go_on_in_halves(self, frame: Frame) -> None:
        """Select the left half of a line that was split while it was selected, and the line once it is whole.

        What is only tried on changes nothing.
        """
        design, selected = frame.stages.design, self._context.view.selected_line
        if design is not self._session.design:
            return
        before, self._parted = self._parted, {name for name in frame.lengths if is_split(design, name)}
        whole = kind_of(selected)
        if selected in self._parted - before:
            self._context.selection.select_line(f"{selected} left")
        elif selected not in frame.lengths and whole in frame.lengths:
            self._context.selection.select_line(whole)

    def show_rows(self) -> None:
        """Show the rows anew: something was hidden, or more is known of limits or pressures."""
        frame = self._frame
        if frame is not None:
            hidden, design = self._context.view.hidden_lines, frame.stages.design
            if self._session.failure is not None:
                design = self._session.design or design  # what is set, though it could not be computed
            views = line_views(design, frame, hidden, self.sources.limits(frame))
            pressed = self.sources.pressures(frame) if self._panel.isVisible() else None
            tried, design = self.sources.is_on_trial, frame.stages.design
            views = [replace(view, tried=tried(view.names, design)) for view in views]
            self._panel.set_lines([line_pressure_view(view, pressed) for view in views])
            problem = frame.stages.lower_problem
            why_not = "" if problem is None else " ".join(render_all([problem.message, problem.hint]))
            self._panel.show_lower_trunk(offered=design.lower is None, why_not=why_not)

    def commit_length(self, name: str, ratio: float) -> None:
        """Set the length of a line and its linked partner."""
        if self._session.design is not None:
            self._session.commit_line(name, row_title(name, self._session.design), ratio)

    def decide(self, name: str, trait: str, value: object) -> None:
        """Set a trait of a line and its linked partner as one undo step."""
        design = self._session.design
        if design is None:
            return
        sides = {line.name for line in design.own_lines}
        if trait == "linked" and not value and partner_of(name) not in sides and line_group(name) == "bust":
            self._split(name, design)
            return
        if trait == "over_shoulder":
            self._lead_over_shoulder(name, design, bool(value))
            return
        if trait == "linked":
            names: tuple[str, ...] = (name, partner_of(name))
            text = self._linked_text(design, name, bool(value))
        else:
            names, text = design.linked_lines(name), _text(row_title(name, design), trait, value)

        def decided(before: Design) -> Design:
            if trait == "linked" and value:
                return before.with_link(name)
            return reduce(lambda d, each: _with_trait(d, each, trait, value), names, before)

        self._session.edit(decided, text)

    def add_lower_trunk(self) -> None:
        """Let the design have lines below the bust."""
        text = tr("Waist, hips and seat added")
        self._session.edit(lambda design: replace(design, lower=design.lower or LowerTrunk()), text)

    def set_visible(self, name: str, visible: bool) -> None:
        """Show or hide the bands of a line and its linked partner."""
        if self._session.design is not None:
            for each in self._session.design.linked_lines(name):
                self._context.view.set_line_visible(each, visible)
            self.show_rows()

    def remove(self, name: str) -> None:
        """Remove a line and its linked partner."""
        design = self._session.design
        if design is None:
            return
        text = tr("{line} removed").format(line=row_title(name, design))
        names = design.linked_lines(name)
        self._session.edit(lambda before: reduce(Design.without_custom_line, names, before), text)
        left = self._session.design
        if left is not None and left is not design:
            self._context.selection.select_line("mid-bust")

    def _lead_over_shoulder(self, name: str, design: Design, over: bool) -> None:
        """Let a line and its linked partner run on over the shoulder, or end on the upper chest."""
        text = tr("{line}: extended over shoulder") if over else tr("{line}: ends at upper chest")
        text = text.format(line=row_title(name, design))
        names = design.linked_lines(name)

        def led(before: Design) -> Design:
            lines = (line for line in before.own_lines if line.name in names)
            after = (replace(line, over_shoulder=over) for line in lines)
            return reduce(Design.with_custom_line, after, before)

        self._session.edit(led, text)

    def _split(self, name: str, design: Design) -> None:
        """Split a line that goes across both sides, and select its left half."""
        text = tr("{line} split into left and right").format(line=row_title(name, design))
        template = read_template(design.template)
        self._session.edit(lambda before: split(before, template, name), text)
        self._context.selection.select_line(f"{name} left")

    def _linked_text(self, design: Design, name: str, linked: bool) -> str:
        words = tr("{line} linked") if linked else tr("{line}: left and right unlinked")
        return words.format(line=pair_title(name, design))

    def _add_actions(self) -> None:
        """Offer what can be done with the selected line; the keys are those of the menu."""
        do = self._context.actions
        do.rule("lines")
        for text, key, act in (
            (tr("Rename"), "F2", "rename"),
            (tr("Show or hide"), "H", "hide"),
            (tr("Lock or unlock"), "Shift+L", "lock"),
            (tr("Link or unlink"), "L", "link"),
            (tr("Split into left and right"), None, "split"),
        ):
            do.add("lines", text, key, do=partial(self._row_asked, act), of_document=True)
        sentence = tr("Built-in lines cannot be removed. Set a line to 100 % to deactivate it.")
        remove = do.add("lines", tr("Remove line"), "Del", sentence, do=partial(self._row_asked, "remove"))
        # Elsewhere the key takes other things away.
        remove.setShortcutContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        self._panel.addAction(remove)

    def _row_asked(self, what: str) -> None:
        self._context.navigation.show_step("lines")
        self._panel.do(what)


def _with_trait(design: Design, name: str, trait: str, value: object) -> Design:
    return design.with_line_settings(replace(design.line_settings(name), **{trait: value}))  # type: ignore[arg-type]


def _text(title: str, trait: str, value: object) -> str:
    """Return what an edit of a trait is called."""
    if trait == "locked":
        return (tr("{line} locked") if value else tr("{line} unlocked")).format(line=title)
    if trait == "title":
        return tr("{line} renamed").format(line=title)
    if trait == "colour":
        return tr("{line}: colour changed").format(line=title)
    if value is None:
        return tr("{line}: stiffness from model").format(line=title)
    return tr("{line}: stiffness {value}").format(line=title, value=number(float(str(value)), 1))
