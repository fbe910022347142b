"""Lining: what the window does about lines: the list, drawing, routing, presets, limits."""
