"""Differences of left and right, and lengths that balance them."""
