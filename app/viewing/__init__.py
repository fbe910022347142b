"""Viewing: how the body is looked at: before and after, side by side, maps, sections."""
