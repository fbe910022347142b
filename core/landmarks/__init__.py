"""Bust landmarks: detection, manual placement, validation and warnings."""
