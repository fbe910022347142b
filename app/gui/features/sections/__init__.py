"""Plane sections and profiles."""
