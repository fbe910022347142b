"""The preferences: a few wishes, each in force as soon as it is chosen."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QWidget

from app.gui.theme.stylesheet import label
from app.gui.widgets.basic import sentence
from app.gui.widgets.dialog import Dialog
from app.gui.widgets.option_field import Field, field_of
from app.gui.widgets.tooltip import set_tip
from app.i18n.catalog import LANGUAGES, tr
from app.presenters.model_options import Amount, Choice, Setting

AUTOSAVE = 5, 600
"""Shortest and longest time between two automatic saves [s]."""


class PreferencesDialog(Dialog):
    """All wishes by group; ``changed`` tells the key of one and its new value, as text."""

    changed = Signal(str, str)
    log_requested = Signal()

    def __init__(self, parent: QWidget, values: Mapping[str, str]) -> None:
        super().__init__(parent, tr("Preferences"), (600, 0))
        self.fields: dict[str, Field] = {}
        grid = QGridLayout()
        grid.setColumnStretch(0, 1)
        grid.setHorizontalSpacing(24)
        grid.setVerticalSpacing(2)
        for title, settings in _groups():
            heading = label(title, "heading")
            heading.setContentsMargins(0, 14, 0, 6)
            grid.addWidget(heading, grid.rowCount(), 0, 1, 2)
            for setting in settings:
                self._add(grid, setting, values[setting.key])
        self.body.addLayout(grid)
        self.body.addStretch(1)
        log = self.add_button(tr("Open log folder"), self.log_requested.emit, "quiet")
        set_tip(log, tr("Show the error logs, which contain no scans or measurements"))
        self.foot.removeWidget(log)
        self.foot.insertWidget(0, log)
        self.add_close()

    def show_value(self, key: str, value: str) -> None:
        """Show what holds now."""
        self.fields[key].show_value(float(value) if key == "autosave" else value)

    def _add(self, grid: QGridLayout, setting: Setting, value: str) -> None:
        row, field = grid.rowCount(), field_of(setting)
        name, tip = label(setting.title, "body"), sentence(setting.tip, "caption")
        field.describe(setting.title, setting.tip)
        for each in (name, field):
            set_tip(each, setting.tip)
        field.chosen.connect(lambda chosen: self._choose(setting.key, chosen))
        self.fields[setting.key] = field
        tip.setContentsMargins(0, 0, 0, 8)
        grid.addWidget(name, row, 0, Qt.AlignmentFlag.AlignBottom)
        grid.addWidget(tip, row + 1, 0)
        grid.addWidget(field, row, 1, 2, 1, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.show_value(setting.key, value)

    def _choose(self, key: str, chosen: object) -> None:
        if key == "autosave":
            seconds = float(str(chosen)) if chosen is not None else AUTOSAVE[0]
            chosen = round(min(max(seconds, AUTOSAVE[0]), AUTOSAVE[1]))
        self.show_value(key, str(chosen))
        self.changed.emit(key, str(chosen))


def _autosave() -> Amount:
    every = tr("Autosave interval for unsaved changes, {least} to {most} s.")
    least, most = AUTOSAVE
    unit = tr("{seconds} s").format(seconds="").strip()
    text = every.format(least=least, most=most)
    return Amount("autosave", tr("Autosave"), text, unit, 1.0, 0, (float(least), float(most)))


def _groups() -> tuple[tuple[str, tuple[Setting, ...]], ...]:
    themes = (("system", tr("System default")), ("light", tr("Light")), ("dark", tr("Dark")))
    units = (("mm", tr("Millimetres")), ("cm", tr("Centimetres")), ("in", tr("Inches")))
    starts = (("page", tr("Start page")), ("last", tr("Last project")))
    hands = (("busk", "Busk"), ("cad", "CAD"), ("blender", "Blender"), ("trackpad", tr("Trackpad")))
    materials = (("clay", tr("Clay")), ("plaster", tr("Plaster")), ("graphite", tr("Graphite")))
    motions = (("full", tr("Full")), ("reduced", tr("Reduced")))
    turns = tr("Mouse buttons for rotating, moving and zooming the body.")
    again = tr("Takes effect when Busk restarts.")
    lengths = tr("On screen and in reports. Takes effect when Busk restarts.")
    return (
        (
            tr("Window"),
            (
                Choice("language", tr("Language"), again, tuple(LANGUAGES.items())),
                Choice("unit", tr("Lengths"), lengths, units),
                Choice("theme", tr("Theme"), tr("Light or dark colours of the window."), themes),
                Choice("start", tr("At startup"), tr("First page shown in the window."), starts),
            ),
        ),
        (
            tr("3D view"),
            (
                Choice("mouse", tr("Mouse"), turns, hands),
                Choice("material", tr("Material"), tr("Material of the body in the view."), materials),
                Choice("motion", tr("Motion"), tr("Reduced: no camera animation."), motions),
            ),
        ),
        (tr("Recovery"), (_autosave(),)),
    )
