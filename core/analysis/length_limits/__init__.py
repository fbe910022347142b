"""Limits of line lengths and zones of sliders."""
