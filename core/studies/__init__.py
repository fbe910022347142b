"""Runs over many lengths, searched or swept."""
