"""The keys that parts of the window read themselves, which no menu has: each part says its own."""

from __future__ import annotations

from collections.abc import Iterator

from app.dress import divider
from app.panels import landmarks, lines, measure_table, project_card, typed_field
from app.panels.commands import Command, plain
from app.showing import hand, plot_canvas, wipe
from app.showing.gestures import chosen_gestures, gestures_in_words
from app.wording.words import in_all_languages, tr


def keys_of_parts() -> Iterator[Command]:
    """Give each key with what it does and where, and what a hand does in the view."""
    parts = (
        (tr("In the view"), gestures_in_words(chosen_gestures())),
        (tr("In the list of lines"), lines.keys_in_words()),
        (tr("In a field"), typed_field.keys_in_words()),
        (tr("While a line is drawn"), hand.keys_in_words()),
        (tr("In the list of landmarks"), landmarks.keys_in_words()),
        (tr("In the table of measures"), measure_table.keys_in_words()),
        (tr("On the handle of the wipe"), wipe.keys_in_words()),
        (tr("In the live plot"), plot_canvas.keys_in_words()),
        (tr("Between two parts of the window"), divider.keys_in_words()),
        (tr("On the start page"), project_card.keys_in_words()),
    )
    for where, keys in parts:
        for key, what in keys:
            words = (*in_all_languages(what), *in_all_languages(where), key)
            yield Command(what, where, key, plain(" ".join(words)))
