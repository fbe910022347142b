"""Orientation and unit of a scan."""
