"""Wording: words, colours and numbers that the window speaks in."""
