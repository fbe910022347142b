"""The keys that parts of the window read themselves, which no menu has: each part says its own."""

from __future__ import annotations

from collections.abc import Iterator

from app.gui.features.help.command_palette import Command, normalized
from app.gui.features.landmarks import panel as landmarks
from app.gui.features.lines import panel as lines
from app.gui.features.measurements import table as measure_table
from app.gui.features.project import project_card
from app.gui.plots import canvas as plot_canvas
from app.gui.viewport import drawing_tool as hand
from app.gui.viewport import split_view as wipe
from app.gui.viewport.mouse_bindings import chosen_gestures, gestures_in_words
from app.gui.widgets import splitter as divider
from app.gui.widgets import value_edit as typed_field
from app.i18n.catalog import in_all_languages, tr


def keys_of_parts() -> Iterator[Command]:
    """Return each key with its action and place, and the mouse actions of the view."""
    parts = (
        (tr("3D view"), gestures_in_words(chosen_gestures())),
        (tr("List of lines"), lines.keys_in_words()),
        (tr("Input fields"), typed_field.keys_in_words()),
        (tr("Line drawing"), hand.keys_in_words()),
        (tr("List of landmarks"), landmarks.keys_in_words()),
        (tr("Table of measurements"), measure_table.keys_in_words()),
        (tr("Before / after divider"), wipe.keys_in_words()),
        (tr("Live plot"), plot_canvas.keys_in_words()),
        (tr("Pane dividers"), divider.keys_in_words()),
        (tr("Start page"), project_card.keys_in_words()),
    )
    for where, keys in parts:
        for key, what in keys:
            words = (*in_all_languages(what), *in_all_languages(where), key)
            yield Command(what, where, key, normalized(" ".join(words)))
