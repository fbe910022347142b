"""Model options."""
