"""Command palette, user guide, about, faults."""
