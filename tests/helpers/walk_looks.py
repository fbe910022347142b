"""What a random walk through the window looks at: where fields and document tell different things."""

from __future__ import annotations

from dataclasses import fields

from app.gui.main_window import MainWindow
from app.gui.widgets.option_field import AmountField
from app.i18n.catalog import number
from app.presenters.model_options import present_values
from core.document.design import Design
from core.document.document import Document


def differences(one: Document, other: Document) -> list[str]:
    """Tell in which fields two documents differ."""
    found = [] if one.shown == other.shown else [f"{one.shown} shown for {other.shown}"]
    for name in sorted({*one.variants, *other.variants}):
        first, second = one.variants.get(name), other.variants.get(name)
        for field in fields(Design):
            values = getattr(first, field.name, None), getattr(second, field.name, None)
            if values[0] != values[1]:
                found.append(f"{name}.{field.name}: {values[0]} for {values[1]}")
    return found


def differences_seen(window: MainWindow, document: Document) -> list[str]:
    """Tell where the window at rest shows something else than a document."""
    design, found = document.design, [*_lines_seen(window, document.design)]
    present = present_values(design)
    if window.model._present.keys() != present.keys():
        found.append(f"model options {window.model._present.keys() ^ present.keys()}")
    for key, field in window.model.fields.items():
        if key not in present:
            continue
        if isinstance(field, AmountField):
            value, scale = present[key], field.edit._amount.scale
            shown = "" if value is None else number(scale * value, field.edit._amount.digits).replace(",", "")
            if field.edit.text() != shown:
                found.append(f"{key}: {field.edit.text()!r} for {shown!r}")
        if window.model._present[key] != present[key]:
            found.append(f"{key}: {window.model._present[key]} for {present[key]}")
    do, segment = window.actions_, window.variants_controller.segment
    for name, said in (
        ("control", do.controls[design.volume].isChecked()),
        ("template", do.templates[design.template].isChecked()),
        ("shown variant", segment.button(document.shown).isChecked()),
    ):
        if not said:
            found.append(f"{name} is not what is chosen")
    there = {name for name in "ABC" if not segment.button(name).text().startswith("+")}
    if there != set(document.variants):
        found.append(f"variants {there}")
    by_hand = {name for name, row in window.landmarks.rows.items() if row.view.by_hand}
    if by_hand != {mark.name for mark in design.placed}:
        found.append(f"placed by hand: {by_hand}")
    stack, edits = window.session.undo_stack, window.history.edits
    if edits.count() != stack.count() + 1:
        found.append(f"{edits.count()} rows of history for {stack.count()} edits")
    if do.undo.isEnabled() != stack.canUndo() or do.redo.isEnabled() != stack.canRedo():
        found.append("undo and redo are not offered as they can be done")
    return found


def _lines_seen(window: MainWindow, design: Design) -> list[str]:
    rows, found = window.lines.rows, []
    names = {"mid-bust", "full-bust", "under-bust", *(line.name for line in design.own_lines)}
    led = {name: min(design.linked_lines(name)) for name in names}
    if set(rows) != set(led.values()):
        found.append(f"rows {sorted(rows)} for {sorted(set(led.values()))}")
    for name in set(rows) & set(led.values()):
        row, traits, ratio = rows[name], design.line_settings(name), design.ratio(name)
        window.selection.select_line(name)  # what is in a closed row nobody sees
        # The slider ends where longer or shorter lines can still be typed.
        on_slider = min(max(ratio, row.slider.minimum() / 1e5), row.slider.maximum() / 1e5)
        for what, shown, wanted in (
            ("percent", row.percent.text(), number(100.0 * ratio).replace(",", "")),
            ("slider", round(row.slider.ratio(), 4), round(on_slider, 4)),
            ("lock", row.view.locked, traits.locked),
            ("stiffness", row.details._stiffness._stiffness, traits.stiffness),
            ("title", traits.title in row.title.text(), True),
            ("colour", traits.colour or row.view.color, row.view.color),
        ):
            if shown != wanted:
                found.append(f"{what} of {name}: {shown} for {wanted}")
    return found
