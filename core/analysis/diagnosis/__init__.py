"""Conflicting lines of a design, and changes that end the conflict."""
