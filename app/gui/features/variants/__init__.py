"""Variants and history."""
