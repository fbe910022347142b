"""Coloured maps on the body."""
