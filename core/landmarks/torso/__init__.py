"""Cross-sections of the torso without the arms, and their girths."""
