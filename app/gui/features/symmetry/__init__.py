"""Left and right compared and balanced."""
