"""The steps of a random walk that lines take: lengths, traits, lines added, drawn and removed."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce

from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit
from shiboken6 import isValid
from window_tools import Script, drag
from window_walk import WindowWalk

from app.gui.features.lines.row import LineRow
from core.control_mesh.template import read_template
from core.document.design import Design
from core.document.line_notation import ready_made_lines
from core.document.lines import partner_of
from core.mechanics.constraint_lines import parse_ratio

NO_KEY, SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
TRAITS = ("locked", "linked", "title", "colour", "stiffness", "hide")
_NOTHING = object()


class LinesWalk(WindowWalk):
    """Makes steps with lines, each as a hand makes it, and says what it must lead to."""

    def undo(self) -> None:
        """Take the last edit back."""
        self.window.actions_.undo.trigger()
        self.present = max(self.present - 1, 0)

    # -- lengths

    def row(self) -> tuple[str, LineRow] | None:
        """Select a line at random; None if the list is one frame behind, and the line is no more."""
        name = self.chance.choice(list(self.window.lines.rows))
        self.window.navigation.show_step("lines")
        self.window.selection.select_line(name)
        self.say(name)
        there = {"mid-bust", "full-bust", "under-bust", *(line.name for line in self.design.own_lines)}
        return (name, self.window.lines.rows[name]) if name in there else None

    def settle(self, name: str, ratio: float) -> None:
        """Note a length that was set; at its rest length a line is off."""
        self.decide(lambda design: design.with_linked(name, None if abs(ratio - 1.0) < 5e-6 else ratio))

    def slide(self) -> Script:
        """Drag a handle, and let it go or press Esc; now and then something is undone meanwhile."""
        chosen = self.row()
        if chosen is None or not chosen[1].slider.isEnabled():
            return
        name, row = chosen
        before, slider = row.slider.ratio(), row.slider
        drag(self.window, name, self.chance.randrange(-40, 40), release=False)
        yield lambda: True
        if self.chance.random() < 0.15:
            self.undo()
            yield lambda: True
        if not isValid(slider):
            return  # the line went with the edit
        if self.chance.random() < 0.2:
            QTest.keyClick(slider, Qt.Key.Key_Escape)
            self.must(slider.ratio() == before, "Esc brings the handle back")
        ratio, decided = slider.ratio(), slider.isSliderDown() and slider._previewed
        QTest.mouseRelease(slider, Qt.MouseButton.LeftButton)
        if decided:
            self.settle(name, ratio)

    def press(self) -> None:
        """Move a handle by keys."""
        chosen = self.row()
        if chosen is None or not chosen[1].slider.isEnabled():
            return
        name, row = chosen
        for _ in range(self.chance.randrange(1, 4)):
            before = row.slider.value()
            key = self.chance.choice((Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Backspace))
            QTest.keyClick(row.slider, key, self.chance.choice((NO_KEY, SHIFT)))
            if row.slider.value() != before:
                self.settle(name, row.slider.ratio())

    def type_length(self) -> None:
        """Type a length in percent or millimetres, now and then one that cannot be read."""
        chosen = self.row()
        if chosen is None or not chosen[1].percent.isEnabled():
            return
        name, row = chosen
        percent = round(self.chance.choice((93.0, 97.0, 100.0, self.chance.uniform(80.0, 110.0))), 1)
        rest = row.view.rest_mm
        in_mm = f"{percent / 100.0 * rest:.1f}mm"
        text = self.chance.choice((f"{percent}", f"{percent}%", f"-{abs(100 - percent):.1f}%", in_mm, "wide"))
        field = self.chance.choice((row.percent, row.millimetres))
        before = field.text()
        self.say(text)
        unit = "%" if field is row.percent else "mm"
        ratio = parse_ratio(text, rest, unit)
        type_in(field, text)
        if ratio is None or not 0.5 <= ratio <= 1.3:
            QTest.keyClick(field, Qt.Key.Key_Escape)
            self.must(field.text() == before, "Esc brings the length back")
        else:
            self.settle(name, ratio)

    # -- lines

    def treat(self) -> None:
        """Lock a line, link it, give it another name, colour or stiffness, or hide it."""
        chosen = self.row()
        if chosen is None:
            return
        name, row = chosen
        what = self.chance.choice(TRAITS)
        self.say(what)
        if what == "hide":
            self.window.lines.do("hide")
        elif what == "linked":
            self._link(name, row)
        else:
            names, value = self.design.linked_lines(name), self._trait(what, row)
            if value is not _NOTHING:
                self.decide(lambda design: reduce(lambda d, n: treated(d, n, what, value), names, design))

    def _trait(self, what: str, row: LineRow) -> object:
        """Give a trait by its button or field, and return its value."""
        if what == "locked":
            value: object = not row.view.locked
            row._lock.click()
        elif what == "title":
            value = self.chance.choice(("", "Upper edge", "Zierband", "紐"))
            row.title.begin()
            type_in(row.title._editor, value)
            if value == "" and not self.design.line_settings(row.view.name).title:
                return _NOTHING
        elif what == "colour":
            action = self.chance.choice([each for each in row.details._palette.actions() if each.text()])
            heard: list[str] = []
            row.details._palette.chosen.connect(heard.append)
            action.trigger()
            value = heard[0]
        else:
            if not row.view.constrained:
                return _NOTHING
            value = self.chance.choice((None, 0.5, 2.0))
            type_in(row.details._stiffness, "" if value is None else str(value))
        return value

    def _link(self, name: str, row: LineRow) -> None:
        if not row.view.partner:
            return
        linked, names = not row.view.sides, (name, partner_of(name))
        self.window.lines.do("link")
        if linked:
            self.decide(lambda design: design.with_link(name))
        else:
            self.decide(lambda design: reduce(lambda d, n: treated(d, n, "linked", False), names, design))

    def add(self) -> None:
        """Add a pair of ready-made lines from the menu."""
        kind = self.chance.choice(list(self.window.actions_.add_lines))
        self.window.actions_.add_lines[kind].trigger()
        pair, present = ready_made_lines(read_template(self.design.template))[kind], self.design.own_lines
        missing = [line for line in pair if line.name not in {each.name for each in present}]
        self.decide(lambda design: reduce(Design.with_custom_line, missing, design))

    def remove(self) -> None:
        """Remove a line as by its key, if it is an own one."""
        chosen = self.row()
        if chosen is None or not chosen[1].view.own:
            return
        names = self.design.linked_lines(chosen[0])
        self.window.lines.do("remove")
        self.decide(lambda design: reduce(Design.without_custom_line, names, design))

    def sketch(self) -> Script:
        """Draw a line over the skin, and keep it or leave it."""
        before, drawing = self.design, self.window.draw_tool
        canvas = self.window.view.viewport.overlay.parentWidget()
        drawing.begin()
        for _ in range(3):
            x, y = self.chance.uniform(0.4, 0.6), self.chance.uniform(0.35, 0.6)
            drawing._sketching.hand.clicked.emit(QPointF(x * canvas.width(), y * canvas.height()))
            yield lambda: True
        if self.chance.random() < 0.5:
            self.undo()
            before = self.design
            self.check()
        drawing.go_on()
        if drawing._found is not None:
            drawing.go_on()
            assert self.session.design is not None
            new = [line for line in self.session.design.own_lines if line not in before.own_lines]
            self.must(len(new) in (1, 2), new)
            self.decide(lambda design: reduce(Design.with_custom_line, new, design))
        drawing.leave()


def type_in(field: QLineEdit, text: str) -> None:
    """Type something over what a field says."""
    field.setFocus()
    field.selectAll()
    QTest.keyClick(field, Qt.Key.Key_Backspace)
    field.insert(text)  # as an input method does, in any script
    QTest.keyClick(field, Qt.Key.Key_Return)


def treated(design: Design, name: str, trait: str, value: object) -> Design:
    """Return a design with one line treated otherwise."""
    return design.with_line_settings(replace(design.line_settings(name), **{trait: value}))  # type: ignore[arg-type]
