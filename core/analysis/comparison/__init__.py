"""Comparison of two designs, body by body."""
