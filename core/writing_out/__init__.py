"""Rooms of what is written for other programs: curves, strips and measures."""
