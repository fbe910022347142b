"""Rooms of what leaves Busk for other programs: by command, or from the window."""
