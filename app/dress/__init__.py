"""Dress: theme, icons and the small widgets that every panel is put together from."""
