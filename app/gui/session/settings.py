"""User preferences and their defaults."""

from __future__ import annotations

from PySide6.QtCore import QSettings

DEFAULTS = {
    "theme": "system",
    "language": "en",
    "unit": "mm",  # of lengths in the window, one of app.i18n.lengths.UNITS
    "start": "page",  # what opens: the start page, the last project or the sample
    "mouse": "busk",  # one of app.gui.viewport.mouse_bindings.PRESETS
    "material": "clay",  # one of app.rendering.appearance.MATERIALS
    "motion": "full",  # or reduced
    "autosave": "10",  # seconds after an edit
    "export": "{}",  # what was chosen to export, as app.presenters.export keeps it
    "section_folded": "no",  # whether the section's panel shows its place alone
    "size_system": "jp",  # the key of a table of sizes
}
"""Every wish by its key in the settings, with the answer that holds until the user gives another."""


def get_setting(key: str) -> str:
    """Return what the user wishes, as text."""
    return str(QSettings().value(key, DEFAULTS[key]))


def set_setting(key: str, value: str) -> None:
    """Keep a wish for now and for later sessions."""
    QSettings().setValue(key, value)


def wants_motion() -> bool:
    """Return whether animations are enabled."""
    return get_setting("motion") == "full"
