"""Presenting: what the window says, worked out as plain values for the panels."""
