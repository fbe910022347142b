"""Panel of the model options."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from app.gui.theme.stylesheet import label, set_tag
from app.gui.widgets.basic import ScrollColumn, button, hairline, sentence
from app.gui.widgets.navigation_row import DOOR_HEIGHT, NavigationRow, page_head
from app.gui.widgets.option_field import AmountField, Field, field_of
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import colon, number, tr
from app.presenters.model_options import Setting, consequences, defaults, groups, summary, without_effect


class ModelPanel(QWidget):
    """All settings of the model. ``changed`` tells settings of the design with the name of the step."""

    changed = Signal(object, str)
    closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.fields: dict[str, Field] = {}
        self._rows: dict[str, QWidget] = {}
        self._heads: dict[str, QWidget] = {}
        self._present: dict[str, Any] = defaults()
        self._reset = button(tr("Reset to defaults"), "quiet")
        self._reset.clicked.connect(
            lambda: self.changed.emit(self._defaults(), tr("Model options reset to defaults"))
        )
        self._limit = sentence("", "caption")
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addLayout(page_head(tr("Model options"), tr("Back to lines"), self.closed))
        column.addWidget(self._scroll_area(), 1)
        column.addWidget(self._foot())
        self.set_values(self._present)

    def set_values(self, present: Mapping[str, Any]) -> None:
        """Show these settings of the design, and no others; nothing is emitted."""
        self._present = dict(present)
        for key, value in self._present.items():
            self.fields[key].show_value(value)
        shown = self._present.keys() - without_effect(self._present)
        for key, row in self._rows.items():
            row.setVisible(key in shown)
        for title, settings in groups():
            self._heads[title].setVisible(any(setting.key in shown for setting in settings))
        self._reset.setEnabled(self._present != self._defaults())

    def set_gain(self, gain: float, limit: float) -> None:
        """Show the conventional gain in force and the limit from which on it vibrates at rest."""
        field = self.fields["gain"]
        assert isinstance(field, AmountField)
        field.edit.setPlaceholderText(number(gain, 2))
        above = gain > limit
        text = (
            tr("Above {limit} the solver oscillates. Enter a lower gain.")
            if above
            else tr("The solver oscillates above {limit}.")
        )
        self._limit.setText(text.format(limit=number(limit, 2)))
        set_tag(self._limit, "tone", "warn" if above else "")

    def _defaults(self) -> dict[str, Any]:
        """Return the defaults of the settings that the design has."""
        return {key: value for key, value in defaults().items() if key in self._present}

    def _foot(self) -> QWidget:
        foot = QWidget()
        foot.setFixedHeight(DOOR_HEIGHT)
        column = QVBoxLayout(foot)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(hairline())
        row = QHBoxLayout()
        row.setContentsMargins(6, 0, 10, 0)
        row.addWidget(self._reset)
        row.addStretch(1)
        column.addLayout(row, 1)
        return foot

    def _scroll_area(self) -> ScrollColumn:
        area = ScrollColumn(tr("Model options"), (18, 2, 18, 16), 9)
        column = area.column
        for place, (title, settings) in enumerate(groups()):
            self._heads[title] = _head(title, parted=place > 0)
            column.addWidget(self._heads[title])
            for setting in settings:
                self._rows[setting.key] = self._row(setting)
                column.addWidget(self._rows[setting.key])
                if setting.key == "gain":
                    column.addWidget(self._limit)
        column.addStretch(1)
        return area

    def _row(self, setting: Setting) -> QWidget:
        field = field_of(setting)
        field.chosen.connect(lambda value: self._choose(setting, value))
        self.fields[setting.key] = field
        title = label(setting.title, "secondary")
        for each in (title, field):
            set_tip(each, setting.tip)
        field.describe(setting.title, setting.tip)
        row = QWidget()
        line = QHBoxLayout(row)
        line.setContentsMargins(0, 0, 0, 0)
        line.addWidget(title)
        line.addStretch(1)
        line.addWidget(field)
        return row

    def _choose(self, setting: Setting, value: Any) -> None:
        if value != self._present[setting.key]:
            changes = consequences(setting.key, value, self._present)
            self.changed.emit(changes, f"{setting.title}{colon()}{setting.words(value)}")


def _head(title: str, *, parted: bool) -> QWidget:
    """Return the heading of a group, below a line where it is ``parted`` from another one."""
    head = QWidget()
    column = QVBoxLayout(head)
    column.setContentsMargins(0, 5 if parted else 0, 0, 0)
    column.setSpacing(14)
    if parted:
        column.addWidget(hairline())
    column.addWidget(label(title, "name"))
    return head


class ModelRow(NavigationRow):
    """The way to the settings from under the lines: what is chosen, in a line."""

    def __init__(self) -> None:
        super().__init__(tr("Model options"))

    def set_values(self, present: Mapping[str, Any]) -> None:
        """Show the current choices."""
        self.show_words(summary(present))
