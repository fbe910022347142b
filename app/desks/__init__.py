"""Desks: what the window does when the session speaks or the user asks, one desk for each kind of work."""
