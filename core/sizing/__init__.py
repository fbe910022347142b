"""Rooms of ``core.sizes``: what a table of sizes is, how its file is read, the rule in words."""
