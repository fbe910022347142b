"""Measurements and sizes."""
