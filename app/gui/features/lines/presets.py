"""Presets: named sets of lines are applied, and the lines of a design are saved as one."""

from __future__ import annotations

from functools import partial
from itertools import chain, count
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from app.gui.features.lines.panel import LinesPanel
from app.gui.widgets.dialog import ask, ask_name
from app.gui.widgets.menu import pull_down
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import listed, tr
from app.presenters.lines import row_title
from app.presenters.messages import preset_note, preset_title, render
from core.document.design import Design
from core.document.lines import LONGEST_TITLE
from core.errors import UserError
from core.garment.presets import (
    Preset,
    built_in,
    is_active,
    preset_from,
    save_preset,
    user_file,
    user_presets,
    with_preset,
)

if TYPE_CHECKING:
    from app.gui.context import AppContext


class PresetsController(QObject):
    """Fill the menu of presets, each time anew: files may have come."""

    def __init__(self, context: AppContext, panel: LinesPanel) -> None:
        super().__init__(context.session)
        self._context, self._head = context, panel.head
        panel.presets_requested.connect(self.show_menu)
        self._known: tuple[Preset, ...] = ()
        self._menu = context.actions.submenu("lines", "presets", tr("Presets"))
        self._menu.aboutToShow.connect(self.fill)
        # Not at the start: a designer's files are no reason to come up late, or not at all.
        context.session.opened.connect(self._fill_and_show)
        context.session.design_changed.connect(self.show_worn)

    def fill(self) -> None:
        """List our presets, one's own, those that cannot be read, and how to keep one."""
        menu = self._menu
        menu.clear()
        opened = self._context.session.design is not None
        own, problems = user_presets()
        self._known = (*built_in(), *own)
        for group in (built_in(), own):
            for preset in group:
                action = menu.addAction(preset_title(preset), partial(self.wear, preset))
                set_tip(action, preset_note(preset) if preset.leaves_out else "")
                action.setEnabled(opened)
            menu.addSeparator()
        for problem in problems:
            action = menu.addAction(render(problem.message))
            set_tip(action, render(problem.hint))
            action.setEnabled(False)
        menu.addAction(tr("Save as preset…"), self.ask).setEnabled(opened)

    def show_menu(self) -> None:
        """Show the menu of presets above the list of lines."""
        pull_down(self._menu, self._head.presets)

    def _fill_and_show(self, _: object) -> None:
        self.fill()
        if self._context.session.design is not None:
            self.show_worn(self._context.session.design)

    def show_worn(self, design: Design) -> None:
        """Show the active preset above the list, and what it omits."""
        worn = next((each for each in self._known if _goes(each, design) and is_active(design, each)), None)
        leaves_out = preset_note(worn) if worn is not None and worn.leaves_out else ""
        self._head.show_preset(preset_title(worn) if worn is not None else "", leaves_out)

    def wear(self, preset: Preset) -> None:
        """Replace the present lines by those of a preset; show what it omits."""
        session = self._context.session
        before = session.design
        if before is None:
            return
        step, title = session.undo_stack.index(), preset_title(preset)
        session.edit(lambda design: with_preset(design, preset), tr("Preset {name}").format(name=title))
        self._context.navigation.show_step("lines")
        if session.design is None or session.design is before:
            return
        led = _led_anew(before, session.design)
        if led:
            text = tr("Line paths from preset {name}: {lines}").format(name=title, lines=led)
            undo = tr("Undo"), partial(session.undo_stack.setIndex, step)
            self._context.notifications.info(text, preset_note(preset), [undo])

    def ask(self) -> None:
        """Prompt for a name, and save the present lines as a preset."""
        # Not the name of the project: a set of lines is for more than one customer.
        taken, name = {preset.title for preset in user_presets()[0]}, tr("Custom lines")
        names = chain([name], (f"{name} {number}" for number in count(2)))
        offered = next(each for each in names if each not in taken)
        while title := ask_name(
            self._context.window, tr("Save lines as preset"), tr("Preset name"), offered, LONGEST_TITLE
        ):
            if not user_file(title).exists() or self._may_replace(title):
                self.save(title)
                return
            offered = title

    def _may_replace(self, title: str) -> bool:
        """Ask whether the preset of that name may go; without an answer the name is asked for again."""
        question = tr("Replace the preset {name}?").format(name=title)
        text = tr("A preset of that name already exists. Its lines will be lost.")
        return ask(self._context.window, question, text, [("replace", tr("Replace"))]) == "replace"

    def save(self, title: str) -> None:
        """Keep the present lines as a preset."""
        session = self._context.session
        if session.design is None:
            return
        try:
            path = save_preset(preset_from(session.design, title))
        except UserError as problem:
            self._context.notifications.error(problem, "preset")
            return
        self._context.notifications.withdraw("preset")
        self._context.notifications.done(tr("Preset {name} saved.").format(name=title), str(path))


def _goes(preset: Preset, design: Design) -> bool:
    return preset.template in ("", design.template)


def _led_anew(before: Design, after: Design) -> str:
    """Return the titles of the lines that were led by hand and are led otherwise now."""
    courses = {line.name: line for line in before.own_lines}
    names = [line.name for line in after.own_lines if courses.get(line.name, line) != line]
    return listed(dict.fromkeys(row_title(name, after) for name in names))
