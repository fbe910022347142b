"""Widgets that any feature can use."""
