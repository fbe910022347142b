"""Constraining lines: list, sliders, drawing, paths."""
