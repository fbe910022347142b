"""Start page, recent files, autosave, recovery."""
