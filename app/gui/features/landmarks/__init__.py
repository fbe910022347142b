"""Landmarks: list, placement, warnings."""
