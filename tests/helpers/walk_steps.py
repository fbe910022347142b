"""The other steps of a random walk through the window: landmarks, model, history, files, looks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import reduce

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from walk_lines import NO_KEY, SHIFT, LinesWalk, type_in
from window_tools import Script
from window_walk import Step

from app.gui.widgets.option_field import AmountField, MenuField, SegmentField
from app.presenters.model_options import Amount, Choice, consequences, defaults, groups, present_values
from core.document.design import TEMPLATES, Design
from core.document.storage.project_file import with_scan
from core.garment.presets import built_in, with_preset
from core.landmarks.manual import nearest_skin

SETTINGS = [setting for _, settings in groups() for setting in settings]
AMOUNTS = {
    "line_stiffness": ("0.5", "1", "2,5"),
    "line_height": ("40", "55"),
    "prestress": ("30", "80"),
    "gain": ("", "0.02"),
    "sag": ("15", "30"),
    "density": ("0.9", "1"),
    "belly_line_height": ("40", "50"),
    "waist_kept": ("0", "80"),
    "lower_firmness": ("0", "0.3"),
    "lower_stiffness": ("100", "200"),
}
PINS = ("bust_point_left", "bust_point_right", "under_bust", "fold_left", "navel")
LOOKS = (
    "perspective",
    "control-mesh",
    "landmarks",
    "bands",
    "section",
    "map",
    "ghost",
    "wipe",
    "side",
    "fit",
)
OTHERS = ("flip", "step", "theme", "language", "strip", "inspector", "alone")
ANSWERS = ("save", "discard", "stay")
ARROWS = (Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Up, Qt.Key.Key_Down)


class Walker(LinesWalk):
    """Makes steps at random."""

    def whims(self) -> dict[Callable[[], Step], int]:
        """Return every step that can be made with how often it is."""
        often = {self.slide: 5, self.press: 4, self.type_length: 4, self.treat: 5, self.pin: 4, self.look: 6}
        often |= {self.undo: 6, self.redo: 4, self.model: 5, self.choose: 2, self.add: 2, self.remove: 2}
        often |= {self.variant: 3, self.jump: 2, self.restore: 2, self.wear: 1, self.reset: 1, self.save: 3}
        return often | {self.open: 1, self.cancel: 1, self.sketch: 1, self.wait: 3, self.mark: 2}

    # -- landmarks

    def pin(self) -> Script:
        """Move a pin by keys or by the pointer; put it down, let it go, or do something else."""
        name, panel, view = self.chance.choice(PINS), self.window.landmarks, self.window.view.viewport
        frame = self.session.frame
        assert frame is not None
        if name not in panel.rows or panel.rows[name].view.absent:
            return
        self.say(name)
        self.window.navigation.show_step("landmarks")
        panel.link.setChecked(self.chance.random() < 0.3)
        by_keys = self.chance.random() < 0.5
        if by_keys:
            panel.rows[name].click()
            for key in self.chance.choices(ARROWS, k=3):
                QTest.keyClick(view, key, self.chance.choice((NO_KEY, SHIFT)))
        else:
            view.pin_pressed.emit(name)
            for _ in range(3):
                place = frame.stages.landmarks.position(name)
                off = np.array([self.chance.uniform(-6.0, 6.0) for _ in range(3)])
                view.pin_moved.emit(name, nearest_skin(frame.stages.body.smoothed, place + off))
                yield lambda: True
        self.must(self.window.landmarks_controller.carries, "the pin is carried")
        carried = tuple(self.window.landmarks_controller._carried)
        end = self.chance.choice(("put down", "wait", "let go", "undo", "save", "variant"))
        self.say(end)
        if end == "let go":
            self.window.actions_.cancel.trigger()
            view.pin_released.emit(name)
            return
        if end in ("undo", "variant"):
            getattr(self, end)()
            self.check()
        if end == "wait" and by_keys:
            yield lambda: not self.window.landmarks_controller.carries
        elif end == "save":
            self.window.landmarks_controller.put_down()
        elif by_keys:
            QTest.keyClick(view, Qt.Key.Key_Return)
        else:
            view.pin_released.emit(name)
        self._placed(carried)
        if end == "save":
            yield from self.save()

    def _placed(self, names: tuple[str, ...]) -> None:
        """Note where pins were put: nothing else has changed."""
        assert self.session.design is not None
        places = {mark.name: mark.position for mark in self.session.design.placed}
        self.must(set(names) <= set(places), f"{names} are placed")
        self.decide(lambda design: reduce(lambda d, n: d.with_placed(n, places[n]), names, design))

    def mark(self) -> None:
        """Say that a landmark is right, or let one or all be found again."""
        panel, name, what = self.window.landmarks, self.chance.choice(PINS), self.chance.randrange(3)
        placed = tuple(mark.name for mark in self.design.placed)
        if what == 0 and name in panel.rows and not panel.rows[name].view.absent:
            panel.select(name)
            panel.right.click()
            self._placed((name,))
        elif what == 1 and placed:
            panel.select(placed[0])
            panel.reset.click()
            self.decide(lambda design: design.with_placed(placed[0], None))
        elif what == 2:
            shown = panel._placed()
            if shown:
                panel.reset_all.click()
                self.decide(lambda design: reduce(lambda d, n: d.with_placed(n, None), shown, design))

    # -- the model

    def model(self) -> None:
        """Choose a setting of the model, or bring all back."""
        if self.chance.random() < 0.15:
            self.window.model._reset.click()
            usual = {key: value for key, value in defaults().items() if key in present_values(self.design)}
            self.decide(lambda design: design.with_settings(usual))
            return
        setting = self.chance.choice([each for each in SETTINGS if each.key in present_values(self.design)])
        value = self._setting(setting)
        self.say(f"{setting.key} {value}")
        if value != self.design.setting(setting.key):
            self.decide(lambda d: d.with_settings(consequences(setting.key, value, present_values(d))))

    def _setting(self, setting: Amount | Choice) -> object:
        field = self.window.model.fields[setting.key]
        if isinstance(field, AmountField) and isinstance(setting, Amount):
            text = self.chance.choice(AMOUNTS[setting.key])
            type_in(field.edit, text)
            return float(text.replace(",", ".")) / setting.scale if text else None
        place, (value, _) = self.chance.choice(list(enumerate(setting.options)))
        if isinstance(field, SegmentField):
            field.segment.button(str(place)).click()
        elif isinstance(field, MenuField):
            field.actions_by_value[value].trigger()
        return value

    def choose(self) -> None:
        """Choose control or control mesh from the menu."""
        do = self.window.actions_
        if self.chance.random() < 0.5:
            template = self.chance.choice(TEMPLATES)
            do.templates[template].trigger()
            self.decide(lambda design: design.with_template(template))
        else:
            control = self.chance.choice(list(do.controls))
            do.controls[control].trigger()
            self.decide(lambda design: replace(design, volume=control))

    def wear(self) -> None:
        """Wear a preset."""
        place, preset = self.chance.choice([each for each in enumerate(built_in()) if not each[1].tissue])
        self.window.actions_.menus["presets"].actions()[place].trigger()
        self.decide(lambda design: with_preset(design, preset))

    def reset(self) -> None:
        """Take all lines off."""
        self.window.actions_.reset.trigger()
        self.decide(Design.with_lines_reset)

    # -- what was, what might be

    def redo(self) -> None:
        """Make the last edit again that was taken back."""
        self.window.actions_.redo.trigger()
        self.present = min(self.present + 1, len(self.entries) - 1)

    def jump(self) -> None:
        """Go to an edit in the history."""
        edits = self.window.history.edits
        self.present = self.chance.randrange(max(edits.count() - 8, 0), edits.count())
        edits.itemClicked.emit(edits.item(self.present))

    def restore(self) -> None:
        """Go back to a settled result."""
        rows, kept = self.window.history.snapshots, self.window.history_controller._snapshots
        if rows.count():
            place = self.chance.randrange(rows.count())
            after = kept[len(kept) - 1 - place].within(self.document)
            rows.itemClicked.emit(rows.item(place))
            self.note(after)

    def variant(self) -> None:
        """Show a variant, or remove the one that is shown."""
        name, menu = self.chance.choice("ABC"), self.window.actions_.menus["variants"]
        self.say(name)
        if self.chance.random() < 0.3:
            next(each for each in menu.actions() if each.text() == "Remove this variant").trigger()
            self.note(self.document.without(self.document.shown))
        elif self.chance.random() < 0.2:
            menu.actions()[-1].trigger()
        else:
            self.window.variants_controller.segment.button(name).click()
            if name != self.document.shown:
                self.note(self.document.with_shown(name))

    def cancel(self) -> None:
        """Press Esc: an edit that is being worked out goes, an undoing too; so does a line in the making."""
        stack = self.session.undo_stack
        self.window.actions_.cancel.trigger()
        if stack.index() > self.present:
            self.present += 1
        elif stack.count() < len(self.entries) - 1:
            del self.entries[self.present]
            self.present -= 1

    # -- files

    def save(self) -> Script:
        """Save, here or elsewhere, and wait for it or go on."""
        path, do = self.folder / f"{self.chance.randrange(3)}.busk", self.window.actions_
        self.answers["path"] = str(path)
        here = self.session.path if self.chance.random() < 0.6 else None
        (do.save_as if here is None else do.save).trigger()
        self.saved[here or path] = self.document
        if self.chance.random() < 0.7:
            yield lambda: not self.session._saving.at_work
            self.must(self.session.path == (here or path), self.session.path)

    def open(self) -> Script:
        """Open what was saved, and be asked about the changes; now and then go on working meanwhile."""
        if not self.saved:
            return
        self.session.finish_saving()
        path, self.answers["changes"] = self.chance.choice(list(self.saved)), self.chance.choice(ANSWERS)
        self.answers["path"] = str(path)
        self.say(f"{path.name} {self.answers['changes']}")
        asked, opened = self.session.unsaved, []
        self.session.opened.connect(opened.append)
        if asked and self.answers["changes"] == "save":
            self.saved[self.session.path or path] = self.document
        self.window.actions_.open.trigger()
        if asked and self.answers["changes"] == "stay":
            return
        if self.chance.random() < 0.2:
            self.say("and went on")
            self.add()
        went_on = self.session._opening is None
        yield lambda: bool(opened) or went_on
        if went_on:
            return
        now = self.session.document
        self.must(now and with_scan(now, "", "") == with_scan(self.saved[path], "", ""), "it is another one")
        self.check_files()
        self.entries, self.present = [now], 0

    # -- what changes nothing

    def look(self) -> None:
        """Look at the body in another way, or at another panel."""
        tools, do = self.window.view.tool_actions, self.window.actions_
        name = self.chance.choice(
            (*LOOKS, "flip", "step", "theme", "language", "strip", "inspector", "alone")
        )
        self.say(name)
        if name in tools:
            tools[name].trigger()
        elif name in ("step", "theme", "language"):
            group = {"step": do.steps, "theme": do.themes, "language": do.languages}[name]
            group[self.chance.choice(list(group))].trigger()
        else:
            getattr(do, name).trigger()

    def wait(self) -> Script:
        """Let all come to rest, and stand long enough for a picture of it."""
        yield self.window.is_settled
        clock = self.window.history_controller._clock
        yield lambda: not clock.isActive()
